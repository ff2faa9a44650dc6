/* The virtual MPU-6050: what its self-test adds to the counts. Register map, section 4.1. */
#include "hk_virtual_parts.h"

#define HK_GYRO_CODE 0x1FU /* of a register with both codes */
#define HK_X_ON      0x80
#define HK_GYRO_Y    1

/* Factory trim of a self-test code in counts, 0 for a code of 0: counts * growth^(code - 1). */
static double trim(uint8_t code, double counts, double growth)
{
    double found = code == 0U ? 0.0 : counts;

    for (; code > 1U; code--) {
        found *= growth;
    }
    return found;
}

/* Which share of a response is there, so long after it was switched. */
static double grown(const hk_virtual_mpu6050_t *sensor, uint64_t since_ns)
{
    const uint64_t age_ns = sensor->now_ns - since_ns;
    const uint64_t whole_ns = sensor->response.settling_ns;

    return age_ns >= whole_ns ? 1.0 : (double)age_ns / (double)whole_ns;
}

double hk_virtual_gyro_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting)
{
    const uint8_t code = sensor->reg[HK_REG_SELF_TEST_X + axis] & HK_GYRO_CODE;
    const double found = trim(code, HK_SELF_TEST_GYRO_COUNTS, HK_SELF_TEST_GYRO_GROWTH)
                         / (double)(1U << setting) * sensor->response.share[3 + axis]
                         * grown(sensor, sensor->response.gyro_ns);

    if (((sensor->reg[HK_REG_GYRO_CONFIG] << axis) & HK_X_ON) == 0) {
        return 0.0;
    }
    return axis == HK_GYRO_Y ? -found : found;
}

double hk_virtual_accel_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting)
{
    const uint8_t high = sensor->reg[HK_REG_SELF_TEST_X + axis] >> 5;
    const uint8_t low = (sensor->reg[HK_REG_SELF_TEST_A] >> (4 - 2 * axis)) & 0x03U;
    const uint8_t code = (uint8_t)(high << 2 | low);

    if (((sensor->reg[HK_REG_ACCEL_CONFIG] << axis) & HK_X_ON) == 0) {
        return 0.0;
    }
    return trim(code, HK_SELF_TEST_ACCEL_COUNTS, HK_SELF_TEST_ACCEL_GROWTH)
           * (double)(1U << HK_SELF_TEST_ACCEL_SETTING) / (double)(1U << setting)
           * sensor->response.share[axis] * grown(sensor, sensor->response.accel_ns);
}
