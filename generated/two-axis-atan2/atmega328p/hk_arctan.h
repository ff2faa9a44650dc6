/* Arc tangent and arc sine in integers, the same digits as in VHDL and in the host's model. */
#ifndef HK_ARCTAN_H
#define HK_ARCTAN_H

#include <stdint.h>

/* A length with guard bits. It carries the factor sqrt(1 + (turn / 64)^2). */
typedef struct {
    uint32_t raw;
    uint8_t turn;
} hk_length_t;

/* Angle of the vector (x, y) in counts, half turns, and its length if `length` is not null. A zero
 * vector gives 0 and 0. */
int32_t hk_atan2(int32_t y_count, int32_t x_count, hk_length_t *length);

/* Angle of the vector whose x is a length that hk_atan2 gave. */
int32_t hk_atan2_length(int32_t y_count, const hk_length_t *length);

/* The same of words: components of 30 bits and a sign. A vector of two components below 2^13 counts
 * as zero. */
int32_t hk_atan2_word(int32_t y, int32_t x, hk_length_t *length);
int32_t hk_atan2_word_length(int32_t y, const hk_length_t *length);

/* Arc sine of y_count / one_count, clamped to +-90 deg. */
int32_t hk_arcsin(int32_t y_count, int32_t one_count);

#endif
