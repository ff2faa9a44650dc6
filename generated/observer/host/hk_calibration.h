/* Finds the bias of the gyroscope while the sensor lies still. */
#ifndef HK_CALIBRATION_H
#define HK_CALIBRATION_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"

/* A window lasts a second, but has 32 samples at least. */
#define HK_CALIBRATION_SAMPLES \
    (HK_PERIOD_US * 32U > UINT32_C(1000000) ? UINT32_C(32) : UINT32_C(1000000) / HK_PERIOD_US)

/* So long may it take until a window is still. */
#define HK_CALIBRATION_LIMIT_US (10U * HK_CALIBRATION_SAMPLES * HK_PERIOD_US)

typedef enum {
    HK_CALIBRATION_NOTHING,
    HK_CALIBRATION_DONE,
    HK_CALIBRATION_MOVED /* there was no still window, or there were no samples */
} hk_calibration_event_t;

typedef struct {
    bool running;
    uint32_t began_us;
    uint16_t samples; /* in this window */
    int16_t lowest[6]; /* counts: specific force, angular rate */
    int16_t highest[6];
    int32_t sum[3]; /* of the angular rate */
} hk_calibration_t;

void hk_calibration_init(hk_calibration_t *calibration);
void hk_calibration_start(hk_calibration_t *calibration, uint32_t now_us);

/* Take a sample of counts in sensor axes. With HK_CALIBRATION_DONE the mean of the window's angular
 * rate is in gyro_count. */
hk_calibration_event_t hk_calibration_take(hk_calibration_t *calibration, const int16_t accel[3],
                                           const int16_t gyro[3], float gyro_count[3]);

/* Drop the window: what was measured before does not belong to what comes. */
void hk_calibration_drop(hk_calibration_t *calibration);

/* Look at the clock. */
hk_calibration_event_t hk_calibration_poll(hk_calibration_t *calibration, uint32_t now_us);

#endif
