/* The bus of the sensor on an RP2040: I2C0 at 400 kHz on GP4 (SDA) and GP5 (SCL), polled. */
#include "hk_clock_rp2040.h"
#include "hk_hal.h"
#include "hk_rp2040.h"

#define HK_PIN_SDA 4U
#define HK_PIN_SCL 5U
#define HK_SDA     HK_BIT(HK_PIN_SDA)
#define HK_SCL     HK_BIT(HK_PIN_SCL)

/* A bit takes (HIGH + SPIKE + 7) + (LOW + 1) periods of clk_sys: 313, of them 188 (1.5 us) low. */
#define HK_I2C_SPIKE 7U   /* 56 ns; fast mode asks for 50 */
#define HK_I2C_HIGH  111U
#define HK_I2C_LOW   187U
#define HK_I2C_HOLD  38U  /* SDA stays for 300 ns after SCL has fallen */

/* A byte takes 23 us. */
#define HK_I2C_BYTE_US 100U
#define HK_I2C_MORE_US 500U

static void take_pin(uint32_t pin, uint32_t function)
{
    HK_REG(HK_PAD(pin)) = HK_PAD_INPUT | HK_PAD_SCHMITT | HK_PAD_4_MA | HK_PAD_PULL_UP;
    HK_REG(HK_IO_CTRL(pin)) = function;
}

/* Begin anew, with nothing left of what went before. */
static void i2c_enable(void)
{
    hk_reset_hold(HK_RESET_I2C0);
    hk_reset_release(HK_RESET_I2C0);
    HK_REG(HK_I2C0_CON) = HK_I2C_MASTER | HK_I2C_FAST | HK_I2C_RESTART_OK;
    HK_REG(HK_I2C0_FS_SPKLEN) = HK_I2C_SPIKE;
    HK_REG(HK_I2C0_FS_SCL_HIGH) = HK_I2C_HIGH;
    HK_REG(HK_I2C0_FS_SCL_LOW) = HK_I2C_LOW;
    HK_REG(HK_I2C0_SDA_HOLD) = HK_I2C_HOLD;
    take_pin(HK_PIN_SDA, HK_IO_I2C);
    take_pin(HK_PIN_SCL, HK_IO_I2C);
}

/* The target may change only while the controller is off. */
static bool i2c_select(uint8_t address)
{
    const uint32_t since_us = hk_hal_time_us();

    HK_REG(HK_I2C0_ENABLE) = 0U;
    while ((HK_REG(HK_I2C0_ENABLED) & 1U) != 0U) {
        if (hk_passed(since_us, HK_I2C_MORE_US)) {
            return false;
        }
    }
    HK_REG(HK_I2C0_TAR) = address;
    HK_REG(HK_I2C0_ENABLE) = 1U;
    (void)HK_REG(HK_I2C0_CLR_TX_ABRT);
    (void)HK_REG(HK_I2C0_CLR_STOP_DET);
    return true;
}

/* What one transaction sends, and what it receives after a repeated START. */
typedef struct {
    const uint8_t *out;
    uint8_t *in;
    uint32_t out_count;
    uint32_t in_count;
} hk_i2c_transfer_t;

/* Command `i` of the queue: bytes to send, then requests to receive, STOP with the last. */
static uint32_t i2c_command(const hk_i2c_transfer_t *transfer, uint32_t i)
{
    const uint32_t stop =
        i + 1U == transfer->out_count + transfer->in_count ? HK_I2C_STOP : 0U;

    if (i < transfer->out_count) {
        return transfer->out[i] | stop;
    }
    return HK_I2C_READ | stop | (i == transfer->out_count ? HK_I2C_RESTART : 0U);
}

typedef enum { HK_I2C_GOOD, HK_I2C_NACK, HK_I2C_STUCK } hk_i2c_end_t;

/* Feed the queue and empty the other until STOP; after a NACK the controller sends one by itself. */
static hk_i2c_end_t i2c_exchange(const hk_i2c_transfer_t *transfer)
{
    const uint32_t total = transfer->out_count + transfer->in_count;
    const uint32_t limit_us = HK_I2C_MORE_US + HK_I2C_BYTE_US * total;
    const uint32_t since_us = hk_hal_time_us();
    uint32_t queued = 0U;
    uint32_t received = 0U;

    while (!hk_passed(since_us, limit_us)) {
        const uint32_t events = HK_REG(HK_I2C0_RAW_INTR);
        const uint32_t status = HK_REG(HK_I2C0_STATUS);
        const bool nack = (events & HK_I2C_TX_ABRT) != 0U;

        if ((events & HK_I2C_STOP_DET) != 0U && (nack || received == transfer->in_count)) {
            return nack ? HK_I2C_NACK : HK_I2C_GOOD;
        }
        if (!nack && queued < total && (status & HK_I2C_TX_NOT_FULL) != 0U) {
            HK_REG(HK_I2C0_DATA_CMD) = i2c_command(transfer, queued++);
        }
        if (received < transfer->in_count && (status & HK_I2C_RX_NOT_EMPTY) != 0U) {
            transfer->in[received++] = (uint8_t)HK_REG(HK_I2C0_DATA_CMD);
        }
    }
    return HK_I2C_STUCK;
}

static bool i2c_transfer(uint8_t address, const hk_i2c_transfer_t *transfer)
{
    const hk_i2c_end_t end = i2c_select(address) ? i2c_exchange(transfer) : HK_I2C_STUCK;

    if (end == HK_I2C_STUCK) {
        i2c_enable(); /* lets go of the bus */
    }
    return end == HK_I2C_GOOD;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    const hk_i2c_transfer_t transfer = {.out = bytes, .in = 0, .out_count = count, .in_count = 0U};

    return i2c_transfer(address, &transfer);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    const hk_i2c_transfer_t transfer = {.out = &reg, .in = bytes, .out_count = 1U, .in_count = count};

    return i2c_transfer(address, &transfer);
}

#define HK_RECOVERY_CLOCKS 9U
#define HK_HALF_CLOCK_US   5U

/* The pins are open drain: driven low, or let go. */
static void half_clock(void)
{
    const uint32_t since_us = hk_hal_time_us();

    while (!hk_passed(since_us, HK_HALF_CLOCK_US + 1U)) {
    }
}

static void drive_low(uint32_t pin)
{
    HK_REG(HK_SIO_OE_SET) = pin;
    half_clock();
}

static void let_go(uint32_t pin)
{
    HK_REG(HK_SIO_OE_CLEAR) = pin;
    half_clock();
}

void hk_hal_i2c_recover(void)
{
    uint32_t clocks;

    HK_REG(HK_SIO_OUT_CLEAR) = HK_SDA | HK_SCL;
    HK_REG(HK_SIO_OE_CLEAR) = HK_SDA | HK_SCL;
    take_pin(HK_PIN_SDA, HK_IO_SIO);
    take_pin(HK_PIN_SCL, HK_IO_SIO);
    half_clock();
    for (clocks = 0U; clocks < HK_RECOVERY_CLOCKS && (HK_REG(HK_SIO_IN) & HK_SDA) == 0U; clocks++) {
        drive_low(HK_SCL);
        let_go(HK_SCL);
    }
    drive_low(HK_SCL);
    drive_low(HK_SDA);
    let_go(HK_SCL);
    let_go(HK_SDA); /* SDA rises while SCL is high: STOP */
    i2c_enable();
}
