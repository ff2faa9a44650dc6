/* Keeps the parameters over a loss of the supply.
 *
 * A record fills the beginning of one of the two slots of hk_hal.h, and the next one goes to the
 * other. It holds layout, digest of the design, a generation counter, the values, the secret if
 * frames are signed, a checksum and the generation once more. The newest valid record counts; one of
 * another design or layout is none. */
#ifndef HK_STORE_H
#define HK_STORE_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_design.h"
#include "hk_hal.h"
#include "hk_parameter.h"
#include "hk_signing.h"

#define HK_DIGEST_BYTES 6U
#define HK_STORE_VALUES_AT (2U + HK_DIGEST_BYTES + 2U)
#define HK_STORE_SIGNING_AT (HK_STORE_VALUES_AT + 4U * HK_PARAMETERS)
#define HK_STORE_CRC_AT (HK_STORE_SIGNING_AT + HK_SIGNING * sizeof(hk_signing_kept_t))
#define HK_STORE_BYTES (HK_STORE_CRC_AT + 4U)

typedef char hk_record_fits_slot[HK_STORE_BYTES <= HK_STORE_SLOT_BYTES ? 1 : -1];

typedef enum {
    HK_STORE_IDLE,
    HK_STORE_ERASE,
    HK_STORE_PUT,
    HK_STORE_FINISH,
    HK_STORE_VERIFY
} hk_store_state_t;

typedef enum { HK_STORE_NOTHING, HK_STORE_SAVED, HK_STORE_FAILED } hk_store_event_t;

typedef struct {
    uint8_t state;
    uint8_t slot;    /* of the newest record, or where one is being written */
    uint8_t place;   /* of the byte that comes next */
    uint8_t failures;
    bool valid;      /* image is the newest record, and no slot is being written */
#if HK_SIGNING
    const hk_signing_kept_t *signing; /* what the next record holds of it */
#endif
    uint8_t image[HK_STORE_BYTES];
} hk_store_t;

/* Look for the newest valid record. */
void hk_store_init(hk_store_t *store);

/* Whether init has found a record, or save has written one. */
bool hk_store_valid(const hk_store_t *store);

/* Set the parameters to the record's values; a value that is refused leaves the parameter as it is.
 * Returns false if there is no record. */
bool hk_store_load(const hk_store_t *store, hk_parameters_t *parameters);

#if HK_SIGNING
/* What the record holds for signing; zeros if there is no record. And: where the next one is to
 * take it from, which must be said before the first save. */
void hk_store_signing(const hk_store_t *store, hk_signing_kept_t *kept);
void hk_store_keep(hk_store_t *store, const hk_signing_kept_t *kept);
#endif

/* Begin to write a record; poll carries it out. If the newest one says the same, nothing is written
 * and poll says so. Not while one is being written. */
void hk_store_save(hk_store_t *store, const hk_parameters_t *parameters);
bool hk_store_saving(const hk_store_t *store);

/* Take one step of at most one byte. */
hk_store_event_t hk_store_poll(hk_store_t *store);

#endif
