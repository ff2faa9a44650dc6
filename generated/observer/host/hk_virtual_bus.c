/* The virtual MPU-6050: the I2C bus. */
#include "hk_virtual_parts.h"

/* For the first millisecond of a reset the part does not answer at all. */
#define HK_RESET_DEAF_NS (1U * HK_NS_PER_MS)

static bool is_addressed(const hk_virtual_mpu6050_t *sensor, uint8_t address)
{
    const bool deaf = hk_virtual_resetting(sensor)
                      && sensor->now_ns < sensor->reset_start_ns + HK_RESET_DEAF_NS;

    return address == (HK_MPU6050_ADDRESS | (sensor->first_address_bit ? 1U : 0U)) && !deaf
           && !hk_virtual_mpu6050_sda_low(sensor);
}

bool hk_virtual_mpu6050_start(hk_virtual_mpu6050_t *sensor, uint8_t address, bool read)
{
    if (!is_addressed(sensor, address)) {
        hk_virtual_mpu6050_stop(sensor);
        return false;
    }
    if (sensor->faults.nack_left > 0U) {
        sensor->faults.nack_left--;
        hk_virtual_mpu6050_stop(sensor);
        return false;
    }
    sensor->slave.open = true;
    sensor->slave.gone = false;
    sensor->slave.bytes_read = 0U;
    sensor->slave.pointer_expected = !read;
    return true;
}

/* The address counts up with every byte, but not at the FIFO. */
static void step_pointer(hk_virtual_mpu6050_t *sensor)
{
    if (sensor->slave.pointer != HK_REG_FIFO_R_W) {
        sensor->slave.pointer = (uint8_t)((sensor->slave.pointer + 1U) % HK_VIRTUAL_REGISTERS);
    }
}

/* Whether the supply dips within this write: the register does not get its value. */
static bool browns_out(hk_virtual_mpu6050_t *sensor)
{
    if (!sensor->faults.brown_out) {
        return false;
    }
    if (sensor->faults.good_writes > 0U) {
        sensor->faults.good_writes--;
        return false;
    }
    sensor->faults.brown_out = false;
    return true;
}

bool hk_virtual_mpu6050_write(hk_virtual_mpu6050_t *sensor, uint8_t byte)
{
    if (!sensor->slave.open) {
        return false;
    }
    if (sensor->faults.nack_data_left > 0U) {
        sensor->faults.nack_data_left--;
        hk_virtual_mpu6050_stop(sensor);
        return false;
    }
    if (sensor->slave.pointer_expected) {
        sensor->slave.pointer = byte % HK_VIRTUAL_REGISTERS;
        sensor->slave.pointer_expected = false;
        return true;
    }
    if (browns_out(sensor)) {
        hk_virtual_begin_reset(sensor);
    } else if (!hk_virtual_resetting(sensor)) {
        hk_virtual_write_register(sensor, sensor->slave.pointer, byte);
    }
    step_pointer(sensor);
    return true;
}

uint8_t hk_virtual_mpu6050_read(hk_virtual_mpu6050_t *sensor)
{
    uint8_t value;

    if (sensor->faults.torn && sensor->slave.bytes_read >= sensor->faults.torn_after) {
        sensor->faults.torn = false;
        sensor->slave.gone = true;
    }
    if (!sensor->slave.open || sensor->slave.gone) {
        return 0xFFU;
    }
    sensor->slave.bytes_read++;
    value = hk_virtual_read_register(sensor, sensor->slave.pointer);
    step_pointer(sensor);
    return value;
}

void hk_virtual_mpu6050_stop(hk_virtual_mpu6050_t *sensor)
{
    sensor->slave.open = false;
    sensor->slave.pointer_expected = false;
    if (sensor->pending_full) {
        hk_virtual_publish(sensor);
    }
}

uint64_t hk_virtual_mpu6050_stretch_ns(hk_virtual_mpu6050_t *sensor)
{
    if (sensor->faults.stretch_us > 0U) {
        sensor->faults.scl_free_ns = sensor->now_ns + (uint64_t)sensor->faults.stretch_us * 1000U;
        sensor->faults.stretch_us = 0U;
    }
    return sensor->faults.scl_free_ns > sensor->now_ns
               ? sensor->faults.scl_free_ns - sensor->now_ns
               : 0U;
}

void hk_virtual_mpu6050_clock(hk_virtual_mpu6050_t *sensor)
{
    if (sensor->faults.sda_stuck_left > 0U) {
        sensor->faults.sda_stuck_left--;
    }
}

bool hk_virtual_mpu6050_sda_low(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->faults.sda_stuck_left > 0U;
}
