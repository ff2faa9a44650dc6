/* Driver of the MPU-6050: parts that are known, registers that are read back, samples that repeat. */
#include <stddef.h>

#include "hk_flash.h"
#include "hk_hal.h"
#include "hk_mpu6050_parts.h"

#define HK_CHECK_US (50U * HK_MS)

#define HK_REGISTER_WRITE(register_address, register_value) \
    {.address = (register_address), .value = (register_value)},
static const hk_register_write_t hk_configuration[] HK_FLASH = {
    HK_SENSOR_CONFIGURATION(HK_REGISTER_WRITE) HK_VARIANT_CONFIGURATION(HK_REGISTER_WRITE)};
#define HK_ALL_STEPS     ((uint8_t)(sizeof hk_configuration / sizeof hk_configuration[0]))
#define HK_ONE_MORE(register_address, register_value) +1U
#define HK_VARIANT_STEPS ((uint8_t)(0U HK_VARIANT_CONFIGURATION(HK_ONE_MORE)))

/* The four registers that say what a count means, one behind the other. */
#define HK_SCALE_REGISTERS 4U

typedef struct {
    uint8_t who_am_i;
    uint8_t accepted;
    uint8_t warned;
    uint8_t own_accel_filter;
} hk_identity_t;

#define HK_IDENTITY(value, name, is_accepted, is_warned, has_own_accel_filter) \
    {.who_am_i = (value), .accepted = (is_accepted), .warned = (is_warned), \
     .own_accel_filter = (has_own_accel_filter)},
static const hk_identity_t hk_identities[] HK_FLASH = {HK_MPU6050_IDENTITIES(HK_IDENTITY)};
#define HK_IDENTITIES ((uint8_t)(sizeof hk_identities / sizeof hk_identities[0]))

/* What is known of an identity, in flash; NULL if nothing is. */
static const hk_identity_t *identity_of(uint8_t who_am_i)
{
    uint8_t i;

    for (i = 0U; i < HK_IDENTITIES; i++) {
        if (hk_flash_u8(&hk_identities[i].who_am_i) == who_am_i) {
            return &hk_identities[i];
        }
    }
    return NULL;
}

bool hk_mpu6050_accept(hk_mpu6050_t *sensor, uint8_t who_am_i)
{
    const hk_identity_t *identity = identity_of(who_am_i);

    sensor->who_am_i = who_am_i;
    if (identity == NULL || hk_flash_u8(&identity->accepted) == 0U) {
        return false;
    }
    if (hk_flash_u8(&identity->warned) != 0U && sensor->count[HK_MPU6050_VARIANT] == 0U) {
        hk_mpu6050_count_error(sensor, HK_MPU6050_VARIANT);
    }
    return true;
}

const char *hk_mpu6050_part(uint8_t who_am_i)
{
#define HK_CASE(value, name, accepted, warned, own_accel_filter) \
    case value: \
        return HK_TEXT(name);
    switch (who_am_i) {
        HK_MPU6050_IDENTITIES(HK_CASE)
    default:
        return HK_TEXT("unknown part");
    }
#undef HK_CASE
}

bool hk_mpu6050_bus_fault(const hk_mpu6050_t *sensor)
{
    return sensor->who_am_i == 0x00U || sensor->who_am_i == 0xFFU;
}

uint8_t hk_mpu6050_configuration_steps(const hk_mpu6050_t *sensor)
{
    const hk_identity_t *identity = identity_of(sensor->who_am_i);

    return identity != NULL && hk_flash_u8(&identity->own_accel_filter) != 0U
               ? HK_ALL_STEPS
               : (uint8_t)(HK_ALL_STEPS - HK_VARIANT_STEPS);
}

hk_register_write_t hk_mpu6050_configuration(uint8_t step)
{
    const hk_register_write_t write = {.address = hk_flash_u8(&hk_configuration[step].address),
                                       .value = hk_flash_u8(&hk_configuration[step].value)};

    return write;
}

/* All ones is what is read where the sensor has let go of the bus. Asleep or resetting: it lost them
 * all. */
