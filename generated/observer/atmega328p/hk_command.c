/* Commands: see the header. What is not known is answered too, for a sender repeats what is not. */
#include "hk_command.h"

#include <string.h>

#include "hk_flash.h"
#include "hk_hal.h"
#include "hk_settings.h"

/* Time for the answer to leave, and for a save that is under way. */
#define HK_REBOOT_US       UINT32_C(100000)
#define HK_REBOOT_LIMIT_US UINT32_C(3000000)
#define HK_TEST_LIMIT_US   (UINT32_C(5000000) + 300U * HK_PERIOD_US)

#define HK_INTERVAL_MAX_US  1e9f
#define HK_HEARTBEAT_MAX_US 2e6f

static void acknowledge(hk_app_t *app, uint16_t command, uint8_t result,
                        const hk_late_answer_t *asker)
{
    mavlink_command_ack_t message = {0};

    message.command = command;
    message.result = result;
    message.target_system = asker->system_id;
    message.target_component = asker->component_id;
    (void)HK_SEND(&app->link, COMMAND_ACK, &message);
}

/* Begin a command that takes its time. */
static uint8_t begin_late(hk_app_t *app, hk_late_t which)
{
    hk_late_answer_t *late = &app->late[which];

    late->system_id = app->receiver.system_id;
    late->component_id = app->receiver.component_id;
    late->result = MAV_RESULT_IN_PROGRESS;
    late->waited_for = true;
    return MAV_RESULT_IN_PROGRESS;
}

void hk_command_end(hk_app_t *app, hk_late_t which, uint8_t result)
{
    app->late[which].result = result;
}

/* --- The commands --------------------------------------------------------------------------- */

/* The number that a parameter of a command holds, or 0xFFFF, which is no message. */
static uint16_t message_id(float parameter)
{
    return parameter >= 0.0f && parameter < 65535.0f ? (uint16_t)parameter : UINT16_MAX;
}

static uint8_t set_interval(hk_app_t *app, float id, float interval_us)
{
    const uint8_t which = hk_stream_of(message_id(id));
    uint32_t wanted_us = 0U;

    if (which == HK_NO_STREAM) {
        return MAV_RESULT_UNSUPPORTED;
    }
    if (!(interval_us >= -1.0f && interval_us <= HK_INTERVAL_MAX_US)
        || (which == HK_STREAM_HEARTBEAT
            && (interval_us < 0.0f || interval_us > HK_HEARTBEAT_MAX_US))) {
        return MAV_RESULT_DENIED;
    }
    if (interval_us >= 0.0f) {
        wanted_us = interval_us < 1.0f ? hk_stream_default_us(which) : (uint32_t)interval_us;
    }
    return hk_stream_set(&app->stream, which, wanted_us, (uint32_t)app->now_us)
               ? MAV_RESULT_ACCEPTED
               : MAV_RESULT_DENIED;
}

static uint8_t request(hk_app_t *app, float id)
{
    const uint16_t wanted = message_id(id);
    const uint8_t which = hk_stream_of(wanted);

    if (wanted == MAVLINK_MSG_ID_AUTOPILOT_VERSION) {
        app->version_wanted = true;
        return MAV_RESULT_ACCEPTED;
    }
    if (which == HK_NO_STREAM) {
        return MAV_RESULT_UNSUPPORTED;
    }
    if (which < HK_STREAM_TIMED && app->samples == 0U) {
        return MAV_RESULT_TEMPORARILY_REJECTED; /* there is no sample yet */
    }
    hk_stream_request(&app->stream, which);
    return MAV_RESULT_ACCEPTED;
}

static uint8_t calibrate(hk_app_t *app, const mavlink_command_long_t *command)
{
    const bool others = command->param2 != 0.0f || command->param3 != 0.0f
                        || command->param4 != 0.0f || command->param5 != 0.0f
                        || command->param6 != 0.0f || command->param7 != 0.0f;

    if (command->param1 != 1.0f || others) {
        return MAV_RESULT_UNSUPPORTED;
    }
    if (app->sensor_status != MAV_STATE_ACTIVE || app->calibration.running) {
        return MAV_RESULT_TEMPORARILY_REJECTED;
    }
    hk_calibration_start(&app->calibration, (uint32_t)app->now_us);
    return begin_late(app, HK_LATE_CALIBRATION);
}

