/* I2C 1 of an STM32F103 as master at 400 kHz, polled: see hk_hal.h.
 *
 * The peripheral has a data and a shift register and no count, so how a read ends depends on its
 * length. The sequences are those of RM0008, 26.3.3, for one, two and more bytes. As the part's errata
 * sheet asks, no interrupt may come between the steps that must be done within one byte: between
 * the clearing of ADDR and what goes with it, and between STOP and the reading of the last byte but
 * one. */
#include "hk_board_stm32f103.h"
#include "hk_hal.h"
#include "hk_stm32f103.h"

#define HK_SCL_PIN 6U
#define HK_SDA_PIN 7U
#define HK_SCL     HK_BIT(HK_SCL_PIN)
#define HK_SDA     HK_BIT(HK_SDA_PIN)

#define HK_PCLK1_HZ (F_CPU / 2UL)
#define HK_I2C_HZ   400000UL
/* A byte takes 23 us; the sensor does not stretch the clock. */
#define HK_I2C_LIMIT_US 1000U

#define HK_ERRORS (I2C_SR1_AF | I2C_SR1_BERR | I2C_SR1_ARLO)

/* Wait for a flag; false after an error or when it takes too long. */
static bool i2c_await(uint32_t flag)
{
    const uint32_t since = TIM2_CNT;

    do {
        const uint32_t status = I2C1_SR1;

        if ((status & HK_ERRORS) != 0U) {
            return false;
        }
        if ((status & flag) != 0U) {
            return true;
        }
    } while (hk_board_elapsed_us(since) <= HK_I2C_LIMIT_US);
    return false;
}

/* START or repeated START and the address; ADDR stands then, and stretches the clock. */
static bool i2c_start(uint8_t address_and_direction, uint32_t acknowledge)
{
    I2C1_CR1 = I2C_CR1_PE | I2C_CR1_START | acknowledge;
    if (!i2c_await(I2C_SR1_SB)) {
        return false;
    }
    I2C1_DR = address_and_direction;
    return i2c_await(I2C_SR1_ADDR);
}

/* Reading the second status register after the first, as i2c_await did, clears ADDR. */
static void clear_address(void)
{
    (void)I2C1_SR2;
}

static bool i2c_send(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    bool good = i2c_start((uint8_t)(address << 1), 0U);
    uint8_t i;

    if (good) {
        clear_address();
    }
    for (i = 0U; good && i < count; i++) {
        good = i2c_await(I2C_SR1_TXE);
        if (good) {
            I2C1_DR = bytes[i];
        }
    }
    return good && (count == 0U || i2c_await(I2C_SR1_BTF));
}

static bool receive_one(uint8_t *byte)
{
    const uint32_t held = hk_board_hold();

    clear_address();
    I2C1_CR1 = I2C_CR1_PE | I2C_CR1_STOP;
    hk_board_release(held);
    if (!i2c_await(I2C_SR1_RXNE)) {
        return false;
    }
    *byte = (uint8_t)I2C1_DR;
    return true;
}

/* The last two bytes stand in the data and the shift register, and the clock is stretched. */
static bool receive_last_two(uint8_t *bytes, uint32_t position)
{
    uint32_t held;

    if (!i2c_await(I2C_SR1_BTF)) {
        return false;
    }
    held = hk_board_hold();
    I2C1_CR1 = I2C_CR1_PE | I2C_CR1_STOP | position;
    bytes[0] = (uint8_t)I2C1_DR;
    hk_board_release(held);
    bytes[1] = (uint8_t)I2C1_DR;
    return true;
}

/* POS makes ACK belong to the byte after the one that is coming in. */
static bool receive_two(uint8_t *bytes)
{
    const uint32_t held = hk_board_hold();

    clear_address();
    I2C1_CR1 = I2C_CR1_PE | I2C_CR1_POS;
    hk_board_release(held);
    return receive_last_two(bytes, I2C_CR1_POS);
}

