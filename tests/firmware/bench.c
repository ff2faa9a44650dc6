/* Parts of the application on a bench: a memory whose supply fails on command, and handles for
 * Python. Compiled together with generated code by bench.py. */
#include <string.h>

#include "hk_calibration.h"
#include "hk_crc.h"
#include "hk_hal.h"
#include "hk_parameter.h"
#include "hk_receiver.h"
#include "hk_store.h"
#include "hk_stream.h"

static uint8_t memory[HK_STORE_SLOTS][HK_STORE_SLOT_BYTES];
static long left;      /* bytes that are written before the supply fails; -1: it does not */
static uint8_t spoilt; /* what the byte then becomes */
static int erases;     /* whether erasing leaves 0xFF, as a flash does, or nothing happens */
static int broken;     /* bytes of the memory that do not take what is written */
static int busy;       /* polls until the memory is ready again */
static int dead;
static unsigned long written;
static uint8_t slot_now;
static uint8_t place_now;

uint8_t *bench_memory(void);
void bench_supply(long bytes, uint8_t becomes, int erasing, int breaks);
unsigned long bench_written(void);
int bench_save(uint8_t place, float value);
int bench_load(uint8_t place, float *value);
int bench_record_bytes(void);
void bench_set_generation(uint8_t slot, uint16_t generation);

uint8_t *bench_memory(void)
{
    return &memory[0][0];
}

void bench_supply(long bytes, uint8_t becomes, int erasing, int breaks)
{
    left = bytes;
    spoilt = becomes;
    erases = erasing;
    broken = breaks;
    dead = 0;
    busy = 0;
}

unsigned long bench_written(void)
{
    return written;
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    (void)memcpy(bytes, &memory[slot][offset], count);
}

bool hk_hal_store_busy(void)
{
    return busy > 0 && busy-- > 0;
}

void hk_hal_store_erase(uint8_t slot)
{
    slot_now = slot;
    place_now = 0U;
    if (erases != 0 && dead == 0) {
        (void)memset(memory[slot], 0xFF, HK_STORE_SLOT_BYTES);
    }
}

void hk_hal_store_put(uint8_t byte)
{
    uint8_t *target = &memory[slot_now][place_now++];

    if (busy > 0) {
        dead = 1; /* nobody may write now: as if nothing worked any more */
    }
    if (dead != 0) {
        return;
    }
    if (left == 0) {
        *target = spoilt;
        dead = 1;
        return;
    }
    left -= left > 0 ? 1 : 0;
    *target = broken != 0 ? (uint8_t)~byte : byte;
    written++;
    busy = 2;
}

void hk_hal_store_finish(void)
{
}

static void start(hk_store_t *store, hk_parameters_t *parameters)
{
    hk_parameters_init(parameters);
    hk_store_init(store);
    (void)hk_store_load(store, parameters);
}

/* Set one parameter and save all: the event that ends it, or -1 when the supply has failed. */
int bench_save(uint8_t place, float value)
{
    hk_store_event_t event = HK_STORE_NOTHING;
    hk_parameters_t parameters;
    hk_store_t store;

    start(&store, &parameters);
    if (!hk_parameter_set(&parameters, place, value)) {
        return -2;
    }
    hk_store_save(&store, &parameters);
    while (event == HK_STORE_NOTHING && dead == 0) {
        event = hk_store_poll(&store);
    }
    return dead != 0 ? -1 : (int)event;
}

int bench_save_again(uint8_t place, float first, float second, long bytes);

/* Save in vain, for the memory takes nothing; then save something else while the supply fails. */
int bench_save_again(uint8_t place, float first, float second, long bytes)
{
    hk_store_event_t event = HK_STORE_NOTHING;
    hk_parameters_t parameters;
    hk_store_t store;

    bench_supply(-1, 0U, 0, 1);
    start(&store, &parameters);
    (void)hk_parameter_set(&parameters, place, first);
    hk_store_save(&store, &parameters);
    while (event == HK_STORE_NOTHING) {
        event = hk_store_poll(&store);
    }
    bench_supply(bytes, 0U, 0, 0);
    (void)hk_parameter_set(&parameters, place, second);
    hk_store_save(&store, &parameters);
    while (dead == 0 && hk_store_saving(&store)) {
        (void)hk_store_poll(&store);
    }
    return (int)event;
}

/* What the next start would use. Returns whether there is a record. */
int bench_load(uint8_t place, float *value)
{
    hk_parameters_t parameters;
    hk_store_t store;

    start(&store, &parameters);
    *value = hk_parameter_get(&parameters, place);
    return hk_store_valid(&store) ? 1 : 0;
}

int bench_record_bytes(void)
{
    return (int)HK_STORE_BYTES;
}

