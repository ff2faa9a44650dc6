/* The application: sensor, filter and telemetry, with all their state in one struct. */
#ifndef HK_APP_H
#define HK_APP_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_filter.h"
#include "hk_mpu6050.h"
#include "hk_telemetry.h"

typedef struct {
    hk_mpu6050_t sensor;
    hk_filter_t filter;
    hk_telemetry_t telemetry;
    uint64_t now_us;        /* the clock of the board, extended beyond its wrap */
    uint64_t heartbeat_us;  /* when the next heartbeat is due */
    uint32_t sequence;      /* samples since start */
    uint8_t to_attitude;    /* samples until the next ATTITUDE */
    uint8_t system_status;  /* MAV_STATE of the heartbeat */
} hk_app_t;

void hk_app_init(hk_app_t *app);

/* Take one step. Returns true if there is nothing to do before an interrupt comes. */
bool hk_app_poll(hk_app_t *app);

#endif
