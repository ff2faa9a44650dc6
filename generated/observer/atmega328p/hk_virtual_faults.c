/* The virtual MPU-6050: what goes wrong on demand. */
#include "hk_virtual_parts.h"

#define HK_FULL_SCALE_HIGH 0x7FU
#define HK_FULL_SCALE_LOW  0xFFU

void hk_virtual_mpu6050_nack_next(hk_virtual_mpu6050_t *sensor, uint32_t addressings)
{
    sensor->faults.nack_left = addressings;
}

void hk_virtual_mpu6050_hold_sda(hk_virtual_mpu6050_t *sensor, uint32_t clocks)
{
    sensor->faults.sda_stuck_left = clocks;
}

/* One bit, or several, of a register turn over, with all that a write would bring about. */
static void upset(hk_virtual_mpu6050_t *sensor, uint32_t amount)
{
    const uint8_t address = (uint8_t)(amount / 256U % HK_VIRTUAL_REGISTERS);

    hk_virtual_write_register(sensor, address, (uint8_t)(sensor->reg[address] ^ (amount & 0xFFU)));
}

static void spoil_axis(uint32_t *left, uint32_t amount)
{
    const uint32_t samples = amount / 256U;

    left[amount % 256U % HK_FAULT_AXES] = samples == 0U ? HK_FOR_GOOD : samples;
}

static void weaken(hk_virtual_mpu6050_t *sensor, uint32_t percent)
{
    uint32_t axis;

    for (axis = 0U; axis < 6U; axis++) {
        hk_virtual_mpu6050_set_response(sensor, axis, (double)percent / 100.0);
    }
}

/* Faults of the bus and of the identity. Returns whether it was one of them. */
static bool strike_bus(hk_virtual_mpu6050_t *sensor, hk_fault_kind_t kind, uint32_t amount)
{
    switch (kind) {
    case HK_FAULT_NACK_ADDRESS:
        sensor->faults.nack_left = amount;
        return true;
    case HK_FAULT_NACK_DATA:
        sensor->faults.nack_data_left = amount;
        return true;
    case HK_FAULT_TORN_BURST:
        sensor->faults.torn = true;
        sensor->faults.torn_after = amount;
        return true;
    case HK_FAULT_STUCK_SDA:
        sensor->faults.sda_stuck_left = amount;
        return true;
    case HK_FAULT_CLOCK_STRETCH:
        sensor->faults.stretch_us = amount;
        return true;
    case HK_FAULT_WRONG_IDENTITY:
        hk_virtual_mpu6050_set_identity(sensor, (uint8_t)amount);
        return true;
    default:
        return false;
    }
}

/* Faults of the data and of the FIFO. Returns whether it was one of them. */
static bool strike_data(hk_virtual_mpu6050_t *sensor, hk_fault_kind_t kind, uint32_t amount)
{
    switch (kind) {
    case HK_FAULT_FROZEN_DATA:
        sensor->faults.frozen = true;
        return true;
    case HK_FAULT_LOST_DATA_READY:
        sensor->faults.lost_ready_left = amount;
        return true;
    case HK_FAULT_FIFO_OVERFLOW:
        sensor->faults.extra_packets = amount;
        return true;
    case HK_FAULT_TORN_COUNT:
        sensor->faults.count_is_torn = true;
        sensor->faults.torn_count = (uint8_t)amount;
        return true;
    case HK_FAULT_MISALIGNED:
        sensor->faults.lose_bytes = amount;
        return true;
    case HK_FAULT_STUCK_VALUE:
        spoil_axis(sensor->faults.stuck_left, amount);
        return true;
    case HK_FAULT_SATURATED_AXIS:
        spoil_axis(sensor->faults.saturated_left, amount);
        return true;
    default:
        return false;
    }
}

