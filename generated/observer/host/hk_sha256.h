/* SHA-256 as FIPS 180-4 defines it, for what is signed. */
#ifndef HK_SHA256_H
#define HK_SHA256_H

#include <stdint.h>

#define HK_SHA256_BYTES 32U

typedef struct {
    uint32_t state[8];
    uint32_t word[16]; /* the block that is being filled */
    uint16_t count;    /* bytes so far */
} hk_sha256_t;

void hk_sha256_init(hk_sha256_t *sha);
void hk_sha256_add(hk_sha256_t *sha, const uint8_t *bytes, uint16_t count);
void hk_sha256_end(hk_sha256_t *sha, uint8_t hash[HK_SHA256_BYTES]);

#endif
