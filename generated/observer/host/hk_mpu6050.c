/* Driver of the MPU-6050: see the header. This file: the states, and samples for the application. */
#include "hk_mpu6050.h"

#include "hk_mpu6050_parts.h"

/* Several periods without a sample: the sensor has stopped. A FIFO is waited for a little longer. */
#define HK_SILENCE_US (8U * HK_PERIOD_US + (HK_FIFO != 0 ? 70U : 20U) * HK_MS)
/* After so long a gap the filter begins anew; shorter ones are bridged. */
#define HK_GAP_US (4U * HK_PERIOD_US + HK_PERIOD_US / 2U)

static int16_t big_endian(const uint8_t *bytes)
{
    return (int16_t)(uint16_t)(((uint16_t)bytes[0] << 8) | bytes[1]);
}

static void unpack(const uint8_t *bytes, hk_mpu6050_sample_t *sample)
{
    uint8_t axis;

    for (axis = 0U; axis < 3U; axis++) {
        sample->accel[axis] = big_endian(&bytes[2U * axis]);
        sample->gyro[axis] = big_endian(&bytes[8U + 2U * axis]);
    }
    sample->temperature = big_endian(&bytes[6]);
}

static hk_mpu6050_event_t run(hk_mpu6050_t *sensor, uint32_t now_us, hk_mpu6050_sample_t *sample)
{
    uint8_t data[HK_MPU6050_BURST_BYTES];

    if (sensor->test_wanted) {
        return hk_mpu6050_begin_self_test(sensor, now_us);
    }
    if (!hk_mpu6050_acquire(sensor, now_us, data, &sample->time_us)) {
        if (hk_mpu6050_waited(sensor, now_us, HK_SILENCE_US)) {
            hk_mpu6050_begin_again(sensor, HK_MPU6050_SILENT, now_us);
        }
        return HK_MPU6050_NOTHING;
    }
    if (!hk_mpu6050_is_alive(sensor, data, now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->since_us = now_us;
    sample->after_gap = sample->time_us - sensor->sample_us > HK_GAP_US;
    sensor->sample_us = sample->time_us;
    if (sensor->to_drop > 0U) {
        sensor->to_drop--;
        return HK_MPU6050_NOTHING;
    }
    sensor->state = HK_MPU6050_RUN;
    unpack(data, sample);
    return HK_MPU6050_SAMPLE;
}

void hk_mpu6050_init(hk_mpu6050_t *sensor, uint32_t now_us)
{
    static const hk_mpu6050_t blank = {0};

    *sensor = blank;
    sensor->reset_us = now_us;
    sensor->ready_us = now_us;
    hk_mpu6050_enter(sensor, HK_MPU6050_IDENTIFY, now_us);
}

void hk_mpu6050_request_self_test(hk_mpu6050_t *sensor)
{
    sensor->test_wanted = true;
}

hk_mpu6050_event_t hk_mpu6050_poll(hk_mpu6050_t *sensor, uint32_t now_us,
                                   hk_mpu6050_sample_t *sample)
{
    switch (sensor->state) {
    case HK_MPU6050_SETTLE:
    case HK_MPU6050_RUN:
        return run(sensor, now_us, sample);
    case HK_MPU6050_TEST:
        return hk_mpu6050_continue_self_test(sensor, now_us);
    default:
        return hk_mpu6050_set_up(sensor, now_us);
    }
}

bool hk_mpu6050_waiting(const hk_mpu6050_t *sensor)
{
    switch (sensor->state) {
    case HK_MPU6050_IDENTIFY:
        return sensor->step > 0U;
    case HK_MPU6050_RESETTING:
    case HK_MPU6050_WAKING:
    case HK_MPU6050_REFUSED:
        return true;
    case HK_MPU6050_SETTLE:
    case HK_MPU6050_RUN:
        return !sensor->test_wanted && !hk_mpu6050_has_work(sensor);
    default:
        return false;
    }
}
