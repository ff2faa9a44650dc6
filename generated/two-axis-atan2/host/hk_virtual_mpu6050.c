/* A virtual MPU-6050: see the header. Sources: register map RM-MPU-6000A revision 4.2, product
 * specification PS-MPU-6000A revision 3.4. */
#include "hk_virtual_mpu6050.h"

#include "hk_mpu6050_regs.h"

#define HK_NS_PER_MS UINT64_C(1000000)

/* A reset takes its time; for its first millisecond the part does not answer at all. */
#define HK_RESET_DEAF_NS (1U * HK_NS_PER_MS)
#define HK_RESET_NS      (20U * HK_NS_PER_MS)
/* From waking to the first sample, and from a change of clock to a gyroscope one can believe. */
#define HK_WAKE_NS (30U * HK_NS_PER_MS)
#define HK_PLL_NS  (10U * HK_NS_PER_MS)
#define HK_PULSE_NS UINT64_C(50000)

#define HK_FAST_TICK_NS UINT64_C(125000) /* low-pass settings 0 and 7: 8 kHz */
#define HK_SLOW_TICK_NS HK_NS_PER_MS     /* 1 kHz */

#define HK_CONFIG_LOW_PASS    0x07U
#define HK_RANGE_SHIFT        3
#define HK_RANGE_MASK         0x03U
#define HK_PIN_ACTIVE_LOW     0x80U
#define HK_PIN_LATCH          0x20U
#define HK_PIN_ANY_READ       0x10U
#define HK_PWR_CLOCK          0x07U
#define HK_PWR_NO_SAMPLES     0x60U /* sleep, and cycle mode, which is not modelled */
#define HK_SELF_TEST_GYRO     0x1FU /* of a register with both codes */
#define HK_SELF_TEST_X_ON     0x80
#define HK_USER_RESET_BITS    0x07U
#define HK_FIFO_DATA_REGISTER 0x74U
#define HK_GYRO_UNDEFINED     0x55U /* both bytes of a gyroscope count while the PLL settles */

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

static double gyro_counts_per_rad_s(uint8_t setting)
{
#define HK_CASE(field, counts) \
    case field: \
        return counts;
    switch (setting) {
        HK_MPU6050_GYRO_RANGES(HK_CASE)
    default:
        return 0.0;
    }
#undef HK_CASE
}

static double accel_counts_per_m_s2(uint8_t setting)
{
#define HK_CASE(field, counts) \
    case field: \
        return counts;
    switch (setting) {
        HK_MPU6050_ACCEL_RANGES(HK_CASE)
    default:
        return 0.0;
    }
#undef HK_CASE
}

/* clip(floor(value + 0.5)) to 16 bits, without libm. */
static int16_t to_count(double value)
{
    const double shifted = value + 0.5;
    int32_t count;

    if (!(shifted > -32768.0)) {
        return INT16_MIN;
    }
    if (shifted >= 32767.0) {
        return INT16_MAX;
    }
    count = (int32_t)shifted;
    if ((double)count > shifted) {
        count--;
    }
    return (int16_t)count;
}

static void put_big_endian(uint8_t *bytes, int16_t count)
{
    bytes[0] = (uint8_t)((uint16_t)count >> 8);
    bytes[1] = (uint8_t)((uint16_t)count & 0xFFU);
}

static bool asleep(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_PWR_MGMT_1] & HK_PWR_NO_SAMPLES) != 0U;
}

static bool resetting(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->reset_end_ns != HK_NEVER;
}

static bool data_ready_enabled(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_INT_ENABLE] & HK_INT_DATA_READY) != 0U;
}

static uint64_t sample_period_ns(const hk_virtual_mpu6050_t *sensor)
{
    const uint8_t low_pass = sensor->reg[HK_REG_CONFIG] & HK_CONFIG_LOW_PASS;
    const uint64_t tick = (low_pass == 0U || low_pass == 7U) ? HK_FAST_TICK_NS : HK_SLOW_TICK_NS;

    return tick * (1U + (uint64_t)sensor->reg[HK_REG_SMPLRT_DIV]);
}

