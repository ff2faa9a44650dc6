/* What the parts of the board layer share: see hk_hal_stm32f103.c. */
#ifndef HK_BOARD_STM32F103_H
#define HK_BOARD_STM32F103_H

#include <stdbool.h>
#include <stdint.h>

/* Microseconds from one reading of TIM2_CNT to now; good for spans below 65 ms. */
uint32_t hk_board_elapsed_us(uint32_t since);

/* Hold interrupts off; release restores what hold returned. */
uint32_t hk_board_hold(void);
void hk_board_release(uint32_t held);

/* Set up pin PB0 to PB7: four bits of GPIOB_CRL. */
void hk_board_configure_low_pin(uint32_t pin, uint32_t mode);

/* The link, which needs its clock. */
void hk_board_start_link(void);
bool hk_board_has_received(void);
bool hk_board_has_sent(void);

/* Once after every start: why it was; and the watchdog, which nothing stops any more. */
void hk_board_find_reset_cause(void);
void hk_board_start_watchdog(void);

/* Begin again, as after a fault. */
void hk_board_restart(void);

#endif
