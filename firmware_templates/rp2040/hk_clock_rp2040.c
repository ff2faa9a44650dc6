/* The clocks of the RP2040: see the header.
 *
 * There is no limit to the waits here: without its crystal the board cannot talk, so it stays. */
#include "hk_clock_rp2040.h"

#include "hk_rp2040.h"

#define HK_CRYSTAL_HZ UINT32_C(12000000)
#define HK_MHZ        UINT32_C(1000000)

/* The oscillator of the PLL makes 12 MHz * 125 = 1500 MHz, divided by 6 and by 2: 125 MHz. */
#define HK_PLL_FEEDBACK UINT32_C(125)
#define HK_PLL_DIVIDE_1 UINT32_C(6)
#define HK_PLL_DIVIDE_2 UINT32_C(2)

#if HK_CLOCK_HZ != 12000000 * 125 / 6 / 2
#error "the clock of this board layer is 125 MHz"
#endif

/* Start-up delay of the crystal in units of 256 of its periods: 1 ms, rounded up. */
#define HK_XOSC_DELAY ((HK_CRYSTAL_HZ / 1000U + 255U) / 256U)

static void wait_for(uint32_t address, uint32_t bits)
{
    while ((HK_REG(address) & bits) != bits) {
    }
}

void hk_reset_hold(uint32_t peripherals)
{
    HK_SET(HK_RESETS_RESET) = peripherals;
}

void hk_reset_release(uint32_t peripherals)
{
    HK_CLEAR(HK_RESETS_RESET) = peripherals;
    wait_for(HK_RESETS_DONE, peripherals);
}

/* Both clocks on the crystal, whatever they ran on before. */
static void run_on_crystal(void)
{
    HK_REG(HK_XOSC_STARTUP) = HK_XOSC_DELAY;
    HK_REG(HK_XOSC_CTRL) = HK_XOSC_ENABLE | HK_XOSC_1_TO_15_MHZ;
    wait_for(HK_XOSC_STATUS, HK_XOSC_STABLE);
    HK_REG(HK_CLK_SYS_CTRL) = HK_CLK_SYS_REF;
    wait_for(HK_CLK_SYS_SELECTED, HK_BIT(HK_CLK_SYS_REF));
    HK_REG(HK_CLK_SYS_DIV) = HK_CLK_WHOLE;
    HK_REG(HK_CLK_REF_CTRL) = HK_CLK_REF_XOSC;
    wait_for(HK_CLK_REF_SELECTED, HK_BIT(HK_CLK_REF_XOSC));
    HK_REG(HK_CLK_REF_DIV) = HK_CLK_WHOLE;
}

static void start_pll(void)
{
    hk_reset_hold(HK_RESET_PLL_SYS);
    hk_reset_release(HK_RESET_PLL_SYS);
    HK_REG(HK_PLL_SYS_CS) = 1U; /* the crystal undivided */
    HK_REG(HK_PLL_SYS_FBDIV) = HK_PLL_FEEDBACK;
    HK_CLEAR(HK_PLL_SYS_PWR) = HK_PLL_POWER_DOWN;
    wait_for(HK_PLL_SYS_CS, HK_PLL_LOCK);
    HK_REG(HK_PLL_SYS_PRIM) =
        (HK_PLL_DIVIDE_1 << HK_PLL_POST_1) | (HK_PLL_DIVIDE_2 << HK_PLL_POST_2);
    HK_CLEAR(HK_PLL_SYS_PWR) = HK_PLL_DIVIDERS_DOWN;
}

void hk_clock_init(void)
{
    run_on_crystal();
    start_pll();
    HK_REG(HK_CLK_SYS_CTRL) = HK_CLK_SYS_AUX;
    wait_for(HK_CLK_SYS_SELECTED, HK_BIT(HK_CLK_SYS_AUX));
    HK_REG(HK_CLK_PERI_CTRL) = HK_CLK_PERI_ENABLE;
    HK_REG(HK_WATCHDOG_TICK) = HK_TICK_ENABLE | (HK_CRYSTAL_HZ / HK_MHZ);
}

bool hk_passed(uint32_t since_us, uint32_t wait_us)
{
    return HK_REG(HK_TIMER_RAWL) - since_us >= wait_us;
}