/* Make a valid record one of another generation. */
void bench_set_generation(uint8_t slot, uint16_t generation)
{
    uint8_t *record = memory[slot];
    uint16_t crc = HK_CRC_START;
    uint8_t i;

    for (i = 0U; i < 2U; i++) {
        record[HK_STORE_VALUES_AT - 2U + i] = (uint8_t)(generation >> (8U * i));
        record[HK_STORE_CRC_AT + 2U + i] = (uint8_t)(generation >> (8U * i));
    }
    for (i = 0U; i < HK_STORE_CRC_AT; i++) {
        crc = hk_crc(crc, record[i]);
    }
    record[HK_STORE_CRC_AT] = (uint8_t)(crc & 0xFFU);
    record[HK_STORE_CRC_AT + 1U] = (uint8_t)(crc >> 8);
}

/* --- Parameters ----------------------------------------------------------------------------- */

int bench_find(const char *name);
int bench_set(uint8_t place, float value, float *used, int *retuned);
int bench_settle(uint8_t place);

int bench_find(const char *name)
{
    char field[HK_NAME_BYTES];

    (void)strncpy(field, name, sizeof field);
    return hk_parameter_find(field);
}

/* Set a parameter that is the design's: whether it was taken, and the value in use then. */
int bench_set(uint8_t place, float value, float *used, int *retuned)
{
    hk_parameters_t parameters;
    int taken;

    hk_parameters_init(&parameters);
    taken = hk_parameter_set(&parameters, place, value) ? 1 : 0;
    *used = hk_parameter_get(&parameters, place);
    *retuned = hk_parameters_retuned(&parameters) ? 1 : 0;
    return taken;
}

/* --- Streams -------------------------------------------------------------------------------- */

static hk_stream_t stream;

void bench_stream_init(uint32_t now_us);
int bench_stream_set(uint8_t which, uint32_t interval_us, uint32_t now_us);
void bench_stream_sample(void);
void bench_stream_time(uint32_t now_us);
void bench_stream_request(uint8_t which);
int bench_stream_take(void);
int bench_stream_of(uint16_t id);
int bench_stream_lost(void);

void bench_stream_init(uint32_t now_us)
{
    hk_stream_init(&stream, now_us);
}

int bench_stream_set(uint8_t which, uint32_t interval_us, uint32_t now_us)
{
    return hk_stream_set(&stream, which, interval_us, now_us) ? 1 : 0;
}

void bench_stream_sample(void)
{
    hk_stream_sample(&stream);
}

void bench_stream_time(uint32_t now_us)
{
    hk_stream_time(&stream, now_us);
}

void bench_stream_request(uint8_t which)
{
    hk_stream_request(&stream, which);
}

/* Take the next message that is due; -1 if there is none. */
int bench_stream_take(void)
{
    const uint8_t which = hk_stream_next(&stream);

    if (which == HK_NO_STREAM) {
        return -1;
    }
    hk_stream_sent(&stream, which);
    return which;
}

int bench_stream_of(uint16_t id)
{
    return hk_stream_of(id);
}

int bench_stream_lost(void)
{
    return stream.lost;
}

/* --- Calibration ---------------------------------------------------------------------------- */

static hk_calibration_t calibration;

void bench_calibration_start(uint32_t now_us);
int bench_calibration_take(const int16_t accel[3], const int16_t gyro[3], float mean[3]);
int bench_calibration_poll(uint32_t now_us);
void bench_calibration_drop(void);

void bench_calibration_start(uint32_t now_us)
{
    hk_calibration_init(&calibration);
    hk_calibration_start(&calibration, now_us);
}

int bench_calibration_take(const int16_t accel[3], const int16_t gyro[3], float mean[3])
{
    return (int)hk_calibration_take(&calibration, accel, gyro, mean);
}

int bench_calibration_poll(uint32_t now_us)
{
    return (int)hk_calibration_poll(&calibration, now_us);
}

void bench_calibration_drop(void)
{
    hk_calibration_drop(&calibration);
}

/* --- Receiver ------------------------------------------------------------------------------- */

static hk_receiver_t receiver;

int bench_receive(const uint8_t *bytes, uint32_t count, uint16_t *ids, uint32_t most);
int bench_receiver_errors(void);

/* Take bytes from the beginning of a stream: how many messages, and their identities. */
int bench_receive(const uint8_t *bytes, uint32_t count, uint16_t *ids, uint32_t most)
{
    uint32_t found = 0U;
    uint32_t i;

    hk_receiver_init(&receiver);
    for (i = 0U; i < count; i++) {
        if (hk_receiver_take(&receiver, bytes[i]) && found < most) {
            ids[found++] = receiver.id;
        }
    }
    return (int)found;
}

int bench_receiver_errors(void)
{
    return receiver.errors;
}