static bool table_ended(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->replay.next_row >= sensor->replay.row_count;
}

/* --- Sampling ------------------------------------------------------------------------------- */

static void restart_sampling(hk_virtual_mpu6050_t *sensor, uint64_t delay_ns)
{
    sensor->sample_ns = asleep(sensor) ? HK_NEVER
                                       : sensor->now_ns + delay_ns + sample_period_ns(sensor);
}

/* Factory trim of a self-test code in counts, 0 for a code of 0: counts * growth^(code - 1). */
static double trim(uint8_t code, double counts, double growth)
{
    double found = code == 0U ? 0.0 : counts;

    for (; code > 1U; code--) {
        found *= growth;
    }
    return found;
}

/* What the self-test adds to a count, as far as an axis has it switched on. */
static double gyro_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting)
{
    const uint8_t code = sensor->reg[HK_REG_SELF_TEST_X + axis] & HK_SELF_TEST_GYRO;
    const double found = trim(code, HK_SELF_TEST_GYRO_COUNTS, HK_SELF_TEST_GYRO_GROWTH)
                         / (double)(1U << setting);

    if (((sensor->reg[HK_REG_GYRO_CONFIG] << axis) & HK_SELF_TEST_X_ON) == 0) {
        return 0.0;
    }
    return axis == 1 ? -found : found;
}

static double accel_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting)
{
    const uint8_t high = sensor->reg[HK_REG_SELF_TEST_X + axis] >> 5;
    const uint8_t low = (sensor->reg[HK_REG_SELF_TEST_A] >> (4 - 2 * axis)) & 0x03U;

    if (((sensor->reg[HK_REG_ACCEL_CONFIG] << axis) & HK_SELF_TEST_X_ON) == 0) {
        return 0.0;
    }
    return trim((uint8_t)(high << 2 | low), HK_SELF_TEST_ACCEL_COUNTS, HK_SELF_TEST_ACCEL_GROWTH)
           * (double)(1U << HK_SELF_TEST_ACCEL_SETTING) / (double)(1U << setting);
}

static void quantise(const hk_virtual_mpu6050_t *sensor, const double *row, uint8_t *burst)
{
    const uint8_t gyro = (sensor->reg[HK_REG_GYRO_CONFIG] >> HK_RANGE_SHIFT) & HK_RANGE_MASK;
    const uint8_t accel = (sensor->reg[HK_REG_ACCEL_CONFIG] >> HK_RANGE_SHIFT) & HK_RANGE_MASK;
    const bool settled = sensor->sample_ns >= sensor->pll_locked_ns;
    int axis;

    for (axis = 0; axis < 3; axis++) {
        put_big_endian(&burst[2 * axis], to_count(row[3 + axis] * accel_counts_per_m_s2(accel)
                                                  + accel_response(sensor, axis, accel)));
        put_big_endian(&burst[8 + 2 * axis], to_count(row[axis] * gyro_counts_per_rad_s(gyro)
                                                      + gyro_response(sensor, axis, gyro)));
        if (!settled) {
            burst[8 + 2 * axis] = HK_GYRO_UNDEFINED;
            burst[9 + 2 * axis] = HK_GYRO_UNDEFINED;
        }
    }
    put_big_endian(&burst[6], to_count(row[6] * HK_TEMPERATURE_COUNTS_PER_DEG_C
                                       - HK_TEMPERATURE_OFFSET_COUNTS));
}

