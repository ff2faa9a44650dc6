/* made by hostkit 0.1.0 from design 975f50245cf2; do not edit; template complementary/hk_filter.h.j2 */
#ifndef HK_FILTER_H
#define HK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

/* Angles are signed 32-bit half turns: one unit is pi / 2^31 rad, overflow is the wrap at +-pi. */
#define HK_ROLL 0
#define HK_PITCH 1
#define HK_ANGLES 2

#define HK_RATE_GAIN_PITCH_RAW  INT32_C(72818)  /* 36408.88888888889 half turns / 2^31 per count, s16.1 */
#define HK_RATE_GAIN_PITCH_FRAC 1
#define HK_BLEND_RAW  INT32_C(77070)  /* 0.5880000000000001 1, s0.17 */
#define HK_BLEND_FRAC 17

typedef struct {
    int32_t angle[HK_ANGLES]; /* roll, pitch; an axis that the design does not have stays 0 */
    uint8_t primed;           /* 0 until the first sample has loaded the measured tilt */
} hk_filter_t;

/* The state beside the angles of the design's axes, to initialise an array of words with. */
#define HK_FILTER_HIDDEN(filter) \
    { 0 }

void hk_filter_init(hk_filter_t *filter);

/* Take one sample of raw counts in sensor axes. Returns true if the sample loaded the measured tilt
 * instead of stepping, which the first one after hk_filter_init does. */
bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3]);

#endif
