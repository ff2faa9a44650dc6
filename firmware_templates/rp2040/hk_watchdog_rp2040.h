/* The watchdog of an RP2040, and why the chip was reset. */
#ifndef HK_WATCHDOG_RP2040_H
#define HK_WATCHDOG_RP2040_H

/* Find the cause of the reset and start the watchdog; its tick must run. */
void hk_watchdog_init(void);

#endif
