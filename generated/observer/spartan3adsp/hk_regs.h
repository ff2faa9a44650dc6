/* made by hostkit 0.1.0 from design f27a2d565bf0; do not edit; template registers/hk_regs.h.j2 */
/* Registers of the FPGA system: byte offsets, masks, shifts and values after reset.
 *
 * HK_REGS_GET takes a field out of a word, HK_REGS_PUT makes a word of one field:
 *
 *     gyro = HK_REGS_GET(SENSOR_GYRO_FULL_SCALE, word);
 *     word = HK_REGS_PUT(CONTROL_ENABLE, 1) | HK_REGS_PUT(CONTROL_COMMIT, 1);
 */
#ifndef HK_REGS_H
#define HK_REGS_H

#include <stdint.h>

#define HK_REGS_GET(field, word) \
    (((uint32_t)(word) & HK_REGS_##field##_MASK) >> HK_REGS_##field##_SHIFT)
#define HK_REGS_PUT(field, value) \
    (((uint32_t)(value) << HK_REGS_##field##_SHIFT) & HK_REGS_##field##_MASK)

/* A field of `bits` bits in two's complement as a number. */
static inline int32_t hk_regs_signed(uint32_t value, unsigned bits)
{
    const uint32_t sign = UINT32_C(1) << (bits - 1U);
    const uint32_t extended = ((value & ((sign << 1) - 1U)) ^ sign) - sign;

    return extended > UINT32_C(0x7FFFFFFF) ? -(int32_t)(~extended) - 1 : (int32_t)extended;
}

/* Always 0x484B4954, HKIT in ASCII. */
#define HK_REGS_IDENTITY_OFFSET 0x00U
#define HK_REGS_IDENTITY_RESET UINT32_C(0x484B4954)
/* magic; read only */
#define HK_REGS_IDENTITY_MAGIC_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_IDENTITY_MAGIC_SHIFT 0
#define HK_REGS_IDENTITY_MAGIC_BITS 32

/* Revision of this map and version of hostkit. */
#define HK_REGS_VERSION_OFFSET 0x04U
#define HK_REGS_VERSION_RESET UINT32_C(0x01000100)
/* patch; read only */
#define HK_REGS_VERSION_PATCH_MASK UINT32_C(0x000000FF)
#define HK_REGS_VERSION_PATCH_SHIFT 0
#define HK_REGS_VERSION_PATCH_BITS 8
/* minor; read only */
#define HK_REGS_VERSION_MINOR_MASK UINT32_C(0x0000FF00)
#define HK_REGS_VERSION_MINOR_SHIFT 8
#define HK_REGS_VERSION_MINOR_BITS 8
/* major; read only */
#define HK_REGS_VERSION_MAJOR_MASK UINT32_C(0x00FF0000)
#define HK_REGS_VERSION_MAJOR_SHIFT 16
#define HK_REGS_VERSION_MAJOR_BITS 8
/* revision of the map; it moves with an address; read only */
#define HK_REGS_VERSION_REVISION_MASK UINT32_C(0xFF000000)
#define HK_REGS_VERSION_REVISION_SHIFT 24
#define HK_REGS_VERSION_REVISION_BITS 8

/* First digits of the design's digest. */
#define HK_REGS_DIGEST_HIGH_OFFSET 0x08U
#define HK_REGS_DIGEST_HIGH_RESET UINT32_C(0x0000F27A)
/* 4 hex digits; read only */
#define HK_REGS_DIGEST_HIGH_DIGITS_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_DIGEST_HIGH_DIGITS_SHIFT 0
#define HK_REGS_DIGEST_HIGH_DIGITS_BITS 16

/* The other digits. */
#define HK_REGS_DIGEST_LOW_OFFSET 0x0CU
#define HK_REGS_DIGEST_LOW_RESET UINT32_C(0x2D565BF0)
/* 8 hex digits; read only */
#define HK_REGS_DIGEST_LOW_DIGITS_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_DIGEST_LOW_DIGITS_SHIFT 0
#define HK_REGS_DIGEST_LOW_DIGITS_BITS 32

/* What the filter has. */
#define HK_REGS_FEATURES_OFFSET 0x10U
#define HK_REGS_FEATURES_RESET UINT32_C(0x0001005F)
/* roll is estimated; read only */
#define HK_REGS_FEATURES_ROLL_MASK UINT32_C(0x00000001)
#define HK_REGS_FEATURES_ROLL_SHIFT 0
#define HK_REGS_FEATURES_ROLL_BITS 1
/* pitch is estimated; read only */
#define HK_REGS_FEATURES_PITCH_MASK UINT32_C(0x00000002)
#define HK_REGS_FEATURES_PITCH_SHIFT 1
#define HK_REGS_FEATURES_PITCH_BITS 1
/* the first samples align it; read only */
#define HK_REGS_FEATURES_ALIGN_MASK UINT32_C(0x00000004)
#define HK_REGS_FEATURES_ALIGN_SHIFT 2
#define HK_REGS_FEATURES_ALIGN_BITS 1
/* it looks for rest; read only */
#define HK_REGS_FEATURES_REST_MASK UINT32_C(0x00000008)
#define HK_REGS_FEATURES_REST_SHIFT 3
#define HK_REGS_FEATURES_REST_BITS 1
/* a rate that is clipped makes it align again; read only */
#define HK_REGS_FEATURES_CLIP_MASK UINT32_C(0x00000010)
#define HK_REGS_FEATURES_CLIP_SHIFT 4
#define HK_REGS_FEATURES_CLIP_BITS 1
/* the filter takes a sample every clock; read only */
#define HK_REGS_FEATURES_PIPELINED_MASK UINT32_C(0x00000020)
#define HK_REGS_FEATURES_PIPELINED_SHIFT 5
#define HK_REGS_FEATURES_PIPELINED_BITS 1
/* the angles are told ahead; read only */
#define HK_REGS_FEATURES_LEAD_MASK UINT32_C(0x00000040)
#define HK_REGS_FEATURES_LEAD_SHIFT 6
#define HK_REGS_FEATURES_LEAD_BITS 1
/* sensors that the filter serves; read only */
#define HK_REGS_FEATURES_CHANNELS_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_FEATURES_CHANNELS_SHIFT 16
#define HK_REGS_FEATURES_CHANNELS_BITS 16

/* How the sensor is set. */
#define HK_REGS_SENSOR_OFFSET 0x14U
#define HK_REGS_SENSOR_RESET UINT32_C(0x440901F4)
/* deg/s; read only */
#define HK_REGS_SENSOR_GYRO_FULL_SCALE_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_SENSOR_GYRO_FULL_SCALE_SHIFT 0
#define HK_REGS_SENSOR_GYRO_FULL_SCALE_BITS 16
/* SMPLRT_DIV; read only */
#define HK_REGS_SENSOR_DIVIDER_MASK UINT32_C(0x00FF0000)
#define HK_REGS_SENSOR_DIVIDER_SHIFT 16
#define HK_REGS_SENSOR_DIVIDER_BITS 8
/* g; read only */
#define HK_REGS_SENSOR_ACCEL_FULL_SCALE_MASK UINT32_C(0x1F000000)
#define HK_REGS_SENSOR_ACCEL_FULL_SCALE_SHIFT 24
#define HK_REGS_SENSOR_ACCEL_FULL_SCALE_BITS 5
/* DLPF_CFG; read only */
#define HK_REGS_SENSOR_LOW_PASS_MASK UINT32_C(0xE0000000)
#define HK_REGS_SENSOR_LOW_PASS_SHIFT 29
#define HK_REGS_SENSOR_LOW_PASS_BITS 3

/* Sample rate. */
#define HK_REGS_RATE_OFFSET 0x18U
#define HK_REGS_RATE_RESET UINT32_C(0x000186A0)
/* millihertz; read only */
#define HK_REGS_RATE_MILLIHERTZ_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_RATE_MILLIHERTZ_SHIFT 0
#define HK_REGS_RATE_MILLIHERTZ_BITS 32

/* Fraction bits of the coefficients. */
#define HK_REGS_FORMATS_OFFSET 0x1CU
#define HK_REGS_FORMATS_RESET UINT32_C(0x2727202A)
/* fraction bits of KT; read only */
#define HK_REGS_FORMATS_KT_FRACTION_BITS_MASK UINT32_C(0x000000FF)
#define HK_REGS_FORMATS_KT_FRACTION_BITS_SHIFT 0
#define HK_REGS_FORMATS_KT_FRACTION_BITS_BITS 8
/* fraction bits of KV; read only */
#define HK_REGS_FORMATS_KV_FRACTION_BITS_MASK UINT32_C(0x0000FF00)
#define HK_REGS_FORMATS_KV_FRACTION_BITS_SHIFT 8
#define HK_REGS_FORMATS_KV_FRACTION_BITS_BITS 8
/* fraction bits of KB; read only */
#define HK_REGS_FORMATS_KB_FRACTION_BITS_MASK UINT32_C(0x00FF0000)
#define HK_REGS_FORMATS_KB_FRACTION_BITS_SHIFT 16
#define HK_REGS_FORMATS_KB_FRACTION_BITS_BITS 8
/* fraction bits of BIAS; read only */
#define HK_REGS_FORMATS_BIAS_FRACTION_BITS_MASK UINT32_C(0xFF000000)
#define HK_REGS_FORMATS_BIAS_FRACTION_BITS_SHIFT 24
#define HK_REGS_FORMATS_BIAS_FRACTION_BITS_BITS 8

/* Weight of the other words. */
#define HK_REGS_SCALES_OFFSET 0x20U
#define HK_REGS_SCALES_RESET UINT32_C(0x20000000)
/* accelerometer count of 1 g; read only */
#define HK_REGS_SCALES_GRAVITY_COUNT_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_SCALES_GRAVITY_COUNT_SHIFT 16
#define HK_REGS_SCALES_GRAVITY_COUNT_BITS 16

/* What software asks for; 1 in CLEAR, COMMIT or RESTORE acts once. */
#define HK_REGS_CONTROL_OFFSET 0x24U
#define HK_REGS_CONTROL_RESET UINT32_C(0x00000001)
/* samples are taken; read, write */
#define HK_REGS_CONTROL_ENABLE_MASK UINT32_C(0x00000001)
#define HK_REGS_CONTROL_ENABLE_SHIFT 0
#define HK_REGS_CONTROL_ENABLE_BITS 1
/* restart the filter; 1 acts, reads 0 */
#define HK_REGS_CONTROL_CLEAR_MASK UINT32_C(0x00000002)
#define HK_REGS_CONTROL_CLEAR_SHIFT 1
#define HK_REGS_CONTROL_CLEAR_BITS 1
/* take the written settings over, all at once; 1 acts, reads 0 */
#define HK_REGS_CONTROL_COMMIT_MASK UINT32_C(0x00000004)
#define HK_REGS_CONTROL_COMMIT_SHIFT 2
#define HK_REGS_CONTROL_COMMIT_BITS 1
/* write the design's settings back; 1 acts, reads 0 */
#define HK_REGS_CONTROL_RESTORE_MASK UINT32_C(0x00000008)
#define HK_REGS_CONTROL_RESTORE_SHIFT 3
#define HK_REGS_CONTROL_RESTORE_BITS 1

/* How things stand. */
#define HK_REGS_STATUS_OFFSET 0x28U
#define HK_REGS_STATUS_RESET UINT32_C(0x00000000)
/* the sensor is configured and sampled; read only */
#define HK_REGS_STATUS_RUNNING_MASK UINT32_C(0x00000001)
#define HK_REGS_STATUS_RUNNING_SHIFT 0
#define HK_REGS_STATUS_RUNNING_BITS 1
/* the sensor was refused; it is tried again; read only */
#define HK_REGS_STATUS_FAILED_MASK UINT32_C(0x00000002)
#define HK_REGS_STATUS_FAILED_SHIFT 1
#define HK_REGS_STATUS_FAILED_BITS 1
/* the filter has a sample in work; read only */
#define HK_REGS_STATUS_BUSY_MASK UINT32_C(0x00000004)
#define HK_REGS_STATUS_BUSY_SHIFT 2
#define HK_REGS_STATUS_BUSY_BITS 1
/* the settings in use are not the design's; read only */
#define HK_REGS_STATUS_RETUNED_MASK UINT32_C(0x00000008)
#define HK_REGS_STATUS_RETUNED_SHIFT 3
#define HK_REGS_STATUS_RETUNED_BITS 1
/* settings were written and not committed; read only */
#define HK_REGS_STATUS_STAGED_MASK UINT32_C(0x00000010)
#define HK_REGS_STATUS_STAGED_SHIFT 4
#define HK_REGS_STATUS_STAGED_BITS 1
/* a commit waits for the filter; read only */
#define HK_REGS_STATUS_COMMITTING_MASK UINT32_C(0x00000020)
#define HK_REGS_STATUS_COMMITTING_SHIFT 5
#define HK_REGS_STATUS_COMMITTING_BITS 1
/* identity of the sensor as read; read only */
#define HK_REGS_STATUS_WHO_AM_I_MASK UINT32_C(0x0000FF00)
#define HK_REGS_STATUS_WHO_AM_I_SHIFT 8
#define HK_REGS_STATUS_WHO_AM_I_BITS 8

/* What has happened; 1 clears, unless it happens again just then. */
#define HK_REGS_EVENTS_OFFSET 0x2CU
#define HK_REGS_EVENTS_RESET UINT32_C(0x00000000)
/* a sample went through the filter; sticky, 1 clears */
#define HK_REGS_EVENTS_SAMPLE_MASK UINT32_C(0x00000001)
#define HK_REGS_EVENTS_SAMPLE_SHIFT 0
#define HK_REGS_EVENTS_SAMPLE_BITS 1
/* the filter loaded the measured tilt instead of stepping; sticky, 1 clears */
#define HK_REGS_EVENTS_RESTARTED_MASK UINT32_C(0x00000002)
#define HK_REGS_EVENTS_RESTARTED_SHIFT 1
#define HK_REGS_EVENTS_RESTARTED_BITS 1
/* a count stood at the end of its range; sticky, 1 clears */
#define HK_REGS_EVENTS_SATURATED_MASK UINT32_C(0x00000004)
#define HK_REGS_EVENTS_SATURATED_SHIFT 2
#define HK_REGS_EVENTS_SATURATED_BITS 1
/* a sample was lost because the filter was busy; sticky, 1 clears */
#define HK_REGS_EVENTS_OVERRUN_MASK UINT32_C(0x00000008)
#define HK_REGS_EVENTS_OVERRUN_SHIFT 3
#define HK_REGS_EVENTS_OVERRUN_BITS 1
/* a transfer with the sensor failed; sticky, 1 clears */
#define HK_REGS_EVENTS_BUS_ERROR_MASK UINT32_C(0x00000010)
#define HK_REGS_EVENTS_BUS_ERROR_SHIFT 4
#define HK_REGS_EVENTS_BUS_ERROR_BITS 1
/* a received byte was lost because the one before was unread; sticky, 1 clears */
#define HK_REGS_EVENTS_UART_OVERRUN_MASK UINT32_C(0x00000020)
#define HK_REGS_EVENTS_UART_OVERRUN_SHIFT 5
#define HK_REGS_EVENTS_UART_OVERRUN_BITS 1
/* a received byte had no stop bit; sticky, 1 clears */
#define HK_REGS_EVENTS_UART_FRAMING_MASK UINT32_C(0x00000040)
#define HK_REGS_EVENTS_UART_FRAMING_SHIFT 6
#define HK_REGS_EVENTS_UART_FRAMING_BITS 1

/* Events that raise the interrupt. */
#define HK_REGS_INTERRUPTS_OFFSET 0x30U
#define HK_REGS_INTERRUPTS_RESET UINT32_C(0x00000000)
/* interrupt when a sample went through the filter; read, write */
#define HK_REGS_INTERRUPTS_SAMPLE_MASK UINT32_C(0x00000001)
#define HK_REGS_INTERRUPTS_SAMPLE_SHIFT 0
#define HK_REGS_INTERRUPTS_SAMPLE_BITS 1
/* interrupt when the filter loaded the measured tilt instead of stepping; read, write */
#define HK_REGS_INTERRUPTS_RESTARTED_MASK UINT32_C(0x00000002)
#define HK_REGS_INTERRUPTS_RESTARTED_SHIFT 1
#define HK_REGS_INTERRUPTS_RESTARTED_BITS 1
/* interrupt when a count stood at the end of its range; read, write */
#define HK_REGS_INTERRUPTS_SATURATED_MASK UINT32_C(0x00000004)
#define HK_REGS_INTERRUPTS_SATURATED_SHIFT 2
#define HK_REGS_INTERRUPTS_SATURATED_BITS 1
/* interrupt when a sample was lost because the filter was busy; read, write */
#define HK_REGS_INTERRUPTS_OVERRUN_MASK UINT32_C(0x00000008)
#define HK_REGS_INTERRUPTS_OVERRUN_SHIFT 3
#define HK_REGS_INTERRUPTS_OVERRUN_BITS 1
/* interrupt when a transfer with the sensor failed; read, write */
#define HK_REGS_INTERRUPTS_BUS_ERROR_MASK UINT32_C(0x00000010)
#define HK_REGS_INTERRUPTS_BUS_ERROR_SHIFT 4
#define HK_REGS_INTERRUPTS_BUS_ERROR_BITS 1
/* interrupt when a received byte was lost because the one before was unread; read, write */
#define HK_REGS_INTERRUPTS_UART_OVERRUN_MASK UINT32_C(0x00000020)
#define HK_REGS_INTERRUPTS_UART_OVERRUN_SHIFT 5
#define HK_REGS_INTERRUPTS_UART_OVERRUN_BITS 1
/* interrupt when a received byte had no stop bit; read, write */
#define HK_REGS_INTERRUPTS_UART_FRAMING_MASK UINT32_C(0x00000040)
#define HK_REGS_INTERRUPTS_UART_FRAMING_SHIFT 6
#define HK_REGS_INTERRUPTS_UART_FRAMING_BITS 1

/* The byte the link received; a read takes it. */
#define HK_REGS_UART_RX_OFFSET 0x34U
#define HK_REGS_UART_RX_RESET UINT32_C(0x00000000)
/* the byte, if VALID; a read takes it */
#define HK_REGS_UART_RX_DATA_MASK UINT32_C(0x000000FF)
#define HK_REGS_UART_RX_DATA_SHIFT 0
#define HK_REGS_UART_RX_DATA_BITS 8
/* a byte was there and is taken by this read; a read takes it */
#define HK_REGS_UART_RX_VALID_MASK UINT32_C(0x00000100)
#define HK_REGS_UART_RX_VALID_SHIFT 8
#define HK_REGS_UART_RX_VALID_BITS 1

/* Setting: correction per sample and acceleration, kt / (2 rate^2). */
#define HK_REGS_KT_OFFSET 0x40U
#define HK_REGS_KT_RESET UINT32_C(0x003B642F)
/* correction per sample and acceleration, kt / (2 rate^2); read, write */
#define HK_REGS_KT_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_KT_VALUE_SHIFT 0
#define HK_REGS_KT_VALUE_BITS 32

/* Setting: share of the velocity that goes in a sample, kv / rate. */
#define HK_REGS_KV_OFFSET 0x44U
#define HK_REGS_KV_RESET UINT32_C(0x00F5C28F)
/* share of the velocity that goes in a sample, kv / rate; read, write */
#define HK_REGS_KV_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_KV_VALUE_SHIFT 0
#define HK_REGS_KV_VALUE_BITS 32

/* Setting: bias per correction, kb / rate. */
#define HK_REGS_KB_OFFSET 0x48U
#define HK_REGS_KB_RESET UINT32_C(0x039ABF34)
/* bias per correction, kb / rate; read, write */
#define HK_REGS_KB_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_KB_VALUE_SHIFT 0
#define HK_REGS_KB_VALUE_BITS 32

/* Setting: half-angle that the bias of x turns in a sample, bias (1 + scale) / (2 rate), at the start. */
#define HK_REGS_GYRO_BIAS_X_OFFSET 0x4CU
#define HK_REGS_GYRO_BIAS_X_RESET UINT32_C(0x01ABD1AB)
/* half-angle that the bias of x turns in a sample, bias (1 + scale) / (2 rate), at the start; read, write */
#define HK_REGS_GYRO_BIAS_X_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_GYRO_BIAS_X_VALUE_SHIFT 0
#define HK_REGS_GYRO_BIAS_X_VALUE_BITS 32

/* Setting: the same of y. */
#define HK_REGS_GYRO_BIAS_Y_OFFSET 0x50U
#define HK_REGS_GYRO_BIAS_Y_RESET UINT32_C(0xFCC1871E)
/* the same of y; read, write */
#define HK_REGS_GYRO_BIAS_Y_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_GYRO_BIAS_Y_VALUE_SHIFT 0
#define HK_REGS_GYRO_BIAS_Y_VALUE_BITS 32

/* Setting: the same of z. */
#define HK_REGS_GYRO_BIAS_Z_OFFSET 0x54U
#define HK_REGS_GYRO_BIAS_Z_RESET UINT32_C(0x04F6DFC6)
/* the same of z; read, write */
#define HK_REGS_GYRO_BIAS_Z_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_GYRO_BIAS_Z_VALUE_SHIFT 0
#define HK_REGS_GYRO_BIAS_Z_VALUE_BITS 32

/* Number of the sample. */
#define HK_REGS_SAMPLE_NUMBER_OFFSET 0x80U
#define HK_REGS_SAMPLE_NUMBER_RESET UINT32_C(0x00000000)
/* number of the sample; read only */
#define HK_REGS_SAMPLE_NUMBER_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_SAMPLE_NUMBER_VALUE_SHIFT 0
#define HK_REGS_SAMPLE_NUMBER_VALUE_BITS 32

/* Microseconds; a read keeps TIME_HIGH. */
#define HK_REGS_TIME_LOW_OFFSET 0x84U
#define HK_REGS_TIME_LOW_RESET UINT32_C(0x00000000)
/* microseconds; a read keeps time_high; read only */
#define HK_REGS_TIME_LOW_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_TIME_LOW_VALUE_SHIFT 0
#define HK_REGS_TIME_LOW_VALUE_BITS 32

/* High word of the time, as it was when TIME_LOW was read. */
#define HK_REGS_TIME_HIGH_OFFSET 0x88U
#define HK_REGS_TIME_HIGH_RESET UINT32_C(0x00000000)
/* microseconds / 2**32; read only */
#define HK_REGS_TIME_HIGH_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_TIME_HIGH_VALUE_SHIFT 0
#define HK_REGS_TIME_HIGH_VALUE_BITS 32

/* Angle of roll, half turns / 2**31. */
#define HK_REGS_ANGLE_ROLL_OFFSET 0x8CU
#define HK_REGS_ANGLE_ROLL_RESET UINT32_C(0x00000000)
/* angle of roll, half turns / 2**31; read only */
#define HK_REGS_ANGLE_ROLL_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_ANGLE_ROLL_VALUE_SHIFT 0
#define HK_REGS_ANGLE_ROLL_VALUE_BITS 32

/* Angle of pitch, half turns / 2**31. */
#define HK_REGS_ANGLE_PITCH_OFFSET 0x90U
#define HK_REGS_ANGLE_PITCH_RESET UINT32_C(0x00000000)
/* angle of pitch, half turns / 2**31; read only */
#define HK_REGS_ANGLE_PITCH_VALUE_MASK UINT32_C(0xFFFFFFFF)
#define HK_REGS_ANGLE_PITCH_VALUE_SHIFT 0
#define HK_REGS_ANGLE_PITCH_VALUE_BITS 32

/* Specific force. */
#define HK_REGS_ACCEL_XY_OFFSET 0x9CU
#define HK_REGS_ACCEL_XY_RESET UINT32_C(0x00000000)
/* counts, sensor axes; read only */
#define HK_REGS_ACCEL_XY_ACCEL_X_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_ACCEL_XY_ACCEL_X_SHIFT 0
#define HK_REGS_ACCEL_XY_ACCEL_X_BITS 16
/* counts, sensor axes; read only */
#define HK_REGS_ACCEL_XY_ACCEL_Y_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_ACCEL_XY_ACCEL_Y_SHIFT 16
#define HK_REGS_ACCEL_XY_ACCEL_Y_BITS 16

/* Specific force and temperature. */
#define HK_REGS_ACCEL_Z_TEMPERATURE_OFFSET 0xA0U
#define HK_REGS_ACCEL_Z_TEMPERATURE_RESET UINT32_C(0x00000000)
/* counts, sensor axes; read only */
#define HK_REGS_ACCEL_Z_TEMPERATURE_ACCEL_Z_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_ACCEL_Z_TEMPERATURE_ACCEL_Z_SHIFT 0
#define HK_REGS_ACCEL_Z_TEMPERATURE_ACCEL_Z_BITS 16
/* counts; read only */
#define HK_REGS_ACCEL_Z_TEMPERATURE_TEMPERATURE_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_ACCEL_Z_TEMPERATURE_TEMPERATURE_SHIFT 16
#define HK_REGS_ACCEL_Z_TEMPERATURE_TEMPERATURE_BITS 16

/* Angular rate. */
#define HK_REGS_GYRO_XY_OFFSET 0xA4U
#define HK_REGS_GYRO_XY_RESET UINT32_C(0x00000000)
/* counts, sensor axes; read only */
#define HK_REGS_GYRO_XY_GYRO_X_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_GYRO_XY_GYRO_X_SHIFT 0
#define HK_REGS_GYRO_XY_GYRO_X_BITS 16
/* counts, sensor axes; read only */
#define HK_REGS_GYRO_XY_GYRO_Y_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_GYRO_XY_GYRO_Y_SHIFT 16
#define HK_REGS_GYRO_XY_GYRO_Y_BITS 16

/* Angular rate. */
#define HK_REGS_GYRO_Z_OFFSET 0xA8U
#define HK_REGS_GYRO_Z_RESET UINT32_C(0x00000000)
/* counts, sensor axes; read only */
#define HK_REGS_GYRO_Z_GYRO_Z_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_GYRO_Z_GYRO_Z_SHIFT 0
#define HK_REGS_GYRO_Z_GYRO_Z_BITS 16

/* Failed transfers with the sensor. Each stays at 65535. */
#define HK_REGS_BUS_COUNTS_OFFSET 0xC0U
#define HK_REGS_BUS_COUNTS_RESET UINT32_C(0x00000000)
/* count since reset; read only */
#define HK_REGS_BUS_COUNTS_ERRORS_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_BUS_COUNTS_ERRORS_SHIFT 0
#define HK_REGS_BUS_COUNTS_ERRORS_BITS 16
/* count since reset; read only */
#define HK_REGS_BUS_COUNTS_NACKS_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_BUS_COUNTS_NACKS_SHIFT 16
#define HK_REGS_BUS_COUNTS_NACKS_BITS 16

/* Transfers that came to no end. Each stays at 65535. */
#define HK_REGS_STUCK_COUNTS_OFFSET 0xC4U
#define HK_REGS_STUCK_COUNTS_RESET UINT32_C(0x00000000)
/* count since reset; read only */
#define HK_REGS_STUCK_COUNTS_TIMEOUTS_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_STUCK_COUNTS_TIMEOUTS_SHIFT 0
#define HK_REGS_STUCK_COUNTS_TIMEOUTS_BITS 16
/* count since reset; read only */
#define HK_REGS_STUCK_COUNTS_STUCK_BUSES_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_STUCK_COUNTS_STUCK_BUSES_SHIFT 16
#define HK_REGS_STUCK_COUNTS_STUCK_BUSES_BITS 16

/* Restarts of the sensor and its lost samples. Each stays at 65535. */
#define HK_REGS_LOSS_COUNTS_OFFSET 0xC8U
#define HK_REGS_LOSS_COUNTS_RESET UINT32_C(0x00000000)
/* count since reset; read only */
#define HK_REGS_LOSS_COUNTS_RESTARTS_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_LOSS_COUNTS_RESTARTS_SHIFT 0
#define HK_REGS_LOSS_COUNTS_RESTARTS_BITS 16
/* count since reset; read only */
#define HK_REGS_LOSS_COUNTS_LOST_SAMPLES_MASK UINT32_C(0xFFFF0000)
#define HK_REGS_LOSS_COUNTS_LOST_SAMPLES_SHIFT 16
#define HK_REGS_LOSS_COUNTS_LOST_SAMPLES_BITS 16

/* Samples that the telemetry link had no room for. Each stays at 65535. */
#define HK_REGS_LINK_COUNTS_OFFSET 0xCCU
#define HK_REGS_LINK_COUNTS_RESET UINT32_C(0x00000000)
/* count since reset; read only */
#define HK_REGS_LINK_COUNTS_LINK_LOST_MASK UINT32_C(0x0000FFFF)
#define HK_REGS_LINK_COUNTS_LINK_LOST_SHIFT 0
#define HK_REGS_LINK_COUNTS_LINK_LOST_BITS 16

#endif
