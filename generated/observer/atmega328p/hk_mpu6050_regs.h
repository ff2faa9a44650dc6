/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template virtual_mpu6050/hk_mpu6050_regs.h.j2 */
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
    X(0x74, "MPU-6515", true, true, true) \
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
#define HK_REG_FIFO_COUNT_H 0x72
#define HK_RESET_FIFO_COUNT_H 0x00
#define HK_REG_FIFO_COUNT_L 0x73
#define HK_RESET_FIFO_COUNT_L 0x00
#define HK_REG_FIFO_R_W 0x74
#define HK_RESET_FIFO_R_W 0x00
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
    X(0x72, 0x00) \
    X(0x73, 0x00) \
    X(0x74, 0x00) \
    X(0x75, 0x68)

/* Bits and values. */
#define HK_PWR_DEVICE_RESET   0x80
#define HK_PWR_SLEEP          0x40
#define HK_PWR_CLOCK_PLL      0x01
#define HK_SIGNAL_PATH_RESET  0x07
#define HK_INT_DATA_READY     0x01
#define HK_INT_FIFO_OVERFLOW  0x10
#define HK_USER_FIFO          0x40
#define HK_USER_FIFO_RESET    0x04
#define HK_FIFO_TEMPERATURE   0x80
#define HK_FIFO_GYRO_X        0x40 /* y and z in the bits below */
#define HK_FIFO_ACCEL         0x08
#define HK_FIFO_ALL           0xF8
#define HK_SELF_TEST           0xE0
#define HK_MPU6050_BURST_BYTES 14
#define HK_MPU6050_FIFO_BYTES  1024

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

/* The same as a table, code 1 first, and how far a response may be from it. */
#define HK_SELF_TEST_CODES 31U
#define HK_SELF_TEST_GYRO_TRIMS \
    { 3275, 3426, 3583, 3748, 3920, 4101, 4289, 4487, 4693, 4909, 5135, 5371, 5618, 5877, 6147, 6430, 6725, 7035, 7358, 7697, 8051, 8421, 8809, 9214, 9638, 10081, 10545, 11030, 11537, 12068, 12623 }
#define HK_SELF_TEST_ACCEL_TRIMS \
    { 1393, 1440, 1488, 1538, 1590, 1644, 1699, 1757, 1816, 1877, 1941, 2006, 2074, 2144, 2216, 2291, 2368, 2448, 2531, 2616, 2704, 2795, 2890, 2987, 3088, 3192, 3300, 3411, 3526, 3645, 3768 }
#define HK_SELF_TEST_TOLERANCE_PERCENT 14

/* Ranges of the self-test, and how far a sample of a sensor at rest may be from the first. */
#define HK_SELF_TEST_GYRO_CONFIG  0x00
#define HK_SELF_TEST_ACCEL_CONFIG 0x10
#define HK_SELF_TEST_GYRO_SPREAD  262
#define HK_SELF_TEST_ACCEL_SPREAD 205

/* Low-pass: X(DLPF_CFG, b0, b1, b2, a1, a2, delay in ticks) for gyroscope and accelerometer, sections
 * of second order at 8000 Hz. */
#define HK_MPU6050_GYRO_LOW_PASSES(X) \
    X(0, 0x1.774f4df5596bdp-4, 0x1.774f4df5596bdp-4, 0x0.0p+0, -0x1.a22c2c82a9a51p-1, 0x0.0p+0, 3) \
    X(1, 0x1.1a1592d5d1a76p-4, 0x1.1a1592d5d1a76p-4, 0x0.0p+0, -0x1.b97a9b4a8b963p-1, 0x0.0p+0, 8) \
    X(2, 0x1.2fb9ef527ac1cp-5, 0x1.2fb9ef527ac1cp-5, 0x0.0p+0, -0x1.da08c215b0a7dp-1, 0x0.0p+0, 9) \
    X(3, 0x1.09ddc6ae8e121p-6, 0x1.09ddc6ae8e121p-6, 0x0.0p+0, -0x1.ef622395171eep-1, 0x0.0p+0, 8) \
    X(4, 0x1.feb7c68384b07p-8, 0x1.feb7c68384b07p-8, 0x0.0p+0, -0x1.f80520e5f1ed4p-1, 0x0.0p+0, 3) \
    X(5, 0x1.c78ed3aaf8b05p-9, 0x1.67a6f65533cd8p-17, -0x1.c6272cb4a37c8p-9, -0x1.fda122d46f67ep+0, 0x1.fb4514f6cb7a2p-1, 0) \
    X(6, 0x1.b25a1ead437fap-10, 0x1.f795ba44dcb54p-20, -0x1.b1dc393eb2488p-10, -0x1.ff021ccca6ca7p+0, 0x1.fe04b77ebc261p-1, 0)
#define HK_MPU6050_ACCEL_LOW_PASSES(X) \
    X(0, 0x1.7caa760c8d0f6p-4, 0x1.7caa760c8d0f6p-4, 0x0.0p+0, -0x1.a0d5627cdcbc3p-1, 0x0.0p+0, 0) \
    X(1, 0x1.1477c476d5df5p-4, 0x1.1477c476d5df5p-4, 0x0.0p+0, -0x1.bae20ee24a883p-1, 0x0.0p+0, 9) \
    X(2, 0x1.23c27e38c73fcp-5, 0x1.23c27e38c73fcp-5, 0x0.0p+0, -0x1.db87b038e7181p-1, 0x0.0p+0, 10) \
    X(3, 0x1.165060a862038p-6, 0x1.165060a862038p-6, 0x0.0p+0, -0x1.ee9af9f579dfcp-1, 0x0.0p+0, 10) \
    X(4, 0x1.0c05e3f1ef735p-7, 0x1.0c05e3f1ef735p-7, 0x0.0p+0, -0x1.f79fd0e070846p-1, 0x0.0p+0, 7) \
    X(5, 0x1.cb3111c757b83p-9, 0x1.7c08b57a93271p-17, -0x1.c9b50911dd250p-9, -0x1.fd902d5f9da1cp+0, 0x1.fb2352d0a638ap-1, 0) \
    X(6, 0x1.b311bd62aeba6p-10, 0x1.fe103c2e85172p-20, -0x1.b2923953a3192p-10, -0x1.ff007c0f03a4fp+0, 0x1.fe0177a216558p-1, 0)

/* Rates of cycle mode: X(LP_WAKE_CTRL, period in ms). */
#define HK_MPU6050_WAKE_PERIODS(X) \
    X(0, 800) \
    X(1, 200) \
    X(2, 50) \
    X(3, 25)

/* Temperature count = 340 * degC - offset. */
#define HK_TEMPERATURE_COUNTS_PER_DEG_C 340
#define HK_TEMPERATURE_OFFSET_COUNTS    12420

#endif
