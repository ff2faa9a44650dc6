/* MAVLink telemetry: see the header. */
#include "hk_telemetry.h"

#include "hk_design.h"
#include "hk_hal.h"

/* pi / 2^31: one unit of an angle in rad. */
#define HK_RAD_PER_UNIT 0x1.921fb6p-30f

#define HK_COUNT_LIMIT 32767

static bool queue(const mavlink_message_t *message)
{
    uint8_t frame[MAVLINK_MAX_PACKET_LEN];
    const uint16_t length = mavlink_msg_to_send_buffer(frame, message);

    return hk_hal_transmit(frame, (uint8_t)length);
}

static bool saturated(const int16_t count[3])
{
    uint8_t axis;

    for (axis = 0U; axis < 3U; axis++) {
        if (count[axis] >= HK_COUNT_LIMIT || count[axis] <= -HK_COUNT_LIMIT) {
            return true;
        }
    }
    return false;
}

static float rate_rad_s(int32_t count)
{
    return (float)count * HK_RAD_S_PER_COUNT;
}

void hk_telemetry_init(hk_telemetry_t *telemetry)
{
    static const mavlink_status_t idle = {0};

    telemetry->status = idle;
}

bool hk_telemetry_heartbeat(hk_telemetry_t *telemetry, uint8_t system_status)
{
    mavlink_message_t message;

    (void)mavlink_msg_heartbeat_pack_status(HK_SYSTEM_ID, HK_COMPONENT_ID, &telemetry->status,
                                            &message, HK_VEHICLE_TYPE, HK_AUTOPILOT, 0U, 0U,
                                            system_status);
    return queue(&message);
}

bool hk_telemetry_text(hk_telemetry_t *telemetry, uint8_t severity, const char *text)
{
    mavlink_message_t message;
    char field[MAVLINK_MSG_STATUSTEXT_FIELD_TEXT_LEN] = {0};
    uint8_t i;

    for (i = 0U; i < sizeof field && text[i] != '\0'; i++) {
        field[i] = text[i];
    }
    (void)mavlink_msg_statustext_pack_status(HK_SYSTEM_ID, HK_COMPONENT_ID, &telemetry->status,
                                             &message, severity, field, 0U, 0U);
    return queue(&message);
}

/* ATTITUDE is the one message in MAVLink's convention, forward-right-down. Body axes here are x
 * forward, y left, z up; half a turn about x leads from one to the other, for the body as for the
 * world. So roll and its rate stay, and pitch, whose sense is "nose down" here, and the rates about
 * y and z change their sign. Yaw is not known; 0 is no claim. */
bool hk_telemetry_attitude(hk_telemetry_t *telemetry, const hk_filter_t *filter,
                           const hk_mpu6050_sample_t *sample, uint64_t time_us)
{
    mavlink_message_t message;
    const int32_t p = HK_BODY_X_SIGN * (int32_t)sample->gyro[HK_BODY_X_SOURCE];
    const int32_t q = HK_BODY_Y_SIGN * (int32_t)sample->gyro[HK_BODY_Y_SOURCE];
    const int32_t r = HK_BODY_Z_SIGN * (int32_t)sample->gyro[HK_BODY_Z_SOURCE];

    (void)mavlink_msg_attitude_pack_status(
        HK_SYSTEM_ID, HK_COMPONENT_ID, &telemetry->status, &message, (uint32_t)(time_us / 1000U),
        (float)filter->angle[HK_ROLL] * HK_RAD_PER_UNIT,
        -(float)filter->angle[HK_PITCH] * HK_RAD_PER_UNIT, 0.0f, rate_rad_s(p), -rate_rad_s(q),
        -rate_rad_s(r));
    return queue(&message);
}

bool hk_telemetry_sample(hk_telemetry_t *telemetry, const hk_filter_t *filter,
                         const hk_mpu6050_sample_t *sample, const hk_sample_facts_t *facts)
{
    static const uint8_t digest[] = HK_DESIGN_DIGEST_BYTES;
    const int32_t hidden[MAVLINK_MSG_TILT_SAMPLE_FIELD_HIDDEN_LEN] = HK_FILTER_HIDDEN(filter);
    mavlink_message_t message;
    uint8_t flags = 0U;

    if (facts->restarted) {
        flags |= HOSTKIT_SAMPLE_RESTARTED;
    }
    if (saturated(sample->accel) || saturated(sample->gyro)) {
        flags |= HOSTKIT_SAMPLE_SATURATED;
    }
    (void)mavlink_msg_tilt_sample_pack_status(
        HK_SYSTEM_ID, HK_COMPONENT_ID, &telemetry->status, &message, facts->time_us,
        facts->sequence, filter->angle[HK_ROLL], filter->angle[HK_PITCH], sample->accel,
        sample->gyro, sample->temperature, facts->i2c_errors, digest, flags,
        hidden);
    return queue(&message);
}
