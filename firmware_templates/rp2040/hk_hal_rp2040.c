/* The hardware layer on an RP2040 at 125 MHz, as on a Raspberry Pi Pico: see hk_hal.h.
 *
 * GP6 the sensor's INT pin, GP0 (UART0) the link; hk_i2c_rp2040.c has the bus. */
#include "hk_hal.h"

#include "hk_clock_rp2040.h"
#include "hk_design.h"
#include "hk_rp2040.h"

#define HK_PIN_TX  0U
#define HK_PIN_INT 6U

void hk_irq_timer_0(void);
void hk_irq_io_bank0(void);
void hk_irq_uart0(void);

static uint32_t interrupts_off(void)
{
    uint32_t mask;

    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(mask) : : "memory");
    return mask;
}

static void interrupts_back(uint32_t mask)
{
    __asm__ volatile("msr primask, %0" : : "r"(mask) : "memory");
}

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
    mask = interrupts_off();
    /* The pin may just have risen, with its interrupt still to come. */
    *time_us = (HK_REG(HK_IO_INTR0) & HK_IO_EDGE_HIGH(HK_PIN_INT)) != 0U ? hk_hal_time_us()
                                                                         : ready_us;
    interrupts_back(mask);
    return true;
}

/* --- Link: a ring that the transmitter empties by interrupt ---------------------------------- */

#define HK_RING_SIZE 256U /* indices wrap by themselves */

/* The divisor has 6 fraction bits and divides by 16 beside: clk_peri * 4 / baud, rounded. */
#define HK_UART_DIVISOR ((HK_CLOCK_HZ * 8UL / HK_LINK_BAUD + 1UL) / 2UL)
#define HK_BAUD_MADE (HK_CLOCK_HZ * 4UL / HK_UART_DIVISOR)
typedef char hk_baud_within_1_percent[(HK_BAUD_MADE * 100UL <= HK_LINK_BAUD * 101UL
                                       && HK_BAUD_MADE * 100UL >= HK_LINK_BAUD * 99UL)
                                          ? 1
                                          : -1];

static uint8_t ring[HK_RING_SIZE];
static volatile uint8_t ring_head; /* next free place */
static volatile uint8_t ring_tail; /* next byte to send */

/* Move bytes into the transmitter until it is full or nothing is left. Interrupts must be off, or
 * this is one. It interrupts when it has become a quarter full, not while it is: so whoever leaves
 * bytes in the ring has filled it. */
static void feed_transmitter(void)
{
    while (ring_tail != ring_head && (HK_REG(HK_UART0_FR) & HK_UART_TX_FULL) == 0U) {
        HK_REG(HK_UART0_DR) = ring[ring_tail];
        ring_tail = (uint8_t)(ring_tail + 1U);
    }
    HK_REG(HK_UART0_IMSC) = ring_tail != ring_head ? HK_UART_TX_INTERRUPT : 0U;
}

void hk_irq_uart0(void)
{
    HK_REG(HK_UART0_ICR) = HK_UART_TX_INTERRUPT;
    feed_transmitter();
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t head = ring_head;
    const uint8_t room = (uint8_t)(ring_tail - (uint8_t)(head + 1U));
    uint32_t mask;
    uint8_t i;

    if (count > room) {
        return false;
    }
    for (i = 0U; i < count; i++) {
        ring[head++] = bytes[i];
    }
    mask = interrupts_off();
    ring_head = head;
    feed_transmitter();
    interrupts_back(mask);
    return true;
}

/* --- The rest -------------------------------------------------------------------------------- */

static void init_pins(void)
{
    HK_REG(HK_PAD(HK_PIN_INT)) = HK_PAD_INPUT | HK_PAD_SCHMITT | HK_PAD_4_MA | HK_PAD_PULL_DOWN;
    HK_REG(HK_IO_CTRL(HK_PIN_INT)) = HK_IO_SIO;
    HK_REG(HK_IO_CTRL(HK_PIN_TX)) = HK_IO_UART;
    HK_REG(HK_IO_INTR0) = HK_IO_EDGE_HIGH(HK_PIN_INT);
    HK_REG(HK_IO_INTE0) = HK_IO_EDGE_HIGH(HK_PIN_INT);
}

static void init_link(void)
{
    HK_REG(HK_UART0_IBRD) = HK_UART_DIVISOR >> 6;
    HK_REG(HK_UART0_FBRD) = HK_UART_DIVISOR & 0x3FU;
    HK_REG(HK_UART0_LCR_H) = HK_UART_8_BITS | HK_UART_FIFOS; /* takes the divisor over as well */
    HK_REG(HK_UART0_IFLS) = HK_UART_TX_QUARTER;
    HK_REG(HK_UART0_IMSC) = 0U;
    HK_REG(HK_UART0_CR) = HK_UART_ENABLE;
}

void hk_hal_init(void)
{
    hk_clock_init();
    hk_reset_hold(HK_RESET_TIMER | HK_RESET_UART0 | HK_RESET_IO_BANK0 | HK_RESET_PADS_BANK0);
    hk_reset_release(HK_RESET_TIMER | HK_RESET_UART0 | HK_RESET_IO_BANK0 | HK_RESET_PADS_BANK0);
    init_link();
    init_pins();
    hk_hal_i2c_recover();
    HK_REG(HK_TIMER_INTE) = 1U;
    set_alarm();
    HK_REG(HK_NVIC_ENABLE) =
        HK_BIT(HK_IRQ_TIMER_0) | HK_BIT(HK_IRQ_IO_BANK0) | HK_BIT(HK_IRQ_UART0);
    interrupts_back(0U);
}

/* WFI ends with an interrupt even while they are off, and it is taken when they are on again: so
 * none is lost between the test of the pin and the sleep. The timer ends it at the latest. */
void hk_hal_idle(void)
{
    const uint32_t mask = interrupts_off();

    if (!sample_announced()) {
        __asm__ volatile("dsb\n\twfi" : : : "memory");
    }
    interrupts_back(mask);
}

void hk_hal_mark_begin(void)
{
    HK_REG(HK_WATCHDOG_SCRATCH0) = 1U;
}

void hk_hal_mark_end(void)
{
    HK_REG(HK_WATCHDOG_SCRATCH0) = 0U;
}
