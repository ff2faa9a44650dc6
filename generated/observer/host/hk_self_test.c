/* The self-test of the MPU-6050: means with it off and on, held against the factory's figures.
 *
 * How long the response takes to come the register map does not say; 250 ms is what is commonly
 * waited. The trims stand in a table, so that no power has to be computed. */
#include "hk_self_test.h"

#include "hk_flash.h"
#include "hk_mpu6050_parts.h"

#define HK_SETTLING_US  (250U * HK_MS)
#define HK_SAMPLE_GAP_US (5U * HK_MS)
#define HK_SAMPLES      32
#define HK_DIVIDER      4U /* 200 Hz, or 1600 Hz */
#define HK_GYRO_AXIS    3U /* of six, x first */
#define HK_GYRO_Y_AXIS  4U
#define HK_GYRO_CODE    0x1FU

#define HK_OFF_WRITES 6U
static const hk_register_write_t hk_test_writes[] HK_FLASH = {
    {HK_REG_INT_ENABLE, 0U},
    {HK_REG_USER_CTRL, 0U},
    {HK_REG_FIFO_EN, 0U},
    {HK_REG_SMPLRT_DIV, HK_DIVIDER},
    {HK_REG_GYRO_CONFIG, HK_SELF_TEST_GYRO_CONFIG},
    {HK_REG_ACCEL_CONFIG, HK_SELF_TEST_ACCEL_CONFIG},
    {HK_REG_GYRO_CONFIG, HK_SELF_TEST | HK_SELF_TEST_GYRO_CONFIG},
    {HK_REG_ACCEL_CONFIG, HK_SELF_TEST | HK_SELF_TEST_ACCEL_CONFIG},
};
#define HK_ALL_WRITES ((uint8_t)(sizeof hk_test_writes / sizeof hk_test_writes[0]))

static const uint16_t hk_gyro_trims[HK_SELF_TEST_CODES] HK_FLASH = HK_SELF_TEST_GYRO_TRIMS;
static const uint16_t hk_accel_trims[HK_SELF_TEST_CODES] HK_FLASH = HK_SELF_TEST_ACCEL_TRIMS;

hk_mpu6050_event_t hk_mpu6050_begin_self_test(hk_mpu6050_t *sensor, uint32_t now_us)
{
    sensor->test_wanted = false;
    if (sensor->who_am_i != HK_MPU6050_ID) {
        sensor->self_test = HK_SELF_TEST_VARIANT;
        return HK_MPU6050_SELF_TESTED;
    }
    sensor->tested.writes = 0U;
    sensor->tested.samples = 0U;
    sensor->tested.writes_due = HK_OFF_WRITES;
    sensor->tested.moved = false;
    hk_mpu6050_enter(sensor, HK_MPU6050_TEST, now_us);
    return HK_MPU6050_NOTHING;
}

static int16_t big_endian(const uint8_t *bytes)
{
    return (int16_t)(uint16_t)(((uint16_t)bytes[0] << 8) | bytes[1]);
}

/* Add a sample to the sums. The first is kept, in the place of the trims, to see motion by. */
static void add(hk_self_test_t *test, const uint8_t *data)
{
    uint8_t axis;

    for (axis = 0U; axis < HK_SELF_TEST_AXES; axis++) {
        const bool is_gyro = axis >= HK_GYRO_AXIS;
        const int16_t count = big_endian(&data[2U * axis + (is_gyro ? 2U : 0U)]);
        const int32_t limit = is_gyro ? HK_SELF_TEST_GYRO_SPREAD : HK_SELF_TEST_ACCEL_SPREAD;
        int32_t away;

        if (test->samples == 0U) {
            test->trim[axis] = count;
            test->sum[axis] = 0;
        }
        away = (int32_t)count - test->trim[axis];
        if (away > limit || away < -limit) {
            test->moved = true;
        }
        test->sum[axis] += count;
    }
    test->samples++;
}

/* End a series: the mean with the self-test off is kept until that with it on is known. */
static void end_series(hk_self_test_t *test, bool is_on)
{
    uint8_t axis;

    for (axis = 0U; axis < HK_SELF_TEST_AXES; axis++) {
        const int16_t mean = (int16_t)(test->sum[axis] / HK_SAMPLES);

        test->response[axis] = is_on ? (int16_t)(mean - test->response[axis]) : mean;
    }
    test->samples = 0U;
}

