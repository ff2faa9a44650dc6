/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template observer/hk_filter.h.j2 */
#ifndef HK_FILTER_H
#define HK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

/* The bounded-velocity observer. Angles are signed 32-bit half turns: one unit is pi / 2^31 rad,
 * overflow is the wrap at +-pi. */
#define HK_ROLL 0
#define HK_PITCH 1
#define HK_ANGLES 2

/* Constants of the design: what they are, and their fraction bits. */
#define HK_GYRO_GAIN_X INT32_C(191151367)  /* half-angle per count, 47 fraction bits */
#define HK_GYRO_GAIN_Y INT32_C(185529268)  /* half-angle per count, 47 fraction bits */
#define HK_GYRO_GAIN_Z INT32_C(189277334)  /* half-angle per count, 47 fraction bits */
#define HK_ACCEL_GAIN_X INT32_C(1276739494)  /* m/s^2 per count, 40 */
#define HK_ACCEL_GAIN_Y INT32_C(1342550808)  /* m/s^2 per count, 40 */
#define HK_ACCEL_GAIN_Z INT32_C(1329388545)  /* m/s^2 per count, 40 */
#define HK_ACCEL_OFFSET_X INT32_C(9764340)  /* m/s^2, 25 */
#define HK_ACCEL_OFFSET_Y INT32_C(-6845104)  /* m/s^2, 25 */
#define HK_ACCEL_OFFSET_Z INT32_C(3388998)  /* m/s^2, 25 */
#define HK_FIRST_FORCE_LIMIT INT32_C(394867885)  /* m/s^2, 25 */
#define HK_ACCELERATION_LIMIT INT32_C(671088640)  /* m/s^2, 23 */
#define HK_CORRECTION_LIMIT INT32_C(687194767)  /* half-angle, 34 */
#define HK_BIAS_LIMIT INT32_C(959504903)  /* half-angle per sample, 39 */
#define HK_HALF_PER_G INT32_C(1751859114)  /* 1 / (2 g), s^2/m, 35 */
#define HK_SIXTH INT32_C(715827883)  /* 1/6, 32 */
#define HK_FIFTH INT32_C(858993459)  /* 1/5, 32 */
#define HK_TWENTY_FOURTH INT32_C(178956971)  /* 1/24, 32 */
#define HK_FIRST_ROUNDS INT32_C(6)  /* renormalisations of the first orientation */
#define HK_START_GAIN INT32_C(1073741824)  /* 31 */
#define HK_START_END INT32_C(21474836)  /* 31 */
#define HK_START_LIMIT INT32_C(16777216)  /* half-angle, 26 */
#define HK_CLIP_GAIN INT32_C(67108864)  /* 31 */
#define HK_CLIP_COUNT INT32_C(26284)  /* counts */
#define HK_MEAN_SHIFT INT32_C(6)  /* running means forget 2^-this at each sample */
#define HK_MEAN_LIMIT INT32_C(12304175)  /* counts, 14 */
#define HK_REST_SAMPLES INT32_C(100)  /* samples */
#define HK_LEAD INT32_C(-33554432)  /* lead per half-angle, 25 */
#define HK_LEAD_LIMIT INT32_C(33554432)  /* rad, 25 */
#define HK_REST_RATE INT32_C(1845626)  /* counts, 14 */
#define HK_REST_FORCE INT32_C(4105920)  /* counts, 14 */
#define HK_REST_GAIN INT32_C(85899346)  /* 34 */

/* Shifts between formats. */
#define HK_ACCELERATION_SHIFT 1
#define HK_FIRST_FORCE_SHIFT  2
#define HK_TURN_SHIFT         2
#define HK_BIAS_SHIFT         7
#define HK_FIRST_BIAS_SHIFT   10
#define HK_REST_SHIFT         5

