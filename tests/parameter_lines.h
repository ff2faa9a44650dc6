/* Answers lines about parameters: "which" behind a g, and "which bits" behind an s. Floats are told and
 * taken as their bits. */
#include <stdio.h>
#include <string.h>

#include "hk_filter.h"

static unsigned long bits_of(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(unsigned long number)
{
    const uint32_t bits = (uint32_t)number;
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static void set(hk_filter_t *filter)
{
    unsigned which;
    unsigned long bits;

    if (scanf("%u %lu", &which, &bits) == 2) {
        printf("%d\n", hk_filter_set(&filter->settings, (uint8_t)which, float_of(bits)) ? 1 : 0);
    }
}

static void get(const hk_filter_t *filter)
{
    unsigned which;

    if (scanf("%u", &which) == 1) {
        printf("%lu\n", bits_of(hk_filter_get(&filter->settings, (uint8_t)which)));
    }
}
