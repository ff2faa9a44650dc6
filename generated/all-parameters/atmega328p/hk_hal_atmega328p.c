/* The hardware layer on an ATmega328P at 16 MHz, as on an Arduino Uno or Nano: see hk_hal.h.
 *
 * PC4 SDA, PC5 SCL, PD2 (INT0) the sensor's INT pin, PD1 (TXD) the link. Timer 1 is the clock. */
#include "hk_hal.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/power.h>
#include <avr/sleep.h>
#include <util/atomic.h>
#include <util/delay.h>
#include <util/twi.h>

#include "hk_design.h"

#if F_CPU != 16000000UL
#error "the clock of this board layer is 16 MHz"
#endif

#define HK_SDA _BV(PC4)
#define HK_SCL _BV(PC5)
#define HK_INT _BV(PD2)

/* --- Clock: timer 1 counts half microseconds ------------------------------------------------ */

static volatile uint32_t clock_overflows;

/* Interrupts must be off. */
static uint32_t clock_us(void)
{
    uint32_t overflows = clock_overflows;
    const uint16_t half_us = TCNT1;

    if ((TIFR1 & _BV(TOV1)) != 0U && half_us < 0x8000U) {
        overflows++; /* the counter has wrapped, its interrupt has not come yet */
    }
    return (overflows << 15) + (half_us >> 1);
}

ISR(TIMER1_OVF_vect)
{
    clock_overflows++;
}

uint32_t hk_hal_time_us(void)
{
    uint32_t now_us;

    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        now_us = clock_us();
    }
    return now_us;
}

/* --- Data ready: the sensor holds its pin high until it is read ----------------------------- */

static volatile uint32_t ready_us;

ISR(INT0_vect)
{
    ready_us = clock_us();
}

static bool sample_announced(void)
{
    return (PIND & HK_INT) != 0U;
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    if (!sample_announced()) {
        return false;
    }
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
        /* The pin may just have risen, with its interrupt still to come. */
        *time_us = (EIFR & _BV(INTF0)) != 0U ? clock_us() : ready_us;
    }
    return true;
}

/* --- I2C: 400 kHz, polled ------------------------------------------------------------------- */

#define HK_I2C_HZ 400000UL
/* A byte takes 360 cycles and a turn of the waiting loop about 10: this is some 20 bytes. */
#define HK_I2C_TURNS 800U

static void i2c_enable(void)
{
    TWSR = 0U;
    TWBR = (uint8_t)((F_CPU / HK_I2C_HZ - 16U) / 2U);
    TWCR = _BV(TWEN);
}

/* Give one command to the peripheral and wait for it. */
static bool i2c_command(uint8_t bits)
{
    uint16_t turns = HK_I2C_TURNS;

    TWCR = (uint8_t)(bits | _BV(TWINT) | _BV(TWEN));
    while ((TWCR & _BV(TWINT)) == 0U) {
        if (--turns == 0U) {
            return false;
        }
    }
    return true;
}

static bool i2c_start(void)
{
    return i2c_command(_BV(TWSTA)) && (TW_STATUS == TW_START || TW_STATUS == TW_REP_START);
}

static bool i2c_put(uint8_t byte, uint8_t status)
{
    TWDR = byte;
    return i2c_command(0U) && TW_STATUS == status;
}

static bool i2c_get(uint8_t *byte, bool last)
{
    const uint8_t status = last ? TW_MR_DATA_NACK : TW_MR_DATA_ACK;

    if (!i2c_command(last ? 0U : _BV(TWEA)) || TW_STATUS != status) {
        return false;
    }
    *byte = TWDR;
    return true;
}

/* Send STOP; a bus on which even that fails is switched off until it is recovered. */
static bool i2c_stop(bool good)
{
    uint16_t turns = HK_I2C_TURNS;

    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
    while ((TWCR & _BV(TWSTO)) != 0U) {
        if (--turns == 0U) {
            TWCR = 0U;
            return false;
        }
    }
    return good;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    bool good = i2c_start() && i2c_put((uint8_t)(address << 1) | TW_WRITE, TW_MT_SLA_ACK);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = i2c_put(bytes[i], TW_MT_DATA_ACK);
    }
    return i2c_stop(good);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    bool good = i2c_start() && i2c_put((uint8_t)(address << 1) | TW_WRITE, TW_MT_SLA_ACK)
                && i2c_put(reg, TW_MT_DATA_ACK) && i2c_start()
                && i2c_put((uint8_t)(address << 1) | TW_READ, TW_MR_SLA_ACK);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = i2c_get(&bytes[i], i + 1U == count);
    }
    return i2c_stop(good);
}

