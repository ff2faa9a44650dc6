/* One attitude filter as published, in floats: what the benchmark runs in place of ours. */
#ifndef PEER_H
#define PEER_H

#include <stdint.h>

#define PEER_PERIOD_S ((float)HK_PERIOD_US * 1e-6f)

void peer_init(void);

/* One sample of body axes; the force in any unit. */
void peer_update(const float force[3], const float rate_rad_s[3]);

/* Roll or pitch as our filter has them. */
float peer_angle_rad(uint8_t axis);

#endif
