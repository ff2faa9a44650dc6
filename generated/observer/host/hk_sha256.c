/* SHA-256: see the header. Numbers of sections are those of FIPS 180-4.
 *
 * Rotations are put together of whole bytes, which cost an 8-bit processor next to nothing, and of
 * single bits. */
#include "hk_sha256.h"

#include "hk_design.h"

#if HK_SIGNING

#ifdef __AVR__
/* Expressions that are put together late need more registers than there are: a tenth slower. */
#pragma GCC optimize("no-tree-ter")
#endif

#include <string.h>

#include "hk_flash.h"

#define HK_BLOCK_BYTES  64U
#define HK_LENGTH_AT    56U
#define HK_GROUP_ROUNDS 16

/* One large function would keep its variables in memory. */
#define HK_APART  static __attribute__((noinline))
#define HK_WITHIN static inline __attribute__((always_inline))

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "words are filled as the processor holds them, the lowest byte first"
#endif

/* Section 5.3.3: of the square roots of the first eight primes. */
static const uint32_t start[8] HK_FLASH = {
    0x6A09E667U, 0xBB67AE85U, 0x3C6EF372U, 0xA54FF53AU, 0x510E527FU, 0x9B05688CU,
    0x1F83D9ABU, 0x5BE0CD19U};

/* Section 4.2.2: of the cube roots of the first 64 primes. */
static const uint32_t constant[64] HK_FLASH = {
    0x428A2F98U, 0x71374491U, 0xB5C0FBCFU, 0xE9B5DBA5U, 0x3956C25BU, 0x59F111F1U,
    0x923F82A4U, 0xAB1C5ED5U, 0xD807AA98U, 0x12835B01U, 0x243185BEU, 0x550C7DC3U,
    0x72BE5D74U, 0x80DEB1FEU, 0x9BDC06A7U, 0xC19BF174U, 0xE49B69C1U, 0xEFBE4786U,
    0x0FC19DC6U, 0x240CA1CCU, 0x2DE92C6FU, 0x4A7484AAU, 0x5CB0A9DCU, 0x76F988DAU,
    0x983E5152U, 0xA831C66DU, 0xB00327C8U, 0xBF597FC7U, 0xC6E00BF3U, 0xD5A79147U,
    0x06CA6351U, 0x14292967U, 0x27B70A85U, 0x2E1B2138U, 0x4D2C6DFCU, 0x53380D13U,
    0x650A7354U, 0x766A0ABBU, 0x81C2C92EU, 0x92722C85U, 0xA2BFE8A1U, 0xA81A664BU,
    0xC24B8B70U, 0xC76C51A3U, 0xD192E819U, 0xD6990624U, 0xF40E3585U, 0x106AA070U,
    0x19A4C116U, 0x1E376C08U, 0x2748774CU, 0x34B0BCB5U, 0x391C0CB3U, 0x4ED8AA4AU,
    0x5B9CCA4FU, 0x682E6FF3U, 0x748F82EEU, 0x78A5636FU, 0x84C87814U, 0x8CC70208U,
    0x90BEFFFAU, 0xA4506CEBU, 0xBEF9A3F7U, 0xC67178F2U};

/* By one bit; what avr-gcc makes of shifts would take three times as long. */
HK_WITHIN uint32_t right_1(uint32_t x)
{
#ifdef __AVR__
    __asm__("bst %A0, 0\n\tror %D0\n\tror %C0\n\tror %B0\n\tror %A0\n\tbld %D0, 7" : "+r"(x));
    return x;
#else
    return (x >> 1) | (x << 31);
#endif
}

HK_WITHIN uint32_t left_1(uint32_t x)
{
#ifdef __AVR__
    __asm__("lsl %A0\n\trol %B0\n\trol %C0\n\trol %D0\n\tadc %A0, __zero_reg__" : "+r"(x));
    return x;
#else
    return (x << 1) | (x >> 31);
#endif
}

/* To the right, by so many bytes. */
HK_WITHIN uint32_t bytes_1(uint32_t x)
{
    return (x >> 8) | (x << 24);
}

HK_WITHIN uint32_t bytes_2(uint32_t x)
{
    return (x >> 16) | (x << 16);
}

HK_WITHIN uint32_t bytes_3(uint32_t x)
{
    return (x >> 24) | (x << 8);
}

/* Section 4.1.2, (4.4): rotated by 2, 13 = 16 - 3, 22 = 24 - 2. */
HK_WITHIN uint32_t sum_0(uint32_t x)
{
    const uint32_t left_2 = left_1(left_1(x));

    return right_1(right_1(x)) ^ bytes_2(left_1(left_2)) ^ bytes_3(left_2);
}

