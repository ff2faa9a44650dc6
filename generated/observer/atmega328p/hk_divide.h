/* Division of 32-bit numbers where a processor does it in hardware.
 *
 * HK_DIVIDES is 0 where it does not, and digits are then cheaper one by one. */
#ifndef HK_DIVIDE_H
#define HK_DIVIDE_H

#include <stdint.h>

#ifndef HK_DIVIDES
#if defined(__AVR__) || (defined(__ARM_ARCH_6M__) && !defined(HK_SIO_DIVIDER))
#define HK_DIVIDES 0
#else
#define HK_DIVIDES 1
#endif
#endif

/* Registers of the divider in the RP2040's single-cycle IO block (data sheet, 2.3.1.5): dividend,
 * divisor, and 8 cycles later the quotient. It keeps no state for interrupts, so they must not use
 * it. Four branches take 8 cycles. */
#ifdef HK_SIO_DIVIDER
#define HK_SIO_UDIVIDEND (*(volatile uint32_t *)0xD0000060U)
#define HK_SIO_UDIVISOR  (*(volatile uint32_t *)0xD0000064U)
#define HK_SIO_QUOTIENT  (*(volatile uint32_t *)0xD0000070U)

static inline uint32_t hk_divide(uint32_t dividend, uint32_t divisor)
{
    HK_SIO_UDIVIDEND = dividend;
    HK_SIO_UDIVISOR = divisor;
    __asm__ volatile("b 1f\n1: b 1f\n1: b 1f\n1: b 1f\n1:");
    return HK_SIO_QUOTIENT;
}
#elif HK_DIVIDES
static inline uint32_t hk_divide(uint32_t dividend, uint32_t divisor)
{
    return dividend / divisor;
}
#endif

#endif
