/* The firmware as a program: plays a table of samples, writes MAVLink to standard output.
 *
 * The table is a file of little-endian 64-bit floats in rows of seven: angular rate x, y, z (rad/s),
 * specific force x, y, z (m/s^2), temperature (degC). */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hk_app.h"
#include "hk_hal.h"
#include "hk_host_board.h"
#include "hk_virtual_mpu6050.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the table is little-endian, and this host is not"
#endif

#define HK_ROW_BYTES (HK_ROW_VALUES * sizeof(double))

static const char usage[] =
    "use: firmware TABLE [--settle N] [--realtime] [--statistics FILE]\n"
    "              [--who-am-i N] [--nack N] [--hold-sda CLOCKS] [--fault-row N]\n"
    "              [--fault KIND:ROW:AMOUNT]...\n"
    "--settle      samples that the driver drops before the first row (default 0)\n"
    "--realtime    keep pace with the wall clock and loop the table until SIGTERM\n"
    "--statistics  write one line of JSON there at the end\n"
    "--who-am-i, --nack, --hold-sda: faults of the sensor; --fault-row: from which row on\n"
    "--store FILE  what the non-volatile store holds; written back\n"
    "--received FILE  what the link receives and when\n"
    "--power-cut N  the supply fails once so many bytes have been written to the store\n"
    "--fault       plan a fault: see hk_fault_kind_t; numbers, KIND from 0\n";

static void fail(const char *what, const char *detail)
{
    (void)fprintf(stderr, "firmware: %s %s\n", what, detail);
    exit(EXIT_FAILURE);
}

static uint32_t number(const char *option, const char *text)
{
    char *end = NULL;
    unsigned long value = 0U;

    if (text == NULL) {
        fail(option, "needs a value");
        return 0U;
    }
    value = strtoul(text, &end, 0);
    if (*text == '\0' || *text == '-' || *end != '\0' || value > UINT32_MAX) {
        fail(option, "needs a number from 0 to 4294967295");
    }
    return (uint32_t)value;
}

static void add_fault(const char *text, hk_host_options_t *options)
{
    hk_host_fault_t *fault = &options->faults[options->fault_count];
    unsigned long kind;
    unsigned long row;
    unsigned long amount;

    if (text == NULL || sscanf(text, "%lu:%lu:%lu", &kind, &row, &amount) != 3
        || kind >= HK_FAULT_KINDS || options->fault_count == HK_PLANNED_FAULTS) {
        fail("--fault", "needs KIND:ROW:AMOUNT, of a kind that exists, and not too often");
        return;
    }
    fault->kind = (uint32_t)kind;
    fault->row = (uint32_t)row;
    fault->amount = (uint32_t)amount;
    options->fault_count++;
}

static long file_size(FILE *file)
{
    long size = -1;

    if (fseek(file, 0, SEEK_END) == 0) {
        size = ftell(file);
        rewind(file);
    }
    return size;
}

static double *load_table(const char *path, uint32_t *row_count)
{
    FILE *file = fopen(path, "rb");
    const long size = file == NULL ? -1 : file_size(file);
    double *rows = NULL;

    if (size < 0) {
        fail(path, "cannot be read");
    } else if (size == 0 || (size_t)size % HK_ROW_BYTES != 0U) {
        fail(path, "is not a table of whole rows of seven 64-bit floats");
    } else {
        rows = malloc((size_t)size);
    }
    if (rows == NULL || fread(rows, 1U, (size_t)size, file) != (size_t)size) {
        fail(path, "cannot be read");
    }
    (void)fclose(file);
    *row_count = (uint32_t)((size_t)size / HK_ROW_BYTES);
    return rows;
}

static const char *parse(int argc, char **argv, hk_host_options_t *options,
                         const char **statistics)
{
    const char *table = NULL;
    int i;

    for (i = 1; i < argc; i++) {
        const char *option = argv[i];
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;

        if (strcmp(option, "--realtime") == 0) {
            options->realtime = true;
            continue;
        }
        if (strncmp(option, "--", 2) != 0 && table == NULL) {
            table = option;
            continue;
        }
        if (strcmp(option, "--settle") == 0) {
            options->settle = number(option, value);
        } else if (strcmp(option, "--statistics") == 0) {
            *statistics = value;
        } else if (strcmp(option, "--who-am-i") == 0) {
            options->who_am_i = (int)(number(option, value) & 0xFFU);
        } else if (strcmp(option, "--nack") == 0) {
            options->nack = number(option, value);
        } else if (strcmp(option, "--hold-sda") == 0) {
            options->hold_sda = number(option, value);
        } else if (strcmp(option, "--fault") == 0) {
            add_fault(value, options);
        } else if (strcmp(option, "--store") == 0) {
            options->store = value;
        } else if (strcmp(option, "--received") == 0) {
            options->received = value;
        } else if (strcmp(option, "--power-cut") == 0) {
            options->power_cut = (long)number(option, value);
        } else if (strcmp(option, "--fault-row") == 0) {
            options->fault_row = number(option, value);
        } else {
            fail(option, "is not an option");
        }
        i++;
    }
    if (table == NULL) {
        (void)fputs(usage, stderr);
        exit(2);
    }
    return table;
}

static void write_statistics(const char *path)
{
    const hk_host_statistics_t s = hk_host_board_statistics();
    FILE *file = fopen(path, "w");

    if (file == NULL) {
        fail(path, "cannot be written");
        return;
    }
    (void)fprintf(file, "{\"rows_played\": %lu, \"unread_samples\": %lu, \"stalled\": %d, ",
                  (unsigned long)s.rows_played, (unsigned long)s.unread_samples, s.stalled ? 1 : 0);
    (void)fprintf(file, "\"struck\": %lu, \"resets\": %lu, \"time_s\": %.6f}\n",
                  (unsigned long)s.struck, (unsigned long)s.resets, s.time_s);
    (void)fclose(file);
}

static void on_signal(int number_of_signal)
{
    (void)number_of_signal;
    hk_host_board_stop();
}

/* The firmware from its reset on, which may come again and again. */
static void run(void)
{
    static hk_app_t app;

    (void)setjmp(hk_host_reset_vector);
    hk_hal_init();
    hk_app_init(&app);
    while (!hk_host_board_finished()) {
        if (hk_app_poll(&app)) {
            hk_hal_idle();
        }
    }
}

int main(int argc, char **argv)
{
    hk_host_options_t options = {.who_am_i = -1, .power_cut = -1};
    const char *statistics = NULL;
    const char *table = parse(argc, argv, &options, &statistics);
    double *rows = load_table(table, &options.row_count);

    (void)signal(SIGPIPE, SIG_IGN);
    (void)signal(SIGTERM, on_signal);
    (void)signal(SIGINT, on_signal);
    options.rows = rows;
    if (!hk_host_board_init(&options)) {
        fail("--store or --received", "names a file that cannot be used");
    }
    run();
    if (statistics != NULL) {
        write_statistics(statistics);
    }
    free(rows);
    return EXIT_SUCCESS;
}
