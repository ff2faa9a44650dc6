/* The hardware layer on an RP2040 at 125 MHz, as on a Raspberry Pi Pico: see hk_hal.h.
 *
 * Here are time, sleep and the sensor's INT pin, GP6; the bus, the link, the store and the watchdog
 * have files of their own. */
#include "hk_hal.h"

#include "hk_clock_rp2040.h"
#include "hk_design.h"
#include "hk_interrupt_rp2040.h"
#include "hk_link_rp2040.h"
#include "hk_rp2040.h"
#include "hk_watchdog_rp2040.h"

#define HK_PIN_INT 6U

void hk_irq_timer_0(void);
void hk_irq_io_bank0(void);

/* --- Clock: the timer counts microseconds, and ends a sleep ---------------------------------- */

/* So often somebody looks for a sample whose announcement was lost. */
#define HK_SLEEP_MAX_US (HK_PERIOD_US / 8U)

uint32_t hk_hal_time_us(void)
{
    return HK_REG(HK_TIMER_RAWL);
}

static void set_alarm(void)
{
    HK_REG(HK_TIMER_ALARM0) = hk_hal_time_us() + HK_SLEEP_MAX_US;
}

void hk_irq_timer_0(void)
{
    HK_REG(HK_TIMER_INTR) = 1U;
    set_alarm();
}

/* --- Data ready: the sensor holds its pin high until it is read ------------------------------ */

static volatile uint32_t ready_us;

void hk_irq_io_bank0(void)
{
    ready_us = hk_hal_time_us();
    HK_REG(HK_IO_INTR0) = HK_IO_EDGE_HIGH(HK_PIN_INT);
}

static bool sample_announced(void)
{
    return (HK_REG(HK_SIO_IN) & HK_BIT(HK_PIN_INT)) != 0U;
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    uint32_t mask;

    if (!sample_announced()) {
        return false;
    }
    mask = hk_interrupts_off();
    /* The pin may just have risen, with its interrupt still to come. */
    *time_us = (HK_REG(HK_IO_INTR0) & HK_IO_EDGE_HIGH(HK_PIN_INT)) != 0U ? hk_hal_time_us()
                                                                         : ready_us;
    hk_interrupts_back(mask);
    return true;
}

/* --- The rest -------------------------------------------------------------------------------- */

static void init_sensor_pin(void)
{
    HK_REG(HK_PAD(HK_PIN_INT)) = HK_PAD_INPUT | HK_PAD_SCHMITT | HK_PAD_4_MA | HK_PAD_PULL_DOWN;
    HK_REG(HK_IO_CTRL(HK_PIN_INT)) = HK_IO_SIO;
    HK_REG(HK_IO_INTR0) = HK_IO_EDGE_HIGH(HK_PIN_INT);
    HK_REG(HK_IO_INTE0) = HK_IO_EDGE_HIGH(HK_PIN_INT);
}

void hk_hal_init(void)
{
    hk_clock_init();
    hk_watchdog_init();
    hk_reset_hold(HK_RESET_TIMER | HK_RESET_UART0 | HK_RESET_IO_BANK0 | HK_RESET_PADS_BANK0);
    hk_reset_release(HK_RESET_TIMER | HK_RESET_UART0 | HK_RESET_IO_BANK0 | HK_RESET_PADS_BANK0);
    hk_uart_init();
    init_sensor_pin();
    hk_hal_i2c_recover();
    HK_REG(HK_TIMER_INTE) = 1U;
    set_alarm();
    HK_REG(HK_NVIC_ENABLE) =
        HK_BIT(HK_IRQ_TIMER_0) | HK_BIT(HK_IRQ_IO_BANK0) | HK_BIT(HK_IRQ_UART0);
    hk_interrupts_back(0U);
}

/* WFI ends with an interrupt even while they are off, and it is taken when they are on again: so
 * none is lost between the test of the pin and the sleep. The timer ends it at the latest. */
void hk_hal_idle(void)
{
    const uint32_t mask = hk_interrupts_off();

    if (!sample_announced()) {
        __asm__ volatile("dsb\n\twfi" : : : "memory");
    }
    hk_interrupts_back(mask);
}

void hk_hal_mark_begin(void)
{
    HK_REG(HK_WATCHDOG_SCRATCH0) = 1U;
}

void hk_hal_mark_end(void)
{
    HK_REG(HK_WATCHDOG_SCRATCH0) = 0U;
}
