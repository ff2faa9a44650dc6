/* made by hostkit 0.1.0 from design 975f50245cf2; do not edit; template fixed/hk_arctan.c.j2 */
#include "hk_arctan.h"

#include "hk_divide.h"
#include "hk_fixed.h"

#include <stddef.h>

#define HK_GUARD_BITS   14
#define HK_TURN_DIGITS  6
#define HK_RATIO_DIGITS 14
#define HK_STRETCH_FRAC 18
#define HK_ROOT_FRAC    8
#define HK_LEAST_WORD_BITS 13
#define HK_SLOPE_RAW    UINT16_C(41719)  /* 162.9647145421576 half turns / 2^31 per 2^-22, s8.8 */
#define HK_SLOPE_FRAC   8

#define HK_QUARTER_TURNS(n) ((uint32_t)(n) << 30)

/* Where a compiler can leave constants in program memory (avr-gcc), it does. */
#ifdef __FLASH
#define HK_FLASH __flash
#else
#define HK_FLASH
#endif

/* round(atan(turn / 64) / pi * 2^31) */
static const HK_FLASH uint32_t hk_angles[64] = {
    0, 10679838, 21354465, 32018685, 42667331, 53295284, 63897482, 74468939,
    85004756, 95500135, 105950391, 116350962, 126697423, 136985493, 147211045, 157370116,
    167458907, 177473799, 187411349, 197268300, 207041579, 216728303, 226325781, 235831508,
    245243172, 254558647, 263775993, 272893455, 281909457, 290822599, 299631651, 308335554,
    316933406, 325424463, 333808132, 342083962, 350251643, 358310992, 366261957, 374104599,
    381839095, 389465727, 396984877, 404397019, 411702716, 418902610, 425997422, 432987938,
    439875013, 446659557, 453342536, 459924966, 466407904, 472792449, 479079736, 485270931,
    491367227, 497369841, 503280012, 509098996, 514828063, 520468494, 526021581, 531488619
};

/* round((sqrt(1 + (turn / 64)^2) - 1) * 2^HK_STRETCH_FRAC) */
static const HK_FLASH uint32_t hk_stretches[64] = {
    0, 32, 128, 288, 512, 799, 1149, 1563,
    2040, 2579, 3181, 3844, 4568, 5353, 6199, 7104,
    8068, 9090, 10171, 11308, 12502, 13751, 15056, 16414,
    17826, 19290, 20806, 22373, 23990, 25656, 27371, 29133,
    30942, 32796, 34696, 36639, 38626, 40655, 42726, 44837,
    46989, 49179, 51407, 53673, 55976, 58314, 60687, 63095,
    65536, 68010, 70516, 73053, 75621, 78219, 80846, 83501,
    86185, 88895, 91633, 94396, 97185, 99999, 102837, 105699
};

/* Binary digits of y / x for y <= x, 2^14 <= x < 2^31; *y becomes their remainder. All of them are
 * ones where y equals x. At most 7 at a time where the processor divides. */
#if HK_DIVIDES
HK_INLINE uint16_t hk_digits(uint32_t *y, uint32_t x, uint8_t digits)
{
    /* A divisor that is too large by less than one of its units: the quotient is right or, with
     * 2^(2 digits - 1) at most as large as x, one too small. */
    uint32_t quotient = hk_divide(*y << 1, (x >> (digits - 1U)) + 1U);
    uint32_t rest = (*y << digits) - quotient * x;

    if (rest >= x && *y != x) {
        quotient++;
        rest -= x;
    }
    *y = rest;
    return (uint16_t)quotient;
}
#else
HK_INLINE uint16_t hk_digits(uint32_t *y, uint32_t x, uint8_t digits)
{
    uint32_t rest = *y;
    uint16_t quotient = 0U;
    uint8_t i;

    for (i = 0U; i < digits; i++) {
        rest <<= 1;
        quotient = (uint16_t)(quotient << 1);
        if (rest >= x) {
            rest -= x;
            quotient |= 1U;
        }
    }
    *y = rest;
    return quotient;
}
#endif

/* Angle of (x, y) with 0 <= y <= x, 0 < x < 2^30. The first digits of y / x choose a turn, and what
 * they leave lies across the vector that is turned by it. The digits of that are the rest. */
