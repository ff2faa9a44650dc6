/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template observer/hk_filter.c.j2 */
#include "hk_filter.h"

#include "hk_arctan.h"
#include "hk_fixed.h"

#include <string.h>

/* Words have 32 bits, and a number in a comment says how many of them are fraction. hk_product takes
 * 32 of the sum of those of its factors. */

/* pi / 2^31: one unit of an angle in rad. */
#define HK_RAD_PER_UNIT 0x1.921fb6p-30f

/* One half with 31 fraction bits less a unit, one with 27 and with 28, one half with 30. */
#define HK_HALF_32  INT32_C(0x7FFFFFFF)
#define HK_ONE_27   (INT32_C(1) << 27)
#define HK_ONE_28   (INT32_C(1) << 28)
#define HK_HALF_30  (INT32_C(1) << 29)

/* A shift to the left, also of what is negative. */
#define HK_LEFT(value, bits) ((int32_t)((uint32_t)(value) << (bits)))

/* Body axes from sensor axes. */
#define HK_BODY_X(vector) ((vector)[0])
#define HK_BODY_Y(vector) ((vector)[1])
#define HK_BODY_Z(vector) ((vector)[2])

/* Rows of the rotation from sensor to earth that give x and y, 30. */
typedef struct {
    int32_t x[3];
    int32_t y[3];
} hk_rows_t;

void hk_filter_init(hk_filter_t *filter)
{
    const hk_filter_settings_t settings = filter->settings;

    (void)memset(filter, 0, sizeof *filter);
    filter->settings = settings;
}

/* Specific force from counts, m/s^2, as many as HK_ACCEL_OFFSET_X. */
static void hk_force(const int16_t accel_count[3], int32_t force[3])
{
    force[0] = hk_scale(HK_ACCEL_GAIN_X, accel_count[0]) - HK_ACCEL_OFFSET_X;
    force[1] = hk_scale(HK_ACCEL_GAIN_Y, accel_count[1]) - HK_ACCEL_OFFSET_Y;
    force[2] = hk_scale(HK_ACCEL_GAIN_Z, accel_count[2]) - HK_ACCEL_OFFSET_Z;
}

/* Half-angle of the sample about each axis, less the bias, 32. */
static void hk_turn(const hk_filter_t *filter, const int16_t gyro_count[3], int32_t turn[3])
{
    turn[0] = hk_scale(HK_GYRO_GAIN_X, gyro_count[0]) - (filter->bias[0] >> HK_BIAS_SHIFT);
    turn[1] = hk_scale(HK_GYRO_GAIN_Y, gyro_count[1]) - (filter->bias[1] >> HK_BIAS_SHIFT);
    turn[2] = hk_scale(HK_GYRO_GAIN_Z, gyro_count[2]) - (filter->bias[2] >> HK_BIAS_SHIFT);
}

/* Bring the length of a quaternion nearer to one. */
static void hk_normalise(int32_t q[4])
{
    int32_t less = HK_ONE_28;
    uint8_t i;

    for (i = 0U; i < 4U; i++) {
        less -= hk_product(q[i], q[i]);
    }
    less = HK_LEFT(less, 3); /* half of what the square lacks, 32 */
    for (i = 0U; i < 4U; i++) {
        q[i] += hk_product(q[i], less);
    }
}

/* The turn that lays the specific force of the first sample upwards. */
static void hk_upright(const int32_t force[3], int32_t q[4])
{
    int32_t half[3]; /* of the force in g, 30 */
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        half[i] = hk_product(
            HK_LEFT(hk_clamped(force[i], HK_FIRST_FORCE_LIMIT), HK_FIRST_FORCE_SHIFT),
            HK_HALF_PER_G);
    }
    if (half[2] >= 0) {
        q[0] = HK_HALF_30 + half[2];
        q[1] = half[1];
        q[2] = -half[0];
        q[3] = 0;
    } else {
        q[0] = half[1];
        q[1] = HK_HALF_30 - half[2];
        q[2] = 0;
        q[3] = half[0];
    }
    for (i = 0U; i < HK_FIRST_ROUNDS; i++) {
        hk_normalise(q);
    }
}

static void hk_load(hk_filter_t *filter, const int32_t force[3], const int16_t accel_count[3],
                    const int16_t gyro_count[3])
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        filter->gyro_mean[i] = HK_LEFT(gyro_count[i], 14);
        filter->accel_mean[i] = HK_LEFT(accel_count[i], 14);
    }
    hk_upright(force, filter->quaternion);
    (void)memcpy(filter->bias, filter->settings.bias, sizeof filter->bias);
    filter->start_gain = HK_START_GAIN;
    filter->primed = 1U;
}

