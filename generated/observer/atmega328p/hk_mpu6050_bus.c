/* Driver of the MPU-6050: transfers, and what becomes of those that fail. */
#include "hk_hal.h"
#include "hk_mpu6050_parts.h"

#define HK_FAILURES_MAX 10U
/* The FIFO goes on filling while the bus is dead: so long nothing is lost by waiting for it. */
#define HK_PATIENCE_US (64U * HK_MS)

void hk_mpu6050_enter(hk_mpu6050_t *sensor, hk_mpu6050_state_t state, uint32_t now_us)
{
    sensor->state = state;
    sensor->since_us = now_us;
    sensor->step = 0U;
}

bool hk_mpu6050_waited(const hk_mpu6050_t *sensor, uint32_t now_us, uint32_t wait_us)
{
    return now_us - sensor->since_us >= wait_us;
}

static void count_one(uint16_t *counter)
{
    if (*counter < UINT16_MAX) {
        (*counter)++;
    }
}

void hk_mpu6050_count_error(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind)
{
    if (kind != HK_MPU6050_VARIANT) {
        count_one(&sensor->errors);
    }
    count_one(&sensor->count[kind]);
    if (kind != HK_MPU6050_TRANSFER) {
        sensor->untold |= (uint16_t)(1U << kind);
    }
}

void hk_mpu6050_restart(hk_mpu6050_t *sensor, uint32_t now_us)
{
    sensor->failures = 0U;
    hk_mpu6050_enter(sensor, HK_MPU6050_IDENTIFY, now_us);
}

void hk_mpu6050_begin_again(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us)
{
    hk_mpu6050_count_error(sensor, kind);
    hk_hal_i2c_recover();
    sensor->test_wanted = sensor->test_wanted || sensor->state == HK_MPU6050_TEST;
    hk_mpu6050_restart(sensor, now_us);
}

/* Whether so many failures in a row are too many. */
static bool too_many(hk_mpu6050_t *sensor, uint32_t now_us)
{
#if HK_FIFO
    const bool runs = sensor->state == HK_MPU6050_RUN || sensor->state == HK_MPU6050_SETTLE;

    if (sensor->failures == 1U) {
        sensor->fifo.failed_us = now_us;
    }
    sensor->fifo.retry_us = now_us;
    if (runs && now_us - sensor->fifo.failed_us < HK_PATIENCE_US) {
        return false;
    }
#else
    (void)now_us;
#endif
    return sensor->failures > HK_FAILURES_MAX;
}

void hk_mpu6050_fail(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us)
{
    if (sensor->failures < UINT8_MAX) {
        sensor->failures++;
    }
    if (too_many(sensor, now_us)) {
        hk_mpu6050_begin_again(sensor, HK_MPU6050_DEAD_BUS, now_us);
    } else {
        hk_mpu6050_count_error(sensor, kind);
        hk_hal_i2c_recover();
    }
}

/* Take note of a transfer. */
static bool check(hk_mpu6050_t *sensor, bool good, uint32_t now_us)
{
    if (good) {
        sensor->failures = 0U;
    } else {
        hk_mpu6050_fail(sensor, HK_MPU6050_TRANSFER, now_us);
    }
    return good;
}

bool hk_mpu6050_set(hk_mpu6050_t *sensor, uint8_t reg, uint8_t value, uint32_t now_us)
{
    const uint8_t bytes[2] = {reg, value};

    return check(sensor, hk_hal_i2c_write(HK_MPU6050_ADDRESS, bytes, sizeof bytes), now_us);
}

bool hk_mpu6050_get(hk_mpu6050_t *sensor, uint8_t reg, uint8_t *values, uint8_t count,
                    uint32_t now_us)
{
    return check(sensor, hk_hal_i2c_read(HK_MPU6050_ADDRESS, reg, values, count), now_us);
}
