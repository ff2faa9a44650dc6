/* A while without interrupts. */
#ifndef HK_INTERRUPT_RP2040_H
#define HK_INTERRUPT_RP2040_H

#include <stdint.h>

/* Return what it was before, for the other. */
static inline uint32_t hk_interrupts_off(void)
{
    uint32_t mask;

    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(mask) : : "memory");
    return mask;
}

static inline void hk_interrupts_back(uint32_t mask)
{
    __asm__ volatile("msr primask, %0" : : "r"(mask) : "memory");
}

#endif