/* What can be changed while the filter runs, by number; in SI units. */
enum {
    HK_FILTER_KT, /* rad/m: 0.00010000000474974513 to 9.76562213897705 */
    HK_FILTER_KV, /* 1/s: 0.0010000000474974513 to 49.99998474121094 */
    HK_FILTER_KB, /* 1/s: 0.0 to 0.29999998211860657 */
    HK_FILTER_BIAS_X, /* rad/s: -0.3422214090824127 to 0.3422214090824127 */
    HK_FILTER_BIAS_Y, /* rad/s: -0.3490658402442932 to 0.3490658402442932 */
    HK_FILTER_BIAS_Z, /* rad/s: -0.34560972452163696 to 0.34560972452163696 */
    HK_FILTER_PARAMETERS
};

/* X(name, number) for each of them, in the order of the link and the store. */
#define HK_FILTER_NAMES(X) \
    X(FILT_KT, HK_FILTER_KT) \
    X(FILT_KV, HK_FILTER_KV) \
    X(FILT_KB, HK_FILTER_KB) \
    X(GYRO_BIAS_X, HK_FILTER_BIAS_X) \
    X(GYRO_BIAS_Y, HK_FILTER_BIAS_Y) \
    X(GYRO_BIAS_Z, HK_FILTER_BIAS_Z)

/* Biases of the gyroscope among them: how many, the number of the first one, and where the settings
 * have them, for the filter starts from them anew when they are set. */
#define HK_FILTER_BIASES     3
#define HK_FILTER_FIRST_BIAS HK_FILTER_BIAS_X
#define HK_FILTER_START_BIAS(settings) ((settings)->bias)

/* The same in integers. */
typedef struct {
    int32_t gain[3]; /* kt, kv, kb */
    int32_t bias[3]; /* of the gyroscope at the start: half-angle per sample, 39 fraction bits */
} hk_filter_settings_t;

/* Axes of the sensor are x, y, z; those of the earth x and y, with z up. */
typedef struct {
    hk_filter_settings_t settings;
    int32_t angle[HK_ANGLES]; /* roll, pitch */
    int32_t quaternion[4];    /* sensor to earth: w, x, y, z; 30 fraction bits */
    int32_t velocity[2];      /* as the half-angle that it corrects in a sample, 34 */
    int32_t bias[3];          /* of the gyroscope, 39 */
    int32_t gyro_mean[3];     /* running means of the counts, 14 */
    int32_t accel_mean[3];
    int32_t start_gain;       /* weight of the alignment, 31; 0 when it is over */
    uint16_t still;           /* samples that were near their means, up to HK_REST_SAMPLES */
    uint8_t rested;           /* 1 after the first rest */
    uint8_t primed;           /* 0 until the first sample has been loaded */
} hk_filter_t;

/* TILT_SAMPLE has no room for the state beside the angles; TILT_STATE tells it. */
#define HK_FILTER_HIDDEN(filter) { 0 }
#define HK_FILTER_STATE_WORDS 18

/* The settings of the design. They must be there before hk_filter_init. */
void hk_filter_defaults(hk_filter_settings_t *settings);

/* The value in use of one parameter, rounded to a float: set again, it changes nothing. */
float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which);

/* Take the nearest value that the filter can hold. Returns false, and changes nothing, if it is not
 * finite or out of range. A bias is where the filter starts from: it counts from the next
 * hk_filter_init on. */
bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value);

/* What a bias, counted from the first, is taken off: the rate about that axis of the sensor. */
float hk_filter_rate_rad_s(uint8_t bias, const float gyro_count[3]);

/* Reset the state; the settings stay. */
void hk_filter_init(hk_filter_t *filter);

/* Take one sample of raw counts in sensor axes. Returns true if the sample was loaded instead of
 * taken as a step, which the first one after hk_filter_init is. */
bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3]);

/* Roll and pitch in half turns, and one of them in rad. */
void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES]);
float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis);

/* The state beside the angles, in the order of hk_filter_t. */
void hk_filter_state(const hk_filter_t *filter, int32_t words[HK_FILTER_STATE_WORDS]);

#endif
