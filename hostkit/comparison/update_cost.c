/* Runs the generated filter over raw counts; built beside it to measure what an update costs. */
#include "hk_filter.h"

/* Counts are three to a sample, sensor axes. Returns something that depends on every sample, so that
 * none is left out. */
int32_t hk_run_updates(const int16_t *accel_count, const int16_t *gyro_count, long samples)
{
    static hk_filter_t filter;
    int32_t angle[HK_ANGLES];

    hk_filter_defaults(&filter.settings);
    hk_filter_init(&filter);
    for (long k = 0; k < samples; k++) {
        hk_filter_update(&filter, accel_count + 3 * k, gyro_count + 3 * k);
    }
    hk_filter_angles(&filter, angle);
    return angle[HK_ROLL] ^ angle[HK_PITCH];
}

/* The same with the angles of every sample. */
int32_t hk_run_angles(const int16_t *accel_count, const int16_t *gyro_count, long samples)
{
    static hk_filter_t filter;
    int32_t angle[HK_ANGLES], all = 0;

    hk_filter_defaults(&filter.settings);
    hk_filter_init(&filter);
    for (long k = 0; k < samples; k++) {
        hk_filter_update(&filter, accel_count + 3 * k, gyro_count + 3 * k);
        hk_filter_angles(&filter, angle);
        all ^= angle[HK_ROLL] ^ angle[HK_PITCH];
    }
    return all;
}
