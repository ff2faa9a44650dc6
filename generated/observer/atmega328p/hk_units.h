/* Between a float in SI units and an integer, rounded to the nearest, without 64-bit arithmetic. */
#ifndef HK_UNITS_H
#define HK_UNITS_H

#include <stdint.h>

/* A positive factor: (high * 2^32 + low) * 2^(exponent - 64), with 2^30 <= high < 2^31. */
typedef struct {
    uint32_t high;
    uint32_t low;
    int16_t exponent;
} hk_factor_t;

/* The integer nearest to value * factor, which is below 2^31. The factor lies in flash. */
int32_t hk_integer_of(float value, const hk_factor_t *factor);

/* The float nearest to raw * factor, which is a normal number. */
float hk_float_of(int32_t raw, const hk_factor_t *factor);

#endif
