/* A board for fuzzing: see the header.
 *
 * The sensor is a file of registers that keeps what is written to it and gives new data at every
 * sample. Trouble makes transfers fail, bytes differ, time jump and announcements get lost. Every
 * frame that the firmware sends must be a valid one. */
#include "fuzz_board.h"

#include <stdlib.h>
#include <string.h>

#include "hk_design.h"
#include "hk_hal.h"
#include "hk_mavlink.h"
#include "hk_mpu6050_regs.h"

#define REGISTERS 128U
#define QUEUE     512U
#define FIFO_BYTES 1024U

static struct {
    fuzz_input_t *trouble;
    uint8_t reg[REGISTERS];
    uint32_t now_us;
    uint32_t sample_us;
    bool ready;
    uint8_t queue[QUEUE];
    size_t head;
    size_t tail;
    uint8_t store[HK_STORE_SLOTS][HK_STORE_SLOT_BYTES];
    uint8_t slot;
    uint8_t offset;
    bool replacing;
    uint32_t samples;
    uint32_t erasures;
    bool rebooted;
    mavlink_message_t message;
    mavlink_status_t status;
} board;

uint8_t fuzz_take(fuzz_input_t *input)
{
    if (input->left == 0U) {
        return 0U;
    }
    input->left--;
    return *input->data++;
}

static uint8_t trouble(void)
{
    return board.trouble == NULL ? 0U : fuzz_take(board.trouble);
}

static void reset_sensor(void)
{
    memset(board.reg, 0, sizeof board.reg);
    board.reg[HK_REG_PWR_MGMT_1] = HK_RESET_PWR_MGMT_1;
    board.reg[HK_REG_WHO_AM_I] = 0x68U;
}

void fuzz_board_start(fuzz_input_t *input)
{
    memset(&board, 0, sizeof board);
    memset(board.store, 0xFF, sizeof board.store);
    board.trouble = input;
    reset_sensor();
}

static void sample(void)
{
    uint8_t i;

    board.ready = (board.reg[HK_REG_PWR_MGMT_1] & HK_PWR_SLEEP) == 0U
                  && board.reg[HK_REG_INT_ENABLE] != 0U;
    for (i = 0U; i < HK_MPU6050_BURST_BYTES; i++) {
        board.reg[HK_REG_ACCEL_XOUT_H + i] = (uint8_t)(board.reg[HK_REG_ACCEL_XOUT_H + i] * 5U + i);
    }
    if (board.ready) {
        board.reg[HK_REG_INT_STATUS] |= HK_INT_DATA_READY;
    }
}

void fuzz_board_pass(uint32_t us)
{
    board.now_us += us;
    if (board.now_us - board.sample_us >= HK_PERIOD_US) {
        board.sample_us = board.now_us;
        sample();
    }
}

void fuzz_board_receive(const uint8_t *bytes, size_t count)
{
    size_t i;

    for (i = 0U; i < count && (board.head + 1U) % QUEUE != board.tail; i++) {
        board.queue[board.head] = bytes[i];
        board.head = (board.head + 1U) % QUEUE;
    }
}

size_t fuzz_board_unread(void)
{
    return (board.head + QUEUE - board.tail) % QUEUE;
}

uint32_t fuzz_board_samples(void)
{
    return board.samples;
}

uint32_t fuzz_board_erasures(void)
{
    return board.erasures;
}

int fuzz_board_rebooted(void)
{
    return board.rebooted ? 1 : 0;
}

/* --- The hardware layer --------------------------------------------------------------------- */

void hk_hal_init(void)
{
}

hk_reset_cause_t hk_hal_reset_cause(void)
{
    return HK_RESET_POWER;
}

void hk_hal_reboot(void)
{
    board.rebooted = true;
}

void hk_hal_watchdog_feed(void)
{
}

/* A transfer takes its time; one byte of trouble decides whether it works. */
static bool transfer(uint8_t count)
{
    const uint8_t what = trouble();

    fuzz_board_pass(25U * (count + 3U));
    if (what >= 0xF0U) {
        fuzz_board_pass((what & 0x0FU) * UINT32_C(20000));
    }
    return (what & 0x03U) != 0x03U;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    const bool good = transfer(count);

    if (good && address == HK_MPU6050_ADDRESS && count == 2U) {
        if (bytes[0] == HK_REG_PWR_MGMT_1 && (bytes[1] & HK_PWR_DEVICE_RESET) != 0U) {
            reset_sensor();
        } else if (bytes[0] < REGISTERS && bytes[0] != HK_REG_WHO_AM_I) {
            board.reg[bytes[0]] = bytes[1];
        }
    }
    return good;
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    const bool good = transfer(count) && address == HK_MPU6050_ADDRESS;
    const uint8_t differs = trouble();
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        bytes[i] = board.reg[(reg + i) % REGISTERS];
    }
    if (good && (differs & 0xC0U) == 0xC0U) {
        bytes[differs % count] ^= trouble();
    }
    if (good && reg <= HK_REG_INT_STATUS && reg + count > HK_REG_INT_STATUS) {
        board.reg[HK_REG_INT_STATUS] = 0U;
        board.ready = false;
    }
    return good;
}

void hk_hal_i2c_recover(void)
{
    fuzz_board_pass(100U);
}

uint32_t hk_hal_time_us(void)
{
    return board.now_us;
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    *time_us = board.sample_us;
    return board.ready && (trouble() & 0x1FU) != 0x1FU;
}

static void take_frame(uint8_t byte)
{
    mavlink_message_t message;
    mavlink_status_t status;
    const uint8_t result =
        mavlink_frame_char_buffer(&board.message, &board.status, byte, &message, &status);

    if (result == MAVLINK_FRAMING_BAD_CRC) {
        abort(); /* the firmware has sent a broken frame */
    }
    if (result == MAVLINK_FRAMING_OK && message.msgid == MAVLINK_MSG_ID_TILT_SAMPLE) {
        board.samples++;
    }
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t i;

    for (i = 0U; i < count; i++) {
        take_frame(bytes[i]);
    }
    return true;
}

uint8_t hk_hal_transmit_room(void)
{
    const uint8_t what = trouble();

    return (what & 0x1FU) == 0x1FU ? what : 255U;
}

bool hk_hal_receive(uint8_t *byte)
{
    if (board.head == board.tail) {
        return false;
    }
    *byte = board.queue[board.tail];
    board.tail = (board.tail + 1U) % QUEUE;
    return true;
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    if (slot >= HK_STORE_SLOTS || offset + count > (int)HK_STORE_SLOT_BYTES || board.replacing) {
        abort();
    }
    memcpy(bytes, &board.store[slot][offset], count);
}

bool hk_hal_store_busy(void)
{
    return (trouble() & 0x07U) == 0x07U;
}

void hk_hal_store_erase(uint8_t slot)
{
    if (slot >= HK_STORE_SLOTS) {
        abort();
    }
    memset(board.store[slot], 0xFF, sizeof board.store[slot]);
    board.slot = slot;
    board.offset = 0U;
    board.replacing = true;
    board.erasures++;
}

void hk_hal_store_put(uint8_t byte)
{
    if (!board.replacing || board.offset >= HK_STORE_SLOT_BYTES) {
        abort();
    }
    board.store[board.slot][board.offset++] = byte;
}

void hk_hal_store_finish(void)
{
    if (!board.replacing) {
        abort();
    }
    board.replacing = false;
}

void hk_hal_idle(void)
{
    fuzz_board_pass(HK_PERIOD_US / 4U);
}

void hk_hal_mark_begin(void)
{
}

void hk_hal_mark_end(void)
{
}
