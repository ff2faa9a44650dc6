/* The store: see the header.
 *
 * A supply that fails leaves a record that begins anew, then one byte of any content, then what was
 * in the slot before, or nothing. Its end is then not of the generation of its beginning: the slot's
 * own former generation differs, and 0xFFFF, which an erased slot shows, is never used. So such a
 * record is invalid for certain; the checksum is there for what memory loses by itself. */
#include "hk_store.h"

#include <string.h>

#include "hk_crc.h"
#include "hk_design.h"
#include "hk_flash.h"

#define HK_LAYOUT (HK_SIGNING ? 2U : 1U)
#define HK_TRIES  3U
#define HK_PIECE  8U /* bytes that are compared at once */

#define HK_DIGEST_AT     2U
#define HK_GENERATION_AT (HK_DIGEST_AT + HK_DIGEST_BYTES)
#define HK_UNUSED_GENERATION 0xFFFFU

typedef char hk_value_has_four_bytes[sizeof(float) == 4U ? 1 : -1];

static uint16_t number_at(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8));
}

static void put_number(uint8_t *bytes, uint16_t number)
{
    bytes[0] = (uint8_t)(number & 0xFFU);
    bytes[1] = (uint8_t)(number >> 8);
}

static uint16_t checksum(const uint8_t *image)
{
    uint16_t crc = HK_CRC_START;
    uint8_t i;

    for (i = 0U; i < HK_STORE_CRC_AT; i++) {
        crc = hk_crc(crc, image[i]);
    }
    return crc;
}

static void put_head(uint8_t *image)
{
    static const uint8_t digest[HK_DIGEST_BYTES] HK_FLASH = HK_DESIGN_DIGEST_BYTES;
    uint8_t i;

    image[0] = HK_LAYOUT;
    image[1] = HK_PARAMETERS;
    for (i = 0U; i < HK_DIGEST_BYTES; i++) {
        image[HK_DIGEST_AT + i] = hk_flash_u8(&digest[i]);
    }
}

static bool is_valid(const uint8_t *image)
{
    uint8_t head[HK_GENERATION_AT];
    const uint16_t generation = number_at(&image[HK_GENERATION_AT]);

    put_head(head);
    return memcmp(head, image, sizeof head) == 0 && generation != HK_UNUSED_GENERATION
           && number_at(&image[HK_STORE_CRC_AT]) == checksum(image)
           && number_at(&image[HK_STORE_CRC_AT + 2U]) == generation;
}

/* Whether a generation came after another one; both count round. */
static bool is_newer(uint16_t generation, uint16_t than)
{
    return (int16_t)(uint16_t)(generation - than) > 0;
}

void hk_store_init(hk_store_t *store)
{
    uint8_t found[HK_STORE_BYTES];
    uint8_t slot;

    (void)memset(store, 0, sizeof *store);
    for (slot = 0U; slot < HK_STORE_SLOTS; slot++) {
        hk_hal_store_read(slot, 0U, found, sizeof found);
        if (is_valid(found)
            && (!store->valid || is_newer(number_at(&found[HK_GENERATION_AT]),
                                          number_at(&store->image[HK_GENERATION_AT])))) {
            (void)memcpy(store->image, found, sizeof found);
            store->slot = slot;
            store->valid = true;
        }
    }
}

bool hk_store_valid(const hk_store_t *store)
{
    return store->valid;
}

bool hk_store_load(const hk_store_t *store, hk_parameters_t *parameters)
{
    uint8_t place;

    if (!store->valid) {
        return false;
    }
    for (place = 0U; place < HK_PARAMETERS; place++) {
        const float used = hk_parameter_get(parameters, place);
        float value;

        (void)memcpy(&value, &store->image[HK_STORE_VALUES_AT + 4U * place], sizeof value);
        if (memcmp(&value, &used, sizeof value) != 0) {
            (void)hk_parameter_set(parameters, place, value);
        }
    }
    return true;
}

#if HK_SIGNING
void hk_store_signing(const hk_store_t *store, hk_signing_kept_t *kept)
{
    (void)memset(kept, 0, sizeof *kept);
    if (store->valid) {
        (void)memcpy(kept, &store->image[HK_STORE_SIGNING_AT], sizeof *kept);
    }
}

