/* The hardware layer on a host: see hk_hal.h and hk_host_board.h. */
#include "hk_hal.h"

#include <signal.h>
#include <time.h>

#include "hk_host_board.h"
#include "hk_host_link.h"
#include "hk_host_store.h"
#include "hk_virtual_mpu6050.h"

#define HK_NS_PER_S   UINT64_C(1000000000)
#define HK_BIT_NS     UINT64_C(2500) /* 400 kHz */
#define HK_TICK_NS    UINT64_C(10000000) /* longest sleep */
#define HK_POLL_NS    UINT64_C(10000)    /* a turn of the main loop that does not sleep */
#define HK_TIMEOUT_NS UINT64_C(1000000)
#define HK_STALL_NS   (5U * HK_NS_PER_S)
#define HK_WATCHDOG_NS (2U * HK_NS_PER_S)
#define HK_RECOVERY_CLOCKS 9

static struct {
    hk_virtual_mpu6050_t sensor;
    hk_host_options_t options;
    uint64_t now_ns;
    uint64_t reset_ns; /* when the processor started last; its clock counts from there */
    uint64_t fed_ns;   /* when the watchdog was fed last */
    hk_reset_cause_t cause;
    uint32_t resets;
    uint64_t progress_ns; /* when the last row was taken */
    uint32_t progress_row;
    bool faults_armed;
    bool idled; /* since the main loop began its turn */
    bool ended;
    bool stalled;
    struct timespec start;
} board;

static volatile sig_atomic_t stop_requested;

jmp_buf hk_host_reset_vector;

uint64_t hk_host_board_now_ns(void)
{
    return board.now_ns;
}

/* The supply of the sensor fails and comes back: what it did on the bus ends, and it resets. */
static void power_cycle_sensor(void)
{
    hk_virtual_mpu6050_stop(&board.sensor);
    hk_virtual_mpu6050_nack_next(&board.sensor, 0U);
    hk_virtual_mpu6050_hold_sda(&board.sensor, 0U);
    (void)hk_virtual_mpu6050_start(&board.sensor, HK_MPU6050_ADDRESS, false);
    (void)hk_virtual_mpu6050_write(&board.sensor, HK_REG_PWR_MGMT_1);
    (void)hk_virtual_mpu6050_write(&board.sensor, HK_PWR_DEVICE_RESET);
    hk_virtual_mpu6050_stop(&board.sensor);
}

void hk_host_board_restart(hk_reset_cause_t cause)
{
    board.cause = cause;
    board.resets++;
    board.reset_ns = board.now_ns;
    board.fed_ns = board.now_ns;
    if (cause == HK_RESET_POWER) {
        power_cycle_sensor();
    } else {
        hk_virtual_mpu6050_stop(&board.sensor); /* the bus is let go */
    }
    hk_host_link_drop(board.now_ns);
    longjmp(hk_host_reset_vector, 1);
}

static void arm_faults(void)
{
    if (board.faults_armed
        || hk_virtual_mpu6050_rows_played(&board.sensor) < board.options.fault_row) {
        return;
    }
    board.faults_armed = true;
    hk_virtual_mpu6050_nack_next(&board.sensor, board.options.nack);
    hk_virtual_mpu6050_hold_sda(&board.sensor, board.options.hold_sda);
}

static void watch_progress(void)
{
    const uint32_t row = hk_virtual_mpu6050_rows_played(&board.sensor);

    if (row != board.progress_row) {
        board.progress_row = row;
        board.progress_ns = board.now_ns;
    }
    if (board.options.realtime) {
        return;
    }
    if (hk_virtual_mpu6050_exhausted(&board.sensor)) {
        board.ended = true;
    } else if (board.now_ns - board.progress_ns > HK_STALL_NS) {
        board.ended = true;
        board.stalled = true;
    }
}

static void pass(uint64_t ns)
{
    board.now_ns += ns;
    hk_virtual_mpu6050_advance(&board.sensor, board.now_ns);
    if (board.now_ns - board.fed_ns > HK_WATCHDOG_NS) {
        hk_host_board_restart(HK_RESET_WATCHDOG);
    }
}

static void sleep_until_now(void)
{
    struct timespec until = board.start;
    const uint64_t ns = board.now_ns + (uint64_t)board.start.tv_nsec;

    until.tv_sec += (time_t)(ns / HK_NS_PER_S);
    until.tv_nsec = (long)(ns % HK_NS_PER_S);
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
}

bool hk_host_board_init(const hk_host_options_t *options)
{
    uint32_t i;

    board.options = *options;
    hk_virtual_mpu6050_init(&board.sensor, options->rows, options->row_count, options->settle,
                            options->realtime);
    if (options->who_am_i >= 0) {
        hk_virtual_mpu6050_set_identity(&board.sensor, (uint8_t)options->who_am_i);
    }
    for (i = 0U; i < options->fault_count; i++) {
        const hk_host_fault_t *fault = &options->faults[i];

        (void)hk_virtual_mpu6050_plan(&board.sensor, fault->kind, fault->row, fault->amount);
    }
    (void)clock_gettime(CLOCK_MONOTONIC, &board.start);
    arm_faults();
    if (options->realtime) {
        hk_host_link_listen();
    }
    return hk_host_link_play(options->received)
           && hk_host_store_open(options->store, options->power_cut);
}

