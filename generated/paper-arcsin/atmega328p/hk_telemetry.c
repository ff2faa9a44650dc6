/* MAVLink telemetry: see the header. */
#include "hk_telemetry.h"

#include <string.h>

#include "hk_design.h"
#include "hk_flash.h"

#define HK_M_S2_PER_G 9.80665f

/* Body axes from sensor axes; a count is widened first, because -(-32768) is no int16_t. */
#define HK_BODY(axis, count) (HK_BODY_##axis##_SIGN * (int32_t)(count)[HK_BODY_##axis##_SOURCE])

/* Body axes here are x forward, y left, z up; half a turn about x leads from there to MAVLink's
 * forward-right-down, for the body as for the world. */
static void to_frd(const int16_t count[3], int32_t frd[3])
{
    frd[0] = HK_BODY(X, count);
    frd[1] = -HK_BODY(Y, count);
    frd[2] = -HK_BODY(Z, count);
}

/* Hundredths of a degree Celsius. */
static int16_t temperature_cdeg(int16_t count)
{
    const int32_t shifted = (int32_t)count + HK_TEMPERATURE_OFFSET_COUNTS;

    return (int16_t)(shifted * 100 / HK_TEMPERATURE_COUNTS_PER_DEG_C);
}

static uint32_t boot_ms(uint64_t time_us)
{
    return (uint32_t)(time_us / 1000U);
}

/* --- Streams -------------------------------------------------------------------------------- */

static bool send_sample(hk_app_t *app)
{
    static const uint8_t digest[] HK_FLASH = HK_DESIGN_DIGEST_BYTES;
    const int32_t hidden[MAVLINK_MSG_TILT_SAMPLE_FIELD_HIDDEN_LEN] =
        HK_FILTER_HIDDEN(&app->filter);
    const hk_latest_t *latest = &app->latest;
    int32_t angle[HK_ANGLES];
    mavlink_tilt_sample_t message;
    uint8_t i;

    hk_filter_angles(&app->filter, angle);
    message.time_usec = latest->time_us;
    message.sequence = latest->sequence;
    message.roll = angle[HK_ROLL];
    message.pitch = angle[HK_PITCH];
    (void)memcpy(message.accel, latest->sample.accel, sizeof message.accel);
    (void)memcpy(message.gyro, latest->sample.gyro, sizeof message.gyro);
    message.temperature = latest->sample.temperature;
    message.i2c_errors = app->sensor.errors;
    for (i = 0U; i < sizeof message.digest; i++) {
        message.digest[i] = hk_flash_u8(&digest[i]);
    }
    message.flags = latest->flags;
    (void)memcpy(message.hidden, hidden, sizeof message.hidden);
    return HK_SEND(&app->link, TILT_SAMPLE, &message);
}

typedef char hk_plan_knows_state[HK_FILTER_STATE_WORDS == HK_TOLD_WORDS ? 1 : -1];

#if HK_FILTER_STATE_WORDS
static bool send_state(hk_app_t *app)
{
    mavlink_tilt_state_t message = {0};

    message.sequence = app->latest.sequence;
    (void)memcpy(message.words, app->latest.state, sizeof app->latest.state);
    return HK_SEND(&app->link, TILT_STATE, &message);
}
#endif

/* Roll stays, and pitch, whose sense is "nose down" here, changes its sign. Yaw is not known; 0 is
 * no claim. */
static bool send_attitude(hk_app_t *app)
{
    mavlink_attitude_t message;
    int32_t rate[3];

    to_frd(app->latest.sample.gyro, rate);
    message.time_boot_ms = boot_ms(app->latest.time_us);
    message.roll = hk_filter_angle_rad(&app->filter, HK_ROLL);
    message.pitch = -hk_filter_angle_rad(&app->filter, HK_PITCH);
    message.yaw = 0.0f;
    message.rollspeed = (float)rate[0] * HK_RAD_S_PER_COUNT;
    message.pitchspeed = (float)rate[1] * HK_RAD_S_PER_COUNT;
    message.yawspeed = (float)rate[2] * HK_RAD_S_PER_COUNT;
    return HK_SEND(&app->link, ATTITUDE, &message);
}

