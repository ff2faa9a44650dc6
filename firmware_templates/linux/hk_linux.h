/* The "board" under Linux: devices of the kernel, named by options. */
#ifndef HK_LINUX_H
#define HK_LINUX_H

#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include "hk_hal.h"

typedef struct {
    const char *i2c;    /* such as /dev/i2c-1 */
    const char *serial; /* such as /dev/ttyAMA0, or NULL: standard input and output */
    const char *chip;   /* such as /dev/gpiochip0, or NULL: the sensor is polled */
    uint32_t line;      /* of that chip, where the sensor's INT is */
    const char *store;  /* folder of the store, or NULL: forgotten at the end */
} hk_linux_options_t;

/* The command line, for the watchdog to start the program over with. */
extern char **hk_linux_arguments;

/* Open what the options name. Returns NULL, or the device that cannot be used. */
const char *hk_linux_open(const hk_linux_options_t *options);

/* Where hk_hal_reboot goes on; to be set before anything of the hk_hal is used. */
extern jmp_buf hk_linux_reset_vector;

/* True once the program was asked to end, or nobody reads any more; what is queued is sent first. */
bool hk_linux_finished(void);

/* Nanoseconds of the kernel's monotonic clock. */
uint64_t hk_linux_now_ns(void);

/* The parts. Each open returns false if its device cannot be used. */
bool hk_linux_i2c_open(const char *device);

bool hk_linux_gpio_open(const char *chip, uint32_t line);
int hk_linux_gpio_events(void);              /* descriptor to wait for, or -1 */
bool hk_linux_gpio_high(uint64_t *since_ns); /* false without a line */

bool hk_linux_link_open(const char *serial);
int hk_linux_link_input(void); /* descriptor to wait for, or -1 when nobody talks any more */
int hk_linux_link_output(void);
bool hk_linux_link_waiting(void); /* bytes are queued */
void hk_linux_link_send(void);    /* as many as go without waiting */
void hk_linux_link_drain(void);   /* all */
bool hk_linux_link_broken(void);  /* nobody reads any more */

bool hk_linux_store_open(const char *folder);

#endif
