/* The virtual MPU-6050: from a row of the table to counts in the registers. */
#include "hk_virtual_parts.h"

#define HK_GYRO_UNDEFINED 0x55U /* both bytes of a gyroscope count while the PLL settles */
#define HK_GYRO_PLACE     8     /* in a burst */
#define HK_TEMP_PLACE     6

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

static void quantise_accel(hk_virtual_mpu6050_t *sensor, const double *force, uint8_t *bytes)
{
    const uint8_t range = (sensor->reg[HK_REG_ACCEL_CONFIG] >> HK_RANGE_SHIFT) & HK_RANGE_MASK;
    int axis;

    for (axis = 0; axis < 3; axis++) {
        if (!hk_virtual_in_standby(sensor, HK_PATH_ACCEL, axis)) {
            put_big_endian(&bytes[2 * axis],
                           to_count(force[axis] * accel_counts_per_m_s2(range)
                                    + hk_virtual_accel_response(sensor, axis, range)));
        }
    }
}

static void quantise_gyro(hk_virtual_mpu6050_t *sensor, const double *rate, uint8_t *bytes)
{
    const uint8_t range = (sensor->reg[HK_REG_GYRO_CONFIG] >> HK_RANGE_SHIFT) & HK_RANGE_MASK;
    const bool settled = sensor->sample_ns >= sensor->pll_locked_ns;
    int axis;

    for (axis = 0; axis < 3; axis++) {
        if (hk_virtual_in_standby(sensor, HK_PATH_GYRO, axis)) {
            continue;
        }
        put_big_endian(&bytes[2 * axis], to_count(rate[axis] * gyro_counts_per_rad_s(range)
                                                  + hk_virtual_gyro_response(sensor, axis, range)));
        if (!settled) {
            bytes[2 * axis] = HK_GYRO_UNDEFINED;
            bytes[2 * axis + 1] = HK_GYRO_UNDEFINED;
        }
    }
}

/* Make counts of a row. What does not work, or stands by, keeps the counts of the sample before. */
void hk_virtual_quantise(hk_virtual_mpu6050_t *sensor, const double *row, uint8_t *burst)
{
    if (hk_virtual_path_works(sensor, HK_PATH_ACCEL)) {
        quantise_accel(sensor, &row[3], burst);
    }
    if (hk_virtual_path_works(sensor, HK_PATH_GYRO)) {
        quantise_gyro(sensor, row, &burst[HK_GYRO_PLACE]);
    }
    if (hk_virtual_path_works(sensor, HK_PATH_TEMP)) {
        put_big_endian(&burst[HK_TEMP_PLACE], to_count(row[6] * HK_TEMPERATURE_COUNTS_PER_DEG_C
                                                       - HK_TEMPERATURE_OFFSET_COUNTS));
    }
}

static bool data_ready_enabled(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_INT_ENABLE] & HK_INT_DATA_READY) != 0U;
}

/* The table begins with data-ready and, where the FIFO is on, with something to enter it; it pauses
 * without data-ready only. */
void hk_virtual_enable_replay(hk_virtual_mpu6050_t *sensor)
{
    const bool enters = !hk_virtual_fifo_enabled(sensor) || sensor->reg[HK_REG_FIFO_EN] != 0U;
    const bool begins = data_ready_enabled(sensor) && enters && !sensor->replay.running;

    if (begins) {
        sensor->replay.lead_in_left = sensor->replay.settle;
    }
    sensor->replay.running = data_ready_enabled(sensor) && (begins || sensor->replay.running);
}

/* Move the waiting burst into the registers and raise data-ready. */
void hk_virtual_publish(hk_virtual_mpu6050_t *sensor)
{
    const bool in_fifo = hk_virtual_fifo_enabled(sensor);
    int i;

    for (i = 0; i < HK_MPU6050_BURST_BYTES; i++) {
        sensor->reg[HK_REG_ACCEL_XOUT_H + i] = sensor->pending[i];
    }
    sensor->pending_full = false;
    if (!sensor->pending_ready) {
        return;
    }
    if ((sensor->reg[HK_REG_INT_STATUS] & HK_INT_DATA_READY) != 0U && !in_fifo) {
        sensor->faults.unread_samples++;
    }
    hk_virtual_interrupt(sensor, HK_INT_DATA_READY);
}

/* The row of this sample; false when the table has ended. */
static bool take_row(hk_virtual_mpu6050_t *sensor, double *row)
{
    hk_replay_t *replay = &sensor->replay;
    const double *from;
    int i;

    if (replay->loop && replay->next_row >= replay->row_count) {
        replay->next_row = 0U;
    }
    if (replay->next_row >= replay->row_count) {
        return false;
    }
    from = &replay->rows[(uint64_t)replay->next_row * HK_ROW_VALUES];
    for (i = 0; i < HK_ROW_VALUES; i++) {
        row[i] = from[i];
    }
    if (!replay->running) {
        return true;
    }
    if (replay->lead_in_left > 0U) {
        replay->lead_in_left--;
        return true;
    }
    replay->next_row++;
    replay->rows_played++;
    return true;
}

static bool next_row(hk_virtual_mpu6050_t *sensor, double *row)
{
    return hk_virtual_feels_motion(sensor) ? hk_virtual_motion_row(sensor, row)
                                           : take_row(sensor, row);
}

static void measure(hk_virtual_mpu6050_t *sensor, const double *row)
{
    uint8_t before[HK_MPU6050_BURST_BYTES];
    int i;

    for (i = 0; i < HK_MPU6050_BURST_BYTES; i++) {
        before[i] = sensor->pending[i];
    }
    if (!sensor->faults.frozen) {
        hk_virtual_quantise(sensor, row, sensor->pending);
        hk_virtual_spoil(sensor, before, sensor->pending);
    }
}

void hk_virtual_take_sample(hk_virtual_mpu6050_t *sensor)
{
    double row[HK_ROW_VALUES];

    hk_virtual_strike_due(sensor);
    if (sensor->sample_ns != sensor->now_ns) {
        return; /* a fault has stopped the sampling, or changed its rate */
    }
    if (!next_row(sensor, row)) {
        sensor->sample_ns = HK_NEVER;
        return;
    }
    if (sensor->pending_full && !hk_virtual_fifo_enabled(sensor)) {
        sensor->faults.unread_samples++;
    }
    measure(sensor, row);
    hk_virtual_fifo_take(sensor, sensor->pending);
    sensor->pending_full = true;
    sensor->pending_ready = data_ready_enabled(sensor);
    /* The registers are refreshed only while the serial interface is idle. */
    if (!sensor->slave.open) {
        hk_virtual_publish(sensor);
    }
    sensor->sample_ns += hk_virtual_sample_period_ns(sensor);
}
