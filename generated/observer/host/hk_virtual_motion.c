/* The virtual MPU-6050: motion that goes on by itself, and the digital low-pass on the way to the
 * counts. hostkit/sensors/low_pass.py says what is known of the filter and what is assumed. */
#include "hk_virtual_parts.h"

#define HK_SLOW_TICKS 8U /* of the fast rate in one of the slow */
#define HK_FELT_AXES  6

typedef struct {
    double b[3];
    double a[2];
    uint32_t delay_ticks;
} section_t;

#define HK_SECTION(setting, b0, b1, b2, a1, a2, delay) {{b0, b1, b2}, {a1, a2}, delay},
static const section_t gyro_sections[] = {HK_MPU6050_GYRO_LOW_PASSES(HK_SECTION)};
static const section_t accel_sections[] = {HK_MPU6050_ACCEL_LOW_PASSES(HK_SECTION)};

bool hk_virtual_feels_motion(const hk_virtual_mpu6050_t *sensor)
{
    return sensor->motion.row_period_ns > 0U;
}

static uint64_t motion_ns(const hk_virtual_mpu6050_t *sensor, uint64_t at_ns)
{
    const uint64_t begin_ns = sensor->motion.begin_ns;

    return begin_ns == HK_NEVER || at_ns < begin_ns ? 0U : at_ns - begin_ns;
}

/* What is felt at a time: on a straight line between two rows. */
static void feel(const hk_virtual_mpu6050_t *sensor, uint64_t at_ns, double *row)
{
    const hk_replay_t *replay = &sensor->replay;
    const uint64_t period_ns = sensor->motion.row_period_ns;
    const uint64_t time_ns = motion_ns(sensor, at_ns);
    uint64_t first = time_ns / period_ns;
    uint64_t second = first + 1U;
    const double share = (double)(time_ns % period_ns) / (double)period_ns;
    int i;

    if (replay->loop) {
        first %= replay->row_count;
        second %= replay->row_count;
    }
    first = first < replay->row_count ? first : replay->row_count - 1U;
    second = second < replay->row_count ? second : replay->row_count - 1U;
    for (i = 0; i < HK_ROW_VALUES; i++) {
        const double from = replay->rows[first * HK_ROW_VALUES + (uint64_t)i];
        const double to = replay->rows[second * HK_ROW_VALUES + (uint64_t)i];

        row[i] = from + share * (to - from);
    }
}

static const section_t *section_of(const hk_virtual_mpu6050_t *sensor, int axis)
{
    const uint8_t setting = sensor->reg[HK_REG_CONFIG] & HK_CONFIG_LOW_PASS;
    const uint8_t place = setting == 7U ? 0U : setting;

    return axis < 3 ? &gyro_sections[place] : &accel_sections[place];
}

/* The state of a filter that has seen one value for ever. */
static void settle(hk_virtual_low_pass_t *filter, const section_t *section, double value)
{
    int i;

    filter->state[1] = (section->b[2] - section->a[1]) * value;
    filter->state[0] = (section->b[1] - section->a[0]) * value + filter->state[1];
    for (i = 0; i < HK_LOW_PASS_DELAY_TICKS; i++) {
        filter->line[i] = value;
    }
}

static void step(hk_virtual_low_pass_t *filter, const section_t *section, uint32_t here,
                 double value)
{
    const double out = section->b[0] * value + filter->state[0];

    filter->state[0] = section->b[1] * value - section->a[0] * out + filter->state[1];
    filter->state[1] = section->b[2] * value - section->a[1] * out;
    filter->line[here % HK_LOW_PASS_DELAY_TICKS] = out;
}

/* Take over what has left the filters, the accelerometer at 1 kHz only. */
static void hold(hk_virtual_mpu6050_t *sensor)
{
    hk_virtual_motion_t *motion = &sensor->motion;
    const bool slow = motion->here % HK_SLOW_TICKS == 0U;
    int axis;

    for (axis = 0; axis < HK_FELT_AXES; axis++) {
        const uint32_t place = motion->here - section_of(sensor, axis)->delay_ticks;
        const double value = motion->axis[axis].line[place % HK_LOW_PASS_DELAY_TICKS];

        if (axis < 3 && (slow || hk_virtual_fast(sensor))) {
            motion->gyro_hold[axis] = value;
        } else if (axis >= 3 && slow) {
            motion->accel_hold[axis - 3] = value;
        }
    }
}

/* Begin with filters that know nothing but the present; their ticks are those of the samples. */
static void begin(hk_virtual_mpu6050_t *sensor)
{
    double row[HK_ROW_VALUES];
    int axis;

    feel(sensor, sensor->now_ns, row);
    for (axis = 0; axis < HK_FELT_AXES; axis++) {
        settle(&sensor->motion.axis[axis], section_of(sensor, axis), row[axis]);
    }
    sensor->motion.here = 0U;
    sensor->motion.tick_ns = sensor->now_ns + HK_FAST_TICK_NS;
    sensor->motion.settled = true;
    hold(sensor);
}

static void run_filters(hk_virtual_mpu6050_t *sensor)
{
    hk_virtual_motion_t *motion = &sensor->motion;
    double row[HK_ROW_VALUES];
    int axis;

    if (!motion->settled) {
        begin(sensor);
    }
    for (; motion->tick_ns <= sensor->now_ns; motion->tick_ns += HK_FAST_TICK_NS) {
        feel(sensor, motion->tick_ns, row);
        motion->here++;
        for (axis = 0; axis < HK_FELT_AXES; axis++) {
            step(&motion->axis[axis], section_of(sensor, axis), motion->here, row[axis]);
        }
        hold(sensor);
    }
}

/* Let the motion begin with the first sample behind the lead-in. */
static void start_when_due(hk_virtual_mpu6050_t *sensor)
{
    hk_replay_t *replay = &sensor->replay;

    if (!replay->running || sensor->motion.begin_ns != HK_NEVER) {
        return;
    }
    if (replay->lead_in_left > 0U) {
        replay->lead_in_left--;
    } else {
        sensor->motion.begin_ns = sensor->now_ns;
    }
}

bool hk_virtual_motion_row(hk_virtual_mpu6050_t *sensor, double *row)
{
    hk_replay_t *replay = &sensor->replay;
    uint64_t reached;
    int i;

    start_when_due(sensor);
    reached = motion_ns(sensor, sensor->now_ns) / sensor->motion.row_period_ns;
    if (!replay->loop && reached >= replay->row_count) {
        replay->next_row = replay->row_count;
        return false;
    }
    run_filters(sensor);
    feel(sensor, sensor->now_ns, row);
    for (i = 0; i < 3; i++) {
        row[i] = sensor->motion.gyro_hold[i];
        row[3 + i] = sensor->motion.accel_hold[i];
    }
    if (sensor->motion.begin_ns != HK_NEVER) {
        replay->lead_in_left = 0U; /* it comes once: the motion does not wait */
        replay->next_row = (uint32_t)((reached + 1U) % ((uint64_t)replay->row_count + 1U));
        replay->rows_played = (uint32_t)(reached + 1U);
    }
    return true;
}
