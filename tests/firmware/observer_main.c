/* Answers lines of standard input: six counts after "u" an update, which prints the angles, whether the
 * sample was loaded, and the words of the state; "g which" a parameter; "s which bits" whether it was
 * taken; "w" the words of the settings; "d" the defaults again; "i" a reset. Floats are told and taken
 * as their bits. */
#include <stdio.h>

#include "hk_filter.h"

#include "../parameter_lines.h"

static void update(hk_filter_t *filter)
{
    int16_t accel[3];
    int16_t gyro[3];

    if (scanf("%hd %hd %hd %hd %hd %hd", &accel[0], &accel[1], &accel[2], &gyro[0], &gyro[1],
              &gyro[2]) == 6) {
        const int loaded = hk_filter_update(filter, accel, gyro) ? 1 : 0;
        int32_t angle[HK_ANGLES];
        int32_t words[HK_FILTER_STATE_WORDS];
        int i;

        hk_filter_angles(filter, angle);
        hk_filter_state(filter, words);
        printf("%ld %ld %d", (long)angle[HK_ROLL], (long)angle[HK_PITCH], loaded);
        for (i = 0; i < HK_FILTER_STATE_WORDS; i++) {
            printf(" %ld", (long)words[i]);
        }
        printf("\n");
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
            const hk_filter_settings_t *own = &filter.settings;
            printf("%ld %ld %ld ", (long)own->gain[0], (long)own->gain[1], (long)own->gain[2]);
            printf("%ld %ld %ld\n", (long)own->bias[0], (long)own->bias[1], (long)own->bias[2]);
        } else if (what == 'd') {
            hk_filter_defaults(&filter.settings);
        } else if (what == 'i') {
            hk_filter_init(&filter);
        } else {
            update(&filter);
        }
    }
    return 0;
}
