/* A filter for tests: see the header. */
#include "hk_filter.h"

#include <string.h>

#include "hk_design.h"

void hk_filter_defaults(hk_filter_settings_t *settings)
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        settings->gain[i] = 0.25f;
        settings->bias_rad_s[i] = 0.0f;
    }
}

float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which)
{
    return which < HK_FILTER_BIAS_X ? settings->gain[which]
                                    : settings->bias_rad_s[which - HK_FILTER_BIAS_X];
}

bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value)
{
    if (which >= HK_FILTER_PARAMETERS || !(value >= -1.0f && value <= 1.0f)) {
        return false;
    }
    if (which < HK_FILTER_BIAS_X) {
        settings->gain[which] = value;
    } else {
        settings->bias_rad_s[which - HK_FILTER_BIAS_X] = value;
    }
    return true;
}

float hk_filter_rate_rad_s(uint8_t bias, const float gyro_count[3])
{
    return gyro_count[bias] * HK_RAD_S_PER_COUNT;
}

void hk_filter_init(hk_filter_t *filter)
{
    (void)memset(filter->last, 0, sizeof filter->last);
    (void)memset(filter->sum, 0, sizeof filter->sum);
    filter->updates = 0U;
}

bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3])
{
    uint8_t i;

    for (i = 0U; i < 6U; i++) {
        filter->last[i] = i < 3U ? accel_count[i] : gyro_count[i - 3U];
        filter->sum[i] += (uint32_t)filter->last[i];
    }
    filter->updates++;
    return filter->updates == 1U;
}

void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES])
{
    angle[HK_ROLL] = (int32_t)filter->sum[0];
    angle[HK_PITCH] = (int32_t)filter->sum[4];
}

float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis)
{
    return (float)(int32_t)filter->sum[4U * axis];
}

void hk_filter_state(const hk_filter_t *filter, int32_t words[HK_FILTER_STATE_WORDS])
{
    uint8_t i;

    words[0] = (int32_t)filter->updates;
    for (i = 0U; i < 6U; i++) {
        words[1U + i] = (int32_t)filter->sum[i];
        words[7U + i] = filter->last[i];
    }
    for (i = 0U; i < 3U; i++) {
        const float urad_s = filter->settings.bias_rad_s[i] * 1e6f;

        words[13U + i] = (int32_t)(urad_s < 0.0f ? urad_s - 0.5f : urad_s + 0.5f);
    }
    words[16] = (int32_t)filter->updates;
}
