/* Packs what the application says into messages and queues them. */
#ifndef HK_TELEMETRY_H
#define HK_TELEMETRY_H

#include "hk_app.h"

/* Each returns false if the link had no room; nothing is queued then. */

/* One message of a stream. */
bool hk_telemetry_stream(hk_app_t *app, uint8_t which);

bool hk_telemetry_version(hk_app_t *app);

/* The value of one parameter. */
bool hk_telemetry_parameter(hk_app_t *app, uint8_t place);

#endif
