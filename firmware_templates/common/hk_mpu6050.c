/* Driver of the MPU-6050: see the header. */
#include "hk_mpu6050.h"

#include <stddef.h>

#include "hk_design.h"
#include "hk_flash.h"
#include "hk_hal.h"

#define HK_MS UINT32_C(1000)

#define HK_IDENTIFY_TRIES   5U
#define HK_IDENTIFY_GAP_US  (10U * HK_MS)
#define HK_RESET_WAIT_US    (100U * HK_MS)
#define HK_RESET_POLL_US    (10U * HK_MS)
#define HK_RESET_GIVE_UP_US (1000U * HK_MS)
#define HK_WAKE_WAIT_US     (100U * HK_MS)
#define HK_RETRY_US         (1000U * HK_MS)
#define HK_FAILURES_MAX     10U
/* A sample that has not been announced by then is looked for, and again after each gap. */
#define HK_OVERDUE_US  (HK_PERIOD_US + HK_PERIOD_US / 2U)
#define HK_POLL_GAP_US (HK_PERIOD_US / 8U)
/* Where INT is not to be relied on, look from a little before the next sample is due. */
#define HK_POLL_US     (HK_PERIOD_US - HK_POLL_GAP_US)
/* Several periods without a sample: the sensor has stopped. */
#define HK_SILENCE_US (8U * HK_PERIOD_US + 20U * HK_MS)
/* After so long a gap the filter begins anew; shorter ones are bridged. */
#define HK_GAP_US (4U * HK_PERIOD_US + HK_PERIOD_US / 2U)
#define HK_CHECK_US (100U * HK_MS)

typedef struct {
    uint8_t address;
    uint8_t value;
} hk_register_write_t;

#define HK_REGISTER_WRITE(register_address, register_value) \
    {.address = (register_address), .value = (register_value)},
static const hk_register_write_t hk_configuration[] = {
    HK_SENSOR_CONFIGURATION(HK_REGISTER_WRITE) HK_VARIANT_CONFIGURATION(HK_REGISTER_WRITE)};
#define HK_ALL_STEPS     ((uint8_t)(sizeof hk_configuration / sizeof hk_configuration[0]))
#define HK_ONE_MORE(register_address, register_value) +1U
#define HK_VARIANT_STEPS ((uint8_t)(0U HK_VARIANT_CONFIGURATION(HK_ONE_MORE)))

/* The four registers that say what a count means, one behind the other. */
#define HK_SCALE_REGISTERS 4U

typedef struct {
    uint8_t who_am_i;
    bool accepted;
    bool warned;
    bool own_accel_filter;
} hk_identity_t;

#define HK_IDENTITY(value, name, is_accepted, is_warned, has_own_accel_filter) \
    {.who_am_i = (value), .accepted = (is_accepted), .warned = (is_warned), \
     .own_accel_filter = (has_own_accel_filter)},
static const hk_identity_t hk_identities[] = {HK_MPU6050_IDENTITIES(HK_IDENTITY)};
#define HK_IDENTITIES ((uint8_t)(sizeof hk_identities / sizeof hk_identities[0]))

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

static void count_one(uint16_t *counter)
{
    if (*counter < UINT16_MAX) {
        (*counter)++;
    }
}

static void count_error(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind)
{
    count_one(&sensor->errors);
    count_one(&sensor->count[kind]);
    if (kind != HK_MPU6050_TRANSFER) {
        sensor->untold |= (uint16_t)(1U << kind);
    }
}

/* Free the bus and begin again. */
static void restart(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us)
{
    count_error(sensor, kind);
    sensor->failures = 0U;
    hk_hal_i2c_recover();
    enter(sensor, HK_MPU6050_IDENTIFY, now_us);
}

/* A failed transfer frees the bus and may be tried again; after too many in a row begin again. */
static void fail(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us)
{
    sensor->failures++;
    if (sensor->failures > HK_FAILURES_MAX) {
        restart(sensor, HK_MPU6050_DEAD_BUS, now_us);
    } else {
        count_error(sensor, kind);
        hk_hal_i2c_recover();
    }
}

/* Take note of a transfer. Returns whether it was good. */
static bool check(hk_mpu6050_t *sensor, bool good, uint32_t now_us)
{
    if (good) {
        sensor->failures = 0U;
    } else {
        fail(sensor, HK_MPU6050_TRANSFER, now_us);
    }
    return good;
}

/* What is known of an identity; NULL if nothing is. */
static const hk_identity_t *identity_of(uint8_t who_am_i)
{
    uint8_t i;

    for (i = 0U; i < HK_IDENTITIES; i++) {
        if (hk_identities[i].who_am_i == who_am_i) {
            return &hk_identities[i];
        }
    }
    return NULL;
}

/* How many registers of the table this part has. */
static uint8_t configuration_steps(const hk_mpu6050_t *sensor)
{
    const hk_identity_t *identity = identity_of(sensor->who_am_i);

    return identity != NULL && identity->own_accel_filter
               ? HK_ALL_STEPS
               : (uint8_t)(HK_ALL_STEPS - HK_VARIANT_STEPS);
}

