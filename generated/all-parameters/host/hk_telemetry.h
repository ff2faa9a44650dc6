/* Packs what the application says into MAVLink 2 frames and queues them. */
#ifndef HK_TELEMETRY_H
#define HK_TELEMETRY_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_filter.h"
#include "hk_mavlink.h"
#include "hk_mpu6050.h"

typedef struct {
    mavlink_status_t status; /* sequence number of the link */
} hk_telemetry_t;

typedef struct {
    uint64_t time_us;
    uint32_t sequence;
    uint16_t i2c_errors;
    bool restarted; /* the filter loaded the measured tilt */
} hk_sample_facts_t;

void hk_telemetry_init(hk_telemetry_t *telemetry);

/* Each returns false if the link had no room; the message is then dropped. */
bool hk_telemetry_heartbeat(hk_telemetry_t *telemetry, uint8_t system_status);
bool hk_telemetry_text(hk_telemetry_t *telemetry, uint8_t severity, const char *text);
bool hk_telemetry_attitude(hk_telemetry_t *telemetry, const hk_filter_t *filter,
                           const hk_mpu6050_sample_t *sample, uint64_t time_us);
bool hk_telemetry_sample(hk_telemetry_t *telemetry, const hk_filter_t *filter,
                         const hk_mpu6050_sample_t *sample, const hk_sample_facts_t *facts);

#endif
