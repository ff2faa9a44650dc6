/* The non-volatile store: a file for each slot, written aside and renamed. */
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "hk_linux.h"

#define HK_ERASED 0xFFU
#define HK_MODE   0644

static struct {
    const char *folder; /* or NULL */
    uint8_t bytes[HK_STORE_SLOTS][HK_STORE_SLOT_BYTES];
    uint8_t staged[HK_STORE_SLOT_BYTES];
    uint8_t slot; /* that is replaced */
    uint8_t place;
} memory;

static bool name_file(char path[PATH_MAX], uint8_t slot, const char *ending)
{
    const int length =
        snprintf(path, PATH_MAX, "%s/slot%u%s", memory.folder, (unsigned)slot, ending);

    return length > 0 && length < PATH_MAX;
}

bool hk_linux_store_open(const char *folder)
{
    char path[PATH_MAX];
    uint8_t slot;

    memory.folder = folder;
    (void)memset(memory.bytes, HK_ERASED, sizeof memory.bytes);
    if (folder == NULL) {
        return true;
    }
    for (slot = 0U; slot < HK_STORE_SLOTS; slot++) {
        const int file = name_file(path, slot, "") ? open(path, O_RDONLY | O_CLOEXEC) : -1;

        if (file >= 0) {
            (void)read(file, memory.bytes[slot], HK_STORE_SLOT_BYTES);
            (void)close(file);
        }
    }
    return access(folder, W_OK | X_OK) == 0;
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    (void)memcpy(bytes, &memory.bytes[slot][offset], count);
}

bool hk_hal_store_busy(void)
{
    return false;
}

void hk_hal_store_erase(uint8_t slot)
{
    memory.slot = slot;
    memory.place = 0U;
    (void)memset(memory.staged, HK_ERASED, sizeof memory.staged);
}

void hk_hal_store_put(uint8_t byte)
{
    if (memory.place < HK_STORE_SLOT_BYTES) {
        memory.staged[memory.place++] = byte;
    }
}

/* The old file stays what it is until the new one is whole on the disk. */
static bool replace_file(void)
{
    char path[PATH_MAX];
    char aside[PATH_MAX];
    bool good;
    int file;

    if (!name_file(path, memory.slot, "") || !name_file(aside, memory.slot, ".part")) {
        return false;
    }
    file = open(aside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, HK_MODE);
    if (file < 0) {
        return false;
    }
    good = write(file, memory.staged, sizeof memory.staged) == (ssize_t)sizeof memory.staged
           && fsync(file) == 0;
    return close(file) == 0 && good && rename(aside, path) == 0;
}

/* What could not be written is not read back either, so that the application notices. */
void hk_hal_store_finish(void)
{
    if (memory.folder == NULL || replace_file()) {
        (void)memcpy(memory.bytes[memory.slot], memory.staged, sizeof memory.staged);
    }
}
