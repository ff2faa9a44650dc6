/* made by hostkit 0.1.0 from design 975f50245cf2; do not edit; template virtual_mpu6050/hk_mpu6050_regs.h.j2 */
#ifndef HK_MPU6050_REGS_H
#define HK_MPU6050_REGS_H

/* MPU-6050: what the driver and the virtual sensor both know of it. */

#define HK_MPU6050_ADDRESS 0x68
#define HK_MPU6050_ID      0x68

/* X(WHO_AM_I, part, accepted, warned of, accelerometer with its own low-pass register) */
#define HK_MPU6050_IDENTITIES(X) \
    X(0x68, "MPU-6050", true, false, false) \
    X(0x70, "MPU-6500", true, true, true) \
    X(0x71, "MPU-9250", true, true, true) \
    X(0x73, "MPU-9255", true, true, true) \
    X(0x98, "ICM-20689", true, true, true) \
    X(0x72, "unknown clone", true, true, false) \
    X(0x74, "unknown clone", true, true, false) \
    X(0x75, "unknown clone", true, true, false) \
    X(0x12, "ICM-20602", false, true, false)

/* Register addresses, and values after a reset. */
#define HK_REG_SELF_TEST_X 0x0D
#define HK_RESET_SELF_TEST_X 0x00
#define HK_REG_SELF_TEST_Y 0x0E
#define HK_RESET_SELF_TEST_Y 0x00
#define HK_REG_SELF_TEST_Z 0x0F
#define HK_RESET_SELF_TEST_Z 0x00
#define HK_REG_SELF_TEST_A 0x10
#define HK_RESET_SELF_TEST_A 0x00
#define HK_REG_SMPLRT_DIV 0x19
#define HK_RESET_SMPLRT_DIV 0x00
#define HK_REG_CONFIG 0x1A
#define HK_RESET_CONFIG 0x00
#define HK_REG_GYRO_CONFIG 0x1B
#define HK_RESET_GYRO_CONFIG 0x00
#define HK_REG_ACCEL_CONFIG 0x1C
#define HK_RESET_ACCEL_CONFIG 0x00
#define HK_REG_ACCEL_CONFIG_2 0x1D
#define HK_RESET_ACCEL_CONFIG_2 0x00
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
#define HK_REG_EXT_SENS_DATA_00 0x49
#define HK_RESET_EXT_SENS_DATA_00 0x00
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
    X(0x0D, 0x00) \
    X(0x0E, 0x00) \
    X(0x0F, 0x00) \
    X(0x10, 0x00) \
    X(0x19, 0x00) \
    X(0x1A, 0x00) \
    X(0x1B, 0x00) \
    X(0x1C, 0x00) \
    X(0x1D, 0x00) \
    X(0x23, 0x00) \
    X(0x37, 0x00) \
    X(0x38, 0x00) \
    X(0x3A, 0x00) \
    X(0x3B, 0x00) \
    X(0x41, 0x00) \
    X(0x43, 0x00) \
    X(0x49, 0x00) \
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
#define HK_SELF_TEST           0xE0
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

/* Self-test: the factory's response for code 1, in counts of the narrowest gyroscope range and of
 * the accelerometer range +-8 g, and its growth from code to code. */
#define HK_SELF_TEST_GYRO_COUNTS  0x1.9960000000000p+11
#define HK_SELF_TEST_GYRO_GROWTH  0x1.0bc6a7ef9db23p+0
#define HK_SELF_TEST_ACCEL_COUNTS 0x1.5c28f5c28f5c3p+10
#define HK_SELF_TEST_ACCEL_GROWTH 0x1.08a3065c31efdp+0
#define HK_SELF_TEST_ACCEL_SETTING 2

/* Temperature count = 340 * degC - offset. */
#define HK_TEMPERATURE_COUNTS_PER_DEG_C 340
#define HK_TEMPERATURE_OFFSET_COUNTS    12420

#endif
