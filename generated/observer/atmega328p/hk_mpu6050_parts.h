/* What the files of the MPU-6050 driver share. The application sees hk_mpu6050.h only. */
#ifndef HK_MPU6050_PARTS_H
#define HK_MPU6050_PARTS_H

#include "hk_mpu6050.h"

#define HK_MS UINT32_C(1000)

/* A sample that has not been announced by then is looked for, and again after each gap. */
#define HK_OVERDUE_US  (HK_PERIOD_US + HK_PERIOD_US / 2U)
#define HK_POLL_GAP_US (HK_PERIOD_US / 8U)
/* Where INT is not to be relied on, look from a little before the next sample is due. */
#define HK_POLL_US     (HK_PERIOD_US - HK_POLL_GAP_US)

typedef struct {
    uint8_t address;
    uint8_t value;
} hk_register_write_t;

/* --- The bus: hk_mpu6050_bus.c --- */

void hk_mpu6050_enter(hk_mpu6050_t *sensor, hk_mpu6050_state_t state, uint32_t now_us);
bool hk_mpu6050_waited(const hk_mpu6050_t *sensor, uint32_t now_us, uint32_t wait_us);
void hk_mpu6050_count_error(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind);

/* Free the bus and begin again. */
void hk_mpu6050_begin_again(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us);

/* A failed transfer frees the bus and may be tried again; after too many in a row begin again. */
void hk_mpu6050_fail(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us);

/* Set a register; read registers, as many as there are values. A transfer that fails is counted.
 * Each returns whether it was good. */
bool hk_mpu6050_set(hk_mpu6050_t *sensor, uint8_t reg, uint8_t value, uint32_t now_us);
bool hk_mpu6050_get(hk_mpu6050_t *sensor, uint8_t reg, uint8_t *values, uint8_t count,
                    uint32_t now_us);

/* --- Registers and samples that must be right: hk_mpu6050_checks.c --- */

/* Accept or refuse the identity that was read; a variant is told once. */
bool hk_mpu6050_accept(hk_mpu6050_t *sensor, uint8_t who_am_i);

/* The configuration of this part: how many registers, and each of them. */
uint8_t hk_mpu6050_configuration_steps(const hk_mpu6050_t *sensor);
hk_register_write_t hk_mpu6050_configuration(uint8_t step);

/* Begin again, for a register is not as it was set. */
void hk_mpu6050_wrong_register(hk_mpu6050_t *sensor, hk_register_write_t found, uint32_t now_us);

/* Read registers back: those that give the counts their meaning; the next of all; the first, and
 * now and then the second. Each returns whether they are as set. */
bool hk_mpu6050_scale_holds(hk_mpu6050_t *sensor, uint32_t now_us);
bool hk_mpu6050_next_register_holds(hk_mpu6050_t *sensor, uint32_t now_us);
bool hk_mpu6050_registers_hold(hk_mpu6050_t *sensor, uint32_t now_us);

/* Compare a sample with the one before. Returns whether it is measured, as far as one can tell. */
bool hk_mpu6050_is_alive(hk_mpu6050_t *sensor, const uint8_t *data, uint32_t now_us);

/* --- From the reset to the first sample: hk_mpu6050_setup.c --- */

hk_mpu6050_event_t hk_mpu6050_set_up(hk_mpu6050_t *sensor, uint32_t now_us);

/* --- Samples: hk_mpu6050_burst.c or hk_mpu6050_fifo.c --- */

/* An announcement that stands although its sample has been read is none: the pin is stuck. */
bool hk_mpu6050_announced(const hk_mpu6050_t *sensor, uint32_t *time_us);

/* Let samples come. Returns whether that was set up. */
bool hk_mpu6050_begin_samples(hk_mpu6050_t *sensor, uint32_t now_us);

/* Read one sample, if there is one, and its time. */
bool hk_mpu6050_acquire(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *data, uint32_t *time_us);

/* True while samples may be there that need no announcement. */
bool hk_mpu6050_has_work(const hk_mpu6050_t *sensor);

/* --- The self-test: hk_self_test.c --- */

hk_mpu6050_event_t hk_mpu6050_begin_self_test(hk_mpu6050_t *sensor, uint32_t now_us);
hk_mpu6050_event_t hk_mpu6050_continue_self_test(hk_mpu6050_t *sensor, uint32_t now_us);

#endif