/* Move the waiting burst into the registers and raise data-ready. */
static void publish(hk_virtual_mpu6050_t *sensor)
{
    int i;

    for (i = 0; i < HK_MPU6050_BURST_BYTES && !sensor->faults.frozen; i++) {
        sensor->reg[HK_REG_ACCEL_XOUT_H + i] = sensor->pending[i];
    }
    sensor->pending_full = false;
    sensor->published_ns = sensor->now_ns;
    if (!sensor->pending_ready) {
        return;
    }
    if ((sensor->reg[HK_REG_INT_STATUS] & HK_INT_DATA_READY) != 0U) {
        sensor->faults.unread_samples++;
    }
    sensor->reg[HK_REG_INT_STATUS] |= HK_INT_DATA_READY;
    if (sensor->faults.lost_ready_left > 0U) {
        sensor->faults.lost_ready_left--;
        return;
    }
    sensor->latch = true;
    if ((sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_LATCH) == 0U) {
        sensor->pulse_end_ns = sensor->now_ns + HK_PULSE_NS;
    }
}

/* The row of this sample, or NULL when the table has ended. */
static const double *take_row(hk_virtual_mpu6050_t *sensor)
{
    hk_replay_t *replay = &sensor->replay;
    const double *row;

    if (replay->loop && table_ended(sensor)) {
        replay->next_row = 0U;
    }
    if (table_ended(sensor)) {
        return 0;
    }
    row = &replay->rows[(uint64_t)replay->next_row * HK_ROW_VALUES];
    if (!replay->running) {
        return row;
    }
    if (replay->lead_in_left > 0U) {
        replay->lead_in_left--;
        return row;
    }
    replay->next_row++;
    replay->rows_played++;
    return row;
}

static void strike_due(hk_virtual_mpu6050_t *sensor);

static void take_sample(hk_virtual_mpu6050_t *sensor)
{
    const double *row;

    strike_due(sensor);
    if (sensor->sample_ns != sensor->now_ns) {
        return; /* a fault has stopped the sampling, or changed its rate */
    }
    row = take_row(sensor);
    if (row == 0) {
        sensor->sample_ns = HK_NEVER;
        return;
    }
    if (sensor->pending_full) {
        sensor->faults.unread_samples++;
    }
    quantise(sensor, row, sensor->pending);
    sensor->pending_full = true;
    sensor->pending_ready = data_ready_enabled(sensor);
    /* The registers are refreshed only while the serial interface is idle. */
    if (!sensor->slave.open) {
        publish(sensor);
    }
    sensor->sample_ns += sample_period_ns(sensor);
}

static void enable_replay(hk_virtual_mpu6050_t *sensor, bool enabled)
{
    if (enabled && !sensor->replay.running) {
        sensor->replay.lead_in_left = sensor->replay.settle;
    }
    sensor->replay.running = enabled;
}

/* --- Registers ------------------------------------------------------------------------------ */

static void load_reset_values(hk_virtual_mpu6050_t *sensor)
{
    uint8_t address;

    for (address = 0U; address < HK_VIRTUAL_REGISTERS; address++) {
        sensor->reg[address] = reset_value(address);
    }
    for (address = 0U; address < sizeof sensor->faults.self_test; address++) {
        sensor->reg[HK_REG_SELF_TEST_X + address] = sensor->faults.self_test[address];
    }
    sensor->reg[HK_REG_WHO_AM_I] = sensor->faults.who_am_i;
    sensor->faults.frozen = false;
    sensor->pending_full = false;
    sensor->pending_ready = false;
    sensor->latch = false;
    sensor->pulse_end_ns = HK_NEVER;
    sensor->sample_ns = HK_NEVER;
    enable_replay(sensor, false);
}

static void begin_reset(hk_virtual_mpu6050_t *sensor)
{
    load_reset_values(sensor);
    sensor->reg[HK_REG_PWR_MGMT_1] = HK_PWR_DEVICE_RESET;
    sensor->reset_start_ns = sensor->now_ns;
    sensor->reset_end_ns = sensor->now_ns + HK_RESET_NS;
}

static void clear_interrupt(hk_virtual_mpu6050_t *sensor)
{
    sensor->reg[HK_REG_INT_STATUS] = 0U;
    if ((sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_LATCH) != 0U) {
        sensor->latch = false;
    }
}

