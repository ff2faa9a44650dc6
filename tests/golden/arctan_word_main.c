/* Runs the arc tangent of words on numbers from standard input: y, x, z. Prints the angle of (x, y), its
 * length and turn, and the angle of (length, z). */
#include <stdio.h>

#include "hk_arctan.h"

int main(void)
{
    long y;
    long x;
    long z;

    while (scanf("%ld %ld %ld", &y, &x, &z) == 3) {
        hk_length_t length;
        const int32_t angle = hk_atan2_word((int32_t)y, (int32_t)x, &length);

        printf("%ld %lu %u ", (long)angle, (unsigned long)length.raw, (unsigned)length.turn);
        printf("%ld\n", (long)hk_atan2_word_length((int32_t)z, &length));
    }
    return 0;
}
