/* What the application needs of a board. Each board folder implements it once. */
#ifndef HK_HAL_H
#define HK_HAL_H

#include <stdbool.h>
#include <stdint.h>

void hk_hal_init(void);

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

/* Sleep until an interrupt; return at once while a sample is announced. */
void hk_hal_idle(void);

/* Mark the code whose cycles an emulator or a probe counts. */
void hk_hal_mark_begin(void);
void hk_hal_mark_end(void);

#endif
