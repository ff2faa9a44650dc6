/* Calibration: see the header.
 *
 * A window is still if no count has moved further than its noise lets it: over a second the noise of
 * the part, 0.05 deg/s and 4 mg (RM-MPU-6000A, PS-MPU-6000A 6.1 and 6.2, with 42 Hz), spans some
 * six times as much. A steady turn shows in no span, so a rate above the zero-rate output that the
 * data sheet allows, 20 deg/s, and half as much for temperature, is none either. A slower steady turn
 * cannot be told from a bias. */
#include "hk_calibration.h"

#define HK_RATE_SPAN_RAD_S  0.03f
#define HK_RATE_LIMIT_RAD_S 0.52f
#define HK_FORCE_SPAN_M_S2  0.5f

#define HK_RATE_SPAN  ((uint16_t)(HK_RATE_SPAN_RAD_S / HK_RAD_S_PER_COUNT))
#define HK_RATE_LIMIT ((int32_t)(HK_RATE_LIMIT_RAD_S / HK_RAD_S_PER_COUNT))
#define HK_FORCE_SPAN ((uint16_t)(HK_FORCE_SPAN_M_S2 / HK_M_S2_PER_COUNT))

typedef char hk_window_can_be_summed[HK_CALIBRATION_SAMPLES <= 32767U ? 1 : -1];

void hk_calibration_init(hk_calibration_t *calibration)
{
    calibration->running = false;
    hk_calibration_drop(calibration);
}

void hk_calibration_start(hk_calibration_t *calibration, uint32_t now_us)
{
    calibration->running = true;
    calibration->began_us = now_us;
    hk_calibration_drop(calibration);
}

void hk_calibration_drop(hk_calibration_t *calibration)
{
    uint8_t i;

    calibration->samples = 0U;
    for (i = 0U; i < 6U; i++) {
        calibration->lowest[i] = INT16_MAX;
        calibration->highest[i] = INT16_MIN;
    }
    for (i = 0U; i < 3U; i++) {
        calibration->sum[i] = 0;
    }
}

/* Take a count into the window. Returns whether it is still. */
static bool still_with(hk_calibration_t *calibration, uint8_t i, int16_t count, uint16_t span)
{
    if (count < calibration->lowest[i]) {
        calibration->lowest[i] = count;
    }
    if (count > calibration->highest[i]) {
        calibration->highest[i] = count;
    }
    return (uint16_t)(calibration->highest[i] - calibration->lowest[i]) <= span;
}

static bool still(hk_calibration_t *calibration, const int16_t accel[3], const int16_t gyro[3])
{
    bool good = true;
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        good = still_with(calibration, i, accel[i], HK_FORCE_SPAN) && good;
        good = still_with(calibration, (uint8_t)(i + 3U), gyro[i], HK_RATE_SPAN) && good;
        good = gyro[i] <= HK_RATE_LIMIT && gyro[i] >= -HK_RATE_LIMIT && good;
        calibration->sum[i] += gyro[i];
    }
    return good;
}

hk_calibration_event_t hk_calibration_take(hk_calibration_t *calibration, const int16_t accel[3],
                                           const int16_t gyro[3], float gyro_count[3])
{
    uint8_t i;

    if (!calibration->running) {
        return HK_CALIBRATION_NOTHING;
    }
    if (!still(calibration, accel, gyro)) {
        hk_calibration_drop(calibration);
        return HK_CALIBRATION_NOTHING;
    }
    calibration->samples++;
    if (calibration->samples < HK_CALIBRATION_SAMPLES) {
        return HK_CALIBRATION_NOTHING;
    }
    for (i = 0U; i < 3U; i++) {
        gyro_count[i] = (float)calibration->sum[i] / (float)HK_CALIBRATION_SAMPLES;
    }
    calibration->running = false;
    return HK_CALIBRATION_DONE;
}

hk_calibration_event_t hk_calibration_poll(hk_calibration_t *calibration, uint32_t now_us)
{
    if (!calibration->running || now_us - calibration->began_us < HK_CALIBRATION_LIMIT_US) {
        return HK_CALIBRATION_NOTHING;
    }
    calibration->running = false;
    return HK_CALIBRATION_MOVED;
}
