/* Signatures of MAVLink 2 frames: SHA-256 over a secret that both ends know, and what is sent.
 *
 * Without HK_SIGNING nothing of this is compiled. With it, frames are signed and only signed ones
 * are taken as soon as there is a secret; until then the link is open. */
#ifndef HK_SIGNING_H
#define HK_SIGNING_H

#include <stdbool.h>
#include <stdint.h>

#define HK_SECRET_BYTES    32U
#define HK_TIMESTAMP_BYTES 6U
#define HK_SIGNATURE_BYTES 13U  /* that a frame is longer: link, timestamp, hash */
#define HK_SIGNED          0x01U /* flag that one must understand */
#define HK_TAIL_BYTES      (2U + HK_SIGNATURE_BYTES)
#define HK_SIGNED_STREAMS  4U

/* What is stored. */
typedef struct {
    uint8_t secret[HK_SECRET_BYTES];
    uint8_t bound[HK_TIMESTAMP_BYTES]; /* no timestamp so far was above it; lowest byte first */
} hk_signing_kept_t;

/* A sender, and its newest timestamp. */
typedef struct {
    uint64_t timestamp;
    uint8_t link;
    uint8_t system_id;
    uint8_t component_id;
} hk_signed_stream_t;

/* A frame in three parts. The tail is its checksum, which is set, and the signature. */
typedef struct {
    const uint8_t *header;
    const uint8_t *payload;
    uint8_t *tail;
} hk_signed_frame_t;

typedef struct {
    hk_signing_kept_t kept;
    uint64_t timestamp; /* units of 10 us; it never goes back */
    uint32_t since_us;  /* when it was taken forward last */
    bool active;        /* there is a secret */
    bool unsaved;       /* what is kept is not what is stored */
    bool worked;        /* something was signed or checked in this turn of the main loop */
    bool checked;       /* namely checked: nothing is sent in the same turn */
    uint8_t streams;    /* senders so far */
    hk_signed_stream_t stream[HK_SIGNED_STREAMS];
} hk_signing_t;

/* Begin with what is kept. */
void hk_signing_init(hk_signing_t *signing, const hk_signing_kept_t *kept, uint32_t now_us);

/* Take another secret; zeros are none. The timestamp does not go back for it. */
void hk_signing_set(hk_signing_t *signing, const uint8_t secret[HK_SECRET_BYTES],
                    uint64_t timestamp);

/* A turn of the main loop begins: a signature takes the time of half a sample on a small board, so
 * there should be one in a turn. */
void hk_signing_turn(hk_signing_t *signing);

/* Set the signature of a frame that is sent. */
void hk_signing_sign(hk_signing_t *signing, const hk_signed_frame_t *frame, uint32_t now_us);

/* Whether a frame that has come is signed with the secret and newer than all of its sender. */
bool hk_signing_accepts(hk_signing_t *signing, const hk_signed_frame_t *frame, uint32_t now_us);

#endif
