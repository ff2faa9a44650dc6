/* Arc tangent and arc sine in integers, the same steps as in VHDL and in the host's model. */
#ifndef HK_CORDIC_H
#define HK_CORDIC_H

#include <stdint.h>

/* Angle of the vector (x, y) in counts, half turns. Also gives its length times the CORDIC gain,
 * with guard bits. A zero vector gives 0 and 0. */
int32_t hk_atan2(int32_t y_count, int32_t x_count, int32_t *magnitude);

/* Angle of the vector whose x is a magnitude that hk_atan2 gave. */
int32_t hk_atan2_magnitude(int32_t y_count, int32_t magnitude);

/* Arc sine of y_count / one_count, clamped to +-90 deg. */
int32_t hk_arcsin(int32_t y_count, int32_t one_count);

#endif
