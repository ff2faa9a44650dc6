/* The watchdog of an RP2040, and why the chip was reset. */
#include "hk_watchdog_rp2040.h"

#include "hk_clock_rp2040.h"
#include "hk_hal.h"
#include "hk_link_rp2040.h"
#include "hk_rp2040.h"

#define HK_WATCHDOG_US UINT32_C(1500000)

/* Nobody can feed it while a sector of the flash is erased. */
#define HK_ERASE_MAX_US UINT32_C(400000)
typedef char hk_watchdog_outlasts_an_erase[HK_WATCHDOG_US > 2U * HK_ERASE_MAX_US ? 1 : -1];

/* The counter has 24 bits and goes down twice per microsecond: erratum RP2040-E1 of the data
 * sheet. */
#define HK_WATCHDOG_COUNTS (2U * HK_WATCHDOG_US)
typedef char hk_watchdog_fits_its_counter[HK_WATCHDOG_COUNTS <= UINT32_C(0xFFFFFF) ? 1 : -1];

/* What a scratch register says after a reset by the watchdog: it survives that, but no other. The
 * boot ROM too resets the chip by the watchdog, when it has loaded an image. */
#define HK_MARK_RUNNING UINT32_C(0x686B7277)
#define HK_MARK_REBOOT  UINT32_C(0x686B7262)

static hk_reset_cause_t cause;

/* A brown-out looks like the power-up that it is for the chip. */
static hk_reset_cause_t find_cause(void)
{
    if (HK_REG(HK_WATCHDOG_REASON) != 0U) {
        return HK_REG(HK_WATCHDOG_SCRATCH1) == HK_MARK_RUNNING ? HK_RESET_WATCHDOG
                                                               : HK_RESET_REQUEST;
    }
    return (HK_REG(HK_CHIP_RESET) & (HK_CHIP_HAD_RUN | HK_CHIP_HAD_RESTART)) != 0U
               ? HK_RESET_PIN
               : HK_RESET_POWER;
}

void hk_watchdog_init(void)
{
    cause = find_cause();
    HK_REG(HK_WATCHDOG_SCRATCH1) = HK_MARK_RUNNING;
    HK_CLEAR(HK_WATCHDOG_CTRL) = HK_WATCHDOG_ENABLE;
    HK_REG(HK_PSM_WDSEL) = HK_PSM_BUT_CLOCKS;
    hk_hal_watchdog_feed();
    HK_SET(HK_WATCHDOG_CTRL) = HK_WATCHDOG_ENABLE | HK_WATCHDOG_PAUSE;
}

hk_reset_cause_t hk_hal_reset_cause(void)
{
    return cause;
}

void hk_hal_watchdog_feed(void)
{
    HK_REG(HK_WATCHDOG_LOAD) = HK_WATCHDOG_COUNTS;
}

/* What is queued for the link leaves first, if it does so in time. */
#define HK_FAREWELL_US UINT32_C(60000)

void hk_hal_reboot(void)
{
    const uint32_t since_us = hk_hal_time_us();

    while (!hk_uart_quiet() && !hk_passed(since_us, HK_FAREWELL_US)) {
    }
    HK_REG(HK_WATCHDOG_SCRATCH1) = HK_MARK_REBOOT;
    HK_SET(HK_WATCHDOG_CTRL) = HK_WATCHDOG_TRIGGER;
    for (;;) {
    }
}
