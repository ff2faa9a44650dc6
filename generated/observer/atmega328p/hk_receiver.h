/* Takes MAVLink 2 frames apart that come over the link, byte by byte. */
#ifndef HK_RECEIVER_H
#define HK_RECEIVER_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_mavlink.h"
#include "hk_signing.h"

/* The longest payload that anybody here reads: SETUP_SIGNING or COMMAND_LONG. */
#define HK_RECEIVE_BYTES (HK_SIGNING ? 42U : 33U)
#define HK_RECEIVED_HEADER_BYTES 10U

typedef struct {
    uint16_t place;   /* of the next byte in its frame; 0 while a frame is awaited */
    uint8_t to_skip;  /* bytes behind the checksum that are not wanted */
    uint8_t length;   /* of the payload */
    uint8_t flags;    /* that one must understand */
    uint8_t sequence;
    uint8_t system_id; /* of the sender */
    uint8_t component_id;
    uint8_t unwanted; /* not 0 if the identity does not fit two bytes */
    uint16_t id;
    uint16_t crc;
    uint8_t crc_low;  /* the first byte of the frame's own */
    uint16_t frames;  /* that were whole; it and the next wrap */
    uint16_t errors;  /* frames with a wrong checksum */
    uint8_t payload[HK_RECEIVE_BYTES]; /* filled up with zeros */
#if HK_SIGNING
    bool wanted; /* the frame will be looked at when its signature is whole */
    uint8_t header[HK_RECEIVED_HEADER_BYTES];
    uint8_t tail[HK_TAIL_BYTES]; /* checksum, and signature if there is one */
#endif
} hk_receiver_t;

void hk_receiver_init(hk_receiver_t *receiver);

/* Take one byte. Returns true if it has completed a frame of a kind that is listened to. */
bool hk_receiver_take(hk_receiver_t *receiver, uint8_t byte);

#endif
