/* Signatures: see the header. The rules are those of "Message Signing" in MAVLink's guide.
 *
 * There is no clock that goes on without supply. So a timestamp that lies ahead is stored, and a
 * start goes on from there: nothing that was sent or accepted before is then newer. */
#include "hk_signing.h"

#include "hk_design.h"

#if HK_SIGNING

#include <string.h>

#include "hk_sha256.h"

#define HK_LINK_ID        0U /* of what is sent */
#define HK_US_PER_STEP    10U
#define HK_MINUTE         UINT64_C(6000000)
#define HK_AHEAD          (240U * HK_MINUTE) /* memory wears out: it is written so rarely */
#define HK_TIMESTAMP_LAST UINT64_C(0xFFFFFFFFFFFF)

/* Places in a frame: of its header, and behind its payload. */
#define HK_HEADER_BYTES  10U
#define HK_LENGTH_AT     1U
#define HK_FLAGS_AT      2U
#define HK_SYSTEM_AT     5U
#define HK_COMPONENT_AT  6U
#define HK_LINK_AT       2U
#define HK_TIMESTAMP_AT  3U
#define HK_HASH_AT       (HK_TIMESTAMP_AT + HK_TIMESTAMP_BYTES)
#define HK_HASH_BYTES    6U

typedef char hk_hash_ends_frame[HK_HASH_AT + HK_HASH_BYTES == HK_TAIL_BYTES ? 1 : -1];

static uint64_t timestamp_at(const uint8_t *bytes)
{
    uint64_t timestamp = 0U;

    (void)memcpy(&timestamp, bytes, HK_TIMESTAMP_BYTES);
    return timestamp;
}

static void put_timestamp(uint8_t *bytes, uint64_t timestamp)
{
    (void)memcpy(bytes, &timestamp, HK_TIMESTAMP_BYTES);
}

/* Keep what is stored ahead, in time for it to be written. */
static void stay_below_bound(hk_signing_t *signing)
{
    if (signing->active && signing->timestamp + HK_MINUTE > timestamp_at(signing->kept.bound)
        && signing->timestamp < HK_TIMESTAMP_LAST) {
        put_timestamp(signing->kept.bound, signing->timestamp + HK_AHEAD > HK_TIMESTAMP_LAST
                                               ? HK_TIMESTAMP_LAST
                                               : signing->timestamp + HK_AHEAD);
        signing->unsaved = true;
    }
}

static void take_forward(hk_signing_t *signing, uint64_t timestamp)
{
    if (timestamp > signing->timestamp) {
        signing->timestamp = timestamp > HK_TIMESTAMP_LAST ? HK_TIMESTAMP_LAST : timestamp;
    }
    stay_below_bound(signing);
}

/* Follow the clock. Returns whether it has gone on. */
static bool follow(hk_signing_t *signing, uint32_t now_us)
{
    const uint32_t steps = (now_us - signing->since_us) / HK_US_PER_STEP;

    signing->since_us += HK_US_PER_STEP * steps;
    take_forward(signing, signing->timestamp + steps);
    return steps > 0U;
}

static bool is_secret(const uint8_t secret[HK_SECRET_BYTES])
{
    uint8_t any = 0U;
    uint8_t i;

    for (i = 0U; i < HK_SECRET_BYTES; i++) {
        any = (uint8_t)(any | secret[i]);
    }
    return any != 0U;
}

void hk_signing_init(hk_signing_t *signing, const hk_signing_kept_t *kept, uint32_t now_us)
{
    (void)memset(signing, 0, sizeof *signing);
    signing->kept = *kept;
    signing->since_us = now_us;
    signing->active = is_secret(kept->secret);
    take_forward(signing, timestamp_at(kept->bound) + HK_MINUTE);
}

void hk_signing_set(hk_signing_t *signing, const uint8_t secret[HK_SECRET_BYTES],
                    uint64_t timestamp)
{
    (void)memcpy(signing->kept.secret, secret, HK_SECRET_BYTES);
    signing->active = is_secret(secret);
    signing->streams = 0U;
    signing->unsaved = true;
    take_forward(signing, timestamp);
}

