/* Parameters: see the header. */
#include "hk_parameter.h"

#include <string.h>

#include "hk_flash.h"

/* A row of the table below. */
#define HK_ROW(name, which) {#name, which},

#define HK_SYSTEM_ID_MAX       254 /* 255 is the ground station's */
#define HK_SYSTEM_ID_FORBIDDEN 250 /* where MAVProxy's modules are */

/* What is no value of the filter. */
enum { OWN_SYSTEM_ID = HK_FILTER_PARAMETERS, OWN_CALIBRATE_AT_START };

typedef struct {
    char name[HK_NAME_BYTES];
    uint8_t which; /* a number of the filter's or of those above */
} hk_row_t;

/* In the order of their numbers on the link and in the store. */
static const hk_row_t rows[HK_PARAMETERS] HK_FLASH = {
    {"SYS_ID", OWN_SYSTEM_ID},
    {"CAL_START", OWN_CALIBRATE_AT_START},
    HK_FILTER_NAMES(HK_ROW)
};

static uint8_t which_at(uint8_t place)
{
    return hk_flash_u8(&rows[place].which);
}

void hk_parameters_init(hk_parameters_t *parameters)
{
    hk_filter_defaults(&parameters->filter);
    parameters->system_id = HK_DEFAULT_SYSTEM_ID;
    parameters->calibrate_at_start = HK_CALIBRATE_AT_START;
}

bool hk_parameters_retuned(const hk_parameters_t *parameters)
{
    hk_filter_settings_t design;
    uint8_t which;

    hk_filter_defaults(&design);
    for (which = 0U; which < HK_FILTER_PARAMETERS; which++) {
        const float wanted = hk_filter_get(&design, which);
        const float used = hk_filter_get(&parameters->filter, which);

        if (used < wanted || used > wanted) {
            return true;
        }
    }
    return false;
}

uint8_t hk_parameter_find(const char name[HK_NAME_BYTES])
{
    char row[HK_NAME_BYTES];
    uint8_t place;

    for (place = 0U; place < HK_PARAMETERS; place++) {
        hk_parameter_name(place, row);
        if (strncmp(row, name, HK_NAME_BYTES) == 0) {
            return place;
        }
    }
    return HK_NO_PARAMETER;
}

void hk_parameter_name(uint8_t place, char name[HK_NAME_BYTES])
{
    uint8_t i;

    for (i = 0U; i < HK_NAME_BYTES; i++) {
        name[i] = (char)hk_flash_u8(&rows[place].name[i]);
    }
}

uint8_t hk_parameter_of_filter(uint8_t which)
{
    uint8_t place;

    for (place = 0U; place < HK_PARAMETERS; place++) {
        if (which_at(place) == which) {
            return place;
        }
    }
    return HK_NO_PARAMETER;
}

float hk_parameter_get(const hk_parameters_t *parameters, uint8_t place)
{
    const uint8_t which = which_at(place);

    if (which == OWN_SYSTEM_ID) {
        return (float)parameters->system_id;
    }
    if (which == OWN_CALIBRATE_AT_START) {
        return (float)parameters->calibrate_at_start;
    }
    return hk_filter_get(&parameters->filter, which);
}

/* A whole number of that range, or -1. */
static int16_t whole(float value, float lowest, float highest)
{
    int16_t number;

    if (!(value >= lowest && value <= highest)) {
        return -1;
    }
    number = (int16_t)value;
    return (float)number < value ? -1 : number;
}

bool hk_parameter_set(hk_parameters_t *parameters, uint8_t place, float value)
{
    const uint8_t which = which_at(place);
    int16_t number;

    if (which < HK_FILTER_PARAMETERS) {
        return hk_filter_set(&parameters->filter, which, value);
    }
    number = whole(value, which == OWN_SYSTEM_ID ? 1.0f : 0.0f,
                   which == OWN_SYSTEM_ID ? (float)HK_SYSTEM_ID_MAX : 1.0f);
    if (number < 0 || number == HK_SYSTEM_ID_FORBIDDEN) {
        return false;
    }
    if (which == OWN_SYSTEM_ID) {
        parameters->system_id = (uint8_t)number;
    } else {
        parameters->calibrate_at_start = (uint8_t)number;
    }
    return true;
}
