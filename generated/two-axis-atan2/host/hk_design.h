/* made by hostkit 0.1.0 from design 00e52f7c2b01; do not edit; template common/hk_design.h.j2 */
#ifndef HK_DESIGN_H
#define HK_DESIGN_H

/* The design that this firmware was made from: rate 100.0 Hz. */
#define HK_VERSION       "0.1.0"
#define HK_DESIGN_DIGEST "00e52f7c2b01"
#define HK_DESIGN_DIGEST_BYTES \
    { 0x00, 0xE5, 0x2F, 0x7C, 0x2B, 0x01 }
#define HK_PERIOD_US UINT32_C(10000)

/* X(address, value) for every register the driver sets, in this order. */
#define HK_SENSOR_CONFIGURATION(X) \
    X(0x38, 0x00) /* INT_ENABLE */ \
    X(0x6A, 0x00) /* USER_CTRL */ \
    X(0x23, 0x00) /* FIFO_EN */ \
    X(0x6C, 0x00) /* PWR_MGMT_2 */ \
    X(0x1A, 0x03) /* CONFIG */ \
    X(0x19, 0x09) /* SMPLRT_DIV */ \
    X(0x1B, 0x08) /* GYRO_CONFIG */ \
    X(0x1C, 0x00) /* ACCEL_CONFIG */ \
    X(0x37, 0x20) /* INT_PIN_CFG */

/* The same for parts whose accelerometer has a low-pass register of its own; written last. */
#define HK_VARIANT_CONFIGURATION(X) \
    X(0x1D, 0x03) /* ACCEL_CONFIG_2 */

/* A sample that comes so often, equal in every bit, is not measured any more. */
#define HK_FROZEN_SAMPLES 50U

/* Samples that still see the state of the sensor's low-pass filter before the start. */
#define HK_SETTLE_SAMPLES 3U

/* Weight of one count of angular rate in rad/s. */
#define HK_RAD_S_PER_COUNT 0.00026631610900792384f

/* Body axes x, y, z as signed sensor axes. */
#define HK_BODY_X_SOURCE 0
#define HK_BODY_X_SIGN   1
#define HK_BODY_Y_SOURCE 1
#define HK_BODY_Y_SIGN   1
#define HK_BODY_Z_SOURCE 2
#define HK_BODY_Z_SIGN   1

/* Telemetry. */
#define HK_SYSTEM_ID      1U
#define HK_COMPONENT_ID   1U
#define HK_VEHICLE_TYPE   0U
#define HK_AUTOPILOT      0U
#define HK_LINK_BAUD      500000 /* bit/s; telemetry takes 7521 bytes/s */
#define HK_HEARTBEAT_US   (UINT32_C(1000) * 1000U)
#define HK_ATTITUDE_EVERY 2U

#endif