/* (4.5): by 6 = 8 - 2, 11 = 8 + 3, 25 = 24 + 1. */
HK_WITHIN uint32_t sum_1(uint32_t x)
{
    const uint32_t one = right_1(x);

    return bytes_1(left_1(left_1(x)) ^ right_1(right_1(one))) ^ bytes_3(one);
}

/* (4.6): by 7 = 8 - 1, 18 = 16 + 2, and shifted by 3. */
HK_WITHIN uint32_t sigma_0(uint32_t x)
{
    const uint32_t two = right_1(right_1(x));

    return bytes_1(left_1(x)) ^ bytes_2(two) ^ (right_1(two) & 0x1FFFFFFFU);
}

/* (4.7): by 17 = 16 + 1, 19 = 16 + 3, and shifted by 10 = 8 + 2. */
HK_WITHIN uint32_t sigma_1(uint32_t x)
{
    const uint32_t one = right_1(x);
    const uint32_t two = right_1(one);

    return bytes_2(one ^ right_1(two)) ^ (bytes_1(two) & 0x003FFFFFU);
}

/* Section 6.2.2, step 3. Of a..h at v, the next eight stand at v - 1: all but two keep their places,
 * h is left behind, d becomes e. */
HK_APART void round_at(uint32_t *v, uint32_t sum)
{
    uint32_t chosen = v[5] ^ v[6];

    sum += v[7];
    chosen &= v[4];
    chosen ^= v[6];
    sum += chosen;
    sum += sum_1(v[4]);
    v[3] += sum;
    chosen = v[1] ^ v[2];
    chosen &= v[0];
    chosen ^= v[1] & v[2];
    sum += chosen;
    sum += sum_0(v[0]);
    v[-1] = sum;
}

/* Section 6.2.2, step 1: the words of the next 16 rounds, in the place of the last. */
HK_APART void next_words(uint32_t word[16])
{
    uint8_t i;

    for (i = 0U; i < 16U; i++) {
        uint32_t sum = word[i];

        sum += sigma_0(word[(i + 1U) & 15U]);
        sum += word[(i + 9U) & 15U];
        sum += sigma_1(word[(i + 14U) & 15U]);
        word[i] = sum;
    }
}

HK_APART void take_block(hk_sha256_t *sha)
{
    uint32_t v[HK_GROUP_ROUNDS + 8];
    uint32_t *const first = &v[HK_GROUP_ROUNDS];
    uint32_t *at;
    const uint32_t *k = constant;
    uint8_t group;
    uint8_t i;

    (void)memcpy(first, sha->state, sizeof sha->state);
    for (group = 0U; group < 4U; group++) {
        if (group > 0U) {
            next_words(sha->word);
            (void)memcpy(first, v, sizeof sha->state);
        }
        at = first;
        for (i = 0U; i < HK_GROUP_ROUNDS; i++) {
            round_at(at, sha->word[i] + hk_flash_u32(k));
            at--;
            k++;
        }
    }
    for (i = 0U; i < 8U; i++) {
        sha->state[i] += v[i];
    }
}

void hk_sha256_init(hk_sha256_t *sha)
{
    uint8_t i;

    for (i = 0U; i < 8U; i++) {
        sha->state[i] = hk_flash_u32(&start[i]);
    }
    sha->count = 0U;
}

/* The highest byte of a word comes first. */
HK_APART void take_byte(hk_sha256_t *sha, uint8_t byte)
{
    const uint8_t place = (uint8_t)(sha->count % HK_BLOCK_BYTES);

    ((uint8_t *)sha->word)[place ^ 3U] = byte;
    sha->count++;
    if (place == HK_BLOCK_BYTES - 1U) {
        take_block(sha);
    }
}

void hk_sha256_add(hk_sha256_t *sha, const uint8_t *bytes, uint16_t count)
{
    uint16_t i;

    for (i = 0U; i < count; i++) {
        take_byte(sha, bytes[i]);
    }
}

/* Section 5.1.1: a one, zeros, and the number of bits. */
void hk_sha256_end(hk_sha256_t *sha, uint8_t hash[HK_SHA256_BYTES])
{
    const uint32_t bits = 8UL * sha->count;
    uint8_t i;

    take_byte(sha, 0x80U);
    while (sha->count % HK_BLOCK_BYTES != HK_LENGTH_AT) {
        take_byte(sha, 0U);
    }
    for (i = 0U; i < 8U; i++) {
        take_byte(sha, i < 4U ? 0U : (uint8_t)(bits >> (56U - 8U * i)));
    }
    for (i = 0U; i < HK_SHA256_BYTES; i++) {
        hash[i] = ((const uint8_t *)sha->state)[i ^ 3U];
    }
}

#else

typedef char hk_sha256_is_not_used[1];

#endif
