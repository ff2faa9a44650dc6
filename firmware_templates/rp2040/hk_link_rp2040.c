/* The link of an RP2040: UART0, GP0 sends and GP1 receives, a ring for each served by interrupt. */
#include "hk_link_rp2040.h"

#include "hk_design.h"
#include "hk_hal.h"
#include "hk_interrupt_rp2040.h"
#include "hk_rp2040.h"

#define HK_PIN_TX    0U
#define HK_PIN_RX    1U
#define HK_RING_SIZE 256U /* indices wrap by themselves */

/* The divisor has 6 fraction bits and divides by 16 beside: clk_peri * 4 / baud, rounded. */
#define HK_UART_DIVISOR ((HK_CLOCK_HZ * 8UL / HK_LINK_BAUD + 1UL) / 2UL)
#define HK_BAUD_MADE (HK_CLOCK_HZ * 4UL / HK_UART_DIVISOR)
typedef char hk_baud_within_1_percent[(HK_BAUD_MADE * 100UL <= HK_LINK_BAUD * 101UL
                                       && HK_BAUD_MADE * 100UL >= HK_LINK_BAUD * 99UL)
                                          ? 1
                                          : -1];

/* Bytes that wait; one writes the head and the other the tail. */
typedef struct {
    uint8_t bytes[HK_RING_SIZE];
    volatile uint8_t head; /* next free place */
    volatile uint8_t tail; /* next byte to take */
} hk_ring_t;

static hk_ring_t to_send;
static hk_ring_t received;

void hk_irq_uart0(void);

/* --- Sending -------------------------------------------------------------------------------- */

/* Move bytes into the transmitter until it is full or nothing is left. Interrupts must be off, or
 * this is one. It interrupts when it has become a quarter full, not while it is: so whoever leaves
 * bytes in the ring has filled it. */
static void feed_transmitter(void)
{
    while (to_send.tail != to_send.head && (HK_REG(HK_UART0_FR) & HK_UART_TX_FULL) == 0U) {
        HK_REG(HK_UART0_DR) = to_send.bytes[to_send.tail];
        to_send.tail = (uint8_t)(to_send.tail + 1U);
    }
    HK_REG(HK_UART0_IMSC) =
        HK_UART_RX_INTERRUPT | (to_send.tail != to_send.head ? HK_UART_TX_INTERRUPT : 0U);
}

uint8_t hk_hal_transmit_room(void)
{
    return (uint8_t)(to_send.tail - (uint8_t)(to_send.head + 1U));
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t head = to_send.head;
    uint32_t mask;
    uint8_t i;

    if (count > hk_hal_transmit_room()) {
        return false;
    }
    for (i = 0U; i < count; i++) {
        to_send.bytes[head++] = bytes[i];
    }
    mask = hk_interrupts_off();
    to_send.head = head;
    feed_transmitter();
    hk_interrupts_back(mask);
    return true;
}

bool hk_uart_quiet(void)
{
    return to_send.tail == to_send.head && (HK_REG(HK_UART0_FR) & HK_UART_BUSY) == 0U;
}

/* --- Receiving ------------------------------------------------------------------------------ */

/* Empty the receiver; damaged bytes and those that find no room are lost. */
static void empty_receiver(void)
{
    while ((HK_REG(HK_UART0_FR) & HK_UART_RX_EMPTY) == 0U) {
        const uint32_t found = HK_REG(HK_UART0_DR);
        const uint8_t next = (uint8_t)(received.head + 1U);

        if ((found & HK_UART_BAD) == 0U && next != received.tail) {
            received.bytes[received.head] = (uint8_t)found;
            received.head = next;
        }
    }
}

bool hk_hal_receive(uint8_t *byte)
{
    const uint8_t tail = received.tail;

    if (tail == received.head) {
        return false;
    }
    *byte = received.bytes[tail];
    received.tail = (uint8_t)(tail + 1U);
    return true;
}

/* --- Both ----------------------------------------------------------------------------------- */

void hk_irq_uart0(void)
{
    HK_REG(HK_UART0_ICR) = HK_UART_TX_INTERRUPT | HK_UART_RX_INTERRUPT;
    empty_receiver();
    feed_transmitter();
}

void hk_uart_init(void)
{
    HK_REG(HK_UART0_IBRD) = HK_UART_DIVISOR >> 6;
    HK_REG(HK_UART0_FBRD) = HK_UART_DIVISOR & 0x3FU;
    HK_REG(HK_UART0_LCR_H) = HK_UART_8_BITS | HK_UART_FIFOS; /* takes the divisor over as well */
    HK_REG(HK_UART0_IFLS) = HK_UART_TX_QUARTER | HK_UART_RX_HALF;
    HK_REG(HK_UART0_IMSC) = HK_UART_RX_INTERRUPT;
    HK_REG(HK_PAD(HK_PIN_RX)) = HK_PAD_INPUT | HK_PAD_SCHMITT | HK_PAD_4_MA | HK_PAD_PULL_UP;
    HK_REG(HK_IO_CTRL(HK_PIN_RX)) = HK_IO_UART;
    HK_REG(HK_IO_CTRL(HK_PIN_TX)) = HK_IO_UART;
    HK_REG(HK_UART0_CR) = HK_UART_ENABLE;
}