/* The nearest whole number that the field holds: 2000 deg/s are more mrad/s than it does. */
static int16_t scaled(int32_t count, float per_count)
{
    const float value = (float)count * per_count;

    if (value >= 32767.0f) {
        return INT16_MAX;
    }
    if (value <= -32768.0f) {
        return INT16_MIN;
    }
    return (int16_t)(value < 0.0f ? value - 0.5f : value + 0.5f);
}

static bool send_scaled(hk_app_t *app)
{
    mavlink_scaled_imu_t message = {0};
    const float mg_per_count = HK_M_S2_PER_COUNT * 1000.0f / HK_M_S2_PER_G;
    const float mrad_s_per_count = HK_RAD_S_PER_COUNT * 1000.0f;
    const hk_mpu6050_sample_t *sample = &app->latest.sample;
    int32_t frd[3];

    message.time_boot_ms = boot_ms(app->latest.time_us);
    to_frd(sample->accel, frd);
    message.xacc = scaled(frd[0], mg_per_count);
    message.yacc = scaled(frd[1], mg_per_count);
    message.zacc = scaled(frd[2], mg_per_count);
    to_frd(sample->gyro, frd);
    message.xgyro = scaled(frd[0], mrad_s_per_count);
    message.ygyro = scaled(frd[1], mrad_s_per_count);
    message.zgyro = scaled(frd[2], mrad_s_per_count);
    message.temperature = temperature_cdeg(sample->temperature);
    if (message.temperature == 0) {
        message.temperature = 1; /* 0 would mean that there is no thermometer */
    }
    return HK_SEND(&app->link, SCALED_IMU, &message);
}

/* What the sensor said, in its own axes. */
static bool send_raw(hk_app_t *app)
{
    mavlink_raw_imu_t message = {0};
    const hk_mpu6050_sample_t *sample = &app->latest.sample;

    message.time_usec = app->latest.time_us;
    message.xacc = sample->accel[0];
    message.yacc = sample->accel[1];
    message.zacc = sample->accel[2];
    message.xgyro = sample->gyro[0];
    message.ygyro = sample->gyro[1];
    message.zgyro = sample->gyro[2];
    message.temperature = temperature_cdeg(sample->temperature);
    return HK_SEND(&app->link, RAW_IMU, &message);
}

static bool send_highres(hk_app_t *app)
{
    mavlink_highres_imu_t message = {0};
    const hk_mpu6050_sample_t *sample = &app->latest.sample;
    int32_t frd[3];

    message.time_usec = app->latest.time_us;
    to_frd(sample->accel, frd);
    message.xacc = (float)frd[0] * HK_M_S2_PER_COUNT;
    message.yacc = (float)frd[1] * HK_M_S2_PER_COUNT;
    message.zacc = (float)frd[2] * HK_M_S2_PER_COUNT;
    to_frd(sample->gyro, frd);
    message.xgyro = (float)frd[0] * HK_RAD_S_PER_COUNT;
    message.ygyro = (float)frd[1] * HK_RAD_S_PER_COUNT;
    message.zgyro = (float)frd[2] * HK_RAD_S_PER_COUNT;
    message.temperature = (float)temperature_cdeg(sample->temperature) * 0.01f;
    message.fields_updated = HIGHRES_IMU_UPDATED_XACC | HIGHRES_IMU_UPDATED_YACC
                             | HIGHRES_IMU_UPDATED_ZACC | HIGHRES_IMU_UPDATED_XGYRO
                             | HIGHRES_IMU_UPDATED_YGYRO | HIGHRES_IMU_UPDATED_ZGYRO
                             | HIGHRES_IMU_UPDATED_TEMPERATURE;
    return HK_SEND(&app->link, HIGHRES_IMU, &message);
}

