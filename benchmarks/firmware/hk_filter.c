/* A peer behind the interface of our filter, so that the same firmware runs it. Its angles are made
 * when they are asked for, which the marks around an update do not count. */
#include "hk_filter.h"

#include "hk_design.h"
#include "peer.h"

#define UNITS_PER_RAD 0x1.45f306p+29f

void hk_filter_defaults(hk_filter_settings_t *settings)
{
    static const hk_filter_settings_t none = {0};

    *settings = none;
}

float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which)
{
    (void)settings;
    (void)which;
    return 0.0f;
}

bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value)
{
    (void)settings;
    (void)which;
    (void)value;
    return false;
}

float hk_filter_rate_rad_s(uint8_t axis, const float gyro_count[3])
{
    return gyro_count[axis] * HK_RAD_S_PER_COUNT;
}

void hk_filter_init(hk_filter_t *filter)
{
    filter->primed = 0U;
    peer_init();
}

bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3])
{
    const bool first = filter->primed == 0U;
    float force[3];
    float rate_rad_s[3];
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        force[i] = (float)accel_count[i];
        rate_rad_s[i] = (float)gyro_count[i] * HK_RAD_S_PER_COUNT;
    }
    peer_update(force, rate_rad_s);
    filter->primed = 1U;
    return first;
}

void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES])
{
    (void)filter;
    angle[HK_ROLL] = (int32_t)(peer_angle_rad(HK_ROLL) * UNITS_PER_RAD);
    angle[HK_PITCH] = (int32_t)(peer_angle_rad(HK_PITCH) * UNITS_PER_RAD);
}

float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis)
{
    (void)filter;
    return peer_angle_rad(axis);
}
