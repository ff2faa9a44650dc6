/* Feeds counts from standard input (accel x y z gyro x y z, decimal) to the rendered filter. */
#include <stdio.h>

#include "hk_filter.h"

int main(void)
{
    hk_filter_t filter;
    int16_t accel[3];
    int16_t gyro[3];

    hk_filter_defaults(&filter.settings);
    hk_filter_init(&filter);
    while (scanf("%hd %hd %hd %hd %hd %hd", &accel[0], &accel[1], &accel[2], &gyro[0], &gyro[1],
                 &gyro[2]) == 6) {
        const int restarted = hk_filter_update(&filter, accel, gyro) ? 1 : 0;
        const int32_t hidden[2] = HK_FILTER_HIDDEN(&filter);

        printf("%ld %ld %d ", (long)filter.angle[HK_ROLL], (long)filter.angle[HK_PITCH], restarted);
        printf("%ld %ld\n", (long)hidden[0], (long)hidden[1]);
    }
    return 0;
}
