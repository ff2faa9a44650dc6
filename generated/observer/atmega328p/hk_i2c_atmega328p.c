/* The I2C master of the ATmega328P: 400 kHz, polled, every wait with a limit. PC4 SDA, PC5 SCL. */
#include <avr/io.h>
#include <util/delay.h>
#include <util/twi.h>

#include "hk_hal.h"

#define HK_SDA _BV(PC4)
#define HK_SCL _BV(PC5)

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
