/* Fixed-point primitives: scaling by an 18-bit coefficient, 32-bit wrap.
 *
 * A coefficient is positive and fills its 18 bits: 2^16 <= raw < 2^17. So raw is 2^16 plus a number
 * of 16 bits, and a product needs one multiplication of 16 bits less than it seems, none of 64 bits. */
#ifndef HK_FIXED_H
#define HK_FIXED_H

#include <stdint.h>

#define HK_COEFFICIENT_MSB INT32_C(0x10000)

/* Where a call costs more than the code it saves, also where the compiler is asked for small code. */
#ifdef __GNUC__
#define HK_INLINE static inline __attribute__((always_inline))
#else
#define HK_INLINE static inline
#endif

/* raw / 2^frac */
typedef struct {
    int32_t raw;
    uint8_t frac;
} hk_coefficient_t;

/* The integer model shifts negative numbers arithmetically. */
typedef char hk_shift_is_arithmetic[((INT32_C(-3) >> 1) == INT32_C(-2)) ? 1 : -1];

/* One instruction multiplies 32 by 32 bits on these; elsewhere 16 by 16 bits are cheaper. */
#ifndef HK_LONG_PRODUCT
#if defined(__AVR__) || defined(__ARM_ARCH_6M__)
#define HK_LONG_PRODUCT 0
#else
#define HK_LONG_PRODUCT 1
#endif
#endif

/* count * raw / 2^frac, halves upwards; |count| <= 2^15, 1 <= frac <= 15. */
static inline int32_t hk_scale_count(int32_t count, int32_t raw, unsigned frac)
{
    const int32_t low = count * (raw - HK_COEFFICIENT_MSB);
    const int32_t half = INT32_C(1) << (frac - 1U);

    return count * (INT32_C(1) << (16U - frac)) + ((low + half) >> frac);
}

/* angle * raw / 2^frac, halves upwards; any angle, 17 <= frac <= 49, or frac = 16 with raw = 2^16. */
#if HK_LONG_PRODUCT
static inline int32_t hk_scale_angle(int32_t angle, int32_t raw, unsigned frac)
{
    if (frac > 18U) {
        const int32_t rest = (int32_t)(((int64_t)angle * (raw << 14)) >> 32); /* less 18 bits */

        return ((rest >> (frac - 19U)) + 1) >> 1;
    }
    return (int32_t)(((int64_t)angle * raw + (INT32_C(1) << (frac - 1U))) >> frac);
}
#else
static inline int32_t hk_scale_angle(int32_t angle, int32_t raw, unsigned frac)
{
    const uint16_t coefficient = (uint16_t)(raw - HK_COEFFICIENT_MSB);
    const uint32_t low = (uint32_t)(uint16_t)angle * coefficient;
    const int32_t rest = (int32_t)(int16_t)(angle >> 16) * coefficient + (int32_t)(low >> 16);
    /* angle + rest is the product without its last 16 bits. It has 33 bits, its half has 32. */
    const int32_t half = (angle >> 1) + (rest >> 1) + (angle & rest & 1);

    if (frac > 17U) {
        return ((half >> (frac - 18U)) + 1) >> 1;
    }
    if (frac == 17U) {
        return half + ((angle ^ rest) & 1);
    }
    return (int32_t)((uint32_t)angle + (uint32_t)rest + ((uint16_t)low >> 15));
}
#endif

/* a * b / 2^32, rounded down. */
#if HK_LONG_PRODUCT
static inline int32_t hk_product(int32_t a, int32_t b)
{
    return (int32_t)(((int64_t)a * b) >> 32);
}
#else
int32_t hk_product(int32_t a, int32_t b);
#endif

/* count * gain / 2^15, rounded down; 0 <= gain, and the result fits. */
static inline int32_t hk_scale(int32_t gain, int16_t count)
{
#if HK_LONG_PRODUCT
    return (int32_t)(((int64_t)gain * count) >> 15);
#else
    /* Of the 16 bits that the product of words leaves out, the first. */
    const uint16_t low = (uint16_t)(1U * (uint16_t)gain * (uint16_t)count);

    return hk_product(gain, (int32_t)((uint32_t)count << 16)) * 2 + (int32_t)(low >> 15);
#endif
}

/* value / 2^bits, halves upwards; value + 2^(bits - 1) fits 32 bits, 1 <= bits <= 30. */
static inline int32_t hk_shift_rounded(int32_t value, unsigned bits)
{
    return (value + (INT32_C(1) << (bits - 1U))) >> bits;
}

/* The nearest number in -limit .. limit. */
static inline int32_t hk_clamped(int32_t value, int32_t limit)
{
    return value > limit ? limit : (value < -limit ? -limit : value);
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
