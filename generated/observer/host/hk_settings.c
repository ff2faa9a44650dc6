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

/* A PARAM_VALUE, and its frame. */
#define HK_VALUE_BYTES 25U
#define HK_VALUE_FRAME (HK_VALUE_BYTES + HK_FRAME_OVERHEAD)
typedef char hk_value_has_that_length[HK_VALUE_BYTES == MAVLINK_MSG_ID_PARAM_VALUE_LEN ? 1 : -1];

#define HK_ALL_PARAMETERS ((hk_parameter_bits_t)((UINT32_C(1) << HK_PARAMETERS) - 1U))
typedef char hk_parameters_fit_mask[HK_PARAMETERS <= 16U ? 1 : -1];

/* Whether the queue of a board, of 255 bytes, does not take the values of all changes. Then some are
 * told, and put to use, before the others. */
#define HK_TOLD_IN_PARTS ((HK_PARAMETERS - HK_OWN_PARAMETERS) * HK_VALUE_FRAME > 255U)

/* Messages that tell of the sample that was made last, with its values. */
#if HK_FILTER_STATE_WORDS
#define HK_OF_SAMPLE ((1U << HK_STREAM_TILT_SAMPLE) | (1U << HK_STREAM_TILT_STATE))
#else
#define HK_OF_SAMPLE (1U << HK_STREAM_TILT_SAMPLE)
#endif

static bool is_announced(const hk_app_t *app, uint8_t place)
{
    return (app->announce & (1U << place)) != 0U;
}

#if HK_TOLD_IN_PARTS
/* Go on with the old values of what has not been told yet. */
static void leave_untold(const hk_app_t *app, hk_filter_settings_t *next)
{
    uint8_t which;

    for (which = 0U; which < HK_FILTER_PARAMETERS; which++) {
        const uint8_t place = hk_parameter_of_filter(which);

        if (place != HK_NO_PARAMETER && is_announced(app, place)) {
            (void)hk_filter_set(next, which, hk_filter_get(&app->filter.settings, which));
        }
    }
}
#endif

static void take_over(hk_app_t *app)
{
#ifdef HK_FILTER_START_BIAS
    bool restart;
#endif
#if HK_TOLD_IN_PARTS
    hk_parameters_t told = app->parameters;
    const hk_parameters_t *const next = &told;

    leave_untold(app, &told.filter);
#else
    const hk_parameters_t *const next = &app->parameters;
#endif

#ifdef HK_FILTER_START_BIAS
    /* The filter follows the bias by itself, and takes a new one only to start from. */
    restart = memcmp(HK_FILTER_START_BIAS(&app->filter.settings),
                     HK_FILTER_START_BIAS(&next->filter),
                     sizeof HK_FILTER_START_BIAS(&next->filter)) != 0;
#endif
    app->filter.settings = next->filter;
#ifdef HK_FILTER_START_BIAS
    if (restart) {
        hk_filter_init(&app->filter);
    }
#endif
    app->retuned = hk_parameters_retuned(next);
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
    app->announce = (hk_parameter_bits_t)(app->announce | (1U << place));
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
    hk_parameters_t found = app->parameters;
    uint8_t bias;

    for (bias = 0U; bias < HK_FILTER_BIASES; bias++) {
        const uint8_t place = hk_parameter_of_filter((uint8_t)(HK_FILTER_FIRST_BIAS + bias));

        if (place == HK_NO_PARAMETER) {
            continue;
        }
        if (!hk_parameter_set(&found, place, hk_filter_rate_rad_s(bias, gyro_count))) {
            return false;
        }
        hk_settings_tell(app, place);
    }
    app->parameters = found;
    return true;
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
            app->announce = (hk_parameter_bits_t)(app->announce & ~(1U << place));
        }
    }
    return true;
}

/* Tell at once what has changed of the filter, all that the queue of a board can take, and put it to
 * use. */
static void announce(hk_app_t *app)
{
    const bool sample_waits = (app->stream.due & HK_OF_SAMPLE) != 0U;
    hk_parameter_bits_t left = 0U;
    uint8_t needed = 0U;
    uint8_t place;

    for (place = HK_OWN_PARAMETERS; place < HK_PARAMETERS; place++) {
        if (is_announced(app, place)) {
#if HK_TOLD_IN_PARTS
            if (needed > 255U - HK_VALUE_FRAME) {
                left = (hk_parameter_bits_t)(left | (1U << place));
                continue;
            }
#endif
            needed = (uint8_t)(needed + HK_VALUE_FRAME);
        }
    }
    if (sample_waits || !hk_link_has_time(&app->link) || hk_hal_transmit_room() < needed) {
        return;
    }
    for (place = HK_OWN_PARAMETERS; place < HK_PARAMETERS; place++) {
        if (is_announced(app, place) && (left & (1U << place)) == 0U) {
            (void)hk_telemetry_parameter(app, place);
        }
    }
    app->announce = left;
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
        || !hk_link_has_room(HK_VALUE_FRAME + MAVLINK_MSG_ID_TILT_SAMPLE_LEN)) {
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
