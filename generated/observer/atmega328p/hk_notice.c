/* Texts: see the header. They stay in flash until they are sent. */
#include "hk_notice.h"

#include "hk_hal.h"
#include "hk_text.h"

static bool send(hk_app_t *app, const hk_line_t *line)
{
    return HK_SEND(&app->link, STATUSTEXT, &line->message);
}

/* --- Events of the sensor ------------------------------------------------------------------- */

/* What stands in a text for each kind of event; no failed transfer is told by itself. */
static const char *what_happened(hk_mpu6050_kind_t kind)
{
    switch (kind) {
    case HK_MPU6050_TORN:
        return HK_TEXT("torn burst");
    case HK_MPU6050_DEAD_BUS:
        return HK_TEXT("bus failed, restart");
    case HK_MPU6050_REGISTER:
        return HK_TEXT("restart, register ");
    case HK_MPU6050_SELF_RESET:
        return HK_TEXT("had reset itself, restart");
    case HK_MPU6050_LOST_READY:
        return HK_TEXT("INT lost, polling");
    case HK_MPU6050_SILENT:
        return HK_TEXT("silent, restart");
    case HK_MPU6050_FROZEN:
        return HK_TEXT("frozen, restart");
    case HK_MPU6050_VARIANT:
        return HK_TEXT("WHO_AM_I ");
    case HK_MPU6050_OVERFLOW:
        return HK_TEXT("FIFO overflow");
    case HK_MPU6050_MISALIGNED:
        return HK_TEXT("FIFO misaligned");
    case HK_MPU6050_TRANSFER:
    case HK_MPU6050_KINDS:
        break;
    }
    return HK_TEXT("");
}

static uint8_t severity_of(hk_mpu6050_kind_t kind)
{
    switch (kind) {
    case HK_MPU6050_TORN:
    case HK_MPU6050_LOST_READY:
    case HK_MPU6050_VARIANT:
    case HK_MPU6050_OVERFLOW:
    case HK_MPU6050_MISALIGNED:
        return MAV_SEVERITY_WARNING;
    default:
        return MAV_SEVERITY_ERROR;
    }
}

/* One line: what happened, what was found, and how often so far. */
static bool tell_event(hk_app_t *app, hk_mpu6050_kind_t kind)
{
    const hk_mpu6050_t *sensor = &app->sensor;
    hk_line_t line;

    hk_line_init(&line, severity_of(kind));
    hk_line_put(&line, HK_TEXT("MPU-6050: "));
    hk_line_put(&line, what_happened(kind));
    if (kind == HK_MPU6050_VARIANT) {
        hk_line_put_hex(&line, sensor->who_am_i);
        hk_line_put(&line, HK_TEXT(" taken for "));
        hk_line_put(&line, hk_mpu6050_part(sensor->who_am_i));
    } else {
        if (kind == HK_MPU6050_REGISTER) {
            hk_line_put_hex(&line, sensor->bad_register);
            hk_line_put(&line, HK_TEXT(" was "));
            hk_line_put_hex(&line, sensor->bad_value);
        }
        hk_line_put(&line, HK_TEXT(" #"));
        hk_line_put_number(&line, sensor->count[kind]);
    }
    return send(app, &line);
}

/* --- Events of the application -------------------------------------------------------------- */

static void put_refusal(hk_app_t *app, hk_line_t *line)
{
    if (hk_mpu6050_bus_fault(&app->sensor)) {
        hk_line_put(line, HK_TEXT("MPU-6050 does not answer: I2C bus fault"));
    } else {
        hk_line_put(line, HK_TEXT("MPU-6050 refused: WHO_AM_I is "));
        hk_line_put_hex(line, app->sensor.who_am_i);
    }
}

static const char *test_result(hk_self_test_result_t result)
{
    switch (result) {
    case HK_SELF_TEST_PASSED:
        return HK_TEXT("passed");
    case HK_SELF_TEST_FAILED:
        return HK_TEXT("failed");
    case HK_SELF_TEST_NO_TRIM:
        return HK_TEXT("has no factory figures");
    case HK_SELF_TEST_MOVED:
        return HK_TEXT("failed: it moves");
    case HK_SELF_TEST_VARIANT:
        return HK_TEXT("is not known of this part");
    case HK_SELF_TEST_NONE:
        break;
    }
    return HK_TEXT("broke off");
}

static uint8_t severity_of_notice(hk_notice_t notice)
{
    switch (notice) {
    case HK_NOTICE_REFUSED:
        return MAV_SEVERITY_CRITICAL;
    case HK_NOTICE_STORE_FAILED:
        return MAV_SEVERITY_ERROR;
    case HK_NOTICE_RESET:
    case HK_NOTICE_MOVED:
        return MAV_SEVERITY_WARNING;
    default:
        return MAV_SEVERITY_INFO;
    }
}

static bool tell_notice(hk_app_t *app, hk_notice_t notice)
{
    hk_line_t line;

    hk_line_init(&line, severity_of_notice(notice));
    switch (notice) {
    case HK_NOTICE_RESET:
        hk_line_put(&line, hk_hal_reset_cause() == HK_RESET_WATCHDOG
                               ? HK_TEXT("Restarted by the watchdog")
                               : HK_TEXT("Restarted after a brown-out"));
        break;
    case HK_NOTICE_REFUSED:
        put_refusal(app, &line);
        break;
    case HK_NOTICE_CALIBRATED:
        hk_line_put(&line, HK_TEXT("Gyroscope calibrated"));
        break;
    case HK_NOTICE_MOVED:
        hk_line_put(&line, HK_TEXT("Gyroscope not calibrated: it moves"));
        break;
    case HK_NOTICE_STORE_FAILED:
        hk_line_put(&line, HK_TEXT("Parameters cannot be stored"));
        break;
    case HK_NOTICE_SELF_TEST:
        hk_line_put(&line, HK_TEXT("Self-test "));
        hk_line_put(&line, test_result(app->sensor.self_test));
        break;
    default:
        break;
    }
    return send(app, &line);
}

/* --- In turn -------------------------------------------------------------------------------- */

void hk_notice_poll(hk_app_t *app)
{
    uint8_t i;

    for (i = 0U; i < HK_NOTICES; i++) {
        const uint8_t bit = (uint8_t)(1U << i);

        if ((app->notices & bit) != 0U) {
            if (tell_notice(app, (hk_notice_t)i)) {
                app->notices &= (uint8_t)~bit;
            }
            return;
        }
    }
    for (i = 0U; i < HK_MPU6050_KINDS; i++) {
        const uint16_t bit = (uint16_t)(1U << i);

        if ((app->sensor.untold & bit) != 0U) {
            if (tell_event(app, (hk_mpu6050_kind_t)i)) {
                app->sensor.untold &= (uint16_t)~bit;
            }
            return;
        }
    }
}
