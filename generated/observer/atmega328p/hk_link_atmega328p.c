/* The link of the ATmega328P: USART 0 with a ring each way, both served by interrupt. PD0 is RXD,
 * PD1 TXD. */
#include <avr/interrupt.h>
#include <avr/io.h>

#include "hk_atmega328p.h"
#include "hk_design.h"
#include "hk_hal.h"

#define HK_UBRR ((F_CPU + 4UL * HK_LINK_BAUD) / (8UL * HK_LINK_BAUD) - 1UL)
#define HK_BAUD_MADE (F_CPU / (8UL * (HK_UBRR + 1UL)))
typedef char hk_baud_within_2_5_percent[(HK_BAUD_MADE * 40UL <= HK_LINK_BAUD * 41UL
                                         && HK_BAUD_MADE * 40UL >= HK_LINK_BAUD * 39UL)
                                            ? 1
                                            : -1];

#define HK_LINK_ON (_BV(TXEN0) | _BV(RXEN0) | _BV(RXCIE0))

void hk_uart_init(void)
{
    PORTD |= _BV(PD0); /* pulled up: an open RXD is a line at rest */
    UBRR0 = (uint16_t)HK_UBRR;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = HK_LINK_ON;
}

/* --- Transmitter ---------------------------------------------------------------------------- */

#define HK_SENT_SIZE 256U /* indices wrap by themselves */

static uint8_t sent[HK_SENT_SIZE];
static volatile uint8_t sent_head; /* next free place */
static volatile uint8_t sent_tail; /* next byte to send */

ISR(USART_UDRE_vect)
{
    const uint8_t tail = sent_tail;

    if (tail == sent_head) {
        UCSR0B = HK_LINK_ON;
        return;
    }
    UDR0 = sent[tail];
    sent_tail = (uint8_t)(tail + 1U);
}

uint8_t hk_hal_transmit_room(void)
{
    return (uint8_t)(sent_tail - (uint8_t)(sent_head + 1U));
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t head = sent_head;
    uint8_t i;

    if (count > hk_hal_transmit_room()) {
        return false;
    }
    for (i = 0U; i < count; i++) {
        sent[head++] = bytes[i];
    }
    sent_head = head;
    UCSR0B = HK_LINK_ON | _BV(UDRIE0);
    return true;
}

/* --- Receiver ------------------------------------------------------------------------------- */

#define HK_HEARD_SIZE 128U

static uint8_t heard[HK_HEARD_SIZE];
static volatile uint8_t heard_head; /* next free place */
static volatile uint8_t heard_tail; /* next byte to take */

static uint8_t after(uint8_t place)
{
    return (uint8_t)((place + 1U) % HK_HEARD_SIZE);
}

ISR(USART_RX_vect)
{
    const uint8_t byte = UDR0;
    const uint8_t head = heard_head;
    const uint8_t next = after(head);

    if (next != heard_tail) {
        heard[head] = byte;
        heard_head = next;
    }
}

bool hk_hal_receive(uint8_t *byte)
{
    const uint8_t tail = heard_tail;

    if (tail == heard_head) {
        return false;
    }
    *byte = heard[tail];
    heard_tail = after(tail);
    return true;
}
