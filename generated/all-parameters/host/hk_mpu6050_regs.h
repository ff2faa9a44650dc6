/* made by hostkit 0.1.0 from design 0099cab74159; do not edit; template virtual_mpu6050/hk_mpu6050_regs.h.j2 */
#ifndef HK_MPU6050_REGS_H
#define HK_MPU6050_REGS_H

/* MPU-6050: what the driver and the virtual sensor both know of it. */

#define HK_MPU6050_ADDRESS 0x68
#define HK_MPU6050_ID      0x68

/* Register addresses, and values after a reset. */
#define HK_REG_SMPLRT_DIV 0x19
#define HK_RESET_SMPLRT_DIV 0x00
#define HK_REG_CONFIG 0x1A
#define HK_RESET_CONFIG 0x00
#define HK_REG_GYRO_CONFIG 0x1B
#define HK_RESET_GYRO_CONFIG 0x00
#define HK_REG_ACCEL_CONFIG 0x1C
#define HK_RESET_ACCEL_CONFIG 0x00
#define HK_REG_FIFO_EN 0x23
#define HK_RESET_FIFO_EN 0x00
#define HK_REG_INT_PIN_CFG 0x37
#define HK_RESET_INT_PIN_CFG 0x00
#define HK_REG_INT_ENABLE 0x38
#define HK_RESET_INT_ENABLE 0x00
#define HK_REG_INT_STATUS 0x3A
#define HK_RESET_INT_STATUS 0x00
#define HK_REG_ACCEL_XOUT_H 0x3B
#define HK_RESET_ACCEL_XOUT_H 0x00
#define HK_REG_TEMP_OUT_H 0x41
#define HK_RESET_TEMP_OUT_H 0x00
#define HK_REG_GYRO_XOUT_H 0x43
#define HK_RESET_GYRO_XOUT_H 0x00
#define HK_REG_SIGNAL_PATH_RESET 0x68
#define HK_RESET_SIGNAL_PATH_RESET 0x00
#define HK_REG_USER_CTRL 0x6A
#define HK_RESET_USER_CTRL 0x00
#define HK_REG_PWR_MGMT_1 0x6B
#define HK_RESET_PWR_MGMT_1 0x40
#define HK_REG_PWR_MGMT_2 0x6C
#define HK_RESET_PWR_MGMT_2 0x00
#define HK_REG_WHO_AM_I 0x75
#define HK_RESET_WHO_AM_I 0x68

/* X(address, value after a reset) for every register. */
#define HK_MPU6050_REGISTERS(X) \
    X(0x19, 0x00) \
    X(0x1A, 0x00) \
    X(0x1B, 0x00) \
    X(0x1C, 0x00) \
    X(0x23, 0x00) \
    X(0x37, 0x00) \
    X(0x38, 0x00) \
    X(0x3A, 0x00) \
    X(0x3B, 0x00) \
    X(0x41, 0x00) \
    X(0x43, 0x00) \
    X(0x68, 0x00) \
    X(0x6A, 0x00) \
    X(0x6B, 0x40) \
    X(0x6C, 0x00) \
    X(0x75, 0x68)

/* Bits and values. */
#define HK_PWR_DEVICE_RESET   0x80
#define HK_PWR_SLEEP          0x40
#define HK_PWR_CLOCK_PLL      0x01
#define HK_SIGNAL_PATH_RESET  0x07
#define HK_INT_DATA_READY     0x01
#define HK_MPU6050_BURST_BYTES 14

/* X(field that selects the range, counts per SI unit) for every range. */
#define HK_MPU6050_GYRO_RANGES(X) \
    X(0, 0x1.d55df566a3f74p+12 /* rad/s, +-250 deg/s */) \
    X(1, 0x1.d55df566a3f74p+11 /* rad/s, +-500 deg/s */) \
    X(2, 0x1.d55df566a3f74p+10 /* rad/s, +-1000 deg/s */) \
    X(3, 0x1.d55df566a3f74p+9 /* rad/s, +-2000 deg/s */)
#define HK_MPU6050_ACCEL_RANGES(X) \
    X(0, 0x1.a1acfea981812p+10 /* m/s^2, +-2 g */) \
    X(1, 0x1.a1acfea981812p+9 /* m/s^2, +-4 g */) \
    X(2, 0x1.a1acfea981812p+8 /* m/s^2, +-8 g */) \
    X(3, 0x1.a1acfea981812p+7 /* m/s^2, +-16 g */)

/* Temperature count = 340 * degC - offset. */
#define HK_TEMPERATURE_COUNTS_PER_DEG_C 340
#define HK_TEMPERATURE_OFFSET_COUNTS    12420

#endif
