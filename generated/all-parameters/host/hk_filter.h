/* made by hostkit 0.1.0 from design 0099cab74159; do not edit; template complementary/hk_filter.h.j2 */
#ifndef HK_FILTER_H
#define HK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

/* Angles are signed 32-bit half turns: one unit is pi / 2^31 rad, overflow is the wrap at +-pi. */
#define HK_ROLL 0
#define HK_PITCH 1
#define HK_ANGLES 2

#define HK_RATE_GAIN_ROLL_RAW  INT32_C(117674)  /* 1838.6488888888891 half turns / 2^31 per count, s11.6 */
#define HK_RATE_GAIN_ROLL_FRAC 6
#define HK_RATE_GAIN_PITCH_RAW  INT32_C(114178)  /* 1784.0355555555557 half turns / 2^31 per count, s11.6 */
#define HK_RATE_GAIN_PITCH_FRAC 6
#define HK_BLEND_RAW  INT32_C(117441)  /* 0.0034999999999999476 1, s-8.25 */
#define HK_BLEND_FRAC 25
#define HK_INTEGRAL_GAIN_RAW  INT32_C(85899)  /* 0.01024 1, s-6.23 */
#define HK_INTEGRAL_GAIN_FRAC 23
#define HK_TILT_OFFSET_ROLL INT32_C(23860929)  /* half turns */
#define HK_TILT_OFFSET_PITCH INT32_C(-41756626)  /* half turns */

/* Sums of squared counts of specific force that correct: close enough to 1 g, 16384 counts. */
#define HK_GATE_LOWEST  UINT32_C(217432720)
#define HK_GATE_HIGHEST UINT32_C(324806901)

/* Bias of the gyroscope: half turns per sample with HK_BIAS_FRAC fraction bits. */
#define HK_BIAS_FRAC  9
#define HK_BIAS_LIMIT INT32_C(1221679586)
#define HK_BIAS_START_ROLL INT32_C(91625969)
#define HK_BIAS_START_PITCH INT32_C(-45812984)

typedef struct {
    int32_t angle[HK_ANGLES]; /* roll, pitch; an axis that the design does not have stays 0 */
    int32_t bias[HK_ANGLES];  /* of the gyroscope, likewise */
    uint8_t primed;           /* 0 until the first sample has loaded the measured tilt */
} hk_filter_t;

/* The state beside the angles of the design's axes, to initialise an array of words with. */
#define HK_FILTER_HIDDEN(filter) \
    { (filter)->bias[HK_ROLL], (filter)->bias[HK_PITCH] }

void hk_filter_init(hk_filter_t *filter);

/* Take one sample of raw counts in sensor axes. Returns true if the sample loaded the measured tilt
 * instead of stepping, which the first one after hk_filter_init does. */
bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3]);

#endif