void hk_mpu6050_wrong_register(hk_mpu6050_t *sensor, hk_register_write_t found, uint32_t now_us)
{
    const uint8_t lost = HK_PWR_DEVICE_RESET | HK_PWR_SLEEP;
    uint8_t power = 0U;

    if (found.value == 0xFFU) {
        hk_mpu6050_fail(sensor, HK_MPU6050_TORN, now_us);
        return;
    }
    sensor->bad_register = found.address;
    sensor->bad_value = found.value;
    if (found.address != HK_REG_PWR_MGMT_1
        && hk_hal_i2c_read(HK_MPU6050_ADDRESS, HK_REG_PWR_MGMT_1, &power, 1U) && (power & lost) != 0U) {
        hk_mpu6050_begin_again(sensor, HK_MPU6050_SELF_RESET, now_us);
    } else {
        hk_mpu6050_begin_again(sensor, HK_MPU6050_REGISTER, now_us);
    }
}

/* What a register of the table holds while the sensor runs; behind the table comes the clock. Every
 * other time it is the turn of the one that can let a single axis stand still. */
static hk_register_write_t running_value(const hk_mpu6050_t *sensor)
{
    hk_register_write_t wanted = {.address = HK_REG_PWR_MGMT_1, .value = HK_PWR_CLOCK_PLL};

    if (sensor->check_standby) {
        wanted.address = HK_REG_PWR_MGMT_2;
        wanted.value = HK_RESET_PWR_MGMT_2;
    } else if (sensor->check_step < hk_mpu6050_configuration_steps(sensor)) {
        wanted = hk_mpu6050_configuration(sensor->check_step);
    }
    if (wanted.address == HK_REG_INT_ENABLE) {
        wanted.value = HK_FIFO != 0 ? HK_INT_DATA_READY | HK_INT_FIFO_OVERFLOW : HK_INT_DATA_READY;
    }
#if HK_FIFO
    if (wanted.address == HK_REG_USER_CTRL) {
        wanted.value = HK_USER_FIFO;
    } else if (wanted.address == HK_REG_FIFO_EN) {
        wanted.value = HK_FIFO_ALL;
    }
#endif
    return wanted;
}

bool hk_mpu6050_next_register_holds(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t wanted = running_value(sensor);
    hk_register_write_t found = {.address = wanted.address, .value = 0U};

    if (!hk_mpu6050_get(sensor, wanted.address, &found.value, 1U, now_us)) {
        return false;
    }
    if (found.value != wanted.value) {
        hk_mpu6050_wrong_register(sensor, found, now_us);
        return false;
    }
    sensor->check_us = now_us;
    sensor->check_standby = !sensor->check_standby;
    if (sensor->check_standby) {
        sensor->check_step = sensor->check_step < hk_mpu6050_configuration_steps(sensor)
                                 ? (uint8_t)(sensor->check_step + 1U)
                                 : 0U;
    }
    return true;
}

bool hk_mpu6050_scale_holds(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t found[HK_SCALE_REGISTERS];
    uint8_t step;

    if (!hk_mpu6050_get(sensor, HK_REG_SMPLRT_DIV, found, sizeof found, now_us)) {
        return false;
    }
    for (step = 0U; step < HK_ALL_STEPS; step++) {
        hk_register_write_t write = hk_mpu6050_configuration(step);
        const uint8_t place = (uint8_t)(write.address - HK_REG_SMPLRT_DIV);

        if (place < HK_SCALE_REGISTERS && found[place] != write.value) {
            write.value = found[place];
            hk_mpu6050_wrong_register(sensor, write, now_us);
            return false;
        }
    }
    return true;
}

bool hk_mpu6050_registers_hold(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (!hk_mpu6050_scale_holds(sensor, now_us)) {
        return false;
    }
    return now_us - sensor->check_us < HK_CHECK_US
           || hk_mpu6050_next_register_holds(sensor, now_us);
}

bool hk_mpu6050_is_alive(hk_mpu6050_t *sensor, const uint8_t *data, uint32_t now_us)
{
    bool same = true;
    uint8_t i;

    for (i = 0U; i < HK_MPU6050_BURST_BYTES; i++) {
        same = same && sensor->last[i] == data[i];
        sensor->last[i] = data[i];
    }
    sensor->equal = same ? (uint16_t)(sensor->equal + 1U) : 0U;
    if (sensor->equal < HK_FROZEN_SAMPLES) {
        return true;
    }
    hk_mpu6050_begin_again(sensor, HK_MPU6050_FROZEN, now_us);
    return false;
}
