/* Driver of the MPU-6050: from the identification to the first sample. */
#include "hk_hal.h"
#include "hk_mpu6050_parts.h"

#define HK_IDENTIFY_TRIES   5U
#define HK_IDENTIFY_GAP_US  (10U * HK_MS)
#define HK_RESET_WAIT_US    (100U * HK_MS)
#define HK_RESET_POLL_US    (10U * HK_MS)
#define HK_RESET_GIVE_UP_US (1000U * HK_MS)
#define HK_WAKE_WAIT_US     (100U * HK_MS)
#define HK_RETRY_US         (1000U * HK_MS)

static hk_mpu6050_event_t identify(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t identity = 0U;

    if (sensor->step > 0U && !hk_mpu6050_waited(sensor, now_us, HK_IDENTIFY_GAP_US)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->since_us = now_us;
    if (!hk_hal_i2c_read(HK_MPU6050_ADDRESS, HK_REG_WHO_AM_I, &identity, 1U)) {
        hk_mpu6050_count_error(sensor, HK_MPU6050_TRANSFER);
        hk_hal_i2c_recover();
        identity = 0U;
    }
    if (hk_mpu6050_accept(sensor, identity)) {
        hk_mpu6050_enter(sensor, HK_MPU6050_RESET, now_us);
        return HK_MPU6050_NOTHING;
    }
    sensor->step++;
    if (sensor->step < HK_IDENTIFY_TRIES) {
        return HK_MPU6050_NOTHING;
    }
    hk_mpu6050_enter(sensor, HK_MPU6050_REFUSED, now_us);
    return HK_MPU6050_REFUSAL;
}

static void reset(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (hk_mpu6050_set(sensor, HK_REG_PWR_MGMT_1, HK_PWR_DEVICE_RESET, now_us)) {
        sensor->reset_us = now_us;
        hk_mpu6050_enter(sensor, HK_MPU6050_RESETTING, now_us);
    }
}

static void wait_for_reset(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t value = 0U;

    if (!hk_mpu6050_waited(sensor, now_us,
                           sensor->step == 0U ? HK_RESET_WAIT_US : HK_RESET_POLL_US)) {
        return;
    }
    if (now_us - sensor->reset_us >= HK_RESET_GIVE_UP_US) {
        hk_mpu6050_begin_again(sensor, HK_MPU6050_SILENT, now_us);
        return;
    }
    sensor->since_us = now_us;
    sensor->step = 1U;
    if (hk_mpu6050_get(sensor, HK_REG_PWR_MGMT_1, &value, 1U, now_us)
        && value == HK_RESET_PWR_MGMT_1) {
        hk_mpu6050_enter(sensor, HK_MPU6050_WAKE, now_us);
    }
}

static void wake(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (hk_mpu6050_set(sensor, HK_REG_PWR_MGMT_1, HK_PWR_CLOCK_PLL, now_us)
        && hk_mpu6050_set(sensor, HK_REG_SIGNAL_PATH_RESET, HK_SIGNAL_PATH_RESET, now_us)) {
        hk_mpu6050_enter(sensor, HK_MPU6050_WAKING, now_us);
    }
}

/* One register more; returns behind the last. */
static void next_step(hk_mpu6050_t *sensor, hk_mpu6050_state_t following, uint32_t now_us)
{
    sensor->step++;
    if (sensor->step == hk_mpu6050_configuration_steps(sensor)) {
        hk_mpu6050_enter(sensor, following, now_us);
    }
}

static void configure(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t write = hk_mpu6050_configuration(sensor->step);

    if (hk_mpu6050_set(sensor, write.address, write.value, now_us)) {
        next_step(sensor, HK_MPU6050_VERIFY, now_us);
    }
}

static void verify(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t wanted = hk_mpu6050_configuration(sensor->step);
    hk_register_write_t found = wanted;

    if (!hk_mpu6050_get(sensor, found.address, &found.value, 1U, now_us)) {
        return;
    }
    if (found.value != wanted.value) {
        hk_mpu6050_wrong_register(sensor, found, now_us);
        return;
    }
    next_step(sensor, HK_MPU6050_ENABLE, now_us);
}

static hk_mpu6050_event_t enable(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t stale = 0U;

    if (!hk_mpu6050_get(sensor, HK_REG_INT_STATUS, &stale, 1U, now_us)) {
        return HK_MPU6050_NOTHING;
    }
    (void)hk_hal_data_ready(&sensor->ready_us); /* a pin that is up by now is stuck */
    if (!hk_mpu6050_begin_samples(sensor, now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->to_drop = HK_SETTLE_SAMPLES;
    sensor->owed = false;
    sensor->overdue = false;
    sensor->polling = false;
    sensor->equal = 0U;
    sensor->poll_us = now_us;
    sensor->check_us = now_us;
    hk_mpu6050_enter(sensor, HK_MPU6050_SETTLE, now_us);
    return HK_MPU6050_STARTED;
}

hk_mpu6050_event_t hk_mpu6050_set_up(hk_mpu6050_t *sensor, uint32_t now_us)
{
    switch (sensor->state) {
    case HK_MPU6050_IDENTIFY:
        return identify(sensor, now_us);
    case HK_MPU6050_RESET:
        reset(sensor, now_us);
        break;
    case HK_MPU6050_RESETTING:
        wait_for_reset(sensor, now_us);
        break;
    case HK_MPU6050_WAKE:
        wake(sensor, now_us);
        break;
    case HK_MPU6050_WAKING:
        if (hk_mpu6050_waited(sensor, now_us, HK_WAKE_WAIT_US)) {
            hk_mpu6050_enter(sensor, HK_MPU6050_CONFIGURE, now_us);
        }
        break;
    case HK_MPU6050_CONFIGURE:
        configure(sensor, now_us);
        break;
    case HK_MPU6050_VERIFY:
        verify(sensor, now_us);
        break;
    case HK_MPU6050_ENABLE:
        return enable(sensor, now_us);
    default: /* HK_MPU6050_REFUSED */
        if (hk_mpu6050_waited(sensor, now_us, HK_RETRY_US)) {
            hk_mpu6050_enter(sensor, HK_MPU6050_IDENTIFY, now_us);
        }
        break;
    }
    return HK_MPU6050_NOTHING;
}
