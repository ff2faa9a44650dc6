/* The virtual MPU-6050: INT_STATUS and the INT pin. */
#include "hk_virtual_parts.h"

#define HK_PULSE_NS UINT64_C(50000)

/* Raise a bit of INT_STATUS, as far as it is enabled, and the pin. */
void hk_virtual_interrupt(hk_virtual_mpu6050_t *sensor, uint8_t status)
{
    if ((sensor->reg[HK_REG_INT_ENABLE] & status) == 0U) {
        return;
    }
    sensor->reg[HK_REG_INT_STATUS] |= status;
    if (status == HK_INT_DATA_READY && sensor->faults.lost_ready_left > 0U) {
        sensor->faults.lost_ready_left--;
        return;
    }
    if (!sensor->latch) {
        sensor->announced_ns = sensor->now_ns;
    }
    sensor->latch = true;
    if ((sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_LATCH) == 0U) {
        sensor->pulse_end_ns = sensor->now_ns + HK_PULSE_NS;
    }
}

void hk_virtual_clear_interrupt(hk_virtual_mpu6050_t *sensor)
{
    sensor->reg[HK_REG_INT_STATUS] = 0U;
    if ((sensor->reg[HK_REG_INT_PIN_CFG] & HK_PIN_LATCH) != 0U) {
        sensor->latch = false;
    }
}
