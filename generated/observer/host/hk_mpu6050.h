/* Driver of the MPU-6050: a state machine that never waits. */
#ifndef HK_MPU6050_H
#define HK_MPU6050_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_mpu6050_regs.h"
#include "hk_self_test.h"

typedef enum {
    HK_MPU6050_IDENTIFY,  /* read WHO_AM_I */
    HK_MPU6050_RESET,     /* write DEVICE_RESET */
    HK_MPU6050_RESETTING, /* wait, then poll for the reset value */
    HK_MPU6050_WAKE,      /* clock and signal path */
    HK_MPU6050_WAKING,    /* wait */
    HK_MPU6050_CONFIGURE, /* write one register per call */
    HK_MPU6050_VERIFY,    /* read one register per call back */
    HK_MPU6050_ENABLE,    /* drop a stale flag, enable data-ready */
    HK_MPU6050_SETTLE,    /* drop the first samples */
    HK_MPU6050_RUN,
    HK_MPU6050_TEST,   /* the self-test; what was set up is void afterwards */
    HK_MPU6050_REFUSED /* not a sensor we know; try again after a pause */
} hk_mpu6050_state_t;

typedef enum {
    HK_MPU6050_NOTHING,
    HK_MPU6050_STARTED, /* samples follow; whatever was integrated before is void */
    HK_MPU6050_SAMPLE,
    HK_MPU6050_REFUSAL,
    HK_MPU6050_SELF_TESTED /* sensor->self_test says how it went, sensor->tested what was found */
} hk_mpu6050_event_t;

/* What can go wrong. Every kind has a counter and a text of its own. */
typedef enum {
    HK_MPU6050_TRANSFER,   /* a transfer failed: no acknowledge, time limit, or a bus held low */
    HK_MPU6050_TORN,       /* the sensor let go of the bus in the middle of a burst */
    HK_MPU6050_DEAD_BUS,   /* too many failures of these two in a row; restarted */
    HK_MPU6050_REGISTER,   /* a register had lost its value; restarted */
    HK_MPU6050_SELF_RESET, /* the sensor had reset itself; restarted */
    HK_MPU6050_LOST_READY, /* samples were there that INT had not announced; polled since */
    HK_MPU6050_SILENT,     /* no samples, for no reason that could be found; restarted */
    HK_MPU6050_FROZEN,     /* the same sample over and over; restarted */
    HK_MPU6050_VARIANT,    /* another part than the design's, accepted */
    HK_MPU6050_OVERFLOW,   /* the FIFO was full; emptied, with all that was in it */
    HK_MPU6050_MISALIGNED, /* the FIFO did not hold whole samples; emptied likewise */
    HK_MPU6050_KINDS
} hk_mpu6050_kind_t;

typedef struct {
    uint32_t time_us;
    bool after_gap;   /* too many samples were lost before this one to go on integrating */
    int16_t accel[3]; /* counts, sensor axes */
    int16_t temperature;
    int16_t gyro[3];
} hk_mpu6050_sample_t;

#if HK_FIFO
/* How far the FIFO has been read, and when its samples were there. */
typedef struct {
    uint32_t count_us;   /* when the samples in it were counted */
    uint32_t next_us;    /* time of the sample to be taken next */
    uint32_t retry_us;   /* when a transfer failed last */
    uint32_t failed_us;  /* the first of those in a row */
    uint8_t counted;     /* samples that it held then */
    uint8_t taken;       /* of these, since */
    uint8_t left;        /* that may be taken before they are counted again */
    uint8_t resets;      /* in a row, without a sample between them */
    bool uncounted;      /* the status was read, but the samples could not be counted */
    bool crooked;        /* the count was not one of whole samples */
    bool reset_due;
    bool temperature_known;
} hk_mpu6050_fifo_t;
#endif

typedef struct {
    hk_mpu6050_state_t state;
    uint32_t since_us;  /* start of the current wait */
    uint32_t reset_us;  /* when the device reset was written */
    uint32_t ready_us;  /* the announcement that was answered last */
    uint32_t sample_us; /* when the sample accepted last was announced or found */
    uint32_t poll_us;   /* when the sensor was last read without an announcement */
    uint32_t check_us;  /* when a register was last checked */
    uint8_t step;       /* register of the configuration, or try of the identification */
    uint8_t check_step; /* register to be checked next */
    bool check_standby; /* it is the turn of PWR_MGMT_2 */
    uint8_t failures;   /* consecutive failed transfers */
    uint8_t who_am_i;   /* last identity read; 0 if none could be */
    uint8_t to_drop;    /* samples still to be dropped */
    bool owed;          /* an announced sample could not be read yet */
    bool overdue;       /* no announcement when one was due: look without */
    bool polling;       /* INT is not to be relied on */
    uint8_t bad_register; /* the one that was found wrong last, and its value */
    uint8_t bad_value;
    uint8_t last[HK_MPU6050_BURST_BYTES]; /* the sample read last */
    uint16_t equal;     /* how often it has come again */
    uint16_t errors;    /* all but variants, since start; it and those below stop at their maximum */
    uint16_t count[HK_MPU6050_KINDS];
    uint16_t untold;    /* one bit for each kind that the application has not told yet */
#if HK_FIFO
    hk_mpu6050_fifo_t fifo;
#endif
    bool test_wanted;
    hk_self_test_result_t self_test; /* of the last self-test */
    hk_self_test_t tested;
} hk_mpu6050_t;

void hk_mpu6050_init(hk_mpu6050_t *sensor, uint32_t now_us);

/* Take one step: at most a few bus transactions. *sample is set with HK_MPU6050_SAMPLE. */
hk_mpu6050_event_t hk_mpu6050_poll(hk_mpu6050_t *sensor, uint32_t now_us,
                                   hk_mpu6050_sample_t *sample);

/* Begin again, from the identification on. */
void hk_mpu6050_restart(hk_mpu6050_t *sensor, uint32_t now_us);

/* Ask for a self-test, of a sensor at rest. It takes about a second, once samples come; then comes
 * HK_MPU6050_SELF_TESTED, and the sensor is set up anew. */
void hk_mpu6050_request_self_test(hk_mpu6050_t *sensor);

/* True if the next step needs time to pass, or a sample to come. */
bool hk_mpu6050_waiting(const hk_mpu6050_t *sensor);

/* The part of that identity, for messages: a text in flash, to be read with hk_flash_u8. */
const char *hk_mpu6050_part(uint8_t who_am_i);

/* No answer, or a bus that reads all zeros or all ones, is a fault of the bus, not another part. */
bool hk_mpu6050_bus_fault(const hk_mpu6050_t *sensor);

#endif
