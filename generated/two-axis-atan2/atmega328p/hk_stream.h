/* Which message goes out when. */
#ifndef HK_STREAM_H
#define HK_STREAM_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_filter.h"
#include "hk_mavlink.h"

/* The messages that go out again and again, in order of importance. Those before HK_STREAM_TIMED
 * tell of a sample and go out with every so many-th; the others go by the clock. */
#define HK_NUMBER(name, interval_us, frame_bytes) HK_STREAM_##name,
enum { HK_MESSAGE_PLAN(HK_NUMBER) HK_STREAMS, HK_NO_STREAM = 0xFF };
#undef HK_NUMBER
#define HK_STREAM_TIMED HK_STREAM_SYS_STATUS

typedef struct {
    uint32_t interval_us[HK_STREAMS]; /* 0: off */
    uint32_t next[HK_STREAMS];        /* samples that come before the next, or when it is due, us */
    uint16_t due;                     /* one bit for each that has not gone out yet */
    uint16_t lost;                    /* samples' messages that found no room; it wraps */
#if HK_FILTER_STATE_WORDS
    bool told; /* the TILT_SAMPLE of this sample has gone out */
#endif
} hk_stream_t;

/* Set all to the plan. Those that go by the clock are due at once. */
void hk_stream_init(hk_stream_t *stream, uint32_t now_us);

/* Which stream carries a message, or HK_NO_STREAM. */
uint8_t hk_stream_of(uint16_t message_id);

/* Set how often a message goes out; 0 is off. The plan's is hk_stream_default_us. Returns false, and
 * changes nothing, if the link cannot carry that beside the others. */
bool hk_stream_set(hk_stream_t *stream, uint8_t which, uint32_t interval_us, uint32_t now_us);
uint32_t hk_stream_default_us(uint8_t which);

/* Ask for a message once. A TILT_STATE brings the TILT_SAMPLE of the same sample with it, which goes
 * out before unless it has already. */
void hk_stream_request(hk_stream_t *stream, uint8_t which);

/* A new sample is there: what is still due of the one before is lost or goes out with this one. */
void hk_stream_sample(hk_stream_t *stream);

/* Look at the clock. */
void hk_stream_time(hk_stream_t *stream, uint32_t now_us);

/* The most important message that is due, or HK_NO_STREAM; and: it has gone out. */
uint8_t hk_stream_next(const hk_stream_t *stream);
void hk_stream_sent(hk_stream_t *stream, uint8_t which);

#endif
