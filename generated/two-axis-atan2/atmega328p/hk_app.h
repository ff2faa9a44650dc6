/* The application: sensor, filter, link and store, with all their state in one struct. */
#ifndef HK_APP_H
#define HK_APP_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_calibration.h"
#include "hk_filter.h"
#include "hk_link.h"
#include "hk_mpu6050.h"
#include "hk_parameter.h"
#include "hk_receiver.h"
#include "hk_store.h"
#include "hk_stream.h"

/* The sample that was taken last. */
typedef struct {
    hk_mpu6050_sample_t sample;
    uint64_t time_us;
    uint32_t sequence; /* samples before it */
    uint8_t flags;     /* HOSTKIT_SAMPLE_FLAG */
#if HK_FILTER_STATE_WORDS
    int32_t state[HK_FILTER_STATE_WORDS]; /* of the filter after it */
#endif
} hk_latest_t;

/* How much of its time the processor is awake. */
typedef struct {
    uint32_t since_us;  /* when it was reckoned last */
    uint32_t asleep_us; /* since then */
    uint32_t paused_us; /* when the last step ended */
    bool paused;        /* and whether there was nothing more to do */
} hk_load_t;

/* Commands that are answered when they are through. */
typedef enum {
    HK_LATE_CALIBRATION,
    HK_LATE_STORAGE,
    HK_LATE_SELF_TEST,
    HK_LATE_COMMANDS
} hk_late_t;

typedef struct {
    uint8_t system_id; /* who waits for the answer */
    uint8_t component_id;
    uint8_t result; /* MAV_RESULT; IN_PROGRESS until it is through */
    bool waited_for;
} hk_late_answer_t;

/* What is told in a text beside the events of the sensor: one bit each. */
typedef enum {
    HK_NOTICE_RESET,
    HK_NOTICE_REFUSED,
    HK_NOTICE_CALIBRATED,
    HK_NOTICE_MOVED,
    HK_NOTICE_STORE_FAILED,
    HK_NOTICE_SELF_TEST,
    HK_NOTICES
} hk_notice_t;

typedef struct {
    hk_mpu6050_t sensor;
    hk_filter_t filter;
    hk_latest_t latest;
    hk_link_t link;
    hk_stream_t stream;
    hk_receiver_t receiver;
    hk_parameters_t parameters;
    hk_store_t store;
    hk_calibration_t calibration;
    hk_load_t load;
    hk_late_answer_t late[HK_LATE_COMMANDS];
    uint64_t now_us;       /* the clock of the board, extended beyond its wrap */
    uint32_t samples;      /* since start */
    uint32_t changed_us;   /* when a parameter was set last */
    uint32_t listed_us;    /* when the list of parameters went on last */
    uint32_t test_us;      /* when a self-test was asked for */
    uint32_t reboot_us;    /* when a reboot was asked for */
    hk_parameter_bits_t announce; /* parameters whose values are to be told */
    uint8_t list_place;    /* the next one of the list; HK_NO_PARAMETER if nobody asks for it */
    uint8_t notices;       /* one bit for each that has not been told */
    uint8_t sensor_status; /* MAV_STATE, but for a calibration */
    uint8_t system_status; /* MAV_STATE of the heartbeat */
    bool arrived;          /* the receiver holds a message that has not been answered */
    bool unsaved;          /* parameters have been set since the last save */
    bool rebooting;
    bool version_wanted;
    bool retuned;          /* a value of the filter differs from the design's */
    bool start_calibrated; /* the calibration at the start has begun, or is not wanted */
} hk_app_t;

void hk_app_init(hk_app_t *app);

/* Take one step. Returns true if there is nothing to do before an interrupt comes. */
bool hk_app_poll(hk_app_t *app);

/* Tell something in a text, as soon as there is room. */
void hk_app_notice(hk_app_t *app, hk_notice_t notice);

#endif
