/* The application: see the header. */
#include "hk_app.h"

#include "hk_design.h"
#include "hk_hal.h"

#define HK_HEX_DIGITS "0123456789ABCDEF"

static void advance_clock(hk_app_t *app)
{
    app->now_us += (uint32_t)(hk_hal_time_us() - (uint32_t)app->now_us);
}

/* The full time of an event shortly before or after now. */
static uint64_t full_time_us(const hk_app_t *app, uint32_t event_us)
{
    const uint32_t later_us = event_us - (uint32_t)app->now_us;

    return later_us <= INT32_MAX ? app->now_us + later_us : app->now_us - (0U - later_us);
}

static void set_status(hk_app_t *app, uint8_t system_status)
{
    if (app->system_status != system_status) {
        app->system_status = system_status;
        app->heartbeat_us = app->now_us; /* a change is told at once */
    }
}

static void refuse(hk_app_t *app)
{
    const uint8_t identity = app->sensor.who_am_i;
    char text[] = "MPU-6050 refused: WHO_AM_I is 0x??";

    set_status(app, MAV_STATE_CRITICAL);
    if (hk_mpu6050_bus_fault(&app->sensor)) {
        (void)hk_telemetry_text(&app->telemetry, MAV_SEVERITY_CRITICAL,
                                "MPU-6050 does not answer: I2C bus fault");
        return;
    }
    text[sizeof text - 3U] = HK_HEX_DIGITS[identity >> 4];
    text[sizeof text - 2U] = HK_HEX_DIGITS[identity & 0x0FU];
    (void)hk_telemetry_text(&app->telemetry, MAV_SEVERITY_CRITICAL, text);
}

static void take_sample(hk_app_t *app, const hk_mpu6050_sample_t *sample)
{
    hk_sample_facts_t facts;

    hk_hal_mark_begin();
    facts.restarted = hk_filter_update(&app->filter, sample->accel, sample->gyro);
    hk_hal_mark_end();
    facts.time_us = full_time_us(app, sample->time_us);
    facts.sequence = app->sequence++;
    facts.i2c_errors = app->sensor.errors;
    (void)hk_telemetry_sample(&app->telemetry, &app->filter, sample, &facts);
    if (app->to_attitude == 0U) {
        app->to_attitude = HK_ATTITUDE_EVERY;
        (void)hk_telemetry_attitude(&app->telemetry, &app->filter, sample, facts.time_us);
    }
    app->to_attitude--;
    set_status(app, MAV_STATE_ACTIVE);
}

static void poll_sensor(hk_app_t *app)
{
    hk_mpu6050_sample_t sample;

    switch (hk_mpu6050_poll(&app->sensor, (uint32_t)app->now_us, &sample)) {
    case HK_MPU6050_STARTED:
        hk_filter_init(&app->filter);
        break;
    case HK_MPU6050_SAMPLE:
        take_sample(app, &sample);
        break;
    case HK_MPU6050_REFUSAL:
        refuse(app);
        break;
    case HK_MPU6050_NOTHING:
        break;
    }
}

static void send_heartbeat(hk_app_t *app)
{
    if (app->now_us >= app->heartbeat_us
        && hk_telemetry_heartbeat(&app->telemetry, app->system_status)) {
        app->heartbeat_us = app->now_us + HK_HEARTBEAT_US;
    }
}

void hk_app_init(hk_app_t *app)
{
    app->now_us = hk_hal_time_us();
    app->heartbeat_us = app->now_us;
    app->sequence = 0U;
    app->to_attitude = 0U;
    app->system_status = MAV_STATE_BOOT;
    hk_mpu6050_init(&app->sensor, (uint32_t)app->now_us);
    hk_filter_init(&app->filter);
    hk_telemetry_init(&app->telemetry);
}

bool hk_app_poll(hk_app_t *app)
{
    advance_clock(app);
    poll_sensor(app);
    send_heartbeat(app);
    return hk_mpu6050_waiting(&app->sensor);
}
