/* Streams: see the header. */
#include "hk_stream.h"

#include "hk_flash.h"

#define HK_US_PER_S UINT32_C(1000000)

typedef struct {
    uint16_t message_id;
    uint8_t frame_bytes;
    uint32_t interval_us;
} hk_plan_t;

#define HK_ROW(name, interval, bytes) \
    {.message_id = MAVLINK_MSG_ID_##name, .frame_bytes = (bytes), .interval_us = (interval)},
static const hk_plan_t plan[HK_STREAMS] HK_FLASH = {HK_MESSAGE_PLAN(HK_ROW)};
#undef HK_ROW

static bool is_timed(uint8_t which)
{
    return which >= HK_STREAM_TIMED;
}

/* The interval that a message can keep: whole periods of the sample, for those that tell of one. */
static uint32_t kept_us(uint8_t which, uint32_t interval_us)
{
    uint32_t samples;

    if (interval_us == 0U || is_timed(which)) {
        return interval_us;
    }
    samples = (interval_us + HK_PERIOD_US / 2U) / HK_PERIOD_US;
    return HK_PERIOD_US * (samples == 0U ? 1U : samples);
}

static uint32_t bytes_per_s(uint8_t which, uint32_t interval_us)
{
    return interval_us == 0U ? 0U
                             : hk_flash_u8(&plan[which].frame_bytes) * HK_US_PER_S / interval_us;
}

/* Whether the link carries all messages if one of them has that interval. */
static bool fits(const hk_stream_t *stream, uint8_t changed, uint32_t interval_us)
{
    uint32_t sum = 0U;
    uint8_t which;

    for (which = 0U; which < HK_STREAMS; which++) {
        sum += bytes_per_s(which,
                           which == changed ? interval_us : stream->interval_us[which]);
    }
    return HK_LINK_USABLE_BYTES_S == 0U || sum <= HK_LINK_USABLE_BYTES_S;
}

static void start(hk_stream_t *stream, uint8_t which, uint32_t interval_us, uint32_t now_us)
{
    stream->interval_us[which] = interval_us;
    stream->next[which] = is_timed(which) ? now_us : 0U;
}

uint32_t hk_stream_default_us(uint8_t which)
{
    return hk_flash_u32(&plan[which].interval_us);
}

void hk_stream_init(hk_stream_t *stream, uint32_t now_us)
{
    uint8_t which;

    for (which = 0U; which < HK_STREAMS; which++) {
        start(stream, which, kept_us(which, hk_stream_default_us(which)), now_us);
    }
    stream->due = 0U;
    stream->lost = 0U;
#if HK_FILTER_STATE_WORDS
    stream->told = false;
#endif
}

uint8_t hk_stream_of(uint16_t message_id)
{
    uint8_t which;

    for (which = 0U; which < HK_STREAMS; which++) {
        if (hk_flash_u16(&plan[which].message_id) == message_id) {
            return which;
        }
    }
    return HK_NO_STREAM;
}

bool hk_stream_set(hk_stream_t *stream, uint8_t which, uint32_t interval_us, uint32_t now_us)
{
    const uint32_t kept = kept_us(which, interval_us);

    if (!fits(stream, which, kept)) {
        return false;
    }
    start(stream, which, kept, now_us);
    return true;
}

#if HK_FILTER_STATE_WORDS
/* The state belongs to a sample, and tells nothing without it. */
static void bring_sample(hk_stream_t *stream)
{
    if (!stream->told && (stream->due & (1U << HK_STREAM_TILT_STATE)) != 0U) {
        stream->due |= (uint16_t)(1U << HK_STREAM_TILT_SAMPLE);
    }
}
#endif

void hk_stream_request(hk_stream_t *stream, uint8_t which)
{
    stream->due |= (uint16_t)(1U << which);
#if HK_FILTER_STATE_WORDS
    bring_sample(stream);
#endif
}

void hk_stream_sample(hk_stream_t *stream)
{
    uint8_t which;

#if HK_FILTER_STATE_WORDS
    stream->told = false;
    bring_sample(stream); /* for a state that found no room before */
#endif
    for (which = 0U; which < HK_STREAM_TIMED; which++) {
        if (stream->interval_us[which] == 0U) {
            continue;
        }
        if (stream->next[which] > 0U) {
            stream->next[which]--;
            continue;
        }
        stream->next[which] = stream->interval_us[which] / HK_PERIOD_US - 1U;
        if ((stream->due & (1U << which)) != 0U) {
            stream->lost++;
        }
        hk_stream_request(stream, which);
    }
}

void hk_stream_time(hk_stream_t *stream, uint32_t now_us)
{
    uint8_t which;

    for (which = HK_STREAM_TIMED; which < HK_STREAMS; which++) {
        const uint32_t late_us = now_us - stream->next[which];

        if (stream->interval_us[which] != 0U && late_us <= INT32_MAX) {
            stream->next[which] = now_us + stream->interval_us[which];
            hk_stream_request(stream, which);
        }
    }
}

uint8_t hk_stream_next(const hk_stream_t *stream)
{
    uint8_t which;

    for (which = 0U; which < HK_STREAMS; which++) {
        if ((stream->due & (1U << which)) != 0U) {
            return which;
        }
    }
    return HK_NO_STREAM;
}

void hk_stream_sent(hk_stream_t *stream, uint8_t which)
{
    stream->due &= (uint16_t)~(1U << which);
#if HK_FILTER_STATE_WORDS
    stream->told = stream->told || which == HK_STREAM_TILT_SAMPLE;
#endif
}
