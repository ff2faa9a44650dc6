/* The application: see the header. */
#include "hk_app.h"

#include "hk_design.h"
#include "hk_flash.h"
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

/* --- Texts ---------------------------------------------------------------------------------- */

typedef struct {
    char text[MAVLINK_MSG_STATUSTEXT_FIELD_TEXT_LEN + 1];
    uint8_t length;
} hk_line_t;

static void put_character(hk_line_t *line, char character)
{
    if (line->length < sizeof line->text - 1U) {
        line->text[line->length++] = character;
        line->text[line->length] = '\0';
    }
}

static void put(hk_line_t *line, const char *text)
{
    for (; *text != '\0'; text++) {
        put_character(line, *text);
    }
}

static void put_flash(hk_line_t *line, const char *text)
{
    char character = (char)hk_flash_u8(text);

    for (; character != '\0'; character = (char)hk_flash_u8(text)) {
        put_character(line, character);
        text++;
    }
}

static void put_hex(hk_line_t *line, uint8_t value)
{
    put(line, "0x");
    put_character(line, HK_HEX_DIGITS[value >> 4]);
    put_character(line, HK_HEX_DIGITS[value & 0x0FU]);
}

static void put_number(hk_line_t *line, uint16_t value)
{
    uint16_t unit = 10000U;

    while (unit > 1U && value < unit) {
        unit /= 10U;
    }
    for (; unit > 0U; unit /= 10U) {
        put_character(line, HK_HEX_DIGITS[value / unit % 10U]);
    }
}

/* What stands in a text for each kind of event; no failed transfer is told by itself. */
static const char *what_happened(hk_mpu6050_kind_t kind)
{
    switch (kind) {
    case HK_MPU6050_TORN:
        return "torn burst";
    case HK_MPU6050_DEAD_BUS:
        return "bus failed, restart";
    case HK_MPU6050_REGISTER:
        return "restart, register ";
    case HK_MPU6050_SELF_RESET:
        return "had reset itself, restart";
    case HK_MPU6050_LOST_READY:
        return "INT lost, polling";
    case HK_MPU6050_SILENT:
        return "silent, restart";
    case HK_MPU6050_FROZEN:
        return "frozen, restart";
    case HK_MPU6050_VARIANT:
        return "WHO_AM_I ";
    case HK_MPU6050_OVERFLOW:
        return "FIFO overflow";
    case HK_MPU6050_MISALIGNED:
        return "FIFO misaligned";
    case HK_MPU6050_TRANSFER:
    case HK_MPU6050_KINDS:
        break;
    }
    return "";
}

static bool is_grave(hk_mpu6050_kind_t kind)
{
    return kind != HK_MPU6050_TORN && kind != HK_MPU6050_LOST_READY && kind != HK_MPU6050_VARIANT
           && kind != HK_MPU6050_OVERFLOW && kind != HK_MPU6050_MISALIGNED;
}

/* One line: what happened, what was found, and how often so far. */
static bool tell(hk_app_t *app, hk_mpu6050_kind_t kind)
{
    const hk_mpu6050_t *sensor = &app->sensor;
    hk_line_t line = {.length = 0U};

    put(&line, "MPU-6050: ");
    put(&line, what_happened(kind));
    if (kind == HK_MPU6050_VARIANT) {
        put_hex(&line, sensor->who_am_i);
        put(&line, " taken for ");
        put_flash(&line, hk_mpu6050_part(sensor->who_am_i));
    } else {
        if (kind == HK_MPU6050_REGISTER) {
            put_hex(&line, sensor->bad_register);
            put(&line, " was ");
            put_hex(&line, sensor->bad_value);
        }
        put(&line, " #");
        put_number(&line, sensor->count[kind]);
    }
    return hk_telemetry_text(&app->telemetry,
                             is_grave(kind) ? MAV_SEVERITY_ERROR : MAV_SEVERITY_WARNING, line.text);
}

/* Tell one event that has not been told; one that does not fit the queue is told later. */
static void tell_next(hk_app_t *app)
{
    uint8_t kind;

    for (kind = 0U; kind < HK_MPU6050_KINDS; kind++) {
        const uint16_t bit = (uint16_t)(1U << kind);

        if ((app->sensor.untold & bit) != 0U) {
            if (tell(app, (hk_mpu6050_kind_t)kind)) {
                app->sensor.untold &= (uint16_t)~bit;
            }
            return;
        }
    }
}

static void refuse(hk_app_t *app)
{
    hk_line_t line = {.length = 0U};

    set_status(app, MAV_STATE_CRITICAL);
    if (hk_mpu6050_bus_fault(&app->sensor)) {
        (void)hk_telemetry_text(&app->telemetry, MAV_SEVERITY_CRITICAL,
                                "MPU-6050 does not answer: I2C bus fault");
        return;
    }
    put(&line, "MPU-6050 refused: WHO_AM_I is ");
    put_hex(&line, app->sensor.who_am_i);
    (void)hk_telemetry_text(&app->telemetry, MAV_SEVERITY_CRITICAL, line.text);
}

/* --- Samples -------------------------------------------------------------------------------- */

static void take_sample(hk_app_t *app, const hk_mpu6050_sample_t *sample)
{
    hk_sample_facts_t facts;

    if (sample->after_gap) {
        hk_filter_init(&app->filter);
    }
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
    case HK_MPU6050_SELF_TESTED:
    case HK_MPU6050_NOTHING:
        break;
    }
    if (app->sensor.state != HK_MPU6050_RUN && app->system_status == MAV_STATE_ACTIVE) {
        set_status(app, MAV_STATE_CRITICAL); /* until samples come again */
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
    tell_next(app);
    send_heartbeat(app);
    return hk_mpu6050_waiting(&app->sensor);
}
