/* Settings: see the header.
 *
 * A changed value of the filter is in use from the first sample behind the PARAM_VALUE that tells
 * it. So all changes are told at once, when the last sample that was made before has left. */
#include "hk_settings.h"

#include <string.h>

#include "hk_command.h"
#include "hk_hal.h"
#include "hk_telemetry.h"

/* Memory wears out: it is written when nobody has changed anything for a while. */
#define HK_QUIET_US UINT32_C(3000000)
#define HK_LIST_US  UINT32_C(20000)

#define HK_VALUE_BYTES ((uint8_t)MAVLINK_MSG_ID_PARAM_VALUE_LEN)

#define HK_ALL_PARAMETERS ((uint8_t)((1U << HK_PARAMETERS) - 1U))
typedef char hk_parameters_fit_mask[HK_PARAMETERS <= 8U ? 1 : -1];
typedef char hk_changes_can_be_told_at_once
    [(HK_PARAMETERS - HK_OWN_PARAMETERS) * (HK_VALUE_BYTES + HK_FRAME_OVERHEAD) < 255U ? 1 : -1];

static void take_over(hk_app_t *app)
{
#ifdef HK_BIAS_LIMIT
    /* The filter follows the bias by itself, and takes a new one only to start from. */
    const bool restart = memcmp(app->filter.settings.bias, app->parameters.filter.bias,
                                sizeof app->parameters.filter.bias) != 0;
#endif

    app->filter.settings = app->parameters.filter;
#ifdef HK_BIAS_LIMIT
    if (restart) {
        hk_filter_init(&app->filter);
    }
#endif
    app->retuned = hk_parameters_retuned(&app->parameters);
}

#if HK_SIGNING
static void init_signing(hk_app_t *app)
{
    hk_signing_kept_t kept;

    hk_store_signing(&app->store, &kept);
    hk_store_keep(&app->store, &app->link.signing.kept);
    hk_signing_init(&app->link.signing, &kept, (uint32_t)app->now_us);
}

/* A secret is stored at once, and so is the bound of the timestamp, which changes rarely. */
static void keep_signing(hk_app_t *app)
{
    if (app->link.signing.unsaved && !hk_store_saving(&app->store)) {
        app->link.signing.unsaved = false;
        hk_settings_save(app);
    }
}
#endif

void hk_settings_init(hk_app_t *app)
{
    hk_parameters_init(&app->parameters);
    hk_store_init(&app->store);
    (void)hk_store_load(&app->store, &app->parameters);
#if HK_SIGNING
    init_signing(app);
#endif
    take_over(app);
    app->announce = 0U;
    app->list_place = HK_NO_PARAMETER;
    app->unsaved = false;
}

static void touch(hk_app_t *app)
{
    app->changed_us = (uint32_t)app->now_us;
    app->unsaved = true;
}

void hk_settings_tell(hk_app_t *app, uint8_t place)
{
    app->announce = (uint8_t)(app->announce | (1U << place));
}

void hk_settings_set(hk_app_t *app, uint8_t place, float value)
{
    if (hk_parameter_set(&app->parameters, place, value)) {
        touch(app);
    }
    hk_settings_tell(app, place);
}

void hk_settings_list(hk_app_t *app)
{
    app->list_place = 0U;
    app->listed_us = (uint32_t)app->now_us - HK_LIST_US;
}

bool hk_settings_restore(hk_app_t *app)
{
    if (!hk_store_valid(&app->store)) {
        return false;
    }
    hk_parameters_init(&app->parameters);
    app->announce = HK_ALL_PARAMETERS;
    app->unsaved = false;
    return hk_store_load(&app->store, &app->parameters);
}

void hk_settings_reset(hk_app_t *app)
{
    hk_parameters_init(&app->parameters);
    app->announce = HK_ALL_PARAMETERS;
    touch(app);
}

void hk_settings_save(hk_app_t *app)
{
    if (!hk_store_saving(&app->store)) {
        hk_store_save(&app->store, &app->parameters);
        app->unsaved = false;
    }
}

