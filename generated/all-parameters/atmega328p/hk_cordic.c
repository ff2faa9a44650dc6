/* made by hostkit 0.1.0 from design 0099cab74159; do not edit; template complementary/hk_cordic.c.j2 */
#include "hk_cordic.h"

#include "hk_fixed.h"

#define HK_CORDIC_GUARD 12
#define HK_CORDIC_GAIN_RAW  INT32_C(53961)  /* 1.646760258120067, s1.15 */
#define HK_CORDIC_GAIN_FRAC 15
#define HK_ROOT_FRAC 8

/* One micro-rotation towards the x axis, by `turn` = round(atan(2^-i) / pi * 2^31). The steps are
 * written out, because a processor without a barrel shifter shifts by a constant much faster. */
#define HK_CORDIC_STEP(i, turn)               \
    do {                                      \
        const int32_t x_part = x >> (i);      \
        const int32_t y_part = y >> (i);      \
                                              \
        if (y >= 0) {                         \
            x += y_part;                      \
            y -= x_part;                      \
            angle += (uint32_t)INT32_C(turn); \
        } else {                              \
            x -= y_part;                      \
            y += x_part;                      \
            angle -= (uint32_t)INT32_C(turn); \
        }                                     \
    } while (0)

/* Rotate (x, y) onto the positive x axis; x becomes its length times the gain. */
static int32_t hk_vectoring(int32_t y, int32_t *x_in_length_out)
{
    int32_t x = *x_in_length_out;
    uint32_t angle = 0U;

    if (x == 0 && y == 0) {
        return 0;
    }
    if (x < 0) {
        x = -x;
        y = -y;
        angle = UINT32_C(0x80000000);
    }
    HK_CORDIC_STEP(0, 536870912);
    HK_CORDIC_STEP(1, 316933406);
    HK_CORDIC_STEP(2, 167458907);
    HK_CORDIC_STEP(3, 85004756);
    HK_CORDIC_STEP(4, 42667331);
    HK_CORDIC_STEP(5, 21354465);
    HK_CORDIC_STEP(6, 10679838);
    HK_CORDIC_STEP(7, 5340245);
    HK_CORDIC_STEP(8, 2670163);
    HK_CORDIC_STEP(9, 1335087);
    HK_CORDIC_STEP(10, 667544);
    HK_CORDIC_STEP(11, 333772);
    HK_CORDIC_STEP(12, 166886);
    HK_CORDIC_STEP(13, 83443);
    HK_CORDIC_STEP(14, 41722);
    HK_CORDIC_STEP(15, 20861);
    HK_CORDIC_STEP(16, 10430);
    HK_CORDIC_STEP(17, 5215);
    HK_CORDIC_STEP(18, 2608);
    HK_CORDIC_STEP(19, 1304);
    *x_in_length_out = x;
    return (int32_t)angle;
}

int32_t hk_atan2(int32_t y_count, int32_t x_count, int32_t *magnitude)
{
    *magnitude = x_count * (INT32_C(1) << HK_CORDIC_GUARD);
    return hk_vectoring(y_count * (INT32_C(1) << HK_CORDIC_GUARD), magnitude);
}

int32_t hk_atan2_magnitude(int32_t y_count, int32_t magnitude)
{
    /* 17 bits times 17 bits: the product and its rounding stay within 32 bits. */
    const int32_t product = y_count * HK_CORDIC_GAIN_RAW;
    const int32_t half = INT32_C(1) << (HK_CORDIC_GAIN_FRAC - HK_CORDIC_GUARD - 1);

    return hk_vectoring((product + half) >> (HK_CORDIC_GAIN_FRAC - HK_CORDIC_GUARD), &magnitude);
}

/* Square root of a number below 2^30, with HK_ROOT_FRAC fraction bits, truncated. */
static int32_t hk_root(uint32_t square)
{
    uint32_t bits = square << 2;
    uint32_t rest = 0U;
    uint32_t root = 0U;
    uint8_t i;

    for (i = 0U; i < 15U + HK_ROOT_FRAC; i++) {
        const uint32_t trial = (root << 2) | 1U;

        rest = (rest << 2) | (bits >> 30);
        bits <<= 2;
        root <<= 1;
        if (rest >= trial) {
            rest -= trial;
            root |= 1U;
        }
    }
    return (int32_t)root;
}

int32_t hk_arcsin(int32_t y_count, int32_t one_count)
{
    const int32_t y = y_count > one_count ? one_count : (y_count < -one_count ? -one_count : y_count);
    int32_t x = hk_root((uint32_t)((one_count - y) * (one_count + y)))
                * (INT32_C(1) << (HK_CORDIC_GUARD - HK_ROOT_FRAC));

    return hk_vectoring(y * (INT32_C(1) << HK_CORDIC_GUARD), &x);
}
