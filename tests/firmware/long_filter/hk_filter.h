/* A filter with a long state and three biases, for tests of what is around filters. Its angles are
 * sums of counts, so that a lost, doubled or reset sample shows in every word behind it. */
#ifndef HK_FILTER_H
#define HK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

#define HK_ROLL 0
#define HK_PITCH 1
#define HK_ANGLES 2

enum {
    HK_FILTER_KT,
    HK_FILTER_KV,
    HK_FILTER_KB,
    HK_FILTER_BIAS_X,
    HK_FILTER_BIAS_Y,
    HK_FILTER_BIAS_Z,
    HK_FILTER_PARAMETERS
};

#define HK_FILTER_NAMES(X) \
    X(FILT_KT, HK_FILTER_KT) \
    X(FILT_KV, HK_FILTER_KV) \
    X(FILT_KB, HK_FILTER_KB) \
    X(GYRO_BIAS_X, HK_FILTER_BIAS_X) \
    X(GYRO_BIAS_Y, HK_FILTER_BIAS_Y) \
    X(GYRO_BIAS_Z, HK_FILTER_BIAS_Z)

#define HK_FILTER_BIASES     3
#define HK_FILTER_FIRST_BIAS HK_FILTER_BIAS_X
#define HK_FILTER_START_BIAS(settings) ((settings)->bias_rad_s)

#define HK_FILTER_HIDDEN(filter) { 0 }
#define HK_FILTER_STATE_WORDS 17

typedef struct {
    float gain[3];
    float bias_rad_s[3];
} hk_filter_settings_t;

typedef struct {
    hk_filter_settings_t settings;
    int32_t last[6];  /* counts of the last sample */
    uint32_t sum[6];  /* of all counts since hk_filter_init */
    uint32_t updates; /* since hk_filter_init */
} hk_filter_t;

void hk_filter_defaults(hk_filter_settings_t *settings);
float hk_filter_get(const hk_filter_settings_t *settings, uint8_t which);
bool hk_filter_set(hk_filter_settings_t *settings, uint8_t which, float value);
float hk_filter_rate_rad_s(uint8_t bias, const float gyro_count[3]);
void hk_filter_init(hk_filter_t *filter);
bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3]);
void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES]);
float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis);

/* Updates, sums, last counts, biases in urad/s, updates again. */
void hk_filter_state(const hk_filter_t *filter, int32_t words[HK_FILTER_STATE_WORDS]);

#endif
