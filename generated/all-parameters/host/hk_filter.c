/* made by hostkit 0.1.0 from design 0099cab74159; do not edit; template complementary/hk_filter.c.j2 */
#include "hk_filter.h"

#include "hk_arctan.h"

#include <stddef.h>

/* pi / 2^31: one unit of an angle in rad. */
#define HK_RAD_PER_UNIT 0x1.921fb6p-30f

/* Body axes from sensor axes; a count is widened first, because -(-32768) is no int16_t. */
#define HK_BODY_X(count) ((int32_t)(count)[0])
#define HK_BODY_Y(count) ((int32_t)(count)[1])
#define HK_BODY_Z(count) ((int32_t)(count)[2])

/* What the functions of hk_fixed.h ask for. */
#define HK_FITS(frac, lowest, highest) ((frac) >= (lowest) && (frac) <= (highest) ? 1 : -1)
typedef char hk_rate_gain_roll_fits[HK_FITS(HK_RATE_GAIN_ROLL_FRAC, 1, 15)];
typedef char hk_rate_gain_pitch_fits[HK_FITS(HK_RATE_GAIN_PITCH_FRAC, 1, 15)];
typedef char hk_blend_fits[HK_FITS(HK_BLEND_FRAC, 16, 49)];
typedef char hk_integral_gain_fits[HK_FITS(HK_INTEGRAL_GAIN_FRAC, 17, 49)];
typedef char hk_bias_fits[HK_FITS(HK_BIAS_FRAC, 1, 30)];

void hk_filter_init(hk_filter_t *filter)
{
    filter->angle[HK_ROLL] = 0;
    filter->angle[HK_PITCH] = 0;
    filter->bias[HK_ROLL] = filter->settings.bias[HK_ROLL];
    filter->bias[HK_PITCH] = filter->settings.bias[HK_PITCH];
    filter->primed = 0U;
}

/* Tilt from specific force, half turns. */
static void hk_measure(const hk_filter_settings_t *settings, const int16_t accel_count[3],
                       int32_t tilt[HK_ANGLES])
{
    hk_length_t length;

    tilt[HK_ROLL] = hk_atan2(HK_BODY_Y(accel_count), HK_BODY_Z(accel_count), &length);
    tilt[HK_PITCH] = hk_atan2_length(-HK_BODY_X(accel_count), &length);
    tilt[HK_ROLL] = hk_wrap_sub(tilt[HK_ROLL], settings->tilt_offset[HK_ROLL]);
    tilt[HK_PITCH] = hk_wrap_sub(tilt[HK_PITCH], settings->tilt_offset[HK_PITCH]);
}

/* Whether the specific force is close enough to 1 g to say where up is. */
static bool hk_corrects(const int16_t accel_count[3])
{
    uint32_t square = 0U;
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        square += (uint32_t)((int32_t)accel_count[i] * accel_count[i]);
    }
    return square >= HK_GATE_LOWEST && square <= HK_GATE_HIGHEST;
}

/* Predict roll with the rate. */
static int32_t hk_predict_roll(const hk_filter_t *filter, const int16_t gyro_count[3])
{
    const int32_t turn = hk_scale_count(HK_BODY_X(gyro_count), HK_RATE_GAIN_ROLL_RAW,
                                        HK_RATE_GAIN_ROLL_FRAC);
    const int32_t bias = hk_shift_rounded(filter->bias[HK_ROLL], HK_BIAS_FRAC);

    return hk_wrap_add(filter->angle[HK_ROLL], hk_wrap_sub(turn, bias));
}

/* Predict pitch with the rate. */
static int32_t hk_predict_pitch(const hk_filter_t *filter, const int16_t gyro_count[3])
{
    const int32_t turn = hk_scale_count(HK_BODY_Y(gyro_count), HK_RATE_GAIN_PITCH_RAW,
                                        HK_RATE_GAIN_PITCH_FRAC);
    const int32_t bias = hk_shift_rounded(filter->bias[HK_PITCH], HK_BIAS_FRAC);

    return hk_wrap_add(filter->angle[HK_PITCH], hk_wrap_sub(turn, bias));
}

/* Correct a prediction with the wrapped difference to the measured tilt, and the bias with it. */
HK_INLINE int32_t hk_correct(const hk_coefficient_t *blend, int32_t predicted, int32_t tilt, bool corrects, int32_t *bias)
{
    const int32_t innovation = corrects ? hk_wrap_sub(tilt, predicted) : 0;
    const int32_t correction = hk_scale_angle(innovation, blend->raw, blend->frac);
    const int32_t change =
        hk_scale_angle(innovation, HK_INTEGRAL_GAIN_RAW, HK_INTEGRAL_GAIN_FRAC);

    *bias = hk_clamped(*bias - change, HK_BIAS_LIMIT);
    return hk_wrap_add(predicted, correction);
}

bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3])
{
    int32_t tilt[HK_ANGLES] = {0, 0};
    const bool load = filter->primed == 0U;
    const bool corrects = hk_corrects(accel_count);

    hk_measure(&filter->settings, accel_count, tilt);
    filter->angle[HK_ROLL] =
        load ? tilt[HK_ROLL]
             : hk_correct(&filter->settings.blend, hk_predict_roll(filter, gyro_count), tilt[HK_ROLL], corrects,
                          &filter->bias[HK_ROLL]);
    filter->angle[HK_PITCH] =
        load ? tilt[HK_PITCH]
             : hk_correct(&filter->settings.blend, hk_predict_pitch(filter, gyro_count), tilt[HK_PITCH], corrects,
                          &filter->bias[HK_PITCH]);
    filter->primed = 1U;
    return load;
}

void hk_filter_angles(const hk_filter_t *filter, int32_t angle[HK_ANGLES])
{
    angle[HK_ROLL] = filter->angle[HK_ROLL];
    angle[HK_PITCH] = filter->angle[HK_PITCH];
}

float hk_filter_angle_rad(const hk_filter_t *filter, uint8_t axis)
{
    return (float)filter->angle[axis] * HK_RAD_PER_UNIT;
}
