/* Scales numbers from standard input: "c" (count), "a" (angle) or "s" (shift), value, raw, frac;
 * "p" (product of two words) or "g" (count and gain), value, raw, and a number that is left out. */
#include <stdio.h>

#include "hk_fixed.h"

int main(void)
{
    char kind;
    long value;
    long raw;
    unsigned frac;

    while (scanf(" %c %ld %ld %u", &kind, &value, &raw, &frac) == 4) {
        int32_t scaled;

        if (kind == 'c') {
            scaled = hk_scale_count((int32_t)value, (int32_t)raw, frac);
        } else if (kind == 'a') {
            scaled = hk_scale_angle((int32_t)value, (int32_t)raw, frac);
        } else if (kind == 'p') {
            scaled = hk_product((int32_t)value, (int32_t)raw);
        } else if (kind == 'g') {
            scaled = hk_scale((int32_t)raw, (int16_t)value);
        } else {
            scaled = hk_shift_rounded((int32_t)value, frac);
        }
        printf("%ld\n", (long)scaled);
    }
    return 0;
}
