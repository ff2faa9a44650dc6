/* made by hostkit 0.1.0 from design 975f50245cf2; do not edit; template complementary/hk_filter_settings.c.j2 */
#include "hk_filter.h"

#include "hk_design.h"
#include "hk_flash.h"
#include "hk_units.h"

#define HK_PERIOD_S      0x1.99999a0000000p-5f
#define HK_TAU_LOWEST    0x1.9999980000000p-25f
#define HK_TAU_HIGHEST   0x1.869ff80000000p+15f
#define HK_BIAS_HIGHEST  0x1.6571840000000p-2f
#define HK_OFFSET_HIGHEST 0x1.0c15220000000p-1f

/* Fraction bits and end of the coefficients of one half and more. */
#define HK_LEAST_FRAC      17U
#define HK_COEFFICIENT_END INT32_C(0x20000)

static const HK_FLASH hk_factor_t hk_raw_per_rad_s = {
    UINT32_C(1093704440), UINT32_C(3961207808), 27};
static const HK_FLASH hk_factor_t hk_rad_s_per_raw = {
    UINT32_C(2108287141), UINT32_C(1424062464), -24};
static const HK_FLASH hk_factor_t hk_raw_per_rad = {
    UINT32_C(1367130551), UINT32_C(656542720), 31};
static const HK_FLASH hk_factor_t hk_rad_per_raw = {
    UINT32_C(1686629713), UINT32_C(280256512), -28};

void hk_filter_defaults(hk_filter_settings_t *settings)
{
    settings->blend.raw = HK_BLEND_RAW;
    settings->blend.frac = HK_BLEND_FRAC;
    settings->bias[HK_ROLL] = 0;
    settings->tilt_offset[HK_ROLL] = 0;
    settings->bias[HK_PITCH] = HK_BIAS_START_PITCH;
    settings->tilt_offset[HK_PITCH] = HK_TILT_OFFSET_PITCH;
}

/* The float in -limit .. limit that is nearest. */
static float hk_within(float value, float limit)
{
    return value > limit ? limit : (value < -limit ? -limit : value);
}

/* T (1 - b) / b of the blend b. */
static float hk_tau(const hk_coefficient_t *blend)
{
    float weight = (float)blend->raw;
    float tau;
    uint8_t i;

    for (i = 0U; i < blend->frac; i++) {
        weight *= 0.5f;
    }
    tau = HK_PERIOD_S * (1.0f - weight) / weight;
    return tau < HK_TAU_LOWEST ? HK_TAU_LOWEST : hk_within(tau, HK_TAU_HIGHEST);
}

/* The blend T / (tau + T) with its most significant bit at 2^16. */
static void hk_set_tau(hk_coefficient_t *blend, float tau)
{
    float weight = HK_PERIOD_S / (tau + HK_PERIOD_S);
    uint8_t frac = HK_LEAST_FRAC;
    int32_t raw;

    for (; weight < 0.5f; weight *= 2.0f) {
        frac++;
    }
    raw = (int32_t)(weight * (float)HK_COEFFICIENT_END + 0.5f);
    if (raw == HK_COEFFICIENT_END) {
        raw = HK_COEFFICIENT_MSB;
        frac--;
    }
    blend->raw = raw;
    blend->frac = frac;
}

/* The value of a word, as it is told. */
static float hk_told(int32_t word, bool is_bias)
{
    return is_bias ? hk_within(hk_float_of(word, &hk_rad_s_per_raw), HK_BIAS_HIGHEST)
                   : hk_within(hk_float_of(word, &hk_rad_per_raw), HK_OFFSET_HIGHEST);
}

float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which)
{
    switch (which) {
    case HK_FILTER_TAU:
        return hk_tau(&settings->blend);
    case HK_FILTER_BIAS_ROLL:
    case HK_FILTER_BIAS_PITCH:
        return hk_told(settings->bias[which - HK_FILTER_BIAS_ROLL], true);
    case HK_FILTER_OFFSET_ROLL:
    case HK_FILTER_OFFSET_PITCH:
        return hk_told(settings->tilt_offset[which - HK_FILTER_OFFSET_ROLL], false);
    default:
        return 0.0f;
    }
}

/* Whether the design has an axis. */
static bool hk_has(uint8_t axis)
{
    return axis == HK_PITCH;
}

/* The word of a value. That of the design, which may have more digits, is known by what it tells. */
static int32_t hk_word_of(float value, int32_t of_design, bool is_bias)
{
    return value == hk_told(of_design, is_bias)
               ? of_design
               : hk_integer_of(value, is_bias ? &hk_raw_per_rad_s : &hk_raw_per_rad);
}

/* Each comparison is false for what is not a number. */
static bool hk_is_within(float value, float lowest, float highest)
{
    return value >= lowest && value <= highest;
}

bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value)
{
    const bool is_bias = which < HK_FILTER_OFFSET_ROLL;
    const float limit = is_bias ? HK_BIAS_HIGHEST : HK_OFFSET_HIGHEST;
    const uint8_t axis = (uint8_t)((uint8_t)(which - HK_FILTER_BIAS_ROLL) & 1U);
    hk_filter_settings_t design;

    if (which == HK_FILTER_TAU) {
        if (hk_is_within(value, HK_TAU_LOWEST, HK_TAU_HIGHEST)) {
            hk_set_tau(&settings->blend, value);
            return true;
        }
        return false;
    }
    if (which >= HK_FILTER_PARAMETERS || !hk_has(axis) || !hk_is_within(value, -limit, limit)) {
        return false;
    }
    hk_filter_defaults(&design);
    if (is_bias) {
        settings->bias[axis] = hk_word_of(value, design.bias[axis], true);
    } else {
        settings->tilt_offset[axis] = hk_word_of(value, design.tilt_offset[axis], false);
    }
    return true;
}

float hk_filter_rate_rad_s(uint8_t axis, const float gyro_count[3])
{
    switch (axis) {
    case HK_PITCH:
        return (float)HK_BODY_Y_SIGN * gyro_count[HK_BODY_Y_SOURCE] * 0x1.1740e80000000p-10f;
    default:
        return 0.0f;
    }
}
