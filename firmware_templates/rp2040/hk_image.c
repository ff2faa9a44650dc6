/* Makes what a Pico's boot ROM wants; runs on the computer that builds the firmware.
 *
 * hk_image crc BOOT2.bin       print assembly that holds the loader's checksum
 * hk_image uf2 IMAGE.bin OUT   wrap an image for the drive that a Pico shows with BOOTSEL held */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HK_BOOT2_BYTES 252U
#define HK_CRC_POLYNOMIAL UINT32_C(0x04C11DB7)

#define HK_FLASH_START  UINT32_C(0x10000000)
#define HK_FLASH_BYTES  (2048U * 1024U)
#define HK_UF2_BLOCK    512U
#define HK_UF2_HEADER   32U
#define HK_UF2_PAYLOAD  256U
#define HK_UF2_FAMILY   UINT32_C(0xE48BFF56) /* the RP2040 */
#define HK_UF2_HAS_FAMILY UINT32_C(0x2000)

static void fail(const char *what, const char *name)
{
    fprintf(stderr, "hk_image: %s: %s\n", name, what);
    exit(EXIT_FAILURE);
}

/* Read a whole file of at most `room` bytes and return its length. */
static size_t load(const char *name, uint8_t *bytes, size_t room)
{
    FILE *file = fopen(name, "rb");
    size_t count;

    if (file == NULL) {
        fail("cannot be read", name);
    }
    count = fread(bytes, 1U, room, file);
    if (count == 0U || fgetc(file) != EOF) {
        fail("is empty or too large", name);
    }
    fclose(file);
    return count;
}

/* CRC-32 as the boot ROM takes it: most significant bit first, begun with ones, not inverted. */
static uint32_t boot_crc(const uint8_t *bytes, size_t count)
{
    uint32_t crc = UINT32_MAX;
    size_t i;
    int bit;

    for (i = 0U; i < count; i++) {
        crc ^= (uint32_t)bytes[i] << 24;
        for (bit = 0; bit < 8; bit++) {
            crc = (crc & UINT32_C(0x80000000)) != 0U ? (crc << 1) ^ HK_CRC_POLYNOMIAL : crc << 1;
        }
    }
    return crc;
}

static void print_crc(const char *name)
{
    uint8_t loader[HK_BOOT2_BYTES] = {0};

    (void)load(name, loader, sizeof loader);
    printf("    .section .boot2_crc, \"a\"\n    .word 0x%08lX\n",
           (unsigned long)boot_crc(loader, sizeof loader));
}

static void put_word(uint8_t *at, uint32_t word)
{
    at[0] = (uint8_t)word;
    at[1] = (uint8_t)(word >> 8);
    at[2] = (uint8_t)(word >> 16);
    at[3] = (uint8_t)(word >> 24);
}

static void make_block(uint8_t *block, const uint8_t *payload, uint32_t number, uint32_t blocks)
{
    const uint32_t header[] = {UINT32_C(0x0A324655),
                               UINT32_C(0x9E5D5157),
                               HK_UF2_HAS_FAMILY,
                               HK_FLASH_START + number * HK_UF2_PAYLOAD,
                               HK_UF2_PAYLOAD,
                               number,
                               blocks,
                               HK_UF2_FAMILY};
    size_t i;

    memset(block, 0, HK_UF2_BLOCK);
    for (i = 0U; i < sizeof header / sizeof header[0]; i++) {
        put_word(block + 4U * i, header[i]);
    }
    memcpy(block + HK_UF2_HEADER, payload, HK_UF2_PAYLOAD);
    put_word(block + HK_UF2_BLOCK - 4U, UINT32_C(0x0AB16F30));
}

static void write_uf2(const char *from, const char *to)
{
    static uint8_t image[HK_FLASH_BYTES];
    uint8_t block[HK_UF2_BLOCK];
    const size_t count = load(from, image, sizeof image);
    const uint32_t blocks = (uint32_t)((count + HK_UF2_PAYLOAD - 1U) / HK_UF2_PAYLOAD);
    FILE *file = fopen(to, "wb");
    bool good = file != NULL;
    uint32_t i;

    for (i = 0U; good && i < blocks; i++) {
        make_block(block, image + (size_t)i * HK_UF2_PAYLOAD, i, blocks);
        good = fwrite(block, 1U, sizeof block, file) == sizeof block;
    }
    if (file == NULL || fclose(file) != 0 || !good) {
        fail("cannot be written", to);
    }
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "crc") == 0) {
        print_crc(argv[2]);
    } else if (argc == 4 && strcmp(argv[1], "uf2") == 0) {
        write_uf2(argv[2], argv[3]);
    } else {
        fail("crc BOOT2.bin, or uf2 IMAGE.bin OUT.uf2", "usage");
    }
    return EXIT_SUCCESS;
}
