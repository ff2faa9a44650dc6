/* The virtual MPU-6050: the FIFO, its switches and what enters it. */
#include "hk_virtual_parts.h"

#define HK_USER_I2C_MASTER_RESET 0x02U
#define HK_USER_SIGNAL_RESET     0x01U
#define HK_USER_RESET_BITS       (HK_USER_FIFO_RESET | HK_USER_I2C_MASTER_RESET | HK_USER_SIGNAL_RESET)
#define HK_TEMPERATURE_PLACE 6
#define HK_GYRO_PLACE        8

bool hk_virtual_fifo_enabled(const hk_virtual_mpu6050_t *sensor)
{
    return (sensor->reg[HK_REG_USER_CTRL] & HK_USER_FIFO) != 0U;
}

static uint16_t packet_bytes(const hk_virtual_mpu6050_t *sensor)
{
    const uint8_t which = sensor->reg[HK_REG_FIFO_EN];
    uint16_t bytes = (which & HK_FIFO_ACCEL) != 0U ? 6U : 0U;
    int axis;

    bytes = (uint16_t)(bytes + ((which & HK_FIFO_TEMPERATURE) != 0U ? 2U : 0U));
    for (axis = 0; axis < 3; axis++) {
        bytes = (uint16_t)(bytes + ((which & (HK_FIFO_GYRO_X >> axis)) != 0U ? 2U : 0U));
    }
    return bytes;
}

bool hk_virtual_fifo_has_packet(const hk_virtual_mpu6050_t *sensor)
{
    const uint16_t bytes = packet_bytes(sensor);

    return hk_virtual_fifo_enabled(sensor) && bytes > 0U && sensor->fifo.count >= bytes;
}

void hk_virtual_fifo_clear(hk_virtual_mpu6050_t *sensor)
{
    sensor->fifo.first = 0U;
    sensor->fifo.count = 0U;
}

/* Append a byte; a full FIFO loses its oldest. */
void hk_virtual_fifo_push(hk_virtual_mpu6050_t *sensor, uint8_t byte)
{
    hk_virtual_fifo_t *fifo = &sensor->fifo;

    if (fifo->count == HK_MPU6050_FIFO_BYTES) {
        fifo->first = (uint16_t)((fifo->first + 1U) % HK_MPU6050_FIFO_BYTES);
        fifo->count--;
        hk_virtual_interrupt(sensor, HK_INT_FIFO_OVERFLOW);
    }
    fifo->data[(fifo->first + fifo->count) % HK_MPU6050_FIFO_BYTES] = byte;
    fifo->count++;
}

uint8_t hk_virtual_fifo_pop(hk_virtual_mpu6050_t *sensor)
{
    hk_virtual_fifo_t *fifo = &sensor->fifo;

    if (fifo->count > 0U && hk_virtual_fifo_enabled(sensor)) {
        fifo->last = fifo->data[fifo->first];
        fifo->first = (uint16_t)((fifo->first + 1U) % HK_MPU6050_FIFO_BYTES);
        fifo->count--;
    }
    return fifo->last;
}

static void push_all(hk_virtual_mpu6050_t *sensor, const uint8_t *bytes, int count)
{
    int i;

    for (i = 0; i < count; i++) {
        hk_virtual_fifo_push(sensor, bytes[i]);
    }
}

/* Push what FIFO_EN selects of a sample, in the order of the registers. */
static void push_sample(hk_virtual_mpu6050_t *sensor, const uint8_t *burst)
{
    const uint8_t which = sensor->reg[HK_REG_FIFO_EN];
    int axis;

    if ((which & HK_FIFO_ACCEL) != 0U) {
        push_all(sensor, burst, HK_TEMPERATURE_PLACE);
    }
    if ((which & HK_FIFO_TEMPERATURE) != 0U) {
        push_all(sensor, &burst[HK_TEMPERATURE_PLACE], 2);
    }
    for (axis = 0; axis < 3; axis++) {
        if ((which & (HK_FIFO_GYRO_X >> axis)) != 0U) {
            push_all(sensor, &burst[HK_GYRO_PLACE + 2 * axis], 2);
        }
    }
}

/* A sample enters the FIFO when it is taken, whatever the bus does. */
void hk_virtual_fifo_take(hk_virtual_mpu6050_t *sensor, const uint8_t *burst)
{
    if (!hk_virtual_fifo_enabled(sensor)) {
        return;
    }
    if (sensor->fifo.count + packet_bytes(sensor) > HK_MPU6050_FIFO_BYTES) {
        sensor->faults.unread_samples++;
    }
    push_sample(sensor, burst);
    for (; sensor->faults.extra_packets > 0U; sensor->faults.extra_packets--) {
        push_sample(sensor, burst);
    }
    for (; sensor->faults.lose_bytes > 0U; sensor->faults.lose_bytes--) {
        (void)hk_virtual_fifo_pop(sensor);
    }
}

/* FIFO_RESET acts only while the FIFO is off, before and after the write. */
void hk_virtual_write_user_control(hk_virtual_mpu6050_t *sensor, uint8_t value)
{
    const bool was_on = hk_virtual_fifo_enabled(sensor);

    sensor->reg[HK_REG_USER_CTRL] = (uint8_t)(value & ~HK_USER_RESET_BITS);
    if ((value & HK_USER_FIFO_RESET) != 0U && !was_on && !hk_virtual_fifo_enabled(sensor)) {
        hk_virtual_fifo_clear(sensor);
    }
    if ((value & HK_USER_SIGNAL_RESET) != 0U) {
        hk_virtual_reset_signal_path(sensor, HK_SIGNAL_PATH_RESET);
    }
}
