/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template observer/hk_filter_settings.c.j2 */
#include "hk_filter.h"

#include "hk_flash.h"
#include "hk_units.h"

#include <string.h>

/* Weight of a count of rate, rad/s. */
#define HK_RAD_S_PER_COUNT 0x1.1740b00000000p-12f

/* One parameter: its integer in the design, what it may be, and the factors between the two. */
typedef struct {
    int32_t raw;
    float lowest;
    float highest;
    hk_factor_t raw_per_unit;
    hk_factor_t unit_per_raw;
} hk_row_t;

static const HK_FLASH hk_row_t hk_rows[HK_FILTER_PARAMETERS] = {
    {INT32_C(3892271), 0x1.a36e300000000p-14f, 0x1.387ffa0000000p+3f, /* FILT_KT, rad/m */
     {UINT32_C(1759218604), UINT32_C(1896657920), 29},
     {UINT32_C(1310720000), UINT32_C(0), -26}},
    {INT32_C(16106127), 0x1.0624de0000000p-10f, 0x1.8ffff80000000p+5f, /* FILT_KV, 1/s */
     {UINT32_C(1374389534), UINT32_C(3092376576), 27},
     {UINT32_C(1677721600), UINT32_C(0), -24}},
    {INT32_C(60473140), 0x0.0p+0f, 0x1.3333320000000p-2f, /* FILT_KB, 1/s */
     {UINT32_C(1374389534), UINT32_C(3092376576), 34},
     {UINT32_C(1677721600), UINT32_C(0), -31}},
    {INT32_C(28037547), -0x1.5e6f4a0000000p-2f, 0x1.5e6f4a0000000p-2f, /* GYRO_BIAS_X, rad/s */
     {UINT32_C(1401877325), UINT32_C(1779834880), 33},
     {UINT32_C(1644825098), UINT32_C(168429568), -30}},
    {INT32_C(-54425826), -0x1.6571840000000p-2f, 0x1.6571840000000p-2f, /* GYRO_BIAS_Y, rad/s */
     {UINT32_C(1360645639), UINT32_C(1601164288), 33},
     {UINT32_C(1694668282), UINT32_C(3557446656), -30}},
    {INT32_C(83288006), -0x1.61e7840000000p-2f, 0x1.61e7840000000p-2f, /* GYRO_BIAS_Z, rad/s */
     {UINT32_C(1388133430), UINT32_C(288621568), 33},
     {UINT32_C(1661110495), UINT32_C(212622336), -30}},
};

static float hk_flash_float(const float *address)
{
    const uint32_t bits = hk_flash_u32((const uint32_t *)(const void *)address);
    float value;

    (void)memcpy(&value, &bits, sizeof value);
    return value;
}

static int32_t hk_design_raw(uint8_t which)
{
    return (int32_t)hk_flash_u32((const uint32_t *)&hk_rows[which].raw);
}

/* Where the settings have a parameter. */
static int32_t *hk_place(hk_filter_settings_t *settings, uint8_t which)
{
    return which < HK_FILTER_FIRST_BIAS ? &settings->gain[which]
                                        : &settings->bias[which - HK_FILTER_FIRST_BIAS];
}

void hk_filter_defaults(hk_filter_settings_t *settings)
{
    uint8_t which;

    for (which = 0U; which < HK_FILTER_PARAMETERS; which++) {
        *hk_place(settings, which) = hk_design_raw(which);
    }
}

/* The value of an integer, as it is told: within the limits. */
static float hk_told(uint8_t which, int32_t raw)
{
    const float value = hk_float_of(raw, &hk_rows[which].unit_per_raw);
    const float lowest = hk_flash_float(&hk_rows[which].lowest);
    const float highest = hk_flash_float(&hk_rows[which].highest);

    return value < lowest ? lowest : (value > highest ? highest : value);
}

float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which)
{
    hk_filter_settings_t copy = *settings;

    return which < HK_FILTER_PARAMETERS ? hk_told(which, *hk_place(&copy, which)) : 0.0f;
}

bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value)
{
    /* A comparison is false for what is not a number. */
    if (which >= HK_FILTER_PARAMETERS || !(value >= hk_flash_float(&hk_rows[which].lowest))
        || !(value <= hk_flash_float(&hk_rows[which].highest))) {
        return false;
    }
    /* The integer of the design, which may have more digits, is known by what it tells. */
    *hk_place(settings, which) = value == hk_told(which, hk_design_raw(which))
                                     ? hk_design_raw(which)
                                     : hk_integer_of(value, &hk_rows[which].raw_per_unit);
    return true;
}

float hk_filter_rate_rad_s(uint8_t bias, const float gyro_count[3])
{
    return gyro_count[bias] * HK_RAD_S_PER_COUNT;
}
