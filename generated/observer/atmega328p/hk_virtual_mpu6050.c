/* A virtual MPU-6050: see the header. This file: setting up, time, and what the outside sees.
 * Sources: register map RM-MPU-6000A revision 4.2, product specification PS-MPU-6000A revision
 * 3.4. */
#include "hk_virtual_parts.h"

#define HK_SETTLING_NS (100U * HK_NS_PER_MS)
#define HK_PIN_ACTIVE_LOW 0x80U
#define HK_PIN_OPEN       0x40U

/* Factory codes as a part may have them: accelerometer 14, 15, 13, gyroscope 12, 17, 9. */
#define HK_CODE_X 0x6CU
#define HK_CODE_Y 0x71U
#define HK_CODE_Z 0x69U
#define HK_CODE_A 0x2DU

uint32_t hk_virtual_mpu6050_size(void)
{
    return (uint32_t)sizeof(hk_virtual_mpu6050_t);
}

/* An assignment would ask for a C library. */
static void clear(hk_virtual_mpu6050_t *sensor)
{
    uint8_t *bytes = (uint8_t *)sensor;
    uint32_t i;

    for (i = 0U; i < sizeof *sensor; i++) {
        bytes[i] = 0U;
    }
}

void hk_virtual_mpu6050_init(hk_virtual_mpu6050_t *sensor, const double *rows, uint32_t row_count,
                             uint32_t settle, bool loop)
{
    uint32_t axis;

    clear(sensor);
    sensor->reset_end_ns = HK_NEVER;
    sensor->replay.rows = rows;
    sensor->replay.row_count = row_count;
    sensor->replay.settle = settle;
    sensor->replay.loop = loop && row_count > 0U;
    sensor->motion.begin_ns = HK_NEVER;
    sensor->response.settling_ns = HK_SETTLING_NS;
    for (axis = 0U; axis < 6U; axis++) {
        sensor->response.share[axis] = 1.0;
    }
    sensor->faults.who_am_i = HK_MPU6050_ID;
    hk_virtual_load_reset_values(sensor);
    hk_virtual_mpu6050_set_self_test(sensor, HK_CODE_X, HK_CODE_Y, HK_CODE_Z, HK_CODE_A);
}

void hk_virtual_mpu6050_set_identity(hk_virtual_mpu6050_t *sensor, uint8_t who_am_i)
{
    sensor->faults.who_am_i = who_am_i;
    sensor->reg[HK_REG_WHO_AM_I] = who_am_i;
}

void hk_virtual_mpu6050_set_self_test(hk_virtual_mpu6050_t *sensor, uint8_t x, uint8_t y, uint8_t z,
                                      uint8_t a)
{
    const uint8_t codes[4] = {x, y, z, a};
    int i;

    for (i = 0; i < 4; i++) {
        sensor->faults.self_test[i] = codes[i];
        sensor->reg[HK_REG_SELF_TEST_X + i] = codes[i];
    }
}

void hk_virtual_mpu6050_set_response(hk_virtual_mpu6050_t *sensor, uint32_t axis, double share)
{
    if (axis < 6U) {
        sensor->response.share[axis] = share;
    }
}

void hk_virtual_mpu6050_set_settling(hk_virtual_mpu6050_t *sensor, uint64_t settling_ns)
{
    sensor->response.settling_ns = settling_ns;
}

void hk_virtual_mpu6050_set_ad0(hk_virtual_mpu6050_t *sensor, bool high)
{
    sensor->first_address_bit = high;
}

void hk_virtual_mpu6050_feel_motion(hk_virtual_mpu6050_t *sensor, uint64_t row_period_ns)
{
    sensor->motion.row_period_ns = row_period_ns;
    sensor->motion.begin_ns = HK_NEVER;
}

/* --- Time ----------------------------------------------------------------------------------- */

uint64_t hk_virtual_mpu6050_next_event_ns(const hk_virtual_mpu6050_t *sensor)
{
    uint64_t next = sensor->sample_ns;

    if (sensor->reset_end_ns < next) {
        next = sensor->reset_end_ns;
    }
    if (sensor->pulse_end_ns < next) {
        next = sensor->pulse_end_ns;
    }
    return next;
}

void hk_virtual_mpu6050_advance(hk_virtual_mpu6050_t *sensor, uint64_t now_ns)
{
    for (;;) {
        const uint64_t event = hk_virtual_mpu6050_next_event_ns(sensor);

        if (event == HK_NEVER || event > now_ns) {
            break;
        }
        sensor->now_ns = event;
        if (event == sensor->reset_end_ns) {
            sensor->reset_end_ns = HK_NEVER;
            hk_virtual_load_reset_values(sensor);
        } else if (event == sensor->pulse_end_ns) {
            sensor->pulse_end_ns = HK_NEVER;
            sensor->latch = false;
        } else {
            hk_virtual_take_sample(sensor);
        }
    }
    if (now_ns > sensor->now_ns) {
        sensor->now_ns = now_ns;
    }
}

/* --- What the outside sees ------------------------------------------------------------------ */

bool hk_virtual_mpu6050_int_pin(const hk_virtual_mpu6050_t *sensor)
{
    const bool active_low = (sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_ACTIVE_LOW) != 0U;

    return sensor->latch != active_low;
}

bool hk_virtual_mpu6050_int_driven(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_OPEN) == 0U
           || !hk_virtual_mpu6050_int_pin(sensor);
}

uint64_t hk_virtual_mpu6050_published_ns(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->announced_ns;
}

bool hk_virtual_mpu6050_exhausted(const hk_virtual_mpu6050_t *sensor)
{
    const hk_replay_t *replay = &sensor->replay;
    const bool unread = (sensor->reg[HK_REG_INT_STATUS] & HK_INT_DATA_READY) != 0U;

    return !replay->loop && replay->next_row >= replay->row_count && !sensor->pending_full && !unread
           && !hk_virtual_fifo_has_packet(sensor) && !sensor->slave.open;
}

uint32_t hk_virtual_mpu6050_rows_played(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->replay.rows_played;
}

uint32_t hk_virtual_mpu6050_unread_samples(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->faults.unread_samples;
}