static void write_power(hk_virtual_mpu6050_t *sensor, uint8_t value)
{
    const uint8_t old = sensor->reg[HK_REG_PWR_MGMT_1];
    const bool was_asleep = asleep(sensor);

    if ((value & HK_PWR_DEVICE_RESET) != 0U) {
        begin_reset(sensor);
        return;
    }
    sensor->reg[HK_REG_PWR_MGMT_1] = value;
    if ((value & HK_PWR_CLOCK) != (old & HK_PWR_CLOCK)) {
        sensor->pll_locked_ns = sensor->now_ns + HK_PLL_NS;
    }
    if (asleep(sensor) != was_asleep) {
        restart_sampling(sensor, HK_WAKE_NS);
        if (was_asleep) {
            sensor->pll_locked_ns = sensor->now_ns + HK_WAKE_NS + HK_PLL_NS;
        }
    }
}

static void reset_signal_path(hk_virtual_mpu6050_t *sensor, uint8_t value)
{
    int i;

    if ((value & HK_SIGNAL_PATH_RESET) != 0U) {
        for (i = 0; i < HK_MPU6050_BURST_BYTES; i++) {
            sensor->reg[HK_REG_ACCEL_XOUT_H + i] = 0U;
        }
        restart_sampling(sensor, HK_WAKE_NS);
    }
}

