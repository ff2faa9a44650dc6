/* What filters of the attitude share: a unit quaternion that leads from earth to body axes. */
#ifndef QUATERNION_H
#define QUATERNION_H

#include <math.h>
#include <stdint.h>

#include "hk_filter.h"

static inline void scale_to_one(float *v, uint8_t size)
{
    float square = 0.0f;
    float factor;
    uint8_t i;

    for (i = 0U; i < size; i++) {
        square += v[i] * v[i];
    }
    factor = 1.0f / sqrtf(square);
    for (i = 0U; i < size; i++) {
        v[i] *= factor;
    }
}

/* q + period / 2 * q (0, w), not of length one. */
static inline void turn(float q[4], const float w[3], float period_s)
{
    const float half = 0.5f * period_s;
    const float a = q[0];
    const float b = q[1];
    const float c = q[2];
    const float d = q[3];

    q[0] = a + half * (-b * w[0] - c * w[1] - d * w[2]);
    q[1] = b + half * (a * w[0] + c * w[2] - d * w[1]);
    q[2] = c + half * (a * w[1] - b * w[2] + d * w[0]);
    q[3] = d + half * (a * w[2] + b * w[1] - c * w[0]);
}

/* Upwards in body axes. */
static inline void up(const float q[4], float v[3])
{
    v[0] = 2.0f * (q[1] * q[3] - q[0] * q[2]);
    v[1] = 2.0f * (q[0] * q[1] + q[2] * q[3]);
    v[2] = 2.0f * (0.5f - q[1] * q[1] - q[2] * q[2]);
}

static inline float angle_of(const float q[4], uint8_t axis)
{
    float v[3];

    up(q, v);
    return axis == HK_ROLL ? atan2f(v[1], v[2])
                           : atan2f(-v[0], sqrtf(v[1] * v[1] + v[2] * v[2]));
}

#endif
