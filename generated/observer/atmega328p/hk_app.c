/* The application: see the header. */
#include "hk_app.h"

#include <string.h>

#include "hk_command.h"
#include "hk_design.h"
#include "hk_flash.h"
#include "hk_hal.h"
#include "hk_notice.h"
#include "hk_protocol.h"
#include "hk_settings.h"
#include "hk_telemetry.h"

#define HK_COUNT_LIMIT 32767

static void advance_clock(hk_app_t *app)
{
    app->now_us += (uint32_t)(hk_hal_time_us() - (uint32_t)app->now_us);
    if (app->load.paused) {
        app->load.asleep_us += (uint32_t)app->now_us - app->load.paused_us;
    }
}

/* The full time of an event shortly before or after now. */
static uint64_t full_time_us(const hk_app_t *app, uint32_t event_us)
{
    const uint32_t later_us = event_us - (uint32_t)app->now_us;

    return later_us <= INT32_MAX ? app->now_us + later_us : app->now_us - (0U - later_us);
}

void hk_app_notice(hk_app_t *app, hk_notice_t notice)
{
    app->notices = (uint8_t)(app->notices | (1U << notice));
}

/* The heartbeat tells a change at once. */
static void tell_status(hk_app_t *app)
{
    const bool calibrating = app->calibration.running && app->sensor_status == MAV_STATE_ACTIVE;
    const uint8_t status = calibrating || app->sensor.state == HK_MPU6050_TEST
                               ? MAV_STATE_CALIBRATING
                               : app->sensor_status;

    if (app->system_status != status) {
        app->system_status = status;
        hk_stream_request(&app->stream, HK_STREAM_HEARTBEAT);
    }
}

/* --- Calibration ---------------------------------------------------------------------------- */

static void end_calibration(hk_app_t *app, bool found)
{
    hk_command_end(app, HK_LATE_CALIBRATION, found ? MAV_RESULT_ACCEPTED : MAV_RESULT_FAILED);
    hk_app_notice(app, found ? HK_NOTICE_CALIBRATED : HK_NOTICE_MOVED);
}

/* What was asked for is stored; what every start finds anew is not. */
static void use_calibration(hk_app_t *app, const float gyro_count[3])
{
    const bool found = hk_settings_calibrate(app, gyro_count);

    if (found && app->late[HK_LATE_CALIBRATION].waited_for) {
        app->unsaved = true;
        app->changed_us = (uint32_t)app->now_us;
    }
    end_calibration(app, found);
}

static void calibrate_with(hk_app_t *app, const hk_mpu6050_sample_t *sample)
{
    float gyro_count[3];

    if (!app->start_calibrated) {
        app->start_calibrated = true;
        if (app->parameters.calibrate_at_start != 0U) {
            hk_calibration_start(&app->calibration, (uint32_t)app->now_us);
        }
    }
    if (sample->after_gap) {
        hk_calibration_drop(&app->calibration);
    }
    if (hk_calibration_take(&app->calibration, sample->accel, sample->gyro, gyro_count)
        == HK_CALIBRATION_DONE) {
        use_calibration(app, gyro_count);
    }
}

/* --- Self-test ------------------------------------------------------------------------------ */

static void end_self_test(hk_app_t *app)
{
    hk_command_end(app, HK_LATE_SELF_TEST,
                   app->sensor.self_test == HK_SELF_TEST_PASSED ? MAV_RESULT_ACCEPTED
                                                                : MAV_RESULT_FAILED);
    hk_app_notice(app, HK_NOTICE_SELF_TEST);
}

/* --- Samples -------------------------------------------------------------------------------- */

static bool saturated(const int16_t count[3])
{
    uint8_t axis;

    for (axis = 0U; axis < 3U; axis++) {
        if (count[axis] >= HK_COUNT_LIMIT || count[axis] <= -HK_COUNT_LIMIT) {
            return true;
        }
    }
    return false;
}

static uint8_t flags_of(const hk_app_t *app, const hk_mpu6050_sample_t *sample, bool restarted)
{
    uint8_t flags = app->retuned ? HOSTKIT_SAMPLE_RETUNED : 0U;

    if (restarted) {
        flags |= HOSTKIT_SAMPLE_RESTARTED;
    }
    if (saturated(sample->accel) || saturated(sample->gyro)) {
        flags |= HOSTKIT_SAMPLE_SATURATED;
    }
    return flags;
}