void hk_store_keep(hk_store_t *store, const hk_signing_kept_t *kept)
{
    store->signing = kept;
}
#endif

bool hk_store_saving(const hk_store_t *store)
{
    return store->state != HK_STORE_IDLE;
}

/* All that a record holds between its head and its checksum. */
static void put_values(const hk_store_t *store, uint8_t *values, const hk_parameters_t *parameters)
{
    uint8_t place;

    for (place = 0U; place < HK_PARAMETERS; place++) {
        const float value = hk_parameter_get(parameters, place);

        (void)memcpy(&values[4U * place], &value, sizeof value);
    }
#if HK_SIGNING
    (void)memcpy(&values[4U * HK_PARAMETERS], store->signing, sizeof *store->signing);
#else
    (void)store;
#endif
}

/* The generation after that one; what an erased slot shows is left out. */
static uint16_t next_generation(uint16_t generation)
{
    const uint16_t next = (uint16_t)(generation + 1U);

    return next == HK_UNUSED_GENERATION ? 0U : next;
}

void hk_store_save(hk_store_t *store, const hk_parameters_t *parameters)
{
    uint8_t *const image = store->image;
    uint8_t values[HK_STORE_CRC_AT - HK_STORE_VALUES_AT];
    const uint16_t generation = number_at(&image[HK_GENERATION_AT]);

    put_values(store, values, parameters);
    store->failures = 0U;
    if (store->valid && memcmp(values, &image[HK_STORE_VALUES_AT], sizeof values) == 0) {
        store->state = HK_STORE_VERIFY; /* it is there already */
        store->place = 0U;
        return;
    }
    put_head(image);
    put_number(&image[HK_GENERATION_AT], next_generation(generation));
    (void)memcpy(&image[HK_STORE_VALUES_AT], values, sizeof values);
    put_number(&image[HK_STORE_CRC_AT], checksum(image));
    (void)memcpy(&image[HK_STORE_CRC_AT + 2U], &image[HK_GENERATION_AT], 2U);
    store->slot ^= 1U;
    store->valid = false;
    store->state = HK_STORE_ERASE;
}

/* What was written cannot be read back. The last time, go back to the record that there is. */
static hk_store_event_t try_again(hk_store_t *store)
{
#if HK_SIGNING
    const hk_signing_kept_t *const kept = store->signing;
#endif

    store->failures++;
    store->valid = false;
    store->state = HK_STORE_ERASE;
    if (store->failures < HK_TRIES) {
        return HK_STORE_NOTHING;
    }
    hk_store_init(store);
#if HK_SIGNING
    hk_store_keep(store, kept);
#endif
    return HK_STORE_FAILED;
}

/* Compare a piece of what has been written. */
static hk_store_event_t verify(hk_store_t *store)
{
    uint8_t found[HK_PIECE];
    const uint8_t left = (uint8_t)(HK_STORE_BYTES - store->place);
    const uint8_t count = left < HK_PIECE ? left : HK_PIECE;

    hk_hal_store_read(store->slot, store->place, found, count);
    if (memcmp(found, &store->image[store->place], count) != 0) {
        return try_again(store);
    }
    store->place = (uint8_t)(store->place + count);
    if (store->place < HK_STORE_BYTES) {
        return HK_STORE_NOTHING;
    }
    store->valid = true;
    store->state = HK_STORE_IDLE;
    return HK_STORE_SAVED;
}

hk_store_event_t hk_store_poll(hk_store_t *store)
{
    if (store->state == HK_STORE_IDLE || hk_hal_store_busy()) {
        return HK_STORE_NOTHING;
    }
    switch (store->state) {
    case HK_STORE_ERASE:
        hk_hal_store_erase(store->slot);
        store->place = 0U;
        store->state = HK_STORE_PUT;
        break;
    case HK_STORE_PUT:
        hk_hal_store_put(store->image[store->place]);
        store->place++;
        if (store->place == HK_STORE_BYTES) {
            store->state = HK_STORE_FINISH;
        }
        break;
    case HK_STORE_FINISH:
        hk_hal_store_finish();
        store->place = 0U;
        store->state = HK_STORE_VERIFY;
        break;
    default:
        return verify(store);
    }
    return HK_STORE_NOTHING;
}
