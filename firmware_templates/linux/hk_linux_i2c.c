/* I2C through the kernel's i2c-dev. */
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <stddef.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "hk_linux.h"

#define HK_TIMEOUT_10_MS 1UL /* unit of I2C_TIMEOUT */

static struct {
    const char *device;
    int file;
} bus = {.file = -1};

bool hk_linux_i2c_open(const char *device)
{
    bus.device = device;
    bus.file = open(device, O_RDWR | O_CLOEXEC);
    if (bus.file < 0) {
        return false;
    }
    /* Not every adapter takes these; the driver tries again by itself. */
    (void)ioctl(bus.file, I2C_TIMEOUT, HK_TIMEOUT_10_MS);
    (void)ioctl(bus.file, I2C_RETRIES, 0UL);
    return true;
}

/* No acknowledge, a lost arbitration and a bus that hangs are all the same to the driver. */
static bool transfer(struct i2c_msg *messages, uint32_t count)
{
    struct i2c_rdwr_ioctl_data data = {.msgs = messages, .nmsgs = count};

    return bus.file >= 0 && ioctl(bus.file, I2C_RDWR, &data) == (int)count;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    uint8_t copy[UINT8_MAX]; /* the kernel's struct is not const */
    struct i2c_msg message = {.addr = address, .len = count, .buf = copy};
    uint8_t i;

    for (i = 0U; i < count; i++) {
        copy[i] = bytes[i];
    }
    return transfer(&message, 1U);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    struct i2c_msg messages[] = {
        {.addr = address, .len = 1U, .buf = &reg},
        {.addr = address, .flags = I2C_M_RD, .len = count, .buf = bytes},
    };

    return transfer(messages, 2U);
}

/* The clocks that free a bus are the adapter's business; here the device is opened anew, which also
 * finds an adapter that was taken away and came back. */
void hk_hal_i2c_recover(void)
{
    if (bus.file >= 0) {
        (void)close(bus.file);
    }
    (void)hk_linux_i2c_open(bus.device);
}