static void take_sample(hk_app_t *app)
{
    hk_latest_t *latest = &app->latest;
    const hk_mpu6050_sample_t *sample = &latest->sample;
    bool restarted;

    if (sample->after_gap) {
        hk_filter_init(&app->filter);
    }
    hk_hal_mark_begin();
    restarted = hk_filter_update(&app->filter, sample->accel, sample->gyro);
    hk_hal_mark_end();
#if HK_FILTER_STATE_WORDS
    hk_filter_state(&app->filter, latest->state);
#endif
    latest->time_us = full_time_us(app, sample->time_us);
    latest->sequence = app->samples++;
    latest->flags = flags_of(app, sample, restarted);
    hk_stream_sample(&app->stream);
    app->sensor_status = MAV_STATE_ACTIVE;
    calibrate_with(app, sample);
}

static void poll_sensor(hk_app_t *app)
{
    hk_mpu6050_sample_t sample;

    switch (hk_mpu6050_poll(&app->sensor, (uint32_t)app->now_us, &sample)) {
    case HK_MPU6050_STARTED:
        hk_filter_init(&app->filter);
        hk_calibration_drop(&app->calibration);
        break;
    case HK_MPU6050_SAMPLE:
        app->latest.sample = sample;
        take_sample(app);
        break;
    case HK_MPU6050_REFUSAL:
        app->sensor_status = MAV_STATE_CRITICAL;
        hk_app_notice(app, HK_NOTICE_REFUSED);
        break;
    case HK_MPU6050_SELF_TESTED:
        end_self_test(app);
        break;
    case HK_MPU6050_NOTHING:
        break;
    }
    if (app->sensor.state != HK_MPU6050_RUN && app->sensor_status == MAV_STATE_ACTIVE) {
        app->sensor_status = MAV_STATE_CRITICAL; /* until samples come again */
    }
}

/* --- The link ------------------------------------------------------------------------------- */

/* Send what is due, the most important first, as long as there is room. Returns whether it has
 * stopped only because a signature takes its time: the sensor is to be looked after before. */
static bool send_due(hk_app_t *app)
{
    uint8_t which;

    hk_stream_time(&app->stream, (uint32_t)app->now_us);
    for (which = hk_stream_next(&app->stream); which != HK_NO_STREAM;
         which = hk_stream_next(&app->stream)) {
#if HK_SIGNING
        if (app->link.signing.worked) {
            return true;
        }
#endif
        if (!hk_telemetry_stream(app, which)) {
            return false;
        }
        hk_stream_sent(&app->stream, which);
    }
    if (app->version_wanted && hk_telemetry_version(app)) {
        app->version_wanted = false;
    }
    return false;
}

/* --- The whole ------------------------------------------------------------------------------ */

void hk_app_init(hk_app_t *app)
{
    const hk_reset_cause_t cause = hk_hal_reset_cause();

    (void)memset(app, 0, sizeof *app);
    app->now_us = hk_hal_time_us();
    app->load.since_us = (uint32_t)app->now_us;
    app->sensor_status = MAV_STATE_BOOT;
    app->system_status = MAV_STATE_BOOT;
    hk_settings_init(app);
    hk_mpu6050_init(&app->sensor, (uint32_t)app->now_us);
    hk_filter_init(&app->filter);
    hk_link_init(&app->link, app->parameters.system_id);
    hk_stream_init(&app->stream, (uint32_t)app->now_us);
    hk_receiver_init(&app->receiver);
    hk_calibration_init(&app->calibration);
    if (cause == HK_RESET_WATCHDOG || cause == HK_RESET_BROWN_OUT) {
        hk_app_notice(app, HK_NOTICE_RESET);
    }
}

bool hk_app_poll(hk_app_t *app)
{
    bool more;

    advance_clock(app);
    hk_hal_watchdog_feed();
#if HK_SIGNING
    hk_signing_turn(&app->link.signing);
#endif
    more = hk_protocol_poll(app);
    hk_settings_poll(app);
    poll_sensor(app);
    if (hk_calibration_poll(&app->calibration, (uint32_t)app->now_us) == HK_CALIBRATION_MOVED) {
        end_calibration(app, false);
    }
    tell_status(app);
    more = send_due(app) || more;
    hk_notice_poll(app);
    hk_command_poll(app);
    app->load.paused = hk_mpu6050_waiting(&app->sensor) && !more;
    app->load.paused_us = hk_hal_time_us();
    return app->load.paused;
}
