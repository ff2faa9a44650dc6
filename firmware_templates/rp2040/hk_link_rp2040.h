/* The link of an RP2040: UART0 on GP0 and GP1. */
#ifndef HK_LINK_RP2040_H
#define HK_LINK_RP2040_H

#include <stdbool.h>

/* Set the UART up; it must have been let out of reset. */
void hk_uart_init(void);

/* Whether all that was queued has left. */
bool hk_uart_quiet(void);

#endif