void hk_signing_turn(hk_signing_t *signing)
{
    signing->worked = false;
    signing->checked = false;
}

/* The beginning of the hash over the secret and the frame. */
static void hash_of(hk_signing_t *signing, const hk_signed_frame_t *frame, uint8_t *hash)
{
    uint8_t whole[HK_SHA256_BYTES];
    hk_sha256_t sha;

    hk_sha256_init(&sha);
    hk_sha256_add(&sha, signing->kept.secret, HK_SECRET_BYTES);
    hk_sha256_add(&sha, frame->header, HK_HEADER_BYTES);
    hk_sha256_add(&sha, frame->payload, frame->header[HK_LENGTH_AT]);
    hk_sha256_add(&sha, frame->tail, HK_HASH_AT);
    hk_sha256_end(&sha, whole);
    (void)memcpy(hash, whole, HK_HASH_BYTES);
    signing->worked = true;
}

void hk_signing_sign(hk_signing_t *signing, const hk_signed_frame_t *frame, uint32_t now_us)
{
    uint8_t *const tail = frame->tail;

    if (!follow(signing, now_us)) {
        take_forward(signing, signing->timestamp + 1U);
    }
    tail[HK_LINK_AT] = HK_LINK_ID;
    put_timestamp(&tail[HK_TIMESTAMP_AT], signing->timestamp);
    hash_of(signing, frame, &tail[HK_HASH_AT]);
}

/* --- Senders -------------------------------------------------------------------------------- */

/* The place of a frame's sender, or the next free one. */
static uint8_t sender_of(const hk_signing_t *signing, const hk_signed_frame_t *frame)
{
    uint8_t place;

    for (place = 0U; place < signing->streams; place++) {
        const hk_signed_stream_t *stream = &signing->stream[place];

        if (stream->link == frame->tail[HK_LINK_AT]
            && stream->system_id == frame->header[HK_SYSTEM_AT]
            && stream->component_id == frame->header[HK_COMPONENT_AT]) {
            break;
        }
    }
    return place;
}

/* A sender that is new may be a minute behind. */
static bool is_newer(const hk_signing_t *signing, uint8_t place, uint64_t timestamp)
{
    return place < signing->streams ? timestamp > signing->stream[place].timestamp
                                    : timestamp + HK_MINUTE >= signing->timestamp;
}

static void remember(hk_signing_t *signing, uint8_t place, const hk_signed_frame_t *frame)
{
    hk_signed_stream_t *stream = &signing->stream[place];

    if (place == signing->streams) {
        signing->streams++;
    }
    stream->timestamp = timestamp_at(&frame->tail[HK_TIMESTAMP_AT]);
    stream->link = frame->tail[HK_LINK_AT];
    stream->system_id = frame->header[HK_SYSTEM_AT];
    stream->component_id = frame->header[HK_COMPONENT_AT];
    take_forward(signing, stream->timestamp);
}

/* In a time that does not tell how much of it is right. */
static bool is_signed(hk_signing_t *signing, const hk_signed_frame_t *frame)
{
    uint8_t hash[HK_HASH_BYTES];
    uint8_t wrong = 0U;
    uint8_t i;

    hash_of(signing, frame, hash);
    signing->checked = true;
    for (i = 0U; i < HK_HASH_BYTES; i++) {
        wrong = (uint8_t)(wrong | (hash[i] ^ frame->tail[HK_HASH_AT + i]));
    }
    return wrong == 0U;
}

bool hk_signing_accepts(hk_signing_t *signing, const hk_signed_frame_t *frame, uint32_t now_us)
{
    const uint8_t place = sender_of(signing, frame);

    (void)follow(signing, now_us);
    if ((frame->header[HK_FLAGS_AT] & HK_SIGNED) == 0U || place == HK_SIGNED_STREAMS
        || !is_newer(signing, place, timestamp_at(&frame->tail[HK_TIMESTAMP_AT]))
        || !is_signed(signing, frame)) {
        return false;
    }
    remember(signing, place, frame);
    return true;
}

#else

typedef char hk_signing_is_not_used[1];

#endif