/* Let the running means follow; return whether no count was further from its mean than the limit. */
static bool hk_follow(int32_t mean[3], const int16_t count[3], int32_t limit)
{
    bool near = true;
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        const int32_t apart = HK_LEFT(count[i], 14) - mean[i];

        mean[i] += apart >> HK_MEAN_SHIFT;
        near = near && apart <= limit && apart >= -limit;
    }
    return near;
}

/* Whether the mean rate can be a bias. */
static bool hk_is_bias(const int32_t mean[3])
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        if (mean[i] > HK_MEAN_LIMIT || mean[i] < -HK_MEAN_LIMIT) {
            return false;
        }
    }
    return true;
}

/* Whether the sensor is at rest, and has been for a while. */
static bool hk_rests(hk_filter_t *filter, const int16_t accel_count[3], const int16_t gyro_count[3])
{
    const bool rate_is_near = hk_follow(filter->gyro_mean, gyro_count, HK_REST_RATE);
    const bool force_is_near = hk_follow(filter->accel_mean, accel_count, HK_REST_FORCE);

    if (!rate_is_near || !force_is_near || !hk_is_bias(filter->gyro_mean)) {
        filter->still = 0U;
    } else if (filter->still < HK_REST_SAMPLES) {
        filter->still++;
    }
    return filter->still == HK_REST_SAMPLES;
}

/* At the first rest: the mean rate is the bias, and the alignment starts again. */
static void hk_first_rest(hk_filter_t *filter)
{
    static const int32_t gain[3] = {HK_GYRO_GAIN_X, HK_GYRO_GAIN_Y, HK_GYRO_GAIN_Z};
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        const int32_t rate = hk_product(gain[i], filter->gyro_mean[i]); /* 29 */

        filter->bias[i] = hk_clamped(HK_LEFT(rate, HK_FIRST_BIAS_SHIFT), HK_BIAS_LIMIT);
    }
    filter->start_gain = HK_START_GAIN;
    filter->rested = 1U;
}

/* Let the bias follow the rate, which is small at rest. */
static void hk_follow_rate(hk_filter_t *filter, const int32_t turn[3])
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        const int32_t change = hk_product(HK_LEFT(turn[i], HK_REST_SHIFT), HK_REST_GAIN);

        filter->bias[i] = hk_clamped(filter->bias[i] + change, HK_BIAS_LIMIT);
    }
}

/* A gyroscope that was clipped has lost an angle: lean on the force for a while. */
static void hk_look_for_clipping(hk_filter_t *filter, const int16_t gyro_count[3])
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        if ((gyro_count[i] > HK_CLIP_COUNT || gyro_count[i] < -HK_CLIP_COUNT)
            && filter->start_gain < HK_CLIP_GAIN) {
            filter->start_gain = HK_CLIP_GAIN;
        }
    }
}

/* Turn by twice the half-angles about the axes of the sensor: q * exp(turn). */
static void hk_propagate(int32_t q[4], const int32_t turn[3])
{
    const int32_t square = hk_product(turn[0], turn[0]) + hk_product(turn[1], turn[1])
                         + hk_product(turn[2], turn[2]);
    const int32_t part = hk_product(square, HK_TWENTY_FOURTH);
    /* What cosine and sine of the half-angle lack of one and of the half-angle. */
    const int32_t cosine = hk_product(square, HK_HALF_32 - part);
    const int32_t sine = hk_product(square, HK_SIXTH - hk_product(part, HK_FIFTH));
    const int32_t x = turn[0] - hk_product(turn[0], sine);
    const int32_t y = turn[1] - hk_product(turn[1], sine);
    const int32_t z = turn[2] - hk_product(turn[2], sine);
    const int32_t a = q[0];
    const int32_t b = q[1];
    const int32_t c = q[2];
    const int32_t d = q[3];

    q[0] = a - hk_product(a, cosine) - hk_product(b, x) - hk_product(c, y) - hk_product(d, z);
    q[1] = b - hk_product(b, cosine) + hk_product(a, x) + hk_product(c, z) - hk_product(d, y);
    q[2] = c - hk_product(c, cosine) + hk_product(a, y) + hk_product(d, x) - hk_product(b, z);
    q[3] = d - hk_product(d, cosine) + hk_product(a, z) + hk_product(b, y) - hk_product(c, x);
}

