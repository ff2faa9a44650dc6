/* Fixed-point primitives: rounding halves upwards, 32-bit wrap. */
#ifndef HK_FIXED_H
#define HK_FIXED_H

#include <stdint.h>

/* The integer model shifts negative numbers arithmetically. */
typedef char hk_shift_is_arithmetic[((INT32_C(-3) >> 1) == INT32_C(-2)) ? 1 : -1];

/* Divide by 2^bits, halves upwards; bits is at least 1. */
static inline int64_t hk_shift_round(int64_t value, unsigned bits)
{
    return (value + (INT64_C(1) << (bits - 1U))) >> bits;
}

/* Sum and difference modulo 2^32: the wrap of an angle at +-pi, without signed overflow. */
static inline int32_t hk_wrap_add(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

static inline int32_t hk_wrap_sub(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

#endif