static uint32_t hk_octant(uint32_t y, uint32_t x, hk_length_t *length)
{
    const uint32_t part = y >> 8;
    const uint8_t turn = (uint8_t)hk_digits(&y, x, HK_TURN_DIGITS);
    const uint32_t along = x + part * (uint8_t)(turn << 2);
    uint16_t ratio;

#if HK_DIVIDES
    ratio = (uint16_t)(hk_digits(&y, along, HK_RATIO_DIGITS / 2) << (HK_RATIO_DIGITS / 2));
    ratio |= hk_digits(&y, along, HK_RATIO_DIGITS / 2);
#else
    ratio = hk_digits(&y, along, HK_RATIO_DIGITS);
#endif
    ratio = (uint16_t)(ratio << (16 - HK_RATIO_DIGITS)); /* unit 2^-22 */
    if (length != NULL) {
        const uint8_t fine = (uint8_t)(ratio >> 8);
        const uint16_t square = (uint16_t)(fine * (fine + 1U));
        const uint32_t more = (uint32_t)(uint16_t)(along >> 16) * square;

        length->raw = along + (uint16_t)((uint16_t)(more >> 16) << 3);
        length->turn = turn;
    }
    return hk_angles[turn] + (((uint32_t)ratio * HK_SLOPE_RAW) >> HK_SLOPE_FRAC);
}

/* Angle of (x, y) in the first quadrant, 0 for a zero vector. */
static uint32_t hk_quadrant(uint32_t y, uint32_t x, hk_length_t *length)
{
    if (y > x) {
        return HK_QUARTER_TURNS(1) - hk_octant(x, y, length);
    }
    if (x != 0U) {
        return hk_octant(y, x, length);
    }
    if (length != NULL) {
        length->raw = 0U;
        length->turn = 0U;
    }
    return 0U;
}

static int32_t hk_with_sign_of(int32_t y_count, uint32_t angle)
{
    return (int32_t)(y_count < 0 ? 0U - angle : angle);
}

static uint16_t hk_size(int32_t count)
{
    return (uint16_t)(count < 0 ? -count : count);
}

/* By 16 bits up and down again: a processor without a barrel shifter moves bytes. */
static uint32_t hk_with_guard_bits(uint16_t size)
{
    return ((uint32_t)size << 16) >> (16 - HK_GUARD_BITS);
}

int32_t hk_atan2(int32_t y_count, int32_t x_count, hk_length_t *length)
{
    const uint32_t y = hk_with_guard_bits(hk_size(y_count));
    const uint32_t x = hk_with_guard_bits(hk_size(x_count));
    const uint32_t angle = hk_quadrant(y, x, length);

    return hk_with_sign_of(y_count, x_count < 0 ? HK_QUARTER_TURNS(2) - angle : angle);
}

int32_t hk_atan2_length(int32_t y_count, const hk_length_t *length)
{
    const uint16_t size = hk_size(y_count);
    /* 16 bits up to 2^15 times 17 bits up to 0.81 * 2^17: the product stays within 32 bits. */
    const uint32_t more = (size * hk_stretches[length->turn]) >> (HK_STRETCH_FRAC - HK_GUARD_BITS);

    return hk_with_sign_of(y_count,
                           hk_quadrant(hk_with_guard_bits(size) + more, length->raw, NULL));
}

static uint32_t hk_word_size(int32_t word)
{
    return word < 0 ? 0U - (uint32_t)word : (uint32_t)word;
}

int32_t hk_atan2_word(int32_t y, int32_t x, hk_length_t *length)
{
    uint32_t angle;

    if (((hk_word_size(y) | hk_word_size(x)) >> HK_LEAST_WORD_BITS) == 0U) {
        y = 0;
        x = 0;
    }
    angle = hk_quadrant(hk_word_size(y), hk_word_size(x), length);
    return hk_with_sign_of(y, x < 0 ? HK_QUARTER_TURNS(2) - angle : angle);
}

int32_t hk_atan2_word_length(int32_t y, const hk_length_t *length)
{
    const uint32_t size = hk_word_size(y);
    const uint32_t stretch = hk_stretches[length->turn] << (32 - HK_STRETCH_FRAC);

    return hk_with_sign_of(
        y, hk_quadrant(size + (uint32_t)hk_product((int32_t)size, (int32_t)stretch), length->raw,
                       NULL));
}

/* Square root of a number below 2^30, with HK_ROOT_FRAC fraction bits, truncated. */
static uint32_t hk_root(uint32_t square)
{
    uint32_t bits = square << 2;
    uint32_t rest = 0U;
    uint32_t root = 0U;
    uint8_t i;

    for (i = 0U; i < 15U + HK_ROOT_FRAC; i++) {
        const uint32_t trial = (root << 2) | 1U;

        rest = (rest << 2) | (uint8_t)((uint8_t)(bits >> 24) >> 6);
        bits <<= 2;
        root <<= 1;
        if (rest >= trial) {
            rest -= trial;
            root |= 1U;
        }
    }
    return root;
}

int32_t hk_arcsin(int32_t y_count, int32_t one_count)
{
    const uint16_t one = (uint16_t)one_count;
    const uint16_t size = hk_size(y_count) > one ? one : hk_size(y_count);
    const uint32_t square = (uint32_t)(uint16_t)(one - size) * (uint16_t)(one + size);

    return hk_with_sign_of(y_count, hk_quadrant(hk_with_guard_bits(size),
                                                hk_root(square) << (HK_GUARD_BITS - HK_ROOT_FRAC),
                                                NULL));
}
