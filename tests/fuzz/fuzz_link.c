/* Fuzz the receive path: the input is what a link brings, noise and frames with valid checksums.
 *
 * A record is a kind, a length and so many bytes. Kind 0 is noise; every other kind is a message
 * that the firmware knows, whose payload the bytes are. */
#include <stdlib.h>

#include "fuzz_board.h"
#include "hk_app.h"
#include "hk_design.h"
#include "hk_hal.h"
#include "hk_mavlink.h"

#define HEADER_BYTES   10U
#define CHECKSUM_BYTES 2U
#define TURNS          8
#define TURNS_AFTER    400

static const uint32_t KINDS[] = {
    MAVLINK_MSG_ID_PARAM_REQUEST_READ, MAVLINK_MSG_ID_PARAM_REQUEST_LIST, MAVLINK_MSG_ID_PARAM_SET,
    MAVLINK_MSG_ID_COMMAND_LONG,       MAVLINK_MSG_ID_TIMESYNC,           MAVLINK_MSG_ID_PING,
    MAVLINK_MSG_ID_HEARTBEAT};
#define KIND_COUNT (sizeof KINDS / sizeof KINDS[0])

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void turn(hk_app_t *app)
{
    if (hk_app_poll(app)) {
        hk_hal_idle();
    } else {
        fuzz_board_pass(10U);
    }
}

/* Send a frame of MAVLink 2 from a ground station. */
static void send(uint32_t id, const uint8_t *payload, uint8_t count)
{
    const mavlink_msg_entry_t *entry = mavlink_get_msg_entry(id);
    uint8_t frame[HEADER_BYTES + 255U + CHECKSUM_BYTES] = {
        MAVLINK_STX, count, 0U, 0U, 0U, 255U, 190U, (uint8_t)id, (uint8_t)(id >> 8),
        (uint8_t)(id >> 16)};
    uint16_t crc;
    uint8_t i;

    for (i = 0U; i < count; i++) {
        frame[HEADER_BYTES + i] = payload[i];
    }
    crc = crc_calculate(&frame[1], (uint16_t)(HEADER_BYTES - 1U + count));
    crc_accumulate(entry == NULL ? 0U : entry->crc_extra, &crc);
    frame[HEADER_BYTES + count] = (uint8_t)crc;
    frame[HEADER_BYTES + count + 1U] = (uint8_t)(crc >> 8);
    fuzz_board_receive(frame, HEADER_BYTES + count + CHECKSUM_BYTES);
}

static void receive(fuzz_input_t *input)
{
    const uint8_t kind = fuzz_take(input);
    uint8_t bytes[255];
    uint8_t count = fuzz_take(input);
    uint8_t i;

    if (count > input->left) {
        count = (uint8_t)input->left;
    }
    for (i = 0U; i < count; i++) {
        bytes[i] = fuzz_take(input);
    }
    if (kind % (KIND_COUNT + 1U) == 0U) {
        fuzz_board_receive(bytes, count);
    } else {
        send(KINDS[kind % (KIND_COUNT + 1U) - 1U], bytes, count);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t input = {.data = data, .left = size};
    hk_app_t app;
    int i;

    fuzz_board_start(NULL);
    hk_app_init(&app);
    while (fuzz_board_samples() == 0U) {
        turn(&app);
    }
    while (input.left > 0U && !fuzz_board_rebooted()) {
        receive(&input);
        for (i = 0; i < TURNS; i++) {
            turn(&app);
        }
    }
    for (i = 0; i < TURNS_AFTER && !fuzz_board_rebooted(); i++) {
        turn(&app);
    }
    if (fuzz_board_unread() > 0U && !fuzz_board_rebooted()) {
        abort(); /* the receiver has stopped */
    }
    return 0;
}
