/* Driver of the MPU-6050: a state machine that never waits. */
#ifndef HK_MPU6050_H
#define HK_MPU6050_H

#include <stdbool.h>
#include <stdint.h>

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
    HK_MPU6050_REFUSED /* not a sensor we know; try again after a pause */
} hk_mpu6050_state_t;

typedef enum {
    HK_MPU6050_NOTHING,
    HK_MPU6050_STARTED, /* samples follow; whatever was integrated before is void */
    HK_MPU6050_SAMPLE,
    HK_MPU6050_REFUSAL
} hk_mpu6050_event_t;

typedef struct {
    uint32_t time_us;
    int16_t accel[3]; /* counts, sensor axes */
    int16_t temperature;
    int16_t gyro[3];
} hk_mpu6050_sample_t;

typedef struct {
    hk_mpu6050_state_t state;
    uint32_t since_us;  /* start of the current wait */
    uint32_t reset_us;  /* when the device reset was written */
    uint32_t sample_us; /* when the sample read last was announced */
    uint8_t step;       /* register of the configuration, or try of the identification */
    uint8_t failures;   /* consecutive failed transfers */
    uint8_t who_am_i;   /* last identity read; 0 if none could be */
    uint8_t to_drop;    /* samples still to be dropped */
    uint16_t errors;    /* failed transfers and restarts since start; stops at its maximum */
} hk_mpu6050_t;

void hk_mpu6050_init(hk_mpu6050_t *sensor, uint32_t now_us);

/* Take one step: at most a few bus transactions. *sample is set with HK_MPU6050_SAMPLE. */
hk_mpu6050_event_t hk_mpu6050_poll(hk_mpu6050_t *sensor, uint32_t now_us,
                                   hk_mpu6050_sample_t *sample);

/* True if the next step needs time to pass, or a sample to come. */
bool hk_mpu6050_waiting(const hk_mpu6050_t *sensor);

/* No answer, or a bus that reads all zeros or all ones, is a fault of the bus, not another part. */
bool hk_mpu6050_bus_fault(const hk_mpu6050_t *sensor);

#endif
