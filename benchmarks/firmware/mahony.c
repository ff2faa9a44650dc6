/* R. Mahony, T. Hamel, J.-M. Pflimlin, "Nonlinear complementary filters on the special orthogonal
 * group", IEEE Trans. Automatic Control 53(5), 2008: the explicit filter with bias, equation 32, of
 * one direction, in quaternions as its equation 45. */
#include "hk_design.h"

#include "peer.h"
#include "quaternion.h"

#define PROPORTIONAL 1.0f
#define INTEGRAL     0.05f

static float q[4];
static float bias[3];

void peer_init(void)
{
    uint8_t i;

    for (i = 0U; i < 3U; i++) {
        q[i + 1U] = 0.0f;
        bias[i] = 0.0f;
    }
    q[0] = 1.0f;
}

void peer_update(const float force[3], const float rate_rad_s[3])
{
    float a[3] = {force[0], force[1], force[2]};
    float v[3];
    float e[3];
    float w[3];
    uint8_t i;

    scale_to_one(a, 3U);
    up(q, v);
    e[0] = a[1] * v[2] - a[2] * v[1];
    e[1] = a[2] * v[0] - a[0] * v[2];
    e[2] = a[0] * v[1] - a[1] * v[0];
    for (i = 0U; i < 3U; i++) {
        w[i] = rate_rad_s[i] - bias[i] + PROPORTIONAL * e[i];
        bias[i] -= INTEGRAL * PEER_PERIOD_S * e[i];
    }
    turn(q, w, PEER_PERIOD_S);
    scale_to_one(q, 4U);
}

float peer_angle_rad(uint8_t axis)
{
    return angle_of(q, axis);
}
