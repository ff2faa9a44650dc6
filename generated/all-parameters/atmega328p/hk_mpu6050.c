/* Driver of the MPU-6050: see the header. */
#include "hk_mpu6050.h"

#include "hk_design.h"
#include "hk_hal.h"
#include "hk_mpu6050_regs.h"

#define HK_MS UINT32_C(1000)

#define HK_IDENTIFY_TRIES   5U
#define HK_IDENTIFY_GAP_US  (10U * HK_MS)
#define HK_RESET_WAIT_US    (100U * HK_MS)
#define HK_RESET_POLL_US    (10U * HK_MS)
#define HK_RESET_GIVE_UP_US (1000U * HK_MS)
#define HK_WAKE_WAIT_US     (100U * HK_MS)
#define HK_RETRY_US         (1000U * HK_MS)
#define HK_FAILURES_MAX     10U
/* Several periods without a sample: the sensor has stopped, or has reset itself. */
#define HK_SILENCE_US (8U * HK_PERIOD_US + 20U * HK_MS)

typedef struct {
    uint8_t address;
    uint8_t value;
} hk_register_write_t;

#define HK_REGISTER_WRITE(register_address, register_value) \
    {.address = (register_address), .value = (register_value)},
static const hk_register_write_t hk_configuration[] = {HK_SENSOR_CONFIGURATION(HK_REGISTER_WRITE)};
#define HK_CONFIGURATION_STEPS (sizeof hk_configuration / sizeof hk_configuration[0])

static bool write_register(uint8_t reg, uint8_t value)
{
    const uint8_t bytes[2] = {reg, value};

    return hk_hal_i2c_write(HK_MPU6050_ADDRESS, bytes, sizeof bytes);
}

static bool read_register(uint8_t reg, uint8_t *value)
{
    return hk_hal_i2c_read(HK_MPU6050_ADDRESS, reg, value, 1U);
}

static void enter(hk_mpu6050_t *sensor, hk_mpu6050_state_t state, uint32_t now_us)
{
    sensor->state = state;
    sensor->since_us = now_us;
    sensor->step = 0U;
}

static bool waited(const hk_mpu6050_t *sensor, uint32_t now_us, uint32_t wait_us)
{
    return now_us - sensor->since_us >= wait_us;
}

static void count_error(hk_mpu6050_t *sensor)
{
    if (sensor->errors < UINT16_MAX) {
        sensor->errors++;
    }
}

/* Free the bus and begin again. */
static void restart(hk_mpu6050_t *sensor, uint32_t now_us)
{
    count_error(sensor);
    sensor->failures = 0U;
    hk_hal_i2c_recover();
    enter(sensor, HK_MPU6050_IDENTIFY, now_us);
}

/* Take note of a transfer. A failed one frees the bus and may be tried again; after too many in a
 * row begin again. Returns whether it was good. */
static bool check(hk_mpu6050_t *sensor, bool good, uint32_t now_us)
{
    if (good) {
        sensor->failures = 0U;
        return true;
    }
    sensor->failures++;
    if (sensor->failures > HK_FAILURES_MAX) {
        restart(sensor, now_us);
    } else {
        count_error(sensor);
        hk_hal_i2c_recover();
    }
    return false;
}