static void hk_find_rows(const int32_t q[4], hk_rows_t *rows)
{
    /* Twice a product of two parts has 27; the rows have 30. */
    const int32_t xx = hk_product(q[1], q[1]);
    const int32_t yy = hk_product(q[2], q[2]);
    const int32_t zz = hk_product(q[3], q[3]);
    const int32_t xy = hk_product(q[1], q[2]);
    const int32_t xz = hk_product(q[1], q[3]);
    const int32_t yz = hk_product(q[2], q[3]);
    const int32_t wx = hk_product(q[0], q[1]);
    const int32_t wy = hk_product(q[0], q[2]);
    const int32_t wz = hk_product(q[0], q[3]);

    rows->x[0] = HK_LEFT(HK_ONE_27 - yy - zz, 3);
    rows->x[1] = HK_LEFT(xy - wz, 3);
    rows->x[2] = HK_LEFT(xz + wy, 3);
    rows->y[0] = HK_LEFT(xy + wz, 3);
    rows->y[1] = HK_LEFT(HK_ONE_27 - xx - zz, 3);
    rows->y[2] = HK_LEFT(yz - wx, 3);
}

/* The part of the specific force along an axis of the earth, which is the acceleration, m/s^2, 24. */
static int32_t hk_acceleration(const int32_t row[3], const int32_t force[3])
{
    const int32_t along = hk_product(row[0], force[0]) + hk_product(row[1], force[1])
                        + hk_product(row[2], force[2]);

    return HK_LEFT(hk_clamped(along, HK_ACCELERATION_LIMIT), HK_ACCELERATION_SHIFT);
}

/* Add to the velocity, which is kept as the correction that it asks for. */
static void hk_accelerate(hk_filter_t *filter, const int32_t acceleration[2])
{
    uint8_t i;

    for (i = 0U; i < 2U; i++) {
        const int32_t change = hk_product(acceleration[i], filter->settings.gain[HK_FILTER_KT]);

        filter->velocity[i] = hk_clamped(filter->velocity[i] + change, HK_CORRECTION_LIMIT);
    }
}

/* The alignment at the start: a share of the tilt that the force shows, as a half-angle, 32. */
static int32_t hk_share(const hk_filter_t *filter, int32_t acceleration)
{
    const int32_t gain = hk_product(filter->start_gain, HK_HALF_PER_G);

    return HK_LEFT(hk_clamped(hk_product(acceleration, gain), HK_START_LIMIT), 6);
}

/* The share falls as one over the number of samples, and holds the velocity back. */
static void hk_lower_share(hk_filter_t *filter)
{
    int32_t gain = filter->start_gain - HK_LEFT(hk_product(filter->start_gain, filter->start_gain), 1);

    if (gain <= HK_START_END) {
        gain = 0;
    }
    filter->start_gain = gain;
    filter->velocity[0] -= HK_LEFT(hk_product(filter->velocity[0], gain), 1);
    filter->velocity[1] -= HK_LEFT(hk_product(filter->velocity[1], gain), 1);
}

/* Turn by twice the half-angles about x and y of the earth, 32. */
static void hk_correct(int32_t q[4], int32_t x, int32_t y)
{
    const int32_t a = q[0];
    const int32_t b = q[1];
    const int32_t c = q[2];
    const int32_t d = q[3];

    q[0] = a - hk_product(x, b) - hk_product(y, c);
    q[1] = b + hk_product(x, a) + hk_product(y, d);
    q[2] = c + hk_product(y, a) - hk_product(x, d);
    q[3] = d + hk_product(x, c) - hk_product(y, b);
}

/* Let the bias follow the correction about x and y of the earth. One product is taken off and one is
 * added, so that what they lose by rounding does not add up. */
static void hk_follow_correction(hk_filter_t *filter, const hk_rows_t *rows, int32_t x, int32_t y)
{
    const int32_t by_x = hk_product(x, filter->settings.gain[HK_FILTER_KB]);
    const int32_t by_y = hk_product(-y, filter->settings.gain[HK_FILTER_KB]);
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        const int32_t change = hk_product(rows->x[i], by_x) - hk_product(rows->y[i], by_y);

        filter->bias[i] = hk_clamped(filter->bias[i] - change, HK_BIAS_LIMIT);
    }
}

static void hk_decay(hk_filter_t *filter)
{
    const int32_t gain = filter->settings.gain[HK_FILTER_KV];

    filter->velocity[0] -= hk_product(filter->velocity[0], gain);
    filter->velocity[1] -= hk_product(filter->velocity[1], gain);
}

