/* Driver of the MPU-6050: samples one by one, each in one transaction. */
#include "hk_hal.h"
#include "hk_mpu6050_parts.h"

bool hk_mpu6050_announced(const hk_mpu6050_t *sensor, uint32_t *time_us)
{
    return hk_hal_data_ready(time_us) && *time_us != sensor->ready_us;
}

#if !HK_FIFO

bool hk_mpu6050_begin_samples(hk_mpu6050_t *sensor, uint32_t now_us)
{
    return hk_mpu6050_set(sensor, HK_REG_INT_ENABLE, HK_INT_DATA_READY, now_us);
}

bool hk_mpu6050_has_work(const hk_mpu6050_t *sensor)
{
    return sensor->owed || sensor->overdue || sensor->polling;
}

/* Whether to read the sensor now, and at what time its sample was there. */
static bool worth_reading(hk_mpu6050_t *sensor, uint32_t now_us, uint32_t *time_us)
{
    if (hk_mpu6050_announced(sensor, time_us)) {
        sensor->ready_us = *time_us;
        sensor->owed = true;
        sensor->overdue = false;
        sensor->polling = false;
        return true;
    }
    *time_us = sensor->ready_us;
    if (sensor->owed) {
        return true;
    }
    *time_us = now_us;
    if (!hk_mpu6050_waited(sensor, now_us, sensor->polling ? HK_POLL_US : HK_OVERDUE_US)) {
        return false;
    }
    sensor->overdue = true;
    if (now_us - sensor->poll_us < HK_POLL_GAP_US) {
        return false;
    }
    sensor->poll_us = now_us;
    return true;
}

/* The status, one sample, and one more register, all in one transaction. That register always reads
 * 0; where the sensor lets go of the bus on the way, it reads all ones. */
#define HK_BURST_FIRST  HK_REG_INT_STATUS
#define HK_BURST_LENGTH (1U + HK_MPU6050_BURST_BYTES + 1U)

/* Read a sample. Returns whether it is a new one, read whole, by a sensor that is set up. */
static bool read_sample(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *burst)
{
    if (!hk_mpu6050_get(sensor, HK_BURST_FIRST, burst, HK_BURST_LENGTH, now_us)) {
        return false;
    }
    if (burst[HK_BURST_LENGTH - 1U] == 0xFFU) {
        sensor->owed = true; /* the status is clear by now, the sample still there */
        hk_mpu6050_fail(sensor, HK_MPU6050_TORN, now_us);
        return false;
    }
    if (!sensor->owed && (burst[0] & HK_INT_DATA_READY) == 0U) {
        (void)(hk_mpu6050_scale_holds(sensor, now_us)
               && hk_mpu6050_next_register_holds(sensor, now_us));
        return false;
    }
    if (!sensor->owed && !sensor->polling) {
        sensor->polling = true;
        hk_mpu6050_count_error(sensor, HK_MPU6050_LOST_READY);
    }
    sensor->owed = true;
    return hk_mpu6050_registers_hold(sensor, now_us);
}

bool hk_mpu6050_acquire(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *data, uint32_t *time_us)
{
    uint8_t burst[HK_BURST_LENGTH];
    uint8_t i;

    if (!worth_reading(sensor, now_us, time_us) || !read_sample(sensor, now_us, burst)) {
        return false;
    }
    for (i = 0U; i < HK_MPU6050_BURST_BYTES; i++) {
        data[i] = burst[1U + i];
    }
    sensor->owed = false;
    sensor->overdue = false;
    return true;
}

#endif
