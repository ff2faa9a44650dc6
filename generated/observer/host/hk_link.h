/* Makes MAVLink 2 frames and queues them. */
#ifndef HK_LINK_H
#define HK_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_mavlink.h"
#include "hk_signing.h"

/* Bytes of a frame around its payload, at most. */
#define HK_FRAME_OVERHEAD (12U + HK_SIGNING * HK_SIGNATURE_BYTES)

typedef struct {
    uint8_t system_id;
    uint8_t sequence; /* of the next frame; only frames that are queued are counted */
#if HK_SIGNING
    hk_signing_t signing; /* begins with hk_signing_init */
#endif
} hk_link_t;

void hk_link_init(hk_link_t *link, uint8_t system_id);

/* Whether a frame with so much payload would find room. */
bool hk_link_has_room(uint8_t payload_bytes);

/* Whether there is time to answer: not in a turn of the main loop in which a signature was checked. */
static inline bool hk_link_has_time(const hk_link_t *link)
{
#if HK_SIGNING
    return !link->signing.checked;
#else
    (void)link;
    return true;
#endif
}

/* Queue a message. Returns false, and queues nothing, if the link has no room. */
bool hk_link_send(hk_link_t *link, uint16_t id, uint8_t crc_extra, const void *payload,
                  uint8_t length);

/* The same for a message by its name, from the struct that mavgen has made for it. */
#define HK_SEND(link, NAME, message) \
    hk_link_send((link), (uint16_t)MAVLINK_MSG_ID_##NAME, MAVLINK_MSG_ID_##NAME##_CRC, (message), \
                 MAVLINK_MSG_ID_##NAME##_LEN)

#endif
