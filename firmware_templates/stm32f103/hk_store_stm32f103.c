/* The non-volatile store of an STM32F103: the last two pages of its flash, one for each slot; see
 * hk_hal.h.
 *
 * The flash cannot be read while it is erased or programmed. The program is in it too, so the core
 * stands still meanwhile, interrupts included: 20 to 40 ms for a page, 52 us for two bytes. */
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"

#define HK_PAGE_BYTES 1024U
_Static_assert(HK_STORE_SLOT_BYTES <= HK_PAGE_BYTES, "a slot is a page");

#define HK_PROGRAM_LIMIT_US 1000U

/* From the linker script. */
extern const uint8_t hk_store_start[];

/* The slot that is replaced: where the next two bytes go, and the first of them. */
static struct {
    uint32_t place;
    uint32_t end;
    uint8_t first;
    bool half;
} writer;

static const uint8_t *page_of(uint8_t slot)
{
    return &hk_store_start[slot * HK_PAGE_BYTES];
}

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    const volatile uint8_t *from = page_of(slot) + offset;
    uint8_t i;

    for (i = 0U; i < count; i++) {
        bytes[i] = from[i];
    }
}

bool hk_hal_store_busy(void)
{
    return (FLASH_SR & FLASH_SR_BSY) != 0U;
}

/* The busy flag comes a clock after what raises it; a part that does not make the core wait, as some
 * compatible ones, would be asked too early. */
static void settle(void)
{
    __asm__ volatile("dsb\n\tnop" : : : "memory");
}

/* A key out of turn would lock the flash until the next reset. */
static void unlock(void)
{
    if ((FLASH_CR & FLASH_CR_LOCK) != 0U) {
        FLASH_KEYR = FLASH_KEY1;
        FLASH_KEYR = FLASH_KEY2;
    }
}

void hk_hal_store_erase(uint8_t slot)
{
    writer.place = (uint32_t)(uintptr_t)page_of(slot);
    writer.end = writer.place + HK_STORE_SLOT_BYTES;
    writer.half = false;
    unlock();
    FLASH_SR = FLASH_SR_PGERR | FLASH_SR_WRPRTERR | FLASH_SR_EOP; /* ones clear */
    FLASH_CR = FLASH_CR_PER;
    FLASH_AR = writer.place;
    FLASH_CR = FLASH_CR_PER | FLASH_CR_STRT;
    settle();
}

static void program(uint8_t second)
{
    FLASH_CR = FLASH_CR_PG;
    *(volatile uint16_t *)(uintptr_t)writer.place = (uint16_t)(writer.first | (second << 8));
    settle();
    writer.place += 2U;
    writer.half = false;
}

void hk_hal_store_put(uint8_t byte)
{
    if (writer.half) {
        program(byte);
    } else if (writer.place < writer.end) {
        writer.first = byte;
        writer.half = true;
    }
}

void hk_hal_store_finish(void)
{
    const uint32_t since = TIM2_CNT;

    if (writer.half) {
        program(0xFFU);
    }
    while (hk_hal_store_busy() && hk_board_elapsed_us(since) <= HK_PROGRAM_LIMIT_US) {
    }
    FLASH_CR = FLASH_CR_LOCK;
}