/* Thousandths of the time since it was asked last in which the processor was awake. */
static uint16_t load_permille(const hk_load_t *load, uint32_t now_us)
{
    const uint32_t passed_ms = (now_us - load->since_us) / 1000U;
    const uint32_t asleep_ms = load->asleep_us / 1000U;

    if (passed_ms == 0U || asleep_ms > passed_ms) {
        return 0U;
    }
    return (uint16_t)((passed_ms - asleep_ms) * 1000U / passed_ms);
}

static bool send_status(hk_app_t *app)
{
    mavlink_sys_status_t message = {0};
    const uint32_t sensors = MAV_SYS_STATUS_SENSOR_3D_GYRO | MAV_SYS_STATUS_SENSOR_3D_ACCEL;
    const uint16_t bad = app->receiver.errors;

    message.onboard_control_sensors_present = sensors;
    message.onboard_control_sensors_enabled = sensors;
    if (app->sensor_status == MAV_STATE_ACTIVE) {
        message.onboard_control_sensors_health = sensors;
    }
    message.load = load_permille(&app->load, (uint32_t)app->now_us);
    message.voltage_battery = UINT16_MAX; /* not known, as the next two */
    message.current_battery = -1;
    message.battery_remaining = -1;
    message.errors_comm = bad;
    message.errors_count1 = app->sensor.errors;
    message.errors_count2 = app->stream.lost;
    if (!HK_SEND(&app->link, SYS_STATUS, &message)) {
        return false;
    }
    app->load.since_us = (uint32_t)app->now_us;
    app->load.asleep_us = 0U;
    return true;
}

static bool send_heartbeat(hk_app_t *app)
{
    mavlink_heartbeat_t message = {0};

    message.type = HK_VEHICLE_TYPE;
    message.autopilot = HK_AUTOPILOT;
    message.system_status = app->system_status;
    message.mavlink_version = 3U; /* the protocol's, in every HEARTBEAT of version 2 */
    return HK_SEND(&app->link, HEARTBEAT, &message);
}

bool hk_telemetry_stream(hk_app_t *app, uint8_t which)
{
    switch (which) {
    case HK_STREAM_TILT_SAMPLE:
        return send_sample(app);
#if HK_FILTER_STATE_WORDS
    case HK_STREAM_TILT_STATE:
        return send_state(app);
#endif
    case HK_STREAM_ATTITUDE:
        return send_attitude(app);
    case HK_STREAM_SCALED_IMU:
        return send_scaled(app);
    case HK_STREAM_RAW_IMU:
        return send_raw(app);
    case HK_STREAM_HIGHRES_IMU:
        return send_highres(app);
    case HK_STREAM_SYS_STATUS:
        return send_status(app);
    default:
        return send_heartbeat(app);
    }
}

/* --- On request ----------------------------------------------------------------------------- */

bool hk_telemetry_version(hk_app_t *app)
{
    static const uint8_t digest[] HK_FLASH = HK_DESIGN_DIGEST_BYTES;
    mavlink_autopilot_version_t message = {0};
    uint8_t i;

    message.capabilities =
        MAV_PROTOCOL_CAPABILITY_MAVLINK2 | MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST;
    message.flight_sw_version = HK_VERSION_NUMBER;
    for (i = 0U; i < sizeof digest; i++) {
        message.flight_custom_version[i] = hk_flash_u8(&digest[i]);
    }
    return HK_SEND(&app->link, AUTOPILOT_VERSION, &message);
}

bool hk_telemetry_parameter(hk_app_t *app, uint8_t place)
{
    mavlink_param_value_t message;

    message.param_value = hk_parameter_get(&app->parameters, place);
    message.param_count = HK_PARAMETERS;
    message.param_index = place;
    hk_parameter_name(place, message.param_id);
    message.param_type = MAV_PARAM_TYPE_REAL32;
    return HK_SEND(&app->link, PARAM_VALUE, &message);
}
