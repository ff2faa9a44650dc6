/* The non-volatile store of the host program: bytes that take 3.4 ms each, as in an EEPROM. Every
 * byte goes into the file at once: whoever ends the program leaves what a memory would hold. */
#include "hk_host_store.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "hk_hal.h"
#include "hk_host_board.h"

#define HK_ERASED    0xFFU
#define HK_SPOILT    0x55U
#define HK_WRITE_NS  UINT64_C(3400000)
#define HK_ALL_BYTES (HK_STORE_SLOTS * HK_STORE_SLOT_BYTES)

static struct {
    FILE *file;
    uint8_t bytes[HK_ALL_BYTES];
    long left;        /* bytes that are written before the supply fails; -1: it does not */
    uint8_t slot;     /* that is replaced */
    uint8_t place;
    uint64_t ready_ns;
} host_store;

bool hk_host_store_open(const char *path, long power_cut)
{
    (void)memset(host_store.bytes, HK_ERASED, HK_ALL_BYTES);
    host_store.left = power_cut;
    if (path == NULL) {
        return true;
    }
    host_store.file = fopen(path, "r+b");
    if (host_store.file == NULL) {
        host_store.file = fopen(path, "w+b");
    }
    if (host_store.file == NULL) {
        return false;
    }
    (void)fread(host_store.bytes, 1U, HK_ALL_BYTES, host_store.file);
    rewind(host_store.file);
    return fwrite(host_store.bytes, 1U, HK_ALL_BYTES, host_store.file) == HK_ALL_BYTES
           && fflush(host_store.file) == 0;
}

static void change(size_t place, uint8_t byte)
{
    host_store.bytes[place] = byte;
    if (host_store.file != NULL && fseek(host_store.file, (long)place, SEEK_SET) == 0) {
        (void)fputc(byte, host_store.file);
        (void)fflush(host_store.file);
    }
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    (void)memcpy(bytes, &host_store.bytes[slot * HK_STORE_SLOT_BYTES + offset], count);
}

bool hk_hal_store_busy(void)
{
    return hk_host_board_now_ns() < host_store.ready_ns;
}

void hk_hal_store_erase(uint8_t slot)
{
    host_store.slot = slot;
    host_store.place = 0U;
}

void hk_hal_store_put(uint8_t byte)
{
    const size_t place = host_store.slot * HK_STORE_SLOT_BYTES + host_store.place;

    host_store.place++;
    host_store.ready_ns = hk_host_board_now_ns() + HK_WRITE_NS;
    if (host_store.left == 0) {
        host_store.left = -1;
        change(place, (uint8_t)(byte ^ HK_SPOILT));
        hk_host_board_restart(HK_RESET_POWER);
    }
    if (host_store.left > 0) {
        host_store.left--;
    }
    change(place, byte);
}

void hk_hal_store_finish(void)
{
}
