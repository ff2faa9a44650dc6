/* The sensor's INT on a line of the kernel's gpio character device. */
#include <fcntl.h>
#include <linux/gpio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "hk_linux.h"

static struct {
    int file;         /* of the line, or -1 */
    uint64_t rose_ns; /* when it rose last */
} pin = {.file = -1};

bool hk_linux_gpio_open(const char *chip, uint32_t line)
{
    struct gpio_v2_line_request request = {.num_lines = 1U};
    const int file = open(chip, O_RDWR | O_CLOEXEC);
    bool good;

    if (file < 0) {
        return false;
    }
    request.offsets[0] = line;
    request.config.flags = GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING;
    (void)strcpy(request.consumer, "hostkit");
    good = ioctl(file, GPIO_V2_GET_LINE_IOCTL, &request) == 0;
    (void)close(file);
    if (!good) {
        return false;
    }
    pin.file = request.fd;
    return fcntl(pin.file, F_SETFL, O_NONBLOCK) == 0;
}

int hk_linux_gpio_events(void)
{
    return pin.file;
}

bool hk_linux_gpio_high(uint64_t *since_ns)
{
    struct gpio_v2_line_values values = {.mask = 1U};
    struct gpio_v2_line_event event;

    if (pin.file < 0) {
        return false;
    }
    while (read(pin.file, &event, sizeof event) == (ssize_t)sizeof event) {
        pin.rose_ns = event.timestamp_ns;
    }
    *since_ns = pin.rose_ns;
    return ioctl(pin.file, GPIO_V2_LINE_GET_VALUES_IOCTL, &values) == 0 && (values.bits & 1U) != 0U;
}
