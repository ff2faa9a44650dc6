/* Floats and integers: see the header. A float is taken apart into its bits; nothing is lost but
 * what is rounded at the end. */
#include "hk_units.h"

#include "hk_flash.h"

#include <float.h>
#include <string.h>

#define HK_TOP_BIT UINT32_C(0x80000000)
#define HK_HIDDEN_BIT UINT32_C(0x00800000)

typedef char hk_float_is_ieee[FLT_MANT_DIG == 24 && FLT_MAX_EXP == 128 && sizeof(float) == 4U ? 1 : -1];

typedef struct {
    uint32_t high;
    uint32_t low;
} hk_wide_t;

static int16_t exponent_of(const hk_factor_t *factor)
{
    return (int16_t)hk_flash_u16((const uint16_t *)&factor->exponent);
}

static void halve(hk_wide_t *wide)
{
    wide->low = (wide->low >> 1) | (wide->high << 31);
    wide->high >>= 1;
}

/* number * factor / 2^32 without the power of two of the factor, less than 2 too small. */
static hk_wide_t product(uint32_t number, const hk_factor_t *factor)
{
    const uint32_t high = hk_flash_u32(&factor->high);
    const uint32_t low = hk_flash_u32(&factor->low);
    hk_wide_t sum = {0U, 0U};
    uint8_t i;

    for (i = 0U; i < 32U; i++) {
        if ((number & 1U) != 0U) {
            sum.low += low;
            sum.high += high + (sum.low < low ? 1U : 0U);
        }
        halve(&sum);
        number >>= 1;
    }
    return sum;
}

int32_t hk_integer_of(float value, const hk_factor_t *factor)
{
    uint32_t bits;
    hk_wide_t size;
    int16_t shift;

    (void)memcpy(&bits, &value, sizeof bits);
    shift = (int16_t)(190 - exponent_of(factor) - (int16_t)((bits >> 23) & 0xFFU));
    size = product(((bits & (HK_HIDDEN_BIT - 1U)) | HK_HIDDEN_BIT) << 8, factor);
    if (shift > 64) {
        return 0;
    }
    for (; shift > 1; shift--) {
        halve(&size);
    }
    size.low = (size.low + 1U) >> 1;
    return (int32_t)((bits & HK_TOP_BIT) != 0U ? 0U - size.low : size.low);
}

float hk_float_of(int32_t raw, const hk_factor_t *factor)
{
    uint32_t number = raw < 0 ? 0U - (uint32_t)raw : (uint32_t)raw;
    int16_t exponent = (int16_t)(158 + exponent_of(factor));
    uint32_t bits = 0U;
    hk_wide_t size;
    float value;

    if (number != 0U) {
        for (; (number & HK_TOP_BIT) == 0U; number <<= 1) {
            exponent--;
        }
        size = product(number, factor);
        for (; (size.high & HK_TOP_BIT) == 0U; size.low <<= 1) {
            size.high = (size.high << 1) | (size.low >> 31);
            exponent--;
        }
        /* A mantissa that is rounded up to 2^24 carries into the exponent, as it must. */
        bits = ((uint32_t)(uint16_t)exponent << 23) + (size.high >> 8) - HK_HIDDEN_BIT
             + ((size.high >> 7) & 1U);
    }
    if (raw < 0) {
        bits |= HK_TOP_BIT;
    }
    (void)memcpy(&value, &bits, sizeof value);
    return value;
}
