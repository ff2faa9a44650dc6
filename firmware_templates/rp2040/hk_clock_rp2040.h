/* The clocks of the RP2040, and its peripherals out of reset. */
#ifndef HK_CLOCK_RP2040_H
#define HK_CLOCK_RP2040_H

#include <stdbool.h>
#include <stdint.h>

/* Run from the 12 MHz crystal: clk_sys and clk_peri at HK_CLOCK_HZ, the timer in microseconds. */
void hk_clock_init(void);

/* Hold peripherals in reset; let them go and wait until they are ready. */
void hk_reset_hold(uint32_t peripherals);
void hk_reset_release(uint32_t peripherals);

/* Whether so long a time has passed; hk_hal_time_us() has given its begin. */
bool hk_passed(uint32_t since_us, uint32_t wait_us);

#endif
