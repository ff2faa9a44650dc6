/* R. E. Kalman, "A new approach to linear filtering and prediction problems", J. Basic Eng. 82(1),
 * 1960: per axis the states angle and gyroscope bias, the tilt from specific force as measurement. */
#include "hk_design.h"
#include "hk_filter.h"

#include "peer.h"

#include <math.h>
#include <stdbool.h>

#define PI           0x1.921fb6p+1f
#define ANGLE_NOISE  1e-3f /* rad^2/s */
#define BIAS_NOISE   3e-3f /* (rad/s)^2/s */
#define TILT_NOISE   3e-2f /* rad^2 */

typedef struct {
    float angle;
    float bias;
    float p00;
    float p01; /* the same as p10 */
    float p11;
} state_t;

static state_t states[HK_ANGLES];
static bool primed;

void peer_init(void)
{
    static const state_t start = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};

    states[HK_ROLL] = states[HK_PITCH] = start;
    primed = false;
}

static float wrapped(float angle)
{
    return angle >= PI ? angle - 2.0f * PI : (angle < -PI ? angle + 2.0f * PI : angle);
}

static void step(state_t *s, float rate_rad_s, float tilt)
{
    const float dt = PEER_PERIOD_S;
    float innovation;
    float gain;
    float bias_gain;
    float p01;

    s->angle = wrapped(s->angle + dt * (rate_rad_s - s->bias));
    s->p00 += dt * (dt * s->p11 - 2.0f * s->p01 + ANGLE_NOISE);
    s->p01 -= dt * s->p11;
    s->p11 += dt * BIAS_NOISE;

    gain = 1.0f / (s->p00 + TILT_NOISE);
    bias_gain = s->p01 * gain;
    gain *= s->p00;
    innovation = wrapped(tilt - s->angle);
    s->angle = wrapped(s->angle + gain * innovation);
    s->bias += bias_gain * innovation;
    p01 = s->p01;
    s->p00 -= gain * s->p00;
    s->p01 -= gain * p01;
    s->p11 -= bias_gain * p01;
}

void peer_update(const float force[3], const float rate_rad_s[3])
{
    const float roll = atan2f(force[1], force[2]);
    const float pitch = atan2f(-force[0], sqrtf(force[1] * force[1] + force[2] * force[2]));

    if (primed) {
        step(&states[HK_ROLL], rate_rad_s[0], roll);
        step(&states[HK_PITCH], rate_rad_s[1], pitch);
    } else {
        states[HK_ROLL].angle = roll;
        states[HK_PITCH].angle = pitch;
        primed = true;
    }
}

float peer_angle_rad(uint8_t axis)
{
    return states[axis].angle;
}
