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
        int32_t angle[HK_ANGLES];
#if HK_FILTER_STATE_WORDS
        int32_t hidden[HK_FILTER_STATE_WORDS];

        hk_filter_state(&filter, hidden);
#else
        const int32_t hidden[2] = HK_FILTER_HIDDEN(&filter);
#endif
        hk_filter_angles(&filter, angle);
        printf("%ld %ld %d", (long)angle[HK_ROLL], (long)angle[HK_PITCH], restarted);
        for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++) {
            printf(" %ld", (long)hidden[i]);
        }
        printf("\n");
    }
    return 0;
}