static hk_mpu6050_event_t identify(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t identity = 0U;

    if (sensor->step > 0U && !waited(sensor, now_us, HK_IDENTIFY_GAP_US)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->since_us = now_us;
    if (!read_register(HK_REG_WHO_AM_I, &identity)) {
        count_error(sensor);
        hk_hal_i2c_recover();
        identity = 0U;
    }
    sensor->who_am_i = identity;
    if (identity == HK_MPU6050_ID) {
        enter(sensor, HK_MPU6050_RESET, now_us);
        return HK_MPU6050_NOTHING;
    }
    sensor->step++;
    if (sensor->step < HK_IDENTIFY_TRIES) {
        return HK_MPU6050_NOTHING;
    }
    enter(sensor, HK_MPU6050_REFUSED, now_us);
    return HK_MPU6050_REFUSAL;
}

static void reset(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (check(sensor, write_register(HK_REG_PWR_MGMT_1, HK_PWR_DEVICE_RESET), now_us)) {
        sensor->reset_us = now_us;
        enter(sensor, HK_MPU6050_RESETTING, now_us);
    }
}

static void wait_for_reset(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t value = 0U;

    if (!waited(sensor, now_us, sensor->step == 0U ? HK_RESET_WAIT_US : HK_RESET_POLL_US)) {
        return;
    }
    if (now_us - sensor->reset_us >= HK_RESET_GIVE_UP_US) {
        restart(sensor, now_us);
        return;
    }
    sensor->since_us = now_us;
    sensor->step = 1U;
    if (check(sensor, read_register(HK_REG_PWR_MGMT_1, &value), now_us)
        && value == HK_RESET_PWR_MGMT_1) {
        enter(sensor, HK_MPU6050_WAKE, now_us);
    }
}

static void wake(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (check(sensor, write_register(HK_REG_PWR_MGMT_1, HK_PWR_CLOCK_PLL), now_us)
        && check(sensor, write_register(HK_REG_SIGNAL_PATH_RESET, HK_SIGNAL_PATH_RESET), now_us)) {
        enter(sensor, HK_MPU6050_WAKING, now_us);
    }
}

static void configure(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t *write = &hk_configuration[sensor->step];

    if (!check(sensor, write_register(write->address, write->value), now_us)) {
        return;
    }
    sensor->step++;
    if (sensor->step == HK_CONFIGURATION_STEPS) {
        enter(sensor, HK_MPU6050_VERIFY, now_us);
    }
}

static void verify(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t *write = &hk_configuration[sensor->step];
    uint8_t value = 0U;

    if (!check(sensor, read_register(write->address, &value), now_us)) {
        return;
    }
    if (value != write->value) {
        restart(sensor, now_us);
        return;
    }
    sensor->step++;
    if (sensor->step == HK_CONFIGURATION_STEPS) {
        enter(sensor, HK_MPU6050_ENABLE, now_us);
    }
}

static hk_mpu6050_event_t enable(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t stale = 0U;

    if (!check(sensor, read_register(HK_REG_INT_STATUS, &stale), now_us)) {
        return HK_MPU6050_NOTHING;
    }
    if (!check(sensor, write_register(HK_REG_INT_ENABLE, HK_INT_DATA_READY), now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->to_drop = HK_SETTLE_SAMPLES;
    enter(sensor, HK_MPU6050_SETTLE, now_us);
    return HK_MPU6050_STARTED;
}

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

/* An announcement that stands although its sample has been read is none: the pin is stuck. */
static bool announced(const hk_mpu6050_t *sensor, uint32_t *time_us)
{
    return hk_hal_data_ready(time_us) && *time_us != sensor->sample_us;
}

/* Read the sample that was announced, all of it in one burst. A failed burst is tried again, for
 * the announcement stands until it is read. */
static hk_mpu6050_event_t run(hk_mpu6050_t *sensor, uint32_t now_us, hk_mpu6050_sample_t *sample)
{
    uint8_t burst[HK_MPU6050_BURST_BYTES];

    if (!announced(sensor, &sample->time_us)) {
        if (waited(sensor, now_us, HK_SILENCE_US)) {
            restart(sensor, now_us);
        }
        return HK_MPU6050_NOTHING;
    }
    if (!check(sensor, hk_hal_i2c_read(HK_MPU6050_ADDRESS, HK_REG_ACCEL_XOUT_H, burst, sizeof burst),
               now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->since_us = now_us;
    sensor->sample_us = sample->time_us;
    if (sensor->to_drop > 0U) {
        sensor->to_drop--;
        return HK_MPU6050_NOTHING;
    }
    sensor->state = HK_MPU6050_RUN;
    unpack(burst, sample);
    return HK_MPU6050_SAMPLE;
}

void hk_mpu6050_init(hk_mpu6050_t *sensor, uint32_t now_us)
{
    sensor->reset_us = now_us;
    sensor->sample_us = now_us;
    sensor->failures = 0U;
    sensor->who_am_i = 0U;
    sensor->to_drop = 0U;
    sensor->errors = 0U;
    enter(sensor, HK_MPU6050_IDENTIFY, now_us);
}

hk_mpu6050_event_t hk_mpu6050_poll(hk_mpu6050_t *sensor, uint32_t now_us,
                                   hk_mpu6050_sample_t *sample)
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
        if (waited(sensor, now_us, HK_WAKE_WAIT_US)) {
            enter(sensor, HK_MPU6050_CONFIGURE, now_us);
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
    case HK_MPU6050_SETTLE:
    case HK_MPU6050_RUN:
        return run(sensor, now_us, sample);
    case HK_MPU6050_REFUSED:
        if (waited(sensor, now_us, HK_RETRY_US)) {
            enter(sensor, HK_MPU6050_IDENTIFY, now_us);
        }
        break;
    }
    return HK_MPU6050_NOTHING;
}

bool hk_mpu6050_waiting(const hk_mpu6050_t *sensor)
{
    switch (sensor->state) {
    case HK_MPU6050_IDENTIFY:
        return sensor->step > 0U;
    case HK_MPU6050_RESETTING:
    case HK_MPU6050_WAKING:
    case HK_MPU6050_SETTLE:
    case HK_MPU6050_RUN:
    case HK_MPU6050_REFUSED:
        return true;
    case HK_MPU6050_RESET:
    case HK_MPU6050_WAKE:
    case HK_MPU6050_CONFIGURE:
    case HK_MPU6050_VERIFY:
    case HK_MPU6050_ENABLE:
        break;
    }
    return false;
}

bool hk_mpu6050_bus_fault(const hk_mpu6050_t *sensor)
{
    return sensor->who_am_i == 0x00U || sensor->who_am_i == 0xFFU;
}
