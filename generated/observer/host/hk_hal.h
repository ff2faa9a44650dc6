/* What the application needs of a board. Each board folder implements it once. */
#ifndef HK_HAL_H
#define HK_HAL_H

#include <stdbool.h>
#include <stdint.h>

/* Set the board up and start its watchdog. */
void hk_hal_init(void);

/* Why the processor started. */
typedef enum {
    HK_RESET_POWER,
    HK_RESET_PIN,
    HK_RESET_BROWN_OUT,
    HK_RESET_WATCHDOG,
    HK_RESET_REQUEST /* hk_hal_reboot */
} hk_reset_cause_t;

hk_reset_cause_t hk_hal_reset_cause(void);

/* Start over as after a reset. On a board it does not return. */
void hk_hal_reboot(void);

/* Show the watchdog that the main loop runs. A board on which nobody does so for 1 to 2 s starts
 * over. */
void hk_hal_watchdog_feed(void);

/* One I2C transaction to a 7-bit address. False after a NACK, a bus fault or a timeout; the bus is
 * released in any case. */
bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count);
bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count);

/* Free a bus whose SDA is held low: up to nine clocks, a STOP, and the peripheral set up again. */
void hk_hal_i2c_recover(void);

/* Time since start, wrapping after 71.6 minutes. */
uint32_t hk_hal_time_us(void);

/* True while the sensor announces a sample that nobody has read; *time_us is when it came. */
bool hk_hal_data_ready(uint32_t *time_us);

/* Queue bytes for the link without waiting; false, and nothing queued, if they do not fit. */
bool hk_hal_transmit(const uint8_t *bytes, uint8_t count);

/* Bytes that would fit the queue now. */
uint8_t hk_hal_transmit_room(void);

/* Take the next byte that the link has received; false if there is none. What arrives while the
 * receive queue is full is lost. */
bool hk_hal_receive(uint8_t *byte);

/* The non-volatile store: two slots that are replaced as a whole.
 *
 * Replacing a slot is erase, then put for every byte in order, then finish; each may take its time
 * and must be called only while busy is false. Bytes that are not put read 0xFF or what they were
 * before. Nothing but the slot that is replaced is ever at risk when the supply fails. */
#define HK_STORE_SLOTS      2U
#define HK_STORE_SLOT_BYTES 128U

void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count);
bool hk_hal_store_busy(void);
void hk_hal_store_erase(uint8_t slot);
void hk_hal_store_put(uint8_t byte);
void hk_hal_store_finish(void);

/* Sleep until an interrupt; return at once while a sample is announced. */
void hk_hal_idle(void);

/* Mark the code whose cycles an emulator or a probe counts. */
void hk_hal_mark_begin(void);
void hk_hal_mark_end(void);

#endif
