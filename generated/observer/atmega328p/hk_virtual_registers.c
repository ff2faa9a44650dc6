/* The virtual MPU-6050: what its registers hold, and what reading and writing them does. */
#include "hk_virtual_parts.h"

#define HK_RESET_NS (20U * HK_NS_PER_MS) /* a reset takes its time */

static uint8_t reset_value(uint8_t address)
{
#define HK_CASE(register_address, value) \
    case register_address: \
        return value;
    switch (address) {
        HK_MPU6050_REGISTERS(HK_CASE)
    default:
        return 0U;
    }
#undef HK_CASE
}

bool hk_virtual_resetting(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->reset_end_ns != HK_NEVER;
}

static void end_faults_of_axes(hk_virtual_mpu6050_t *sensor)
{
    uint32_t axis;

    sensor->faults.frozen = false;
    for (axis = 0U; axis < HK_FAULT_AXES; axis++) {
        sensor->faults.stuck_left[axis] = 0U;
        sensor->faults.saturated_left[axis] = 0U;
    }
}

void hk_virtual_load_reset_values(hk_virtual_mpu6050_t *sensor)
{
    uint8_t address;

    for (address = 0U; address < HK_VIRTUAL_REGISTERS; address++) {
        sensor->reg[address] = reset_value(address);
    }
    for (address = 0U; address < sizeof sensor->faults.self_test; address++) {
        sensor->reg[HK_REG_SELF_TEST_X + address] = sensor->faults.self_test[address];
    }
    for (address = 0U; address < HK_MPU6050_BURST_BYTES; address++) {
        sensor->pending[address] = 0U;
    }
    for (address = 0U; address < HK_PATHS; address++) {
        sensor->path_free_ns[address] = 0U;
    }
    sensor->reg[HK_REG_WHO_AM_I] = sensor->faults.who_am_i;
    end_faults_of_axes(sensor);
    hk_virtual_fifo_clear(sensor);
    sensor->motion.settled = false;
    sensor->pending_full = false;
    sensor->pending_ready = false;
    sensor->latch = false;
    sensor->pulse_end_ns = HK_NEVER;
    sensor->sample_ns = HK_NEVER;
    hk_virtual_enable_replay(sensor);
}

void hk_virtual_begin_reset(hk_virtual_mpu6050_t *sensor)
{
    hk_virtual_load_reset_values(sensor);
    sensor->reg[HK_REG_PWR_MGMT_1] = HK_PWR_DEVICE_RESET;
    sensor->reset_start_ns = sensor->now_ns;
    sensor->reset_end_ns = sensor->now_ns + HK_RESET_NS;
}

/* Whether the part that answers so has a low-pass register for its accelerometer. */
static bool own_accel_filter(uint8_t who_am_i)
{
#define HK_CASE(value, part, accepted, warned, has_own_accel_filter) \
    case value: \
        return has_own_accel_filter;
    switch (who_am_i) {
        HK_MPU6050_IDENTITIES(HK_CASE)
    default:
        return false;
    }
#undef HK_CASE
}

/* Keep a register that sets the rate; the sampling begins anew with it. */
static void set_rate(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    sensor->reg[address] = value;
    if (!hk_virtual_asleep(sensor) && sensor->sample_ns != HK_NEVER) {
        hk_virtual_restart_sampling(sensor, 0U);
    }
}

/* Keep a register with self-test bits; a change of them takes its time to show. */
static void set_range(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    uint64_t *since_ns = address == HK_REG_GYRO_CONFIG ? &sensor->response.gyro_ns
                                                       : &sensor->response.accel_ns;

    if (((sensor->reg[address] ^ value) & HK_SELF_TEST) != 0U) {
        *since_ns = sensor->now_ns;
    }
    sensor->reg[address] = value;
}

static void set_standby(hk_virtual_mpu6050_t *sensor, uint8_t value)
{
    if (hk_virtual_cycling(sensor)) {
        set_rate(sensor, HK_REG_PWR_MGMT_2, value);
    } else {
        sensor->reg[HK_REG_PWR_MGMT_2] = value;
    }
}

/* Registers that are more than kept. Returns whether it was one of them. */
static bool write_acting(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    switch (address) {
    case HK_REG_PWR_MGMT_1:
        hk_virtual_write_power(sensor, value);
        return true;
    case HK_REG_PWR_MGMT_2:
        set_standby(sensor, value);
        return true;
    case HK_REG_SIGNAL_PATH_RESET:
        hk_virtual_reset_signal_path(sensor, value & HK_SIGNAL_PATH_RESET);
        return true;
    case HK_REG_CONFIG:
    case HK_REG_SMPLRT_DIV:
        set_rate(sensor, address, value);
        return true;
    case HK_REG_GYRO_CONFIG:
    case HK_REG_ACCEL_CONFIG:
        set_range(sensor, address, value);
        return true;
    case HK_REG_INT_ENABLE:
    case HK_REG_FIFO_EN:
        sensor->reg[address] = value;
        hk_virtual_enable_replay(sensor);
        return true;
    case HK_REG_INT_PIN_CFG:
        sensor->reg[address] = value;
        sensor->latch = false;
        return true;
    case HK_REG_USER_CTRL:
        hk_virtual_write_user_control(sensor, value);
        hk_virtual_enable_replay(sensor);
        return true;
    case HK_REG_FIFO_R_W:
        if (hk_virtual_fifo_enabled(sensor)) {
            hk_virtual_fifo_push(sensor, value);
        }
        return true;
    default:
        return false;
    }
}

/* Writes to registers that cannot be written, or that are not modelled, are ignored. */
void hk_virtual_write_register(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    if (write_acting(sensor, address, value)) {
        return;
    }
    switch (address) {
    case HK_REG_SELF_TEST_X:
    case HK_REG_SELF_TEST_Y:
    case HK_REG_SELF_TEST_Z:
    case HK_REG_SELF_TEST_A:
        sensor->reg[address] = value;
        break;
    case HK_REG_ACCEL_CONFIG_2:
        if (own_accel_filter(sensor->faults.who_am_i)) {
            sensor->reg[address] = value;
        }
        break;
    default:
        break;
    }
}

/* The high byte of the count, which also holds the low one until it is read again. */
static uint8_t read_count(hk_virtual_mpu6050_t *sensor)
{
    sensor->count_low = (uint8_t)(sensor->fifo.count & 0xFFU);
    if (sensor->faults.count_is_torn) {
        sensor->faults.count_is_torn = false;
        return sensor->faults.torn_count;
    }
    return (uint8_t)(sensor->fifo.count >> 8);
}

uint8_t hk_virtual_read_register(hk_virtual_mpu6050_t *sensor, uint8_t address)
{
    uint8_t value = sensor->reg[address];

    switch (address) {
    case HK_REG_FIFO_COUNT_H:
        value = read_count(sensor);
        break;
    case HK_REG_FIFO_COUNT_L:
        value = sensor->count_low;
        break;
    case HK_REG_FIFO_R_W:
        value = hk_virtual_fifo_pop(sensor);
        break;
    default:
        break;
    }
    if (address == HK_REG_INT_STATUS
        || (sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_ANY_READ) != 0U) {
        hk_virtual_clear_interrupt(sensor);
    }
    return value;
}
