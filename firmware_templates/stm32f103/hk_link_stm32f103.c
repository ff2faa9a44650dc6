/* The link of an STM32F103, USART 1 on PA9 and PA10: see hk_hal.h. Two rings, which the interrupt
 * empties and fills. */
#include "hk_board_stm32f103.h"
#include "hk_design.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"

#define HK_BRR       ((F_CPU + HK_LINK_BAUD / 2UL) / HK_LINK_BAUD)
#define HK_BAUD_MADE (F_CPU / HK_BRR)
_Static_assert(HK_BAUD_MADE * 40UL <= HK_LINK_BAUD * 41UL
                   && HK_BAUD_MADE * 40UL >= HK_LINK_BAUD * 39UL,
               "the baud rate is more than 2.5 % off");

#define HK_USART_ON (USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE)

#define HK_RING_SIZE 256U /* indices wrap by themselves */

typedef struct {
    uint8_t bytes[HK_RING_SIZE];
    volatile uint8_t head; /* next free place */
    volatile uint8_t tail; /* oldest byte */
} hk_ring_t;

static hk_ring_t sent;
static hk_ring_t received;

static uint8_t room(const hk_ring_t *ring)
{
    return (uint8_t)(ring->tail - (uint8_t)(ring->head + 1U));
}

/* The bytes are there before the other side hears of them, and read before their place is free. */
static void barrier(void)
{
    __asm__ volatile("" : : : "memory");
}

/* A byte that has come while the one before stood in the register is lost, and leaves the overrun
 * flag; reading status and data ends both. One without a stop bit is noise. */
static void take_received(uint32_t status)
{
    const uint8_t byte = (uint8_t)USART1_DR;
    const uint8_t head = received.head;

    if ((status & USART_SR_RXNE) != 0U && (status & USART_SR_FE) == 0U && room(&received) > 0U) {
        received.bytes[head] = byte;
        barrier();
        received.head = (uint8_t)(head + 1U);
    }
}

static void send_next(void)
{
    const uint8_t tail = sent.tail;

    if (tail == sent.head) {
        USART1_CR1 = HK_USART_ON; /* nothing more to ask for */
    } else {
        USART1_DR = sent.bytes[tail];
        sent.tail = (uint8_t)(tail + 1U);
    }
}

void hk_usart1(void)
{
    const uint32_t status = USART1_SR;

    if ((status & (USART_SR_RXNE | USART_SR_ORE)) != 0U) {
        take_received(status);
    }
    if ((status & USART_SR_TXE) != 0U) {
        send_next();
    }
}

void hk_board_start_link(void)
{
    USART1_BRR = HK_BRR;
    USART1_CR1 = HK_USART_ON;
}

bool hk_board_has_received(void)
{
    return received.head != received.tail;
}

bool hk_board_has_sent(void)
{
    return sent.head == sent.tail && (USART1_SR & USART_SR_TC) != 0U;
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t head = sent.head;
    uint8_t i;

    if (count > room(&sent)) {
        return false;
    }
    for (i = 0U; i < count; i++) {
        sent.bytes[head++] = bytes[i];
    }
    barrier();
    sent.head = head;
    USART1_CR1 = HK_USART_ON | USART_CR1_TXEIE;
    return true;
}

uint8_t hk_hal_transmit_room(void)
{
    return room(&sent);
}

bool hk_hal_receive(uint8_t *byte)
{
    const uint8_t tail = received.tail;

    if (!hk_board_has_received()) {
        return false;
    }
    *byte = received.bytes[tail];
    barrier();
    received.tail = (uint8_t)(tail + 1U);
    return true;
}
