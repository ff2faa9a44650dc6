/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template common/hk_design.h.j2 */
#ifndef HK_DESIGN_H
#define HK_DESIGN_H

/* The design that this firmware was made from: rate 100.0 Hz. */
#define HK_VERSION       "0.1.0"
#define HK_VERSION_NUMBER UINT32_C(65536) /* a byte each: major, minor, patch, kind */
#define HK_DESIGN_DIGEST "f27a2d565bf0"
#define HK_DESIGN_DIGEST_BYTES \
    { 0xF2, 0x7A, 0x2D, 0x56, 0x5B, 0xF0 }
#define HK_PERIOD_US UINT32_C(10000)

/* X(address, value) for every register the driver sets, in this order. */
#define HK_SENSOR_CONFIGURATION(X) \
    X(0x38, 0x00) /* INT_ENABLE */ \
    X(0x6A, 0x00) /* USER_CTRL */ \
    X(0x23, 0x00) /* FIFO_EN */ \
    X(0x6C, 0x00) /* PWR_MGMT_2 */ \
    X(0x1A, 0x02) /* CONFIG */ \
    X(0x19, 0x09) /* SMPLRT_DIV */ \
    X(0x1B, 0x08) /* GYRO_CONFIG */ \
    X(0x1C, 0x08) /* ACCEL_CONFIG */ \
    X(0x37, 0x20) /* INT_PIN_CFG */

/* The same for parts whose accelerometer has a low-pass register of its own; written last. */
#define HK_VARIANT_CONFIGURATION(X) \
    X(0x1D, 0x02) /* ACCEL_CONFIG_2 */

/* A sample that comes so often, equal in every bit, is not measured any more. */
#define HK_FROZEN_SAMPLES 50U

/* Samples that still see the state of the sensor's low-pass filter before the start. */
#define HK_SETTLE_SAMPLES 2U

/* Weight of one count of angular rate in rad/s. */
#define HK_RAD_S_PER_COUNT 0.00026631610900792384f

/* Weight of one count of specific force in m/s^2. */
#define HK_M_S2_PER_COUNT 0.001197100830078125f

/* Body axes x, y, z as signed sensor axes. */
#define HK_BODY_X_SOURCE 0
#define HK_BODY_X_SIGN   1
#define HK_BODY_Y_SOURCE 1
#define HK_BODY_Y_SIGN   1
#define HK_BODY_Z_SOURCE 2
#define HK_BODY_Z_SIGN   1

/* Who the device is at first. */
#define HK_DEFAULT_SYSTEM_ID 1U
#define HK_COMPONENT_ID      1U
#define HK_VEHICLE_TYPE      0U
#define HK_AUTOPILOT         0U

/* The link: bit/s, and bytes/s that telemetry may take of it. The messages below take
 * 7664 bytes/s. */
#define HK_LINK_BAUD           500000
#define HK_LINK_USABLE_BYTES_S 40000

/* X(message, interval in us, bytes of its frame at most) for every message that can be streamed, in
 * the order in which they are sent; 0 is off until it is asked for. */
#define HK_MESSAGE_PLAN(X) \
    X(TILT_SAMPLE, UINT32_C(10000), 55U) \
    X(TILT_STATE, UINT32_C(1000000), 88U) \
    X(ATTITUDE, UINT32_C(20000), 40U) \
    X(SCALED_IMU, UINT32_C(0), 36U) \
    X(RAW_IMU, UINT32_C(0), 41U) \
    X(HIGHRES_IMU, UINT32_C(0), 75U) \
    X(SYS_STATUS, UINT32_C(1000000), 55U) \
    X(HEARTBEAT, UINT32_C(1000000), 21U)

/* Words of the filter's state in TILT_STATE; 0 where that message is not sent. */
#define HK_TOLD_WORDS 18

/* How it works. */
#define HK_FLOAT              0 /* the filter computes in float */
#define HK_FIFO               0 /* samples come out of the sensor's FIFO */
#define HK_CALIBRATE_AT_START 0 /* the gyroscope's bias is measured after a start */
#define HK_SIGNING            0 /* messages are signed */

#endif