static void set_rate_register(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    sensor->reg[address] = value;
    if (!asleep(sensor) && sensor->sample_ns != HK_NEVER) {
        restart_sampling(sensor, 0U);
    }
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

/* Writes to registers that cannot be written, or that are not modelled, are ignored. */
static void write_register(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value)
{
    switch (address) {
    case HK_REG_PWR_MGMT_1:
        write_power(sensor, value);
        break;
    case HK_REG_SIGNAL_PATH_RESET:
        reset_signal_path(sensor, value);
        break;
    case HK_REG_CONFIG:
    case HK_REG_SMPLRT_DIV:
        set_rate_register(sensor, address, value);
        break;
    case HK_REG_INT_ENABLE:
        sensor->reg[address] = value;
        enable_replay(sensor, data_ready_enabled(sensor));
        break;
    case HK_REG_INT_PIN_CFG:
        sensor->reg[address] = value;
        sensor->latch = false;
        break;
    case HK_REG_USER_CTRL:
        sensor->reg[address] = (uint8_t)(value & ~HK_USER_RESET_BITS);
        break;
    case HK_REG_GYRO_CONFIG:
    case HK_REG_ACCEL_CONFIG:
    case HK_REG_FIFO_EN:
    case HK_REG_PWR_MGMT_2:
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

static void step_pointer(hk_virtual_mpu6050_t *sensor)
{
    if (sensor->slave.pointer != HK_FIFO_DATA_REGISTER) {
        sensor->slave.pointer = (uint8_t)((sensor->slave.pointer + 1U) % HK_VIRTUAL_REGISTERS);
    }
}

/* --- Set-up and faults ---------------------------------------------------------------------- */

uint32_t hk_virtual_mpu6050_size(void)
{
    return (uint32_t)sizeof(hk_virtual_mpu6050_t);
}

void hk_virtual_mpu6050_init(hk_virtual_mpu6050_t *sensor, const double *rows, uint32_t row_count,
                             uint32_t settle, bool loop)
{
    uint8_t *faults = (uint8_t *)&sensor->faults;
    uint32_t i;

    sensor->now_ns = 0U;
    sensor->published_ns = 0U;
    sensor->reset_start_ns = 0U;
    sensor->reset_end_ns = HK_NEVER;
    sensor->pll_locked_ns = 0U;
    sensor->slave.open = false;
    sensor->slave.pointer_expected = false;
    sensor->slave.pointer = 0U;
    sensor->slave.gone = false;
    sensor->slave.bytes_read = 0U;
    sensor->replay.rows = rows;
    sensor->replay.row_count = row_count;
    sensor->replay.settle = settle;
    sensor->replay.loop = loop && row_count > 0U;
    sensor->replay.next_row = 0U;
    sensor->replay.rows_played = 0U;
    sensor->replay.lead_in_left = 0U;
    sensor->replay.running = false;
    for (i = 0U; i < sizeof sensor->faults; i++) {
        faults[i] = 0U; /* an assignment would ask for a C library */
    }
    sensor->faults.who_am_i = HK_MPU6050_ID;
    load_reset_values(sensor);
}

void hk_virtual_mpu6050_set_identity(hk_virtual_mpu6050_t *sensor, uint8_t who_am_i)
{
    sensor->faults.who_am_i = who_am_i;
    sensor->reg[HK_REG_WHO_AM_I] = who_am_i;
}

void hk_virtual_mpu6050_nack_next(hk_virtual_mpu6050_t *sensor, uint32_t addressings)
{
    sensor->faults.nack_left = addressings;
}

void hk_virtual_mpu6050_hold_sda(hk_virtual_mpu6050_t *sensor, uint32_t clocks)
{
    sensor->faults.sda_stuck_left = clocks;
}

void hk_virtual_mpu6050_set_self_test(hk_virtual_mpu6050_t *sensor, uint8_t x, uint8_t y, uint8_t z,
                                      uint8_t a)
{
    const uint8_t codes[4] = {x, y, z, a};
    int i;

    for (i = 0; i < 4; i++) {
        sensor->faults.self_test[i] = codes[i];
        sensor->reg[HK_REG_SELF_TEST_X + i] = codes[i];
    }
}

/* One bit, or several, of a register turn over, with all that a write would bring about. */
static void upset(hk_virtual_mpu6050_t *sensor, uint32_t amount)
{
    const uint8_t address = (uint8_t)(amount / 256U % HK_VIRTUAL_REGISTERS);

    write_register(sensor, address, (uint8_t)(sensor->reg[address] ^ (amount & 0xFFU)));
}

static void strike(hk_virtual_mpu6050_t *sensor, hk_fault_kind_t kind, uint32_t amount)
{
    switch (kind) {
    case HK_FAULT_NACK_ADDRESS:
        sensor->faults.nack_left = amount;
        break;
    case HK_FAULT_NACK_DATA:
        sensor->faults.nack_data_left = amount;
        break;
    case HK_FAULT_TORN_BURST:
        sensor->faults.torn = true;
        sensor->faults.torn_after = amount;
        break;
    case HK_FAULT_STUCK_SDA:
        sensor->faults.sda_stuck_left = amount;
        break;
    case HK_FAULT_CLOCK_STRETCH:
        sensor->faults.stretch_us = amount;
        break;
    case HK_FAULT_WRONG_IDENTITY:
        hk_virtual_mpu6050_set_identity(sensor, (uint8_t)amount);
        break;
    case HK_FAULT_REGISTER_UPSET:
        upset(sensor, amount);
        break;
    case HK_FAULT_SELF_RESET:
        begin_reset(sensor);
        break;
    case HK_FAULT_FROZEN_DATA:
        sensor->faults.frozen = true;
        break;
    case HK_FAULT_LOST_DATA_READY:
        sensor->faults.lost_ready_left = amount;
        break;
    case HK_FAULT_KINDS:
        break;
    }
}

/* Strike with what is planned for the row that is about to be sampled. */
static void strike_due(hk_virtual_mpu6050_t *sensor)
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

bool hk_virtual_mpu6050_plan(hk_virtual_mpu6050_t *sensor, uint32_t kind, uint32_t row,
                             uint32_t amount)
{
    hk_planned_fault_t *fault = &sensor->faults.planned[sensor->faults.planned_count];
    const bool at_once = row == 0U && kind != (uint32_t)HK_FAULT_TORN_BURST
                         && kind <= (uint32_t)HK_FAULT_WRONG_IDENTITY;

    if (sensor->faults.planned_count == HK_PLANNED_FAULTS || kind >= (uint32_t)HK_FAULT_KINDS) {
        return false;
    }
    sensor->faults.planned_count++;
    fault->kind = (hk_fault_kind_t)kind;
    fault->row = row;
    fault->amount = amount;
    fault->struck = at_once;
    if (at_once) {
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

/* --- Time ----------------------------------------------------------------------------------- */

uint64_t hk_virtual_mpu6050_next_event_ns(const hk_virtual_mpu6050_t *sensor)
{
    uint64_t next = sensor->sample_ns;

    if (sensor->reset_end_ns < next) {
        next = sensor->reset_end_ns;
    }
    if (sensor->pulse_end_ns < next) {
        next = sensor->pulse_end_ns;
    }
    return next;
}

void hk_virtual_mpu6050_advance(hk_virtual_mpu6050_t *sensor, uint64_t now_ns)
{
    for (;;) {
        const uint64_t event = hk_virtual_mpu6050_next_event_ns(sensor);

        if (event == HK_NEVER || event > now_ns) {
            break;
        }
        sensor->now_ns = event;
        if (event == sensor->reset_end_ns) {
            sensor->reset_end_ns = HK_NEVER;
            load_reset_values(sensor);
        } else if (event == sensor->pulse_end_ns) {
            sensor->pulse_end_ns = HK_NEVER;
            sensor->latch = false;
        } else {
            take_sample(sensor);
        }
    }
    if (now_ns > sensor->now_ns) {
        sensor->now_ns = now_ns;
    }
}

/* --- The bus -------------------------------------------------------------------------------- */

bool hk_virtual_mpu6050_start(hk_virtual_mpu6050_t *sensor, uint8_t address, bool read)
{
    const bool deaf =
        resetting(sensor) && sensor->now_ns < sensor->reset_start_ns + HK_RESET_DEAF_NS;

    if (address != HK_MPU6050_ADDRESS || deaf || hk_virtual_mpu6050_sda_low(sensor)) {
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
    if (!resetting(sensor)) {
        write_register(sensor, sensor->slave.pointer, byte);
    }
    step_pointer(sensor);
    return true;
}

uint8_t hk_virtual_mpu6050_read(hk_virtual_mpu6050_t *sensor)
{
    const uint8_t address = sensor->slave.pointer;
    uint8_t value;

    if (sensor->faults.torn && sensor->slave.bytes_read >= sensor->faults.torn_after) {
        sensor->faults.torn = false;
        sensor->slave.gone = true;
    }
    if (!sensor->slave.open || sensor->slave.gone) {
        return 0xFFU;
    }
    sensor->slave.bytes_read++;
    value = sensor->reg[address];
    if (address == HK_REG_INT_STATUS
        || (sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_ANY_READ) != 0U) {
        clear_interrupt(sensor);
    }
    step_pointer(sensor);
    return value;
}

void hk_virtual_mpu6050_stop(hk_virtual_mpu6050_t *sensor)
{
    sensor->slave.open = false;
    sensor->slave.pointer_expected = false;
    if (sensor->pending_full) {
        publish(sensor);
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

/* --- What the outside sees ------------------------------------------------------------------ */

bool hk_virtual_mpu6050_int_pin(const hk_virtual_mpu6050_t *sensor)
{
    const bool active_low = (sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_ACTIVE_LOW) != 0U;

    return sensor->latch != active_low;
}

uint64_t hk_virtual_mpu6050_published_ns(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->published_ns;
}

bool hk_virtual_mpu6050_exhausted(const hk_virtual_mpu6050_t *sensor)
{
    const bool unread = (sensor->reg[HK_REG_INT_STATUS] & HK_INT_DATA_READY) != 0U;

    return !sensor->replay.loop && table_ended(sensor) && !sensor->pending_full && !unread
           && !sensor->slave.open;
}

uint32_t hk_virtual_mpu6050_rows_played(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->replay.rows_played;
}

uint32_t hk_virtual_mpu6050_unread_samples(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->faults.unread_samples;
}