static uint8_t store(hk_app_t *app, float what)
{
    if (what == 0.0f) {
        return hk_settings_restore(app) ? MAV_RESULT_ACCEPTED : MAV_RESULT_FAILED;
    }
    if (what == 1.0f) {
        if (hk_store_saving(&app->store)) {
            return MAV_RESULT_TEMPORARILY_REJECTED;
        }
        hk_settings_save(app);
        return begin_late(app, HK_LATE_STORAGE);
    }
    if (what == 2.0f) {
        hk_settings_reset(app);
        return MAV_RESULT_ACCEPTED;
    }
    return MAV_RESULT_DENIED;
}

static uint8_t reboot(hk_app_t *app, float what)
{
    if (what != 1.0f) {
        return MAV_RESULT_UNSUPPORTED;
    }
    app->rebooting = true;
    app->reboot_us = (uint32_t)app->now_us;
    return MAV_RESULT_ACCEPTED;
}

static uint8_t test(hk_app_t *app)
{
    if (app->sensor_status != MAV_STATE_ACTIVE || app->calibration.running
        || app->late[HK_LATE_SELF_TEST].waited_for) {
        return MAV_RESULT_TEMPORARILY_REJECTED;
    }
    app->sensor.self_test = HK_SELF_TEST_NONE;
    app->test_us = (uint32_t)app->now_us;
    hk_mpu6050_request_self_test(&app->sensor);
    return begin_late(app, HK_LATE_SELF_TEST);
}

static uint8_t carry_out(hk_app_t *app, const mavlink_command_long_t *command)
{
    switch (command->command) {
    case MAV_CMD_SET_MESSAGE_INTERVAL:
        return set_interval(app, command->param1, command->param2);
    case MAV_CMD_REQUEST_MESSAGE:
        return request(app, command->param1);
    case MAV_CMD_PREFLIGHT_CALIBRATION:
        return calibrate(app, command);
    case MAV_CMD_PREFLIGHT_STORAGE:
        return store(app, command->param1);
    case MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN:
        return reboot(app, command->param1);
    case MAV_CMD_USER_1:
        return test(app);
    default:
        return MAV_RESULT_UNSUPPORTED;
    }
}

void hk_command_take(hk_app_t *app)
{
    const hk_late_answer_t asker = {.system_id = app->receiver.system_id,
                                    .component_id = app->receiver.component_id};
    mavlink_command_long_t command;

    (void)memcpy(&command, app->receiver.payload, MAVLINK_MSG_ID_COMMAND_LONG_LEN);
    acknowledge(app, command.command, carry_out(app, &command), &asker);
}

/* --- Later ---------------------------------------------------------------------------------- */

static void answer_late(hk_app_t *app)
{
    static const uint16_t commands[HK_LATE_COMMANDS] HK_FLASH = {
        MAV_CMD_PREFLIGHT_CALIBRATION, MAV_CMD_PREFLIGHT_STORAGE, MAV_CMD_USER_1};
    uint8_t which;

    for (which = 0U; which < HK_LATE_COMMANDS; which++) {
        hk_late_answer_t *late = &app->late[which];

        if (late->waited_for && late->result != MAV_RESULT_IN_PROGRESS
            && hk_link_has_room(MAVLINK_MSG_ID_COMMAND_ACK_LEN)) {
            late->waited_for = false;
            acknowledge(app, hk_flash_u16(&commands[which]), late->result, late);
        }
    }
}

/* A sensor that fails in the middle of its test ends it without a result. */
static void end_test_in_time(hk_app_t *app)
{
    const hk_late_answer_t *late = &app->late[HK_LATE_SELF_TEST];

    if (late->waited_for && late->result == MAV_RESULT_IN_PROGRESS
        && (uint32_t)app->now_us - app->test_us >= HK_TEST_LIMIT_US) {
        hk_command_end(app, HK_LATE_SELF_TEST, MAV_RESULT_FAILED);
        hk_app_notice(app, HK_NOTICE_SELF_TEST);
    }
}

/* What has been set is saved before, unless that does not end. */
static void reboot_in_time(hk_app_t *app)
{
    const uint32_t waited_us = (uint32_t)app->now_us - app->reboot_us;

    if (app->unsaved && !hk_store_saving(&app->store)) {
        hk_settings_save(app);
    }
    if (waited_us >= HK_REBOOT_US
        && (!hk_store_saving(&app->store) || waited_us >= HK_REBOOT_LIMIT_US)) {
        app->rebooting = false;
        hk_hal_reboot();
    }
}

void hk_command_poll(hk_app_t *app)
{
    end_test_in_time(app);
    answer_late(app);
    if (app->rebooting) {
        reboot_in_time(app);
    }
}
