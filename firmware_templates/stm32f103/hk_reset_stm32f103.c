/* Why an STM32F103 started, starting it over, and its watchdog: see hk_hal.h. */
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"

/* The watchdog counts an oscillator of 30 to 60 kHz, divided by 32: 1 s at the most, 2 s at the
 * least. */
#define HK_WATCHDOG_COUNTS 1875U
_Static_assert(HK_WATCHDOG_COUNTS * 32U == 60000U && HK_WATCHDOG_COUNTS - 1U <= IWDG_RLR_MAX,
               "the watchdog's time is wrong");

/* Turns of a short loop at 8 MHz: some 10 ms. */
#define HK_WATCHDOG_PATIENCE 10000U

/* The queue of 255 bytes takes 44 ms at 57600 bit/s. */
#define HK_FAREWELL_US 60000U

/* Stands in memory that the start leaves alone while a reset on request is under way. */
#define HK_REQUESTED UINT32_C(0x52455354)
__attribute__((section(".noinit"))) static volatile uint32_t request;

static hk_reset_cause_t cause;

/* Every reset also pulls the pin. The part has one flag for power-up and brown-out. A reset by
 * software that nobody has requested is that of the handler of faults, which stands in for the
 * watchdog. */
static hk_reset_cause_t find_cause(uint32_t flags, bool requested)
{
    if ((flags & (RCC_CSR_IWDGRSTF | RCC_CSR_WWDGRSTF)) != 0U) {
        return HK_RESET_WATCHDOG;
    }
    if ((flags & RCC_CSR_SFTRSTF) != 0U) {
        return requested ? HK_RESET_REQUEST : HK_RESET_WATCHDOG;
    }
    return (flags & (RCC_CSR_PORRSTF | RCC_CSR_LPWRRSTF)) != 0U ? HK_RESET_POWER : HK_RESET_PIN;
}

hk_reset_cause_t hk_hal_reset_cause(void)
{
    return cause;
}

void hk_board_find_reset_cause(void)
{
    cause = find_cause(RCC_CSR, request == HK_REQUESTED);
    request = 0U;
    RCC_CSR |= RCC_CSR_RMVF;
}

/* What is queued leaves first, if it does so in time. */
void hk_hal_reboot(void)
{
    const uint32_t since = TIM2_CNT;

    while (!hk_board_has_sent() && hk_board_elapsed_us(since) <= HK_FAREWELL_US) {
    }
    request = HK_REQUESTED;
    hk_board_restart();
}

/* Prescaler and reload value take some of the oscillator's periods to arrive; only then the counter
 * begins with them. An oscillator that does not run at all must not hold the start. */
void hk_board_start_watchdog(void)
{
    uint32_t patience = HK_WATCHDOG_PATIENCE;

    IWDG_KR = IWDG_KR_START;
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_PR = IWDG_PR_BY_32;
    IWDG_RLR = HK_WATCHDOG_COUNTS - 1U;
    while (IWDG_SR != 0U && patience > 0U) {
        patience--;
    }
    hk_hal_watchdog_feed();
}

void hk_hal_watchdog_feed(void)
{
    IWDG_KR = IWDG_KR_RELOAD;
}
