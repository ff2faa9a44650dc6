/* What the two halves of the board layer share: see hk_hal_stm32f103.c. */
#ifndef HK_BOARD_STM32F103_H
#define HK_BOARD_STM32F103_H

#include <stdint.h>

/* The counter of timer 2 runs through so many microseconds. */
#define HK_CLOCK_SHIFT 12
#define HK_CLOCK_MASK  ((UINT32_C(1) << HK_CLOCK_SHIFT) - 1U)

/* Microseconds from one reading of TIM2_CNT to now; good for spans below 4 ms. */
uint32_t hk_board_elapsed_us(uint32_t since);

/* Hold interrupts off; release restores what hold returned. */
uint32_t hk_board_hold(void);
void hk_board_release(uint32_t held);

/* Set up pin PB0 to PB7: four bits of GPIOB_CRL. */
void hk_board_configure_low_pin(uint32_t pin, uint32_t mode);

#endif
