/* Feeds counts from standard input (accel x y z gyro x y z, decimal) to a peer; prints roll and
 * pitch in half turns. */
#include <stdio.h>

#include "hk_filter.h"

int main(void)
{
    hk_filter_t filter;
    int16_t accel[3];
    int16_t gyro[3];

    hk_filter_init(&filter);
    while (scanf("%hd %hd %hd %hd %hd %hd", &accel[0], &accel[1], &accel[2], &gyro[0], &gyro[1],
                 &gyro[2]) == 6) {
        int32_t angle[HK_ANGLES];

        (void)hk_filter_update(&filter, accel, gyro);
        hk_filter_angles(&filter, angle);
        printf("%ld %ld\n", (long)angle[HK_ROLL], (long)angle[HK_PITCH]);
    }
    return 0;
}