/* One sample after the first. */
static void hk_step(hk_filter_t *filter, const int32_t force[3], const int32_t turn[3], bool at_rest)
{
    int32_t acceleration[2];
    int32_t x; /* correction about x and y of the earth, with the fraction bits of the velocity */
    int32_t y;
    int32_t half_x; /* the same, 32 */
    int32_t half_y;
    hk_rows_t rows;

    hk_propagate(filter->quaternion, turn);
    hk_find_rows(filter->quaternion, &rows);
    acceleration[0] = hk_acceleration(rows.x, force);
    acceleration[1] = hk_acceleration(rows.y, force);
    hk_accelerate(filter, acceleration);
    x = filter->velocity[1];
    y = -filter->velocity[0];
    half_x = x >> HK_TURN_SHIFT;
    half_y = y >> HK_TURN_SHIFT;
    if (filter->start_gain != 0) {
        half_x += hk_share(filter, acceleration[1]);
        half_y -= hk_share(filter, acceleration[0]);
        hk_lower_share(filter);
    }
    hk_correct(filter->quaternion, half_x, half_y);
    hk_normalise(filter->quaternion);
    if (at_rest) {
        hk_follow_rate(filter, turn);
    } else {
        hk_follow_correction(filter, &rows, x, y);
    }
    hk_decay(filter);
}

/* Up in axes of the sensor, 27. */
static void hk_find_up(const int32_t q[4], int32_t up[3])
{
    up[0] = hk_product(q[1], q[3]) - hk_product(q[0], q[2]);
    up[1] = hk_product(q[2], q[3]) + hk_product(q[0], q[1]);
    up[2] = HK_ONE_27 - hk_product(q[1], q[1]) - hk_product(q[2], q[2]);
}

/* Advance up by what the sensor turns within the lead. */
static void hk_lead_up(int32_t up[3], const int32_t turn[3])
{
    const int32_t a = hk_clamped(hk_product(turn[0], HK_LEAD), HK_LEAD_LIMIT); /* rad, 25 */
    const int32_t b = hk_clamped(hk_product(turn[1], HK_LEAD), HK_LEAD_LIMIT);
    const int32_t c = hk_clamped(hk_product(turn[2], HK_LEAD), HK_LEAD_LIMIT);
    const int32_t x = HK_LEFT(up[0], 3);
    const int32_t y = HK_LEFT(up[1], 3);
    const int32_t z = HK_LEFT(up[2], 3);

    up[0] += HK_LEFT(hk_product(y, c) - hk_product(z, b), 4);
    up[1] += HK_LEFT(hk_product(z, a) - hk_product(x, c), 4);
    up[2] += HK_LEFT(hk_product(x, b) - hk_product(y, a), 4);
}

bool hk_filter_update(hk_filter_t *filter, const int16_t accel_count[3],
                      const int16_t gyro_count[3])
{
    const bool load = filter->primed == 0U;
    int32_t force[3];
    int32_t turn[3] = {0, 0, 0};
    int32_t up[3];
    hk_length_t length;
    bool at_rest;

    hk_force(accel_count, force);
    if (load) {
        hk_load(filter, force, accel_count, gyro_count);
    } else {
        at_rest = hk_rests(filter, accel_count, gyro_count);
        if (at_rest && filter->rested == 0U) {
            hk_first_rest(filter);
        }
        hk_look_for_clipping(filter, gyro_count);
        hk_turn(filter, gyro_count, turn);
        hk_step(filter, force, turn, at_rest);
    }
    hk_find_up(filter->quaternion, up);
    hk_lead_up(up, turn);
    filter->angle[HK_ROLL] = hk_atan2_word(HK_BODY_Y(up), HK_BODY_Z(up), &length);
    filter->angle[HK_PITCH] = hk_atan2_word_length(-HK_BODY_X(up), &length);
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

/* Copy some words; return where the next ones go. */
static int32_t *hk_tell(int32_t *to, const int32_t *from, uint8_t words)
{
    (void)memcpy(to, from, words * sizeof *to);
    return to + words;
}

void hk_filter_state(const hk_filter_t *filter, int32_t words[HK_FILTER_STATE_WORDS])
{
    words = hk_tell(words, filter->quaternion, 4U);
    words = hk_tell(words, filter->velocity, 2U);
    words = hk_tell(words, filter->bias, 3U);
    words = hk_tell(words, filter->gyro_mean, 3U);
    words = hk_tell(words, filter->accel_mean, 3U);
    words[0] = filter->start_gain;
    words[1] = filter->still;
    words[2] = filter->rested;
}
