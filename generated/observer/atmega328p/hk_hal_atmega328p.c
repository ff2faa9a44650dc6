/* The hardware layer on an ATmega328P at 16 MHz, as on an Arduino Uno or Nano: see hk_hal.h. Bus,
 * link, store and resets have a file each.
 *
 * PD2 (INT0) is the sensor's INT pin, timer 1 the clock. */
#include "hk_hal.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/power.h>
#include <avr/sleep.h>
#include <util/atomic.h>

#include "hk_atmega328p.h"

#if F_CPU != 16000000UL
#error "the clock of this board layer is 16 MHz"
#endif

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
    hk_uart_init();
    EICRA = _BV(ISC01) | _BV(ISC00); /* rising edge */
    EIMSK = _BV(INT0);
    SMCR = 0U; /* sleep is idle mode: the peripherals run on */
    hk_hal_i2c_recover();
    hk_watchdog_start();
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
