/* The firmware as a program for a single-board computer with Linux. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hk_app.h"
#include "hk_linux.h"

#define HK_DEVICE_BYTES 256

static const char usage[] =
    "use: firmware [--i2c DEVICE] [--int CHIP:LINE] [--serial DEVICE] [--store FOLDER]\n"
    "--i2c     bus with the sensor (default /dev/i2c-1)\n"
    "--int     line with the sensor's INT, such as /dev/gpiochip0:17 (default: it is polled)\n"
    "--serial  port for MAVLink (default: standard input and output)\n"
    "--store   folder that keeps parameters (default: they are forgotten)\n";

char **hk_linux_arguments;

static void fail(const char *what, const char *detail)
{
    (void)fprintf(stderr, "firmware: %s %s\n%s", what, detail, usage);
    exit(2);
}

static void parse_line(const char *text, hk_linux_options_t *options)
{
    static char chip[HK_DEVICE_BYTES];
    const char *colon = strrchr(text, ':');
    char *end = NULL;
    unsigned long line = 0U;

    if (colon != NULL) {
        line = strtoul(colon + 1, &end, 10);
    }
    if (end == NULL || end == colon + 1 || *end != '\0' || line > UINT32_MAX
        || (size_t)(colon - text) >= sizeof chip) {
        fail("--int", "needs CHIP:LINE");
        return;
    }
    (void)memcpy(chip, text, (size_t)(colon - text));
    options->chip = chip;
    options->line = (uint32_t)line;
}

static hk_linux_options_t parse(int argc, char **argv)
{
    hk_linux_options_t options = {.i2c = "/dev/i2c-1"};
    int i;

    for (i = 1; i < argc; i += 2) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;

        if (value == NULL) {
            fail(argv[i], "is not an option, or needs a value");
        } else if (strcmp(argv[i], "--i2c") == 0) {
            options.i2c = value;
        } else if (strcmp(argv[i], "--serial") == 0) {
            options.serial = value;
        } else if (strcmp(argv[i], "--int") == 0) {
            parse_line(value, &options);
        } else if (strcmp(argv[i], "--store") == 0) {
            options.store = value;
        } else {
            fail(argv[i], "is not an option");
        }
    }
    return options;
}

/* The firmware from its start on, which comes again when it is asked to reboot. */
static void run(void)
{
    static hk_app_t app;

    (void)setjmp(hk_linux_reset_vector);
    hk_hal_init();
    hk_app_init(&app);
    while (!hk_linux_finished()) {
        if (hk_app_poll(&app)) {
            hk_hal_idle();
        }
    }
}

int main(int argc, char **argv)
{
    hk_linux_options_t options;
    const char *unusable;

    hk_linux_arguments = argv;
    options = parse(argc, argv);
    unusable = hk_linux_open(&options);
    if (unusable != NULL) {
        perror(unusable);
        return EXIT_FAILURE;
    }
    run();
    return EXIT_SUCCESS;
}