/* A turn of the main loop in which the firmware did not sleep takes its time too. */
static void end_turn(void)
{
    if (!board.idled) {
        arm_faults();
        watch_progress();
        pass(HK_POLL_NS);
        if (board.options.realtime) {
            sleep_until_now();
        }
    }
    board.idled = false;
}

bool hk_host_board_finished(void)
{
    end_turn();
    if (board.ended || stop_requested != 0) {
        (void)hk_host_link_flush();
        return true;
    }
    return false;
}

void hk_host_board_stop(void)
{
    stop_requested = 1;
}

hk_host_statistics_t hk_host_board_statistics(void)
{
    const hk_host_statistics_t statistics = {
        .rows_played = hk_virtual_mpu6050_rows_played(&board.sensor),
        .unread_samples = hk_virtual_mpu6050_unread_samples(&board.sensor),
        .resets = board.resets,
        .struck = hk_virtual_mpu6050_struck(&board.sensor),
        .stalled = board.stalled,
        .time_s = (double)board.now_ns / (double)HK_NS_PER_S,
    };

    return statistics;
}

void hk_hal_init(void)
{
    board.fed_ns = board.now_ns;
}

hk_reset_cause_t hk_hal_reset_cause(void)
{
    return board.cause;
}

void hk_hal_reboot(void)
{
    hk_host_board_restart(HK_RESET_REQUEST);
}

void hk_hal_watchdog_feed(void)
{
    board.fed_ns = board.now_ns;
}

/* Let the time of some bits pass; false if the sensor holds the clock for too long. */
static bool bits(uint64_t count)
{
    const uint64_t held_ns = hk_virtual_mpu6050_stretch_ns(&board.sensor);

    pass(held_ns > HK_TIMEOUT_NS ? HK_TIMEOUT_NS : held_ns + count * HK_BIT_NS);
    return held_ns <= HK_TIMEOUT_NS;
}

/* Address the sensor: a START takes one bit time, a byte nine. */
static bool address_sensor(uint8_t address, bool read)
{
    if (hk_virtual_mpu6050_sda_low(&board.sensor)) {
        pass(HK_TIMEOUT_NS); /* no START is possible */
        return false;
    }
    return bits(10U) && hk_virtual_mpu6050_start(&board.sensor, address, read);
}

static bool write_byte(uint8_t byte)
{
    return bits(9U) && hk_virtual_mpu6050_write(&board.sensor, byte);
}

static bool release(bool good)
{
    pass(HK_BIT_NS);
    hk_virtual_mpu6050_stop(&board.sensor);
    return good;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    bool good = address_sensor(address, false);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = write_byte(bytes[i]);
    }
    return release(good);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    bool good = address_sensor(address, false) && write_byte(reg) && address_sensor(address, true);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = bits(9U);
        bytes[i] = good ? hk_virtual_mpu6050_read(&board.sensor) : 0U;
    }
    return release(good);
}

void hk_hal_i2c_recover(void)
{
    int i;

    for (i = 0; i < HK_RECOVERY_CLOCKS && hk_virtual_mpu6050_sda_low(&board.sensor); i++) {
        pass(4U * HK_BIT_NS);
        hk_virtual_mpu6050_clock(&board.sensor);
    }
    (void)release(true);
}

uint32_t hk_hal_time_us(void)
{
    return (uint32_t)((board.now_ns - board.reset_ns) / 1000U);
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    const uint64_t published_ns = hk_virtual_mpu6050_published_ns(&board.sensor);

    *time_us = (uint32_t)((published_ns - board.reset_ns) / 1000U);
    return hk_virtual_mpu6050_int_pin(&board.sensor);
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    hk_host_link_put(bytes, count);
    return true;
}

uint8_t hk_hal_transmit_room(void)
{
    return UINT8_MAX; /* the host's queue is as long as it takes */
}

bool hk_hal_receive(uint8_t *byte)
{
    return hk_host_link_take(board.now_ns, byte);
}

void hk_hal_idle(void)
{
    uint64_t until = hk_virtual_mpu6050_next_event_ns(&board.sensor);

    board.idled = true;
    arm_faults();
    watch_progress();
    if (hk_virtual_mpu6050_int_pin(&board.sensor)) {
        pass(HK_POLL_NS);
        return;
    }
    if (until > board.now_ns + HK_TICK_NS) {
        until = board.now_ns + HK_TICK_NS;
    }
    if (until > hk_host_link_next_ns()) {
        until = hk_host_link_next_ns();
    }
    if (until < board.now_ns + HK_POLL_NS) {
        until = board.now_ns + HK_POLL_NS; /* a byte that waits does not hold the time up */
    }
    if (board.options.realtime && !hk_host_link_flush()) {
        board.ended = true; /* nobody reads any more */
    }
    pass(until - board.now_ns);
    if (board.options.realtime) {
        sleep_until_now();
    }
}

void hk_hal_mark_begin(void)
{
}

void hk_hal_mark_end(void)
{
}
