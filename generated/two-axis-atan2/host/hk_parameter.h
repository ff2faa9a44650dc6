/* The parameters that can be set over the link: names, limits, values.
 *
 * Values of the filter are changed here first and reach it only when all changes have been told, so
 * that nobody sees a sample that was made with a value he does not know of: see hk_app.c. */
#ifndef HK_PARAMETER_H
#define HK_PARAMETER_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_filter.h"

/* Those that are not the filter's come first. */
#define HK_OWN_PARAMETERS 2U
#define HK_ONE_MORE(name, which) +1U
#define HK_PARAMETERS     (HK_OWN_PARAMETERS HK_FILTER_NAMES(HK_ONE_MORE))
#define HK_NAME_BYTES 16U /* of a name; one of full length has no zero behind it */
#define HK_NO_PARAMETER 0xFFU

typedef struct {
    hk_filter_settings_t filter;
    uint8_t system_id; /* for the next start */
    uint8_t calibrate_at_start;
} hk_parameters_t;

/* One bit for each parameter. */
#if HK_PARAMETERS > 8U
typedef uint16_t hk_parameter_bits_t;
#else
typedef uint8_t hk_parameter_bits_t;
#endif

/* Set all to what the design says. */
void hk_parameters_init(hk_parameters_t *parameters);

/* Whether a value of the filter differs from the design's. */
bool hk_parameters_retuned(const hk_parameters_t *parameters);

/* The place of a name in the table, or HK_NO_PARAMETER; and the name at a place. */
uint8_t hk_parameter_find(const char name[HK_NAME_BYTES]);
void hk_parameter_name(uint8_t place, char name[HK_NAME_BYTES]);

/* The place of a value of the filter, or HK_NO_PARAMETER. */
uint8_t hk_parameter_of_filter(uint8_t which);

float hk_parameter_get(const hk_parameters_t *parameters, uint8_t place);

/* Returns false, and changes nothing, if the value is out of range. */
bool hk_parameter_set(hk_parameters_t *parameters, uint8_t place, float value);

#endif
