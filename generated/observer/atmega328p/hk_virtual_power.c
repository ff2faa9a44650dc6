/* The virtual MPU-6050: sleep, cycle mode, clocks, standby, and resets of the signal paths. */
#include "hk_virtual_parts.h"

#define HK_CLOCK_EXTERNAL 4U /* and 5: nothing is connected there */
#define HK_CLOCK_PLL_LAST 3U
#define HK_CLOCK_STOPPED  7U
#define HK_WAKE_RATE_SHIFT 6
#define HK_STANDBY_ACCEL_X 0x20U
#define HK_STANDBY_GYRO_X  0x04U

static bool clock_runs(const hk_virtual_mpu6050_t *sensor)
{
    const uint8_t clock = sensor->reg[HK_REG_PWR_MGMT_1] & HK_PWR_CLOCK;

    return clock != HK_CLOCK_STOPPED && (clock < HK_CLOCK_EXTERNAL || clock > HK_CLOCK_EXTERNAL + 1U);
}

bool hk_virtual_asleep(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_PWR_MGMT_1] & HK_PWR_SLEEP) != 0U || !clock_runs(sensor);
}

bool hk_virtual_cycling(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_PWR_MGMT_1] & (HK_PWR_CYCLE | HK_PWR_SLEEP)) == HK_PWR_CYCLE;
}

bool hk_virtual_fast(const hk_virtual_mpu6050_t *sensor)
{
    const uint8_t low_pass = sensor->reg[HK_REG_CONFIG] & HK_CONFIG_LOW_PASS;

    return low_pass == 0U || low_pass == 7U;
}

static uint64_t wake_period_ns(uint8_t setting)
{
#define HK_CASE(rate, period_ms) \
    case rate: \
        return period_ms * HK_NS_PER_MS;
    switch (setting) {
        HK_MPU6050_WAKE_PERIODS(HK_CASE)
    default:
        return HK_NEVER;
    }
#undef HK_CASE
}

uint64_t hk_virtual_sample_period_ns(const hk_virtual_mpu6050_t *sensor)
{
    const uint64_t tick = hk_virtual_fast(sensor) ? HK_FAST_TICK_NS : HK_SLOW_TICK_NS;

    if (hk_virtual_cycling(sensor)) {
        return wake_period_ns(sensor->reg[HK_REG_PWR_MGMT_2] >> HK_WAKE_RATE_SHIFT);
    }
    return tick * (1U + (uint64_t)sensor->reg[HK_REG_SMPLRT_DIV]);
}

/* Whether a path gives new values: temperature, accelerometer or gyroscope. */
bool hk_virtual_path_works(const hk_virtual_mpu6050_t *sensor, int path)
{
    const bool no_temperature = (sensor->reg[HK_REG_PWR_MGMT_1] & HK_PWR_NO_TEMP) != 0U;

    if (sensor->now_ns < sensor->path_free_ns[path]) {
        return false;
    }
    return path == HK_PATH_ACCEL || (!hk_virtual_cycling(sensor) && path == HK_PATH_GYRO)
           || (path == HK_PATH_TEMP && !no_temperature);
}

bool hk_virtual_in_standby(const hk_virtual_mpu6050_t *sensor, int path, int axis)
{
    const unsigned x = path == HK_PATH_ACCEL ? HK_STANDBY_ACCEL_X : HK_STANDBY_GYRO_X;

    return (sensor->reg[HK_REG_PWR_MGMT_2] & (x >> axis)) != 0U;
}

void hk_virtual_restart_sampling(hk_virtual_mpu6050_t *sensor, uint64_t delay_ns)
{
    sensor->motion.settled = false;
    sensor->sample_ns = hk_virtual_asleep(sensor)
                            ? HK_NEVER
                            : sensor->now_ns + delay_ns + hk_virtual_sample_period_ns(sensor);
}

void hk_virtual_write_power(hk_virtual_mpu6050_t *sensor, uint8_t value)
{
    const uint8_t old = sensor->reg[HK_REG_PWR_MGMT_1];
    const bool was_asleep = hk_virtual_asleep(sensor);
    const bool was_cycling = hk_virtual_cycling(sensor);

    if ((value & HK_PWR_DEVICE_RESET) != 0U) {
        hk_virtual_begin_reset(sensor);
        return;
    }
    sensor->reg[HK_REG_PWR_MGMT_1] = value;
    if ((value & HK_PWR_CLOCK) != (old & HK_PWR_CLOCK)) {
        sensor->pll_locked_ns = sensor->now_ns + HK_PLL_NS;
    }
    if (hk_virtual_asleep(sensor) != was_asleep) {
        hk_virtual_restart_sampling(sensor, HK_WAKE_NS);
        if (was_asleep) {
            sensor->pll_locked_ns = sensor->now_ns + HK_WAKE_NS + HK_PLL_NS;
        }
    } else if (hk_virtual_cycling(sensor) != was_cycling) {
        hk_virtual_restart_sampling(sensor, 0U);
    }
}

/* Clear the data of a path and keep it still while it starts. */
static void reset_path(hk_virtual_mpu6050_t *sensor, int path)
{
    const uint8_t first = path == HK_PATH_ACCEL  ? HK_REG_ACCEL_XOUT_H
                          : path == HK_PATH_GYRO ? HK_REG_GYRO_XOUT_H
                                                 : HK_REG_TEMP_OUT_H;
    const int bytes = path == HK_PATH_TEMP ? 2 : 6;
    int i;

    for (i = 0; i < bytes; i++) {
        sensor->reg[first + i] = 0U;
        sensor->pending[first - HK_REG_ACCEL_XOUT_H + i] = 0U;
    }
    sensor->path_free_ns[path] = sensor->now_ns + HK_WAKE_NS;
}

void hk_virtual_reset_signal_path(hk_virtual_mpu6050_t *sensor, uint8_t paths)
{
    int path;

    for (path = 0; path < HK_PATHS; path++) {
        if ((paths & (1U << path)) != 0U) {
            reset_path(sensor, path);
        }
    }
    if ((paths & HK_SIGNAL_PATH_RESET) == HK_SIGNAL_PATH_RESET) {
        hk_virtual_restart_sampling(sensor, HK_WAKE_NS);
    }
}
