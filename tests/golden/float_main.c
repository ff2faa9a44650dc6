/* Feeds counts from standard input (accel x y z gyro x y z, decimal) to the filter in floats; prints
 * the angles as their bits, in half turns, and the hidden words. */
#include <stdio.h>
#include <string.h>

#include "hk_filter.h"

static unsigned long bits_of(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

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
        int32_t angle[HK_ANGLES];

        hk_filter_angles(&filter, angle);
        printf("%lu %lu %ld %ld %d ", bits_of(hk_filter_angle_rad(&filter, HK_ROLL)),
               bits_of(hk_filter_angle_rad(&filter, HK_PITCH)), (long)angle[HK_ROLL],
               (long)angle[HK_PITCH], restarted);
        printf("%ld %ld\n", (long)hidden[0], (long)hidden[1]);
    }
    return 0;
}
