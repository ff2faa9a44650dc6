/* Scales numbers from standard input: "c" or "a", value, raw, frac. */
#include <stdio.h>

#include "hk_fixed.h"

int main(void)
{
    char kind;
    long value;
    long raw;
    unsigned frac;

    while (scanf(" %c %ld %ld %u", &kind, &value, &raw, &frac) == 4) {
        const int32_t scaled = kind == 'c' ? hk_scale_count((int32_t)value, (int32_t)raw, frac)
                                           : hk_scale_angle((int32_t)value, (int32_t)raw, frac);

        printf("%ld\n", (long)scaled);
    }
    return 0;
}
