/* What the files of the virtual MPU-6050 share. The outside sees hk_virtual_mpu6050.h only. */
#ifndef HK_VIRTUAL_PARTS_H
#define HK_VIRTUAL_PARTS_H

#include "hk_virtual_mpu6050.h"

#define HK_NS_PER_MS    UINT64_C(1000000)
#define HK_FAST_TICK_NS UINT64_C(125000) /* low-pass settings 0 and 7: 8 kHz */
#define HK_SLOW_TICK_NS HK_NS_PER_MS     /* 1 kHz */

/* From waking to the first sample, and from a change of clock to a gyroscope one can believe. */
#define HK_WAKE_NS (30U * HK_NS_PER_MS)
#define HK_PLL_NS  (10U * HK_NS_PER_MS)

#define HK_CONFIG_LOW_PASS 0x07U
#define HK_RANGE_SHIFT     3
#define HK_RANGE_MASK      0x03U
#define HK_PWR_CYCLE       0x20U
#define HK_PWR_NO_TEMP     0x08U
#define HK_PWR_CLOCK       0x07U
#define HK_PIN_LATCH       0x20U
#define HK_PIN_ANY_READ    0x10U
#define HK_PATH_TEMP  0 /* bits of SIGNAL_PATH_RESET, and places of path_free_ns */
#define HK_PATH_ACCEL 1
#define HK_PATH_GYRO  2
#define HK_PATHS      3

/* Registers. */
void hk_virtual_load_reset_values(hk_virtual_mpu6050_t *sensor);
void hk_virtual_begin_reset(hk_virtual_mpu6050_t *sensor);
void hk_virtual_write_register(hk_virtual_mpu6050_t *sensor, uint8_t address, uint8_t value);
uint8_t hk_virtual_read_register(hk_virtual_mpu6050_t *sensor, uint8_t address);
bool hk_virtual_resetting(const hk_virtual_mpu6050_t *sensor);

/* Power: whether the sensor samples, and what of it. */
bool hk_virtual_asleep(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_cycling(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_fast(const hk_virtual_mpu6050_t *sensor);
uint64_t hk_virtual_sample_period_ns(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_path_works(const hk_virtual_mpu6050_t *sensor, int path);
bool hk_virtual_in_standby(const hk_virtual_mpu6050_t *sensor, int path, int axis);
void hk_virtual_write_power(hk_virtual_mpu6050_t *sensor, uint8_t value);
void hk_virtual_reset_signal_path(hk_virtual_mpu6050_t *sensor, uint8_t paths);
void hk_virtual_restart_sampling(hk_virtual_mpu6050_t *sensor, uint64_t delay_ns);

/* Samples. */
void hk_virtual_take_sample(hk_virtual_mpu6050_t *sensor);
void hk_virtual_publish(hk_virtual_mpu6050_t *sensor);
void hk_virtual_enable_replay(hk_virtual_mpu6050_t *sensor);
void hk_virtual_quantise(hk_virtual_mpu6050_t *sensor, const double *row, uint8_t *burst);

/* Motion and the low-pass: the row of the sample that is due, or 0 when there is none. */
bool hk_virtual_feels_motion(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_motion_row(hk_virtual_mpu6050_t *sensor, double *row);

/* The self-test: what it adds to a count. */
double hk_virtual_gyro_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting);
double hk_virtual_accel_response(const hk_virtual_mpu6050_t *sensor, int axis, uint8_t setting);

/* The FIFO. */
void hk_virtual_fifo_clear(hk_virtual_mpu6050_t *sensor);
void hk_virtual_fifo_take(hk_virtual_mpu6050_t *sensor, const uint8_t *burst);
void hk_virtual_fifo_push(hk_virtual_mpu6050_t *sensor, uint8_t byte);
uint8_t hk_virtual_fifo_pop(hk_virtual_mpu6050_t *sensor);
void hk_virtual_write_user_control(hk_virtual_mpu6050_t *sensor, uint8_t value);
bool hk_virtual_fifo_enabled(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_fifo_has_packet(const hk_virtual_mpu6050_t *sensor);

/* Interrupts. */
void hk_virtual_interrupt(hk_virtual_mpu6050_t *sensor, uint8_t status);
void hk_virtual_clear_interrupt(hk_virtual_mpu6050_t *sensor);

/* Faults. */
void hk_virtual_strike_due(hk_virtual_mpu6050_t *sensor);
void hk_virtual_spoil(hk_virtual_mpu6050_t *sensor, const uint8_t *before, uint8_t *burst);

#endif
