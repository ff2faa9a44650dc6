/* The non-volatile store of an RP2040: the last two sectors of its flash, a slot in each.
 *
 * Program and data come out of the same flash, which cannot be read while it is changed: an erase
 * takes 45 ms, at most 400 ms, and programming a page 0.4 ms, at most 3 ms (W25Q16JV). All that
 * while the code runs in RAM, no interrupt is taken and nobody reads the sensor. */
#include "hk_hal.h"
#include "hk_interrupt_rp2040.h"
#include "hk_rp2040.h"

#define HK_SECTOR_BYTES 4096U
#define HK_PAGE_BYTES   256U
#define HK_BLOCK_BYTES  65536U          /* for longer erases than ours, the ROM wants both */
#define HK_BLOCK_ERASE  UINT8_C(0xD8)
#define HK_LOADER_WORDS 64U
#define HK_ERASED       UINT8_C(0xFF)

/* Of the linker script. */
extern const volatile uint32_t hk_flash_start[];
extern const volatile uint8_t hk_store_start[];
extern const uint16_t hk_rom_pointers[]; /* table of functions, table of data, look-up */

/* What the boot ROM offers for the flash; offsets are from its start. */
typedef void (*hk_function_t)(void);
typedef void (*hk_erase_t)(uint32_t offset, uint32_t count, uint32_t block_bytes, uint8_t command);
typedef void (*hk_program_t)(uint32_t offset, const uint8_t *bytes, uint32_t count);
typedef hk_function_t (*hk_look_up_t)(const uint16_t *table, uint32_t code);

typedef struct {
    hk_function_t connect;
    hk_function_t leave_reading;
    hk_erase_t erase;
    hk_program_t program;
    hk_function_t flush;
} hk_rom_t;

static uint32_t loader[HK_LOADER_WORDS]; /* a copy of the second-stage loader */
static uint8_t page[HK_PAGE_BYTES];
static uint8_t slot_in_work;
static uint8_t put_count;

/* --- In RAM ---------------------------------------------------------------------------------- */

/* Erase the sector at an offset, or program the page there. Nothing in here may be in the flash. */
__attribute__((section(".ram_code"), noinline)) static void
change_flash(const hk_rom_t *rom, uint32_t offset, const uint8_t *bytes)
{
    const hk_function_t read_again = (hk_function_t)((uintptr_t)loader | 1U);

    rom->connect();
    rom->leave_reading();
    if (bytes == 0) {
        rom->erase(offset, HK_SECTOR_BYTES, HK_BLOCK_BYTES, HK_BLOCK_ERASE);
    } else {
        rom->program(offset, bytes, HK_PAGE_BYTES);
    }
    rom->flush();
    read_again();
}

/* --- In flash -------------------------------------------------------------------------------- */

/* The ROM knows its functions by two letters each. */
static hk_function_t rom_function(char first, char second)
{
    const hk_look_up_t look_up = (hk_look_up_t)(uintptr_t)hk_rom_pointers[2];
    const uint16_t *table = (const uint16_t *)(uintptr_t)hk_rom_pointers[0];

    return look_up(table, ((uint32_t)second << 8) | (uint32_t)first);
}

static void find_rom(hk_rom_t *rom)
{
    rom->connect = rom_function('I', 'F');
    rom->leave_reading = rom_function('E', 'X');
    rom->erase = (hk_erase_t)rom_function('R', 'E');
    rom->program = (hk_program_t)rom_function('R', 'P');
    rom->flush = rom_function('F', 'C');
}

static uint32_t offset_of(uint8_t slot)
{
    return (uint32_t)((uintptr_t)hk_store_start - (uintptr_t)hk_flash_start)
           + HK_SECTOR_BYTES * slot;
}

/* The watchdog is fed, for it could come in the midst of the longest erase. */
static void change(const uint8_t *bytes)
{
    hk_rom_t rom;
    uint32_t mask;
    uint32_t i;

    find_rom(&rom);
    for (i = 0U; i < HK_LOADER_WORDS; i++) {
        loader[i] = hk_flash_start[i];
    }
    hk_hal_watchdog_feed();
    mask = hk_interrupts_off();
    change_flash(&rom, offset_of(slot_in_work), bytes);
    hk_interrupts_back(mask);
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    const volatile uint8_t *from = hk_store_start + HK_SECTOR_BYTES * slot + offset;
    uint8_t i;

    for (i = 0U; i < count; i++) {
        bytes[i] = from[i];
    }
}

/* Nothing goes on in the background. */
bool hk_hal_store_busy(void)
{
    return false;
}

void hk_hal_store_erase(uint8_t slot)
{
    uint32_t i;

    slot_in_work = slot;
    put_count = 0U;
    for (i = 0U; i < HK_PAGE_BYTES; i++) {
        page[i] = HK_ERASED;
    }
    change(0);
}

void hk_hal_store_put(uint8_t byte)
{
    if (put_count < HK_STORE_SLOT_BYTES) {
        page[put_count++] = byte;
    }
}

void hk_hal_store_finish(void)
{
    change(page);
}