static void strike(hk_virtual_mpu6050_t *sensor, hk_fault_kind_t kind, uint32_t amount)
{
    if (strike_bus(sensor, kind, amount) || strike_data(sensor, kind, amount)) {
        return;
    }
    switch (kind) {
    case HK_FAULT_REGISTER_UPSET:
        upset(sensor, amount);
        break;
    case HK_FAULT_SELF_RESET:
        hk_virtual_begin_reset(sensor);
        break;
    case HK_FAULT_BROWN_OUT_WRITE:
        sensor->faults.brown_out = true;
        sensor->faults.good_writes = amount;
        break;
    case HK_FAULT_WEAK_RESPONSE:
        weaken(sensor, amount);
        break;
    case HK_FAULT_NO_TRIM:
        hk_virtual_mpu6050_set_self_test(sensor, 0U, 0U, 0U, 0U);
        break;
    default:
        break;
    }
}

/* Strike with what is planned for the row that is about to be sampled. */
void hk_virtual_strike_due(hk_virtual_mpu6050_t *sensor)
{
    uint32_t i;

    if (!sensor->replay.running || sensor->replay.lead_in_left > 0U) {
        return;
    }
    for (i = 0U; i < sensor->faults.planned_count; i++) {
        hk_planned_fault_t *fault = &sensor->faults.planned[i];

        if (!fault->struck && sensor->replay.rows_played >= fault->row) {
            fault->struck = true;
            strike(sensor, fault->kind, fault->amount);
        }
    }
}

/* What concerns the bus, the identity, the writes or the self-test can strike at power-up. */
static bool strikes_at_once(hk_fault_kind_t kind, uint32_t row)
{
    switch (kind) {
    case HK_FAULT_NACK_ADDRESS:
    case HK_FAULT_NACK_DATA:
    case HK_FAULT_STUCK_SDA:
    case HK_FAULT_CLOCK_STRETCH:
    case HK_FAULT_WRONG_IDENTITY:
    case HK_FAULT_BROWN_OUT_WRITE:
    case HK_FAULT_WEAK_RESPONSE:
    case HK_FAULT_NO_TRIM:
        return row == 0U;
    default:
        return false;
    }
}

bool hk_virtual_mpu6050_plan(hk_virtual_mpu6050_t *sensor, uint32_t kind, uint32_t row,
                             uint32_t amount)
{
    hk_planned_fault_t *fault = &sensor->faults.planned[sensor->faults.planned_count];

    if (sensor->faults.planned_count == HK_PLANNED_FAULTS || kind >= (uint32_t)HK_FAULT_KINDS) {
        return false;
    }
    sensor->faults.planned_count++;
    fault->kind = (hk_fault_kind_t)kind;
    fault->row = row;
    fault->amount = amount;
    fault->struck = strikes_at_once(fault->kind, row);
    if (fault->struck) {
        strike(sensor, fault->kind, amount);
    }
    return true;
}

uint32_t hk_virtual_mpu6050_struck(const hk_virtual_mpu6050_t *sensor)
{
    uint32_t struck = 0U;
    uint32_t i;

    for (i = 0U; i < sensor->faults.planned_count; i++) {
        struck += sensor->faults.planned[i].struck ? 1U : 0U;
    }
    return struck;
}

static bool lasts(uint32_t *left)
{
    if (*left == 0U) {
        return false;
    }
    if (*left != HK_FOR_GOOD) {
        (*left)--;
    }
    return true;
}

/* The counts of the axes that stick are put back; those that are at their end are put there. */
void hk_virtual_spoil(hk_virtual_mpu6050_t *sensor, const uint8_t *before, uint8_t *burst)
{
    uint32_t axis;

    for (axis = 0U; axis < HK_FAULT_AXES; axis++) {
        const uint32_t place = axis < 3U ? 2U * axis : 2U + 2U * axis;

        if (lasts(&sensor->faults.stuck_left[axis])) {
            burst[place] = before[place];
            burst[place + 1U] = before[place + 1U];
        }
        if (lasts(&sensor->faults.saturated_left[axis])) {
            burst[place] = HK_FULL_SCALE_HIGH;
            burst[place + 1U] = HK_FULL_SCALE_LOW;
        }
    }
}