/* The factory's figure of an axis; registers SELF_TEST_X, Y, Z and A. */
static int16_t trim_of(uint8_t axis, const uint8_t registers[4])
{
    uint8_t code = registers[axis % 3U] & HK_GYRO_CODE;
    int16_t trim;

    if (axis < HK_GYRO_AXIS) {
        const uint8_t high = (uint8_t)(registers[axis] >> 5);
        const uint8_t low = (uint8_t)(registers[3] >> (4U - 2U * axis)) & 0x03U;

        code = (uint8_t)(4U * high + low);
    }
    if (code == 0U) {
        return 0;
    }
    trim = (int16_t)(axis < HK_GYRO_AXIS ? hk_flash_u16(&hk_accel_trims[code - 1U])
                                         : hk_flash_u16(&hk_gyro_trims[code - 1U]));
    return axis == HK_GYRO_Y_AXIS ? (int16_t)-trim : trim;
}

static bool is_near(int16_t response, int16_t trim)
{
    const int32_t away = (int32_t)response - trim;
    const int32_t limit = HK_SELF_TEST_TOLERANCE_PERCENT * (int32_t)(trim < 0 ? -trim : trim);

    return (away < 0 ? -away : away) * 100 <= limit;
}

static hk_self_test_result_t judge(hk_self_test_t *test, const uint8_t registers[4])
{
    hk_self_test_result_t result = HK_SELF_TEST_PASSED;
    uint8_t axis;

    for (axis = 0U; axis < HK_SELF_TEST_AXES; axis++) {
        test->trim[axis] = trim_of(axis, registers);
        if (test->trim[axis] == 0) {
            result = result == HK_SELF_TEST_PASSED ? HK_SELF_TEST_NO_TRIM : result;
        } else if (!is_near(test->response[axis], test->trim[axis])) {
            result = HK_SELF_TEST_FAILED;
        }
    }
    return test->moved ? HK_SELF_TEST_MOVED : result;
}

static void write_next(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t *write = &hk_test_writes[sensor->tested.writes];

    if (hk_mpu6050_set(sensor, hk_flash_u8(&write->address), hk_flash_u8(&write->value), now_us)) {
        sensor->tested.writes++;
        sensor->since_us = now_us;
    }
}

/* Read a sample, and one register more, which always reads 0 unless the read breaks off. */
static bool read_sample(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t burst[HK_MPU6050_BURST_BYTES + 1U];

    if (!hk_mpu6050_get(sensor, HK_REG_ACCEL_XOUT_H, burst, sizeof burst, now_us)) {
        return false;
    }
    if (burst[HK_MPU6050_BURST_BYTES] != 0U) {
        hk_mpu6050_fail(sensor, HK_MPU6050_TORN, now_us);
        return false;
    }
    add(&sensor->tested, burst);
    sensor->since_us = now_us;
    return true;
}

static hk_mpu6050_event_t finish(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t registers[4];

    if (!hk_mpu6050_get(sensor, HK_REG_SELF_TEST_X, registers, sizeof registers, now_us)) {
        return HK_MPU6050_NOTHING;
    }
    end_series(&sensor->tested, true);
    sensor->self_test = judge(&sensor->tested, registers);
    hk_mpu6050_restart(sensor, now_us);
    return HK_MPU6050_SELF_TESTED;
}

hk_mpu6050_event_t hk_mpu6050_continue_self_test(hk_mpu6050_t *sensor, uint32_t now_us)
{
    hk_self_test_t *test = &sensor->tested;

    if (test->writes < test->writes_due) {
        write_next(sensor, now_us);
        return HK_MPU6050_NOTHING;
    }
    if (test->samples == HK_SAMPLES) {
        return finish(sensor, now_us);
    }
    if (!hk_mpu6050_waited(sensor, now_us, test->samples == 0U ? HK_SETTLING_US : HK_SAMPLE_GAP_US)
        || !read_sample(sensor, now_us)) {
        return HK_MPU6050_NOTHING;
    }
    if (test->samples == HK_SAMPLES && test->writes_due == HK_OFF_WRITES) {
        end_series(test, false);
        test->writes_due = HK_ALL_WRITES;
    }
    return HK_MPU6050_NOTHING;
}
