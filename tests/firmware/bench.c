/* The store of hk_hal.h as a memory on a bench, whose supply fails on command. bench.py puts this in
 * front of the module that lets Python at the firmware. */
#include <string.h>

#include "hk_calibration.h"
#include "hk_crc.h"
#include "hk_hal.h"
#include "hk_parameter.h"
#include "hk_receiver.h"
#include "hk_store.h"
#include "hk_stream.h"

typedef struct {
    uint8_t slots[HK_STORE_SLOTS][HK_STORE_SLOT_BYTES];
    long left;      /* bytes that are written before the supply fails; -1: it does not */
    uint8_t spoilt; /* what the byte then becomes */
    bool erases;    /* whether erasing leaves 0xFF, as a flash does, or nothing happens */
    bool broken;    /* whether bytes become something else than what is written */
    bool dead;      /* nothing is written any more */
    int busy;       /* polls until the memory is ready again */
    unsigned long written;
    uint8_t slot; /* that is being replaced, and of its bytes the next */
    uint8_t place;
} bench_memory_t;

static bench_memory_t bench_memory;

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    (void)memcpy(bytes, &bench_memory.slots[slot][offset], count);
}

bool hk_hal_store_busy(void)
{
    return bench_memory.busy > 0 && bench_memory.busy-- > 0;
}

void hk_hal_store_erase(uint8_t slot)
{
    bench_memory.slot = slot;
    bench_memory.place = 0U;
    if (bench_memory.erases && !bench_memory.dead) {
        (void)memset(bench_memory.slots[slot], 0xFF, HK_STORE_SLOT_BYTES);
    }
}

void hk_hal_store_put(uint8_t byte)
{
    uint8_t *target = &bench_memory.slots[bench_memory.slot][bench_memory.place++];

    if (bench_memory.busy > 0) {
        bench_memory.dead = true; /* nobody may write now: as if nothing worked any more */
    }
    if (bench_memory.dead) {
        return;
    }
    if (bench_memory.left == 0) {
        *target = bench_memory.spoilt;
        bench_memory.dead = true;
        return;
    }
    bench_memory.left -= bench_memory.left > 0 ? 1 : 0;
    *target = bench_memory.broken ? (uint8_t)~byte : byte;
    bench_memory.written++;
    bench_memory.busy = 2;
}

void hk_hal_store_finish(void)
{
}
