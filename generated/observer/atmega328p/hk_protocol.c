/* Protocol: see the header. An answer must find room before its question is looked at; until then
 * the question waits, and what comes behind it waits in the board's queue. */
#include "hk_protocol.h"

#include <string.h>

#include "hk_command.h"
#include "hk_hal.h"
#include "hk_settings.h"

#define HK_BYTES_AT_ONCE 32U
#define HK_ANSWER_BYTES  32U /* the longest payload that is answered at once */

/* Message by message: a copy of what the receiver holds. */
#define HK_TAKE(app, NAME, message) \
    ((void)memcpy((message), (app)->receiver.payload, MAVLINK_MSG_ID_##NAME##_LEN))

/* Whether a message is for us; 0 is for all. */
static bool is_for_us(const hk_app_t *app, uint8_t system_id, uint8_t component_id)
{
    return (system_id == 0U || system_id == app->link.system_id)
           && (component_id == 0U || component_id == HK_COMPONENT_ID);
}

static void take_set(hk_app_t *app)
{
    mavlink_param_set_t message;
    uint8_t place;

    HK_TAKE(app, PARAM_SET, &message);
    if (!is_for_us(app, message.target_system, message.target_component)) {
        return;
    }
    place = hk_parameter_find(message.param_id);
    if (place != HK_NO_PARAMETER) {
        hk_settings_set(app, place, message.param_value);
    }
}

static void take_read(hk_app_t *app)
{
    mavlink_param_request_read_t message;
    uint8_t place = HK_NO_PARAMETER;

    HK_TAKE(app, PARAM_REQUEST_READ, &message);
    if (!is_for_us(app, message.target_system, message.target_component)) {
        return;
    }
    if (message.param_index == -1) {
        place = hk_parameter_find(message.param_id);
    } else if (message.param_index >= 0 && message.param_index < (int16_t)HK_PARAMETERS) {
        place = (uint8_t)message.param_index;
    }
    if (place != HK_NO_PARAMETER) {
        hk_settings_tell(app, place);
    }
}

static void take_list(hk_app_t *app)
{
    mavlink_param_request_list_t message;

    HK_TAKE(app, PARAM_REQUEST_LIST, &message);
    if (is_for_us(app, message.target_system, message.target_component)) {
        hk_settings_list(app);
    }
}

static void take_command(hk_app_t *app)
{
    mavlink_command_long_t message;

    HK_TAKE(app, COMMAND_LONG, &message);
    if (is_for_us(app, message.target_system, message.target_component)) {
        hk_command_take(app);
    }
}

/* A question has no time of the one who is to answer; the answer has both, in nanoseconds. */
static void take_timesync(hk_app_t *app)
{
    mavlink_timesync_t message;

    HK_TAKE(app, TIMESYNC, &message);
    if (message.tc1 == 0) {
        message.tc1 = (int64_t)(app->now_us * 1000U) + 1;
        (void)HK_SEND(&app->link, TIMESYNC, &message);
    }
}

/* A question is for nobody by name; the answer is for the one who asked. */
static void take_ping(hk_app_t *app)
{
    mavlink_ping_t message;

    HK_TAKE(app, PING, &message);
    if (message.target_system == 0U && message.target_component == 0U) {
        message.target_system = app->receiver.system_id;
        message.target_component = app->receiver.component_id;
        (void)HK_SEND(&app->link, PING, &message);
    }
}

#if HK_SIGNING
/* Whether a message may be looked at. One that may not is counted like one that was spoilt. */
static bool is_admitted(hk_app_t *app)
{
    const hk_signed_frame_t frame = {.header = app->receiver.header,
                                     .payload = app->receiver.payload,
                                     .tail = app->receiver.tail};

    if (!app->link.signing.active
        || (app->receiver.length <= HK_RECEIVE_BYTES
            && hk_signing_accepts(&app->link.signing, &frame, hk_hal_time_us()))) {
        return true;
    }
    app->receiver.errors++;
    return false;
}

static void take_secret(hk_app_t *app)
{
    mavlink_setup_signing_t message;

    HK_TAKE(app, SETUP_SIGNING, &message);
    if (is_for_us(app, message.target_system, message.target_component)) {
        hk_signing_set(&app->link.signing, message.secret_key, message.initial_timestamp);
    }
}
#endif

static void answer(hk_app_t *app)
{
    switch (app->receiver.id) {
#if HK_SIGNING
    case MAVLINK_MSG_ID_SETUP_SIGNING:
        take_secret(app);
        break;
#endif
    case MAVLINK_MSG_ID_PARAM_SET:
        take_set(app);
        break;
    case MAVLINK_MSG_ID_PARAM_REQUEST_READ:
        take_read(app);
        break;
    case MAVLINK_MSG_ID_PARAM_REQUEST_LIST:
        take_list(app);
        break;
    case MAVLINK_MSG_ID_COMMAND_LONG:
        take_command(app);
        break;
    case MAVLINK_MSG_ID_TIMESYNC:
        take_timesync(app);
        break;
    default:
        take_ping(app);
        break;
    }
}

bool hk_protocol_poll(hk_app_t *app)
{
    uint8_t left = HK_BYTES_AT_ONCE;
    uint8_t byte;

    while (!app->arrived && left > 0U && hk_hal_receive(&byte)) {
        app->arrived = hk_receiver_take(&app->receiver, byte);
        left--;
#if HK_SIGNING
        app->arrived = app->arrived && is_admitted(app);
#endif
    }
    if (app->arrived) {
        if (!hk_link_has_time(&app->link)) {
            return true;
        }
        if (!hk_link_has_room(HK_ANSWER_BYTES)) {
            return false; /* the link makes room by and by */
        }
        answer(app);
        app->arrived = false;
        return true;
    }
    return left == 0U;
}
