/* Receiver of frames: see the header.
 *
 * A frame of a kind that nobody here listens to is passed over without its checksum being looked at,
 * for that needs a seed of its kind. So is one with a flag that one would have to understand. */
#include "hk_receiver.h"

#include <string.h>

#include "hk_crc.h"

enum {
    AT_MAGIC,
    AT_LENGTH,
    AT_FLAGS,
    AT_OTHER_FLAGS,
    AT_SEQUENCE,
    AT_SYSTEM,
    AT_COMPONENT,
    AT_ID_LOW,
    AT_ID_MIDDLE,
    AT_ID_HIGH,
    AT_PAYLOAD
};

#if HK_SIGNING
#define HK_LISTENED_SIGNING(X) X(SETUP_SIGNING)
#else
#define HK_LISTENED_SIGNING(X)
#endif

/* X(name) for every message that is listened to. */
#define HK_LISTENED(X) \
    HK_LISTENED_SIGNING(X) \
    X(PARAM_SET) \
    X(PARAM_REQUEST_READ) \
    X(PARAM_REQUEST_LIST) \
    X(COMMAND_LONG) \
    X(TIMESYNC) \
    X(PING)

#define HK_FITS(NAME) \
    typedef char hk_##NAME##_fits[MAVLINK_MSG_ID_##NAME##_LEN <= HK_RECEIVE_BYTES ? 1 : -1];
HK_LISTENED(HK_FITS)

/* The seed of the checksum of a kind. Returns false for one that is not listened to. */
static bool seed_of(uint16_t id, uint8_t *seed)
{
#define HK_CASE(NAME) \
    case MAVLINK_MSG_ID_##NAME: \
        *seed = MAVLINK_MSG_ID_##NAME##_CRC; \
        return true;
    switch (id) {
        HK_LISTENED(HK_CASE)
    default:
        return false;
    }
#undef HK_CASE
}

void hk_receiver_init(hk_receiver_t *receiver)
{
    (void)memset(receiver, 0, sizeof *receiver);
}

static void take_header(hk_receiver_t *receiver, uint16_t place, uint8_t byte)
{
#if HK_SIGNING
    receiver->header[place] = byte;
#endif
    switch (place) {
    case AT_LENGTH:
        receiver->length = byte;
        receiver->crc = HK_CRC_START;
        (void)memset(receiver->payload, 0, sizeof receiver->payload);
        break;
    case AT_FLAGS:
        receiver->flags = byte;
        break;
    case AT_SEQUENCE:
        receiver->sequence = byte;
        break;
    case AT_SYSTEM:
        receiver->system_id = byte;
        break;
    case AT_COMPONENT:
        receiver->component_id = byte;
        break;
    case AT_ID_LOW:
        receiver->id = byte;
        break;
    case AT_ID_MIDDLE:
        receiver->id |= (uint16_t)((uint16_t)byte << 8);
        break;
    case AT_ID_HIGH:
        receiver->unwanted = byte;
        break;
    default:
        break;
    }
}

/* The checksum is right. Returns whether there is nothing more to come: the signature may be. */
static bool end_payload(hk_receiver_t *receiver, uint16_t crc)
{
#if HK_SIGNING
    receiver->header[AT_MAGIC] = MAVLINK_STX;
    receiver->tail[0] = (uint8_t)(crc & 0xFFU);
    receiver->tail[1] = (uint8_t)(crc >> 8);
    receiver->wanted = true;
    return receiver->to_skip == 0U;
#else
    (void)receiver;
    (void)crc;
    return true;
#endif
}

/* Take a byte behind the checksum. Returns whether a frame is whole and looked at. */
static bool take_signature(hk_receiver_t *receiver, uint8_t byte)
{
    receiver->to_skip--;
#if HK_SIGNING
    receiver->tail[HK_TAIL_BYTES - 1U - receiver->to_skip] = byte;
    return receiver->to_skip == 0U && receiver->wanted;
#else
    (void)byte;
    return false;
#endif
}

/* The checksum has come whole. Returns whether the frame is to be looked at. */
static bool end_frame(hk_receiver_t *receiver, uint8_t crc_high)
{
    uint8_t seed = 0U;
    uint16_t wanted;

    receiver->place = AT_MAGIC;
#if HK_SIGNING
    receiver->wanted = false;
#endif
    receiver->to_skip = (receiver->flags & HK_SIGNED) != 0U ? HK_SIGNATURE_BYTES : 0U;
    if ((receiver->flags & (uint8_t)~HK_SIGNED) != 0U || receiver->unwanted != 0U
        || !seed_of(receiver->id, &seed)) {
        return false;
    }
    wanted = hk_crc(receiver->crc, seed);
    if (wanted != (uint16_t)(((uint16_t)crc_high << 8) | receiver->crc_low)) {
        receiver->to_skip = 0U; /* nothing of its header is known for sure */
        receiver->errors++;
        return false;
    }
    receiver->frames++;
    return end_payload(receiver, wanted);
}

/* Take a byte of a frame behind its magic. Returns whether the frame is whole and looked at. */
static bool take_byte(hk_receiver_t *receiver, uint8_t byte)
{
    const uint16_t end = (uint16_t)(AT_PAYLOAD + receiver->length);
    const uint16_t place = receiver->place++;

    if (place < AT_PAYLOAD) {
        take_header(receiver, place, byte);
    } else if (place == end) {
        receiver->crc_low = byte;
        return false;
    } else if (place > end) {
        return end_frame(receiver, byte);
    } else if (place - AT_PAYLOAD < (int)HK_RECEIVE_BYTES) {
        receiver->payload[place - AT_PAYLOAD] = byte;
    }
    receiver->crc = hk_crc(receiver->crc, byte);
    return false;
}

bool hk_receiver_take(hk_receiver_t *receiver, uint8_t byte)
{
    if (receiver->to_skip > 0U) {
        return take_signature(receiver, byte);
    }
    if (receiver->place == AT_MAGIC) {
        receiver->place = byte == MAVLINK_STX ? AT_LENGTH : AT_MAGIC;
        return false;
    }
    return take_byte(receiver, byte);
}
