/* made by hostkit 0.1.0 from design 00e52f7c2b01; do not edit; template complementary/hk_filter.h.j2 */
#ifndef HK_FILTER_H
#define HK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_fixed.h"

/* Angles are signed 32-bit half turns: one unit is pi / 2^31 rad, overflow is the wrap at +-pi. */
#define HK_ROLL 0
#define HK_PITCH 1
#define HK_ANGLES 2

#define HK_RATE_GAIN_ROLL_RAW  INT32_C(116508)  /* 1820.4444444444448 half turns / 2^31 per count, s11.6 */
#define HK_RATE_GAIN_ROLL_FRAC 6
#define HK_RATE_GAIN_PITCH_RAW  INT32_C(116508)  /* 1820.4444444444448 half turns / 2^31 per count, s11.6 */
#define HK_RATE_GAIN_PITCH_FRAC 6
#define HK_BLEND_RAW  INT32_C(117441)  /* 0.0034999999999999476 1, s-8.25 */
#define HK_BLEND_FRAC 25
#define HK_TILT_OFFSET_ROLL INT32_C(0)  /* half turns */
#define HK_TILT_OFFSET_PITCH INT32_C(0)  /* half turns */

/* Bias of the gyroscope: half turns per sample with HK_BIAS_FRAC fraction bits. */
#define HK_BIAS_FRAC 0
#define HK_BIAS_START_ROLL INT32_C(0)
#define HK_BIAS_START_PITCH INT32_C(0)

/* What can be changed while the filter runs; the constants above are the design's. A bias and an
 * offset of an axis that the design does not have are 0. */
typedef struct {
    hk_coefficient_t blend;         /* 1 - eta */
    int32_t bias[HK_ANGLES];        /* taken off each step of the rate */
    int32_t tilt_offset[HK_ANGLES]; /* taken off the measured tilt, half turns */
} hk_filter_settings_t;

/* The same by number, in SI units. */
enum {
    HK_FILTER_TAU,          /* s: 9.53674295089968e-09 to 9999.9970703125 */
    HK_FILTER_BIAS_ROLL,    /* rad/s: +-0.3490658402442932 */
    HK_FILTER_BIAS_PITCH,
    HK_FILTER_OFFSET_ROLL,  /* rad: +-0.5235987305641174 */
    HK_FILTER_OFFSET_PITCH,
    HK_FILTER_PARAMETERS
};

/* X(name, number) for each parameter that the design has, in the order of the link and the store. */
#define HK_FILTER_NAMES(X) \
    X(FILT_TAU, HK_FILTER_TAU) \
    X(GYRO_BIAS_ROLL, HK_FILTER_BIAS_ROLL) \
    X(TILT_OFS_ROLL, HK_FILTER_OFFSET_ROLL) \
    X(GYRO_BIAS_PITCH, HK_FILTER_BIAS_PITCH) \
    X(TILT_OFS_PITCH, HK_FILTER_OFFSET_PITCH)

/* Biases of the gyroscope among them: how many, the number of the first one. */
#define HK_FILTER_BIASES     2
#define HK_FILTER_FIRST_BIAS HK_FILTER_BIAS_ROLL

typedef struct {
    hk_filter_settings_t settings;
    int32_t angle[HK_ANGLES]; /* roll, pitch; an axis that the design does not have stays 0 */
    uint8_t primed;           /* 0 until the first sample has loaded the measured tilt */
} hk_filter_t;

/* The state beside the angles of the design's axes, as TILT_SAMPLE tells it: to initialise an array of
 * words with. */
#define HK_FILTER_HIDDEN(filter) \
    { 0 }

/* Words of the state that do not fit there, and are told by TILT_STATE. */
#define HK_FILTER_STATE_WORDS 0

/* The settings of the design. They must be there before hk_filter_init. */
void hk_filter_defaults(hk_filter_settings_t *settings);

/* The value in use of one parameter, rounded to a float: set again, it changes nothing. 0 for what
 * the design does not have. */
float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which);

/* Take the nearest value that the filter can hold. Returns false, and changes nothing, if it is not
 * finite, out of range, or of an axis that the design does not have. */
bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value);

/* What a bias, counted from the first, is taken off: the rate of HK_ROLL or HK_PITCH; 0 for an axis
 * without. */
float hk_filter_rate_rad_s(uint8_t axis, const float gyro_count[3]);

/* Reset the state; the settings stay. */
void hk_filter_init(hk_filter_t *filter);

/* Take one sample of raw counts in sensor axes. Returns true if the sample loaded the measured tilt
 * instead of stepping, which the first one after hk_filter_init does. */
bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3]);

/* Roll and pitch in half turns, and one of them in rad. */
void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES]);
float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis);

#endif