#define HK_RECOVERY_CLOCKS 9U
#define HK_HALF_CLOCK_US   5

/* The pins are open drain: driven low, or let go. */
static void drive_low(uint8_t pin)
{
    DDRC |= pin;
    _delay_us(HK_HALF_CLOCK_US);
}

static void let_go(uint8_t pin)
{
    DDRC &= (uint8_t)~pin;
    _delay_us(HK_HALF_CLOCK_US);
}

void hk_hal_i2c_recover(void)
{
    uint8_t clocks;

    TWCR = 0U;
    PORTC &= (uint8_t)~(HK_SDA | HK_SCL);
    let_go(HK_SDA | HK_SCL);
    for (clocks = 0U; clocks < HK_RECOVERY_CLOCKS && (PINC & HK_SDA) == 0U; clocks++) {
        drive_low(HK_SCL);
        let_go(HK_SCL);
    }
    drive_low(HK_SCL);
    drive_low(HK_SDA);
    let_go(HK_SCL);
    let_go(HK_SDA); /* SDA rises while SCL is high: STOP */
    i2c_enable();
}

/* --- Link: a ring that the transmitter empties by interrupt --------------------------------- */

#define HK_RING_SIZE 256U /* indices wrap by themselves */

#define HK_UBRR ((F_CPU + 4UL * HK_LINK_BAUD) / (8UL * HK_LINK_BAUD) - 1UL)
#define HK_BAUD_MADE (F_CPU / (8UL * (HK_UBRR + 1UL)))
typedef char hk_baud_within_2_5_percent[(HK_BAUD_MADE * 40UL <= HK_LINK_BAUD * 41UL
                                         && HK_BAUD_MADE * 40UL >= HK_LINK_BAUD * 39UL)
                                            ? 1
                                            : -1];

static uint8_t ring[HK_RING_SIZE];
static volatile uint8_t ring_head; /* next free place */
static volatile uint8_t ring_tail; /* next byte to send */

ISR(USART_UDRE_vect)
{
    const uint8_t tail = ring_tail;

    UDR0 = ring[tail];
    ring_tail = (uint8_t)(tail + 1U);
    if (ring_tail == ring_head) {
        UCSR0B = _BV(TXEN0);
    }
}

bool hk_hal_transmit(const uint8_t *bytes, uint8_t count)
{
    uint8_t head = ring_head;
    const uint8_t room = (uint8_t)(ring_tail - (uint8_t)(head + 1U));
    uint8_t i;

    if (count > room) {
        return false;
    }
    for (i = 0U; i < count; i++) {
        ring[head++] = bytes[i];
    }
    ring_head = head;
    UCSR0B = _BV(TXEN0) | _BV(UDRIE0);
    return true;
}

/* --- The rest ------------------------------------------------------------------------------- */

void hk_hal_init(void)
{
    power_adc_disable();
    power_spi_disable();
    power_timer0_disable();
    power_timer2_disable();
    TCCR1A = 0U;
    TIMSK1 = _BV(TOIE1);
    TCCR1B = _BV(CS11);
    UBRR0 = (uint16_t)HK_UBRR;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(TXEN0);
    EICRA = _BV(ISC01) | _BV(ISC00); /* rising edge */
    EIMSK = _BV(INT0);
    SMCR = 0U; /* sleep is idle mode: the peripherals run on */
    hk_hal_i2c_recover();
    sei();
}

/* The instruction after SEI runs before any interrupt does, so none is lost between the test of the
 * pin and SLEEP. The timer's overflow ends the sleep after 33 ms at the latest. */
void hk_hal_idle(void)
{
    cli();
    if (sample_announced()) {
        sei();
        return;
    }
    sleep_enable();
    sei();
    sleep_cpu();
    sleep_disable();
}

void hk_hal_mark_begin(void)
{
    GPIOR0 = 1U;
}

void hk_hal_mark_end(void)
{
    GPIOR0 = 0U;
}