/* Accept or refuse the identity that was read; a variant is told once. */
static bool accept(hk_mpu6050_t *sensor, uint8_t who_am_i)
{
    const hk_identity_t *identity = identity_of(who_am_i);

    sensor->who_am_i = who_am_i;
    if (identity == NULL || !identity->accepted) {
        return false;
    }
    if (identity->warned && sensor->count[HK_MPU6050_VARIANT] == 0U) {
        count_one(&sensor->count[HK_MPU6050_VARIANT]);
        sensor->untold |= (uint16_t)(1U << HK_MPU6050_VARIANT);
    }
    return true;
}

static hk_mpu6050_event_t identify(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t identity = 0U;

    if (sensor->step > 0U && !waited(sensor, now_us, HK_IDENTIFY_GAP_US)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->since_us = now_us;
    if (!read_register(HK_REG_WHO_AM_I, &identity)) {
        count_error(sensor, HK_MPU6050_TRANSFER);
        hk_hal_i2c_recover();
        identity = 0U;
    }
    if (accept(sensor, identity)) {
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
        restart(sensor, HK_MPU6050_SILENT, now_us);
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
    if (sensor->step == configuration_steps(sensor)) {
        enter(sensor, HK_MPU6050_VERIFY, now_us);
    }
}

/* Begin again, for a register is not as it was set. Asleep or resetting: it lost them all. */
static void wrong_register(hk_mpu6050_t *sensor, uint8_t address, uint8_t value, uint32_t now_us)
{
    const uint8_t lost = HK_PWR_DEVICE_RESET | HK_PWR_SLEEP;
    uint8_t power = 0U;

    sensor->bad_register = address;
    sensor->bad_value = value;
    if (address != HK_REG_PWR_MGMT_1 && read_register(HK_REG_PWR_MGMT_1, &power)
        && (power & lost) != 0U) {
        restart(sensor, HK_MPU6050_SELF_RESET, now_us);
    } else {
        restart(sensor, HK_MPU6050_REGISTER, now_us);
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
        wrong_register(sensor, write->address, value, now_us);
        return;
    }
    sensor->step++;
    if (sensor->step == configuration_steps(sensor)) {
        enter(sensor, HK_MPU6050_ENABLE, now_us);
    }
}

static hk_mpu6050_event_t enable(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t stale = 0U;

    if (!check(sensor, read_register(HK_REG_INT_STATUS, &stale), now_us)) {
        return HK_MPU6050_NOTHING;
    }
    (void)hk_hal_data_ready(&sensor->ready_us); /* a pin that is up by now is stuck */
    if (!check(sensor, write_register(HK_REG_INT_ENABLE, HK_INT_DATA_READY), now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->to_drop = HK_SETTLE_SAMPLES;
    sensor->owed = false;
    sensor->overdue = false;
    sensor->polling = false;
    sensor->equal = 0U;
    sensor->poll_us = now_us;
    sensor->check_us = now_us;
    enter(sensor, HK_MPU6050_SETTLE, now_us);
    return HK_MPU6050_STARTED;
}

/* --- Checks while it runs ------------------------------------------------------------------- */

/* What a register of the table holds while the sensor runs; behind the table comes the clock. */
static hk_register_write_t running_value(const hk_mpu6050_t *sensor)
{
    hk_register_write_t wanted = {.address = HK_REG_PWR_MGMT_1, .value = HK_PWR_CLOCK_PLL};

    if (sensor->check_step < configuration_steps(sensor)) {
        wanted = hk_configuration[sensor->check_step];
    }
    if (wanted.address == HK_REG_INT_ENABLE) {
        wanted.value = HK_INT_DATA_READY;
    }
    return wanted;
}

/* Read the next register back. Returns whether it is as it was set. */
static bool next_register_holds(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const hk_register_write_t wanted = running_value(sensor);
    uint8_t value = 0U;

    if (!check(sensor, read_register(wanted.address, &value), now_us)) {
        return false;
    }
    if (value != wanted.value) {
        wrong_register(sensor, wanted.address, value, now_us);
        return false;
    }
    sensor->check_us = now_us;
    sensor->check_step = sensor->check_step < configuration_steps(sensor)
                             ? (uint8_t)(sensor->check_step + 1U)
                             : 0U;
    return true;
}

/* Read the registers back that give the counts their meaning. Returns whether they are as set. */
static bool scale_holds(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint8_t found[HK_SCALE_REGISTERS];
    uint8_t step;

    if (!check(sensor,
               hk_hal_i2c_read(HK_MPU6050_ADDRESS, HK_REG_SMPLRT_DIV, found, sizeof found),
               now_us)) {
        return false;
    }
    for (step = 0U; step < HK_ALL_STEPS; step++) {
        const hk_register_write_t *write = &hk_configuration[step];
        const uint8_t place = (uint8_t)(write->address - HK_REG_SMPLRT_DIV);

        if (place < HK_SCALE_REGISTERS && found[place] != write->value) {
            wrong_register(sensor, write->address, found[place], now_us);
            return false;
        }
    }
    return true;
}

static bool registers_hold(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (!scale_holds(sensor, now_us)) {
        return false;
    }
    return now_us - sensor->check_us < HK_CHECK_US || next_register_holds(sensor, now_us);
}

/* --- Samples -------------------------------------------------------------------------------- */

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
    return hk_hal_data_ready(time_us) && *time_us != sensor->ready_us;
}

/* Whether to read the sensor now, and at what time its sample was there. */
static bool worth_reading(hk_mpu6050_t *sensor, uint32_t now_us, uint32_t *time_us)
{
    if (announced(sensor, time_us)) {
        sensor->ready_us = *time_us;
        sensor->owed = true;
        sensor->overdue = false;
        sensor->polling = false;
        return true;
    }
    *time_us = sensor->ready_us;
    if (sensor->owed) {
        return true;
    }
    *time_us = now_us;
    if (!waited(sensor, now_us, sensor->polling ? HK_POLL_US : HK_OVERDUE_US)) {
        return false;
    }
    sensor->overdue = true;
    if (now_us - sensor->poll_us < HK_POLL_GAP_US) {
        return false;
    }
    sensor->poll_us = now_us;
    return true;
}

/* The status, one sample, and one more register, all in one transaction. That register always reads
 * 0; where the sensor lets go of the bus on the way, it reads all ones. */
#define HK_BURST_FIRST  HK_REG_INT_STATUS
#define HK_BURST_LENGTH (1U + HK_MPU6050_BURST_BYTES + 1U)

/* Read a sample. Returns whether it is a new one, read whole, by a sensor that is set up. */
static bool read_sample(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *burst)
{
    if (!check(sensor, hk_hal_i2c_read(HK_MPU6050_ADDRESS, HK_BURST_FIRST, burst, HK_BURST_LENGTH),
               now_us)) {
        return false;
    }
    if (burst[HK_BURST_LENGTH - 1U] == 0xFFU) {
        sensor->owed = true; /* the status is clear by now, the sample still there */
        fail(sensor, HK_MPU6050_TORN, now_us);
        return false;
    }
    if (!sensor->owed && (burst[0] & HK_INT_DATA_READY) == 0U) {
        (void)(scale_holds(sensor, now_us) && next_register_holds(sensor, now_us));
        return false;
    }
    if (!sensor->owed && !sensor->polling) {
        sensor->polling = true;
        count_error(sensor, HK_MPU6050_LOST_READY);
    }
    sensor->owed = true;
    return registers_hold(sensor, now_us);
}

/* Compare a sample with the one before. Returns whether it is measured, as far as one can tell. */
static bool is_alive(hk_mpu6050_t *sensor, const uint8_t *data, uint32_t now_us)
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
    restart(sensor, HK_MPU6050_FROZEN, now_us);
    return false;
}

static hk_mpu6050_event_t run(hk_mpu6050_t *sensor, uint32_t now_us, hk_mpu6050_sample_t *sample)
{
    uint8_t burst[HK_BURST_LENGTH];

    if (waited(sensor, now_us, HK_SILENCE_US)) {
        restart(sensor, HK_MPU6050_SILENT, now_us);
        return HK_MPU6050_NOTHING;
    }
    if (!worth_reading(sensor, now_us, &sample->time_us) || !read_sample(sensor, now_us, burst)
        || !is_alive(sensor, &burst[1], now_us)) {
        return HK_MPU6050_NOTHING;
    }
    sensor->owed = false;
    sensor->overdue = false;
    sensor->since_us = now_us;
    sample->after_gap = sample->time_us - sensor->sample_us > HK_GAP_US;
    sensor->sample_us = sample->time_us;
    if (sensor->to_drop > 0U) {
        sensor->to_drop--;
        return HK_MPU6050_NOTHING;
    }
    sensor->state = HK_MPU6050_RUN;
    unpack(&burst[1], sample);
    return HK_MPU6050_SAMPLE;
}

void hk_mpu6050_init(hk_mpu6050_t *sensor, uint32_t now_us)
{
    static const hk_mpu6050_t blank = {0};

    *sensor = blank;
    sensor->reset_us = now_us;
    sensor->ready_us = now_us;
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
    case HK_MPU6050_REFUSED:
        return true;
    case HK_MPU6050_SETTLE:
    case HK_MPU6050_RUN:
        return !sensor->owed && !sensor->overdue && !sensor->polling;
    case HK_MPU6050_RESET:
    case HK_MPU6050_WAKE:
    case HK_MPU6050_CONFIGURE:
    case HK_MPU6050_VERIFY:
    case HK_MPU6050_ENABLE:
        break;
    }
    return false;
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
