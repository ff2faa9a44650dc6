/* MAVLink 2 frames: see the header. The layout is that of "Packet Serialization" in MAVLink's guide:
 * magic, payload length, two sets of flags, sequence number, system, component, identity in three
 * bytes, payload without the zeros at its end, checksum. */
#include "hk_link.h"

#include "hk_crc.h"
#include "hk_design.h"
#include "hk_hal.h"

#define HK_HEADER_BYTES 10U
#define HK_CRC_BYTES    2U

void hk_link_init(hk_link_t *link, uint8_t system_id)
{
    link->system_id = system_id;
    link->sequence = 0U;
}

bool hk_link_has_room(uint8_t payload_bytes)
{
    return hk_hal_transmit_room() >= payload_bytes + HK_FRAME_OVERHEAD;
}

/* A payload loses the zeros at its end, but not its first byte. */
static uint8_t trimmed(const uint8_t *payload, uint8_t length)
{
    while (length > 1U && payload[length - 1U] == 0U) {
        length--;
    }
    return length;
}

static uint16_t checksum(uint16_t crc, const uint8_t *bytes, uint8_t count)
{
    uint8_t i;

    for (i = 0U; i < count; i++) {
        crc = hk_crc(crc, bytes[i]);
    }
    return crc;
}

/* The flags that one must understand. */
static uint8_t flags_of(const hk_link_t *link)
{
#if HK_SIGNING
    return link->signing.active ? HK_SIGNED : 0U;
#else
    (void)link;
    return 0U;
#endif
}

/* Sign a frame whose checksum is set, if frames are signed. Returns the bytes behind the payload. */
static uint8_t finish(hk_link_t *link, const uint8_t *header, const uint8_t *payload, uint8_t *tail)
{
#if HK_SIGNING
    const hk_signed_frame_t frame = {.header = header, .payload = payload, .tail = tail};

    if (link->signing.active) {
        hk_signing_sign(&link->signing, &frame, hk_hal_time_us());
        return HK_TAIL_BYTES;
    }
#else
    (void)link;
    (void)header;
    (void)payload;
    (void)tail;
#endif
    return HK_CRC_BYTES;
}

bool hk_link_send(hk_link_t *link, uint16_t id, uint8_t crc_extra, const void *payload,
                  uint8_t length)
{
    const uint8_t sent = trimmed(payload, length);
    const uint8_t header[HK_HEADER_BYTES] = {
        MAVLINK_STX, sent, flags_of(link), 0U, link->sequence, link->system_id, HK_COMPONENT_ID,
        (uint8_t)(id & 0xFFU), (uint8_t)(id >> 8), 0U};
    uint16_t crc;
    uint8_t end[HK_SIGNING ? HK_TAIL_BYTES : HK_CRC_BYTES];

    if (!hk_link_has_room(sent)) {
        return false;
    }
    crc = checksum(HK_CRC_START, &header[1], HK_HEADER_BYTES - 1U); /* without the magic */
    crc = hk_crc(checksum(crc, payload, sent), crc_extra);
    end[0] = (uint8_t)(crc & 0xFFU);
    end[1] = (uint8_t)(crc >> 8);
    link->sequence++;
    return hk_hal_transmit(header, sizeof header) && hk_hal_transmit(payload, sent)
           && hk_hal_transmit(end, finish(link, header, payload, end));
}
