/* made by hostkit 0.1.0 from design 00e52f7c2b01; do not edit; template complementary/hk_filter.c.j2 */
#include "hk_filter.h"

#include "hk_arctan.h"
#include "hk_fixed.h"

#include <stddef.h>

/* Body axes from sensor axes; a count is widened first, because -(-32768) is no int16_t. */
#define HK_BODY_X(count) ((int32_t)(count)[0])
#define HK_BODY_Y(count) ((int32_t)(count)[1])
#define HK_BODY_Z(count) ((int32_t)(count)[2])

/* What the functions of hk_fixed.h ask for. */
#define HK_FITS(frac, lowest, highest) ((frac) >= (lowest) && (frac) <= (highest) ? 1 : -1)
typedef char hk_rate_gain_roll_fits[HK_FITS(HK_RATE_GAIN_ROLL_FRAC, 1, 15)];
typedef char hk_rate_gain_pitch_fits[HK_FITS(HK_RATE_GAIN_PITCH_FRAC, 1, 15)];
typedef char hk_blend_fits[HK_FITS(HK_BLEND_FRAC, 16, 49)];

void hk_filter_init(hk_filter_t *filter)
{
    filter->angle[HK_ROLL] = 0;
    filter->angle[HK_PITCH] = 0;
    filter->primed = 0U;
}

/* Tilt from specific force, half turns. */
static void hk_measure(const int16_t accel_count[3], int32_t tilt[HK_ANGLES])
{
    hk_length_t length;

    tilt[HK_ROLL] = hk_atan2(HK_BODY_Y(accel_count), HK_BODY_Z(accel_count), &length);
    tilt[HK_PITCH] = hk_atan2_length(-HK_BODY_X(accel_count), &length);
}

/* Predict roll with the rate. */
static int32_t hk_predict_roll(const hk_filter_t *filter, const int16_t gyro_count[3])
{
    const int32_t turn = hk_scale_count(HK_BODY_X(gyro_count), HK_RATE_GAIN_ROLL_RAW,
                                        HK_RATE_GAIN_ROLL_FRAC);

    return hk_wrap_add(filter->angle[HK_ROLL], turn);
}

/* Predict pitch with the rate. */
static int32_t hk_predict_pitch(const hk_filter_t *filter, const int16_t gyro_count[3])
{
    const int32_t turn = hk_scale_count(HK_BODY_Y(gyro_count), HK_RATE_GAIN_PITCH_RAW,
                                        HK_RATE_GAIN_PITCH_FRAC);

    return hk_wrap_add(filter->angle[HK_PITCH], turn);
}

/* Correct a prediction with the wrapped difference to the measured tilt. */
static int32_t hk_correct(int32_t predicted, int32_t tilt)
{
    const int32_t innovation = hk_wrap_sub(tilt, predicted);
    const int32_t correction = hk_scale_angle(innovation, HK_BLEND_RAW, HK_BLEND_FRAC);

    return hk_wrap_add(predicted, correction);
}

bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3])
{
    int32_t tilt[HK_ANGLES] = {0, 0};
    const bool load = filter->primed == 0U;

    hk_measure(accel_count, tilt);
    filter->angle[HK_ROLL] =
        load ? tilt[HK_ROLL]
             : hk_correct(hk_predict_roll(filter, gyro_count), tilt[HK_ROLL]);
    filter->angle[HK_PITCH] =
        load ? tilt[HK_PITCH]
             : hk_correct(hk_predict_pitch(filter, gyro_count), tilt[HK_PITCH]);
    filter->primed = 1U;
    return load;
}
