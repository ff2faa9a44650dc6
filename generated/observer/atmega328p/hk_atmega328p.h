/* What the files of this board layer need of each other. */
#ifndef HK_ATMEGA328P_H
#define HK_ATMEGA328P_H

/* Set up the USART; interrupts must be off. */
void hk_uart_init(void);

/* Start the watchdog; interrupts must be off. */
void hk_watchdog_start(void);

#endif
