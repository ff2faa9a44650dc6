/* Runs the arc tangent and the arc sine on numbers from standard input: y, x, z, one. Prints the
 * angle of (x, y), its length and turn, the angle of (length, z), and the arc sine of z / one. */
#include <stdio.h>

#include "hk_arctan.h"

int main(void)
{
    long y;
    long x;
    long z;
    long one;

    while (scanf("%ld %ld %ld %ld", &y, &x, &z, &one) == 4) {
        hk_length_t length;
        const int32_t alone = hk_atan2((int32_t)y, (int32_t)x, NULL);
        const int32_t angle = hk_atan2((int32_t)y, (int32_t)x, &length);

        printf("%ld %ld %lu %u ", (long)alone, (long)angle, (unsigned long)length.raw,
               (unsigned)length.turn);
        printf("%ld %ld\n", (long)hk_atan2_length((int32_t)z, &length),
               (long)hk_arcsin((int32_t)z, (int32_t)one));
    }
    return 0;
}