bool hk_settings_calibrate(hk_app_t *app, const float gyro_count[3])
{
    static const uint8_t which[HK_ANGLES] = {HK_FILTER_BIAS_ROLL, HK_FILTER_BIAS_PITCH};
    hk_parameters_t found = app->parameters;
    uint8_t axis;

    for (axis = 0U; axis < HK_ANGLES; axis++) {
        const uint8_t place = hk_parameter_of_filter(which[axis]);

        if (place == HK_NO_PARAMETER) {
            continue;
        }
        if (!hk_parameter_set(&found, place, hk_filter_rate_rad_s(axis, gyro_count))) {
            return false;
        }
        hk_settings_tell(app, place);
    }
    app->parameters = found;
    return true;
}

static bool is_announced(const hk_app_t *app, uint8_t place)
{
    return (app->announce & (1U << place)) != 0U;
}

/* Those that the filter does not use, one after the other. Returns whether all have been told. */
static bool announce_own(hk_app_t *app)
{
    uint8_t place;

    for (place = 0U; place < HK_OWN_PARAMETERS; place++) {
        if (is_announced(app, place)) {
            if (!hk_telemetry_parameter(app, place)) {
                return false;
            }
            app->announce = (uint8_t)(app->announce & ~(1U << place));
        }
    }
    return true;
}

/* Tell all that has changed of the filter at once, and put it to use. */
static void announce(hk_app_t *app)
{
    const bool sample_waits = (app->stream.due & (1U << HK_STREAM_TILT_SAMPLE)) != 0U;
    uint8_t needed = 0U;
    uint8_t place;

    for (place = HK_OWN_PARAMETERS; place < HK_PARAMETERS; place++) {
        if (is_announced(app, place)) {
            needed = (uint8_t)(needed + (HK_VALUE_BYTES + HK_FRAME_OVERHEAD));
        }
    }
    if (sample_waits || !hk_link_has_time(&app->link) || hk_hal_transmit_room() < needed) {
        return;
    }
    for (place = HK_OWN_PARAMETERS; place < HK_PARAMETERS; place++) {
        if (is_announced(app, place)) {
            (void)hk_telemetry_parameter(app, place);
        }
    }
    app->announce = 0U;
    take_over(app);
}

/* One value of the list now and then, and only where it leaves room for a sample. */
static void go_on_listing(hk_app_t *app)
{
    if (app->list_place >= HK_PARAMETERS) {
        app->list_place = HK_NO_PARAMETER;
    }
    if (app->list_place == HK_NO_PARAMETER
        || (uint32_t)app->now_us - app->listed_us < HK_LIST_US
        || !hk_link_has_room(HK_VALUE_BYTES + HK_FRAME_OVERHEAD
                             + MAVLINK_MSG_ID_TILT_SAMPLE_LEN)) {
        return;
    }
    (void)hk_telemetry_parameter(app, app->list_place);
    app->list_place++;
    app->listed_us = (uint32_t)app->now_us;
}

static void keep(hk_app_t *app)
{
#if HK_SIGNING
    keep_signing(app);
#endif
    switch (hk_store_poll(&app->store)) {
    case HK_STORE_SAVED:
        hk_command_end(app, HK_LATE_STORAGE, MAV_RESULT_ACCEPTED);
        break;
    case HK_STORE_FAILED:
        hk_command_end(app, HK_LATE_STORAGE, MAV_RESULT_FAILED);
        hk_app_notice(app, HK_NOTICE_STORE_FAILED);
        break;
    case HK_STORE_NOTHING:
        break;
    }
    if (app->unsaved && (uint32_t)app->now_us - app->changed_us >= HK_QUIET_US) {
        hk_settings_save(app);
    }
}

void hk_settings_poll(hk_app_t *app)
{
    if (app->announce != 0U) {
        if (announce_own(app) && app->announce != 0U) {
            announce(app);
        }
    } else {
        go_on_listing(app);
    }
    keep(app);
}
