/* Resets of the ATmega328P: why it started, starting over, and the watchdog. */
#include <avr/io.h>
#include <avr/wdt.h>

#include "hk_atmega328p.h"
#include "hk_hal.h"

/* What outlives a reset; after power-up it is arbitrary. */
#define HK_NOINIT __attribute__((section(".noinit")))

#define HK_REBOOT_WISH 0xB007U
#define HK_ALL_FLAGS   (_BV(PORF) | _BV(EXTRF) | _BV(BORF) | _BV(WDRF))

static uint8_t reset_flags HK_NOINIT;
static uint16_t reboot_wish HK_NOINIT;
static bool reboot_wished HK_NOINIT;

/* Runs before main and before variables have their values. After a reset by the watchdog it goes on
 * running with its shortest time until WDRF is cleared, so that comes first. A boot loader may have
 * cleared the flags; Optiboot leaves them in r2, which nothing has touched yet. */
void hk_reset_seen(void) __attribute__((naked, used, section(".init3")));
void hk_reset_seen(void)
{
    uint8_t told;

    __asm__ volatile("mov %0, r2" : "=r"(told));
    reset_flags = MCUSR;
    if (reset_flags == 0U) {
        reset_flags = (told & (uint8_t)~HK_ALL_FLAGS) == 0U ? told : 0U;
    }
    MCUSR = 0U;
    wdt_disable();
    reboot_wished = reboot_wish == HK_REBOOT_WISH;
    reboot_wish = 0U;
}

/* Flags gather until they are cleared, and power-up sets others beside its own: the first that
 * holds is the cause. Optiboot leaves by its own watchdog after a reset by the pin. */
hk_reset_cause_t hk_hal_reset_cause(void)
{
    if ((reset_flags & _BV(PORF)) != 0U || reset_flags == 0U) {
        return HK_RESET_POWER;
    }
    if ((reset_flags & _BV(BORF)) != 0U) {
        return HK_RESET_BROWN_OUT;
    }
    if ((reset_flags & _BV(EXTRF)) != 0U) {
        return HK_RESET_PIN;
    }
    return reboot_wished ? HK_RESET_REQUEST : HK_RESET_WATCHDOG;
}

void hk_watchdog_start(void)
{
    wdt_enable(WDTO_1S);
}

void hk_hal_watchdog_feed(void)
{
    wdt_reset();
}

/* The time of the watchdog lets what is queued for the link leave. */
void hk_hal_reboot(void)
{
    reboot_wish = HK_REBOOT_WISH;
    wdt_enable(WDTO_60MS);
    for (;;) {
    }
}
