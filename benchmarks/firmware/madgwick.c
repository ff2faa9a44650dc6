/* S. O. H. Madgwick, "An efficient orientation filter for inertial and inertial/magnetic sensor
 * arrays", report, University of Bristol, 2010: the IMU filter, equations 11, 25, 26 and 42 to 44. */
#include "hk_design.h"

#include "peer.h"
#include "quaternion.h"

#define BETA 0.1f

static float q[4];

void peer_init(void)
{
    q[0] = 1.0f;
    q[1] = q[2] = q[3] = 0.0f;
}

/* J^T f, where f is the direction of gravity in body axes less the one that was measured. */
static void gradient(const float a[3], float g[4])
{
    float f[3];
    uint8_t i;

    up(q, f);
    for (i = 0U; i < 3U; i++) {
        f[i] -= a[i];
    }
    g[0] = 2.0f * (q[1] * f[1] - q[2] * f[0]);
    g[1] = 2.0f * (q[3] * f[0] + q[0] * f[1]) - 4.0f * q[1] * f[2];
    g[2] = 2.0f * (q[3] * f[1] - q[0] * f[0]) - 4.0f * q[2] * f[2];
    g[3] = 2.0f * (q[1] * f[0] + q[2] * f[1]);
}

void peer_update(const float force[3], const float rate_rad_s[3])
{
    float a[3] = {force[0], force[1], force[2]};
    float g[4];
    uint8_t i;

    scale_to_one(a, 3U);
    gradient(a, g);
    scale_to_one(g, 4U);
    turn(q, rate_rad_s, PEER_PERIOD_S);
    for (i = 0U; i < 4U; i++) {
        q[i] -= BETA * PEER_PERIOD_S * g[i];
    }
    scale_to_one(q, 4U);
}

float peer_angle_rad(uint8_t axis)
{
    return angle_of(q, axis);
}
