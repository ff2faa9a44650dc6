/* Answers lines of standard input: "g which" a parameter; "s which bits" whether it was taken;
 * "w" the words of the settings; "d" the defaults again; "r axis x y z" a rate; "i" a reset;
 * six counts after "u" an update. Floats are told and taken as their bits. */
#include <stdio.h>

#include "hk_filter.h"

#include "../parameter_lines.h"

static void rate(void)
{
    unsigned axis;
    float count[3];

    if (scanf("%u %f %f %f", &axis, &count[0], &count[1], &count[2]) == 4) {
        printf("%lu\n", bits_of(hk_filter_rate_rad_s((uint8_t)axis, count)));
    }
}

static void tell_words(const hk_filter_settings_t *settings)
{
    printf("%ld %u ", (long)settings->blend.raw, (unsigned)settings->blend.frac);
    printf("%ld %ld ", (long)settings->bias[HK_ROLL], (long)settings->bias[HK_PITCH]);
    printf("%ld %ld\n", (long)settings->tilt_offset[HK_ROLL],
           (long)settings->tilt_offset[HK_PITCH]);
}

static void update(hk_filter_t *filter)
{
    int16_t accel[3];
    int16_t gyro[3];

    if (scanf("%hd %hd %hd %hd %hd %hd", &accel[0], &accel[1], &accel[2], &gyro[0], &gyro[1],
              &gyro[2]) == 6) {
        int32_t angle[HK_ANGLES];
        (void)hk_filter_update(filter, accel, gyro);
        hk_filter_angles(filter, angle);
        printf("%ld %ld %lu\n", (long)angle[HK_ROLL], (long)angle[HK_PITCH],
               bits_of(hk_filter_angle_rad(filter, HK_PITCH)));
    }
}

int main(void)
{
    hk_filter_t filter;
    char what;

    hk_filter_defaults(&filter.settings);
    hk_filter_init(&filter);
    while (scanf(" %c", &what) == 1) {
        if (what == 'g') {
            get(&filter);
        } else if (what == 's') {
            set(&filter);
        } else if (what == 'w') {
            tell_words(&filter.settings);
        } else if (what == 'd') {
            hk_filter_defaults(&filter.settings);
        } else if (what == 'r') {
            rate();
        } else if (what == 'i') {
            hk_filter_init(&filter);
        } else {
            update(&filter);
        }
    }
    return 0;
}