static bool receive_more(uint8_t *bytes, uint8_t count)
{
    uint8_t i;

    clear_address();
    for (i = 0U; i + 3U < count; i++) {
        if (!i2c_await(I2C_SR1_RXNE)) {
            return false;
        }
        bytes[i] = (uint8_t)I2C1_DR;
    }
    if (!i2c_await(I2C_SR1_BTF)) {
        return false;
    }
    I2C1_CR1 = I2C_CR1_PE; /* no acknowledge for the last byte, which has not begun */
    bytes[i] = (uint8_t)I2C1_DR;
    return receive_last_two(&bytes[i + 1U], 0U);
}

static bool i2c_receive(uint8_t address, uint8_t *bytes, uint8_t count)
{
    const uint32_t acknowledge = count == 2U ? I2C_CR1_ACK | I2C_CR1_POS : I2C_CR1_ACK;
    const uint8_t reads = (uint8_t)(((uint32_t)address << 1) | 1U);

    if (count == 0U || !i2c_start(reads, count == 1U ? 0U : acknowledge)) {
        return false;
    }
    if (count == 1U) {
        return receive_one(bytes);
    }
    return count == 2U ? receive_two(bytes) : receive_more(bytes, count);
}

/* See STOP out, which is asked for here unless a good read has done it; a bus on which even that
 * fails is switched off until it is recovered. */
static bool i2c_finish(bool good, bool stopped)
{
    const uint32_t since = TIM2_CNT;

    I2C1_SR1 = 0U; /* clears the errors */
    if (!stopped && (I2C1_SR2 & I2C_SR2_MSL) != 0U) {
        I2C1_CR1 = I2C_CR1_PE | I2C_CR1_STOP;
    }
    while ((I2C1_CR1 & (I2C_CR1_START | I2C_CR1_STOP)) != 0U) {
        if (hk_board_elapsed_us(since) > HK_I2C_LIMIT_US) {
            I2C1_CR1 = 0U;
            return false;
        }
    }
    return good;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    return i2c_finish(i2c_send(address, bytes, count), false);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    const bool good = i2c_send(address, &reg, 1U) && i2c_receive(address, bytes, count);

    return i2c_finish(good, good);
}

/* --- Recovery -------------------------------------------------------------------------------- */

#define HK_RECOVERY_CLOCKS 9U
#define HK_HALF_CLOCK_US   5U

static void pause(void)
{
    const uint32_t since = TIM2_CNT;

    while (hk_board_elapsed_us(since) <= HK_HALF_CLOCK_US) {
    }
}

/* The pins are open drain: driven low, or let go. */
static void drive_low(uint32_t pins)
{
    GPIOB_BRR = pins;
    pause();
}

static void let_go(uint32_t pins)
{
    GPIOB_BSRR = pins;
    pause();
}

static void i2c_pins(uint32_t mode)
{
    hk_board_configure_low_pin(HK_SCL_PIN, mode);
    hk_board_configure_low_pin(HK_SDA_PIN, mode);
}

/* The reset ends a BUSY that stands although the bus is free, as the errata sheet tells of. In fast
 * mode SCL is low for two thirds of a period, and may take 300 ns to rise. */
static void i2c_enable(void)
{
    I2C1_CR1 = I2C_CR1_SWRST;
    I2C1_CR1 = 0U;
    I2C1_CR2 = HK_PCLK1_HZ / 1000000UL;
    I2C1_CCR = I2C_CCR_FAST | (HK_PCLK1_HZ / (3UL * HK_I2C_HZ));
    I2C1_TRISE = HK_PCLK1_HZ / 1000000UL * 300UL / 1000UL + 1UL;
    I2C1_CR1 = I2C_CR1_PE;
}

void hk_hal_i2c_recover(void)
{
    uint8_t clocks;

    I2C1_CR1 = 0U;
    let_go(HK_SDA | HK_SCL);
    i2c_pins(GPIO_OPEN_DRAIN);
    pause();
    for (clocks = 0U; clocks < HK_RECOVERY_CLOCKS && (GPIOB_IDR & HK_SDA) == 0U; clocks++) {
        drive_low(HK_SCL);
        let_go(HK_SCL);
    }
    drive_low(HK_SCL);
    drive_low(HK_SDA);
    let_go(HK_SCL);
    let_go(HK_SDA); /* SDA rises while SCL is high: STOP */
    i2c_pins(GPIO_PERIPHERAL_DRAIN);
    i2c_enable();
}
