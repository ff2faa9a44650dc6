/* The bounded-velocity observer for many sets of parameters at once; the equations are those of
 * hostkit/filters/observer/float_model.py, in the same order.
 *
 * A lane is one candidate of the tuning; HK_LANES of them are stepped together. */
#include <math.h>
#include <string.h>

#define HK_LANES 8

typedef double lanes __attribute__((vector_size(8 * HK_LANES)));
typedef long long mask __attribute__((vector_size(8 * HK_LANES)));

/* Parameters of a candidate, in the order of its column. */
enum {
    KT, KV, KB, START_END, REST_RATE, REST_FORCE, REST_GAIN, LEAD, CLIP_RATE,
    BIAS_X, BIAS_Y, BIAS_Z, RATE_SCALE_X, RATE_SCALE_Y, RATE_SCALE_Z,
    FORCE_OFFSET_X, FORCE_OFFSET_Y, FORCE_OFFSET_Z, FORCE_SCALE_X, FORCE_SCALE_Y, FORCE_SCALE_Z,
    PARAMETERS
};

/* A recording: rates, forces and reference directions of up in sensor axes, three numbers each. */
typedef struct {
    long samples;
    const double *rate_rad_s;
    const double *force_m_s2;
    const double *reference;
    const unsigned char *scored;
} hk_track;

/* What all candidates have in common. */
typedef struct {
    double period_s;
    double mean_weight;
    double rest_s;
    double start_gain;
    double clip_gain;
    double bias_limit;
    double rest_rate_limit;
    double acceleration_limit;
    double correction_limit;
    double start_limit;
    double lead_limit;
    double gravity;
    double first_force;
    double body[9]; /* rows: body axes in sensor axes */
    int first_rounds;
    int quantity;   /* 0 inclination, 1 roll, 2 pitch */
    int squared;
} hk_terms;

static inline lanes all(double x)
{
    return x - (lanes){0};
}

static inline lanes chosen(mask where, lanes yes, lanes no)
{
    return (lanes)(((mask)yes & where) | ((mask)no & ~where));
}

static inline lanes magnitude(lanes x)
{
    return chosen(x < 0, -x, x);
}

static inline lanes greater(lanes a, lanes b)
{
    return chosen(a > b, a, b);
}

static inline lanes clamped(lanes x, lanes limit)
{
    x = chosen(x > limit, limit, x);
    return chosen(x < -limit, -limit, x);
}

static inline lanes root(lanes x)
{
    for (int i = 0; i < HK_LANES; i++) {
        x[i] = sqrt(x[i]);
    }
    return x;
}

typedef struct {
    lanes q[4], v[2], b[3], rate_mean[3], force_mean[3], alpha, still, found, turn[3];
} state;

static inline lanes force_of(const lanes *p, const double *force, int i)
{
    return (1.0 + p[FORCE_SCALE_X + i]) * (force[i] - p[FORCE_OFFSET_X + i]);
}

static inline void normalise(lanes q[4])
{
    const lanes more = 0.5 * (1.0 - (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]));

    for (int i = 0; i < 4; i++) {
        q[i] += more * q[i];
    }
}

static void load(state *s, const lanes *p, const hk_terms *t, const double *rate,
                 const double *force)
{
    lanes half[3];
    mask upright;

    for (int i = 0; i < 3; i++) {
        half[i] = clamped(force_of(p, force, i) / t->gravity, all(t->first_force)) * 0.5;
        s->b[i] = (1.0 + p[RATE_SCALE_X + i]) * p[BIAS_X + i];
        s->rate_mean[i] = all(rate[i]);
        s->force_mean[i] = all(force[i]);
        s->turn[i] = all(0);
    }
    upright = half[2] >= 0;
    s->q[0] = chosen(upright, 0.5 + half[2], half[1]);
    s->q[1] = chosen(upright, half[1], 0.5 - half[2]);
    s->q[2] = chosen(upright, -half[0], all(0));
    s->q[3] = chosen(upright, all(0), half[0]);
    for (int i = 0; i < t->first_rounds; i++) {
        normalise(s->q);
    }
    s->v[0] = s->v[1] = all(0);
    s->alpha = chosen(p[START_END] < t->start_gain, all(t->start_gain), all(0));
    s->still = s->found = all(0);
}

/* The first rest: its mean rate is the bias, and the alignment begins again. */
static inline void find_bias(state *s, const lanes *p, const hk_terms *t, mask rest)
{
    const mask first = rest & (s->found < 0.5);

    for (int i = 0; i < 3; i++) {
        const lanes mean = clamped((1.0 + p[RATE_SCALE_X + i]) * s->rate_mean[i],
                                   all(t->bias_limit));

        s->b[i] = chosen(first, mean, s->b[i]);
    }
    s->alpha = chosen(first & (p[START_END] < t->start_gain), all(t->start_gain), s->alpha);
    s->found = chosen(first, all(1), s->found);
}

/* The running means; whether the sensor is at rest. */
static inline mask rested(state *s, const lanes *p, const hk_terms *t, const double *rate,
                          const double *force)
{
    lanes rate_apart = all(0), force_apart = all(0), mean = all(0);
    mask quiet;

    for (int i = 0; i < 3; i++) {
        const lanes a = rate[i] - s->rate_mean[i], f = force[i] - s->force_mean[i];

        s->rate_mean[i] += t->mean_weight * a;
        s->force_mean[i] += t->mean_weight * f;
        rate_apart = greater(rate_apart, magnitude(a));
        force_apart = greater(force_apart, magnitude(f));
        mean = greater(mean, magnitude(s->rate_mean[i]));
    }
    quiet = (rate_apart <= p[REST_RATE]) & (force_apart <= p[REST_FORCE])
            & (mean <= t->rest_rate_limit);
    s->still = chosen(quiet, s->still + t->period_s, all(0));
    s->still = chosen(s->still > t->rest_s, all(t->rest_s), s->still);
    return s->still > t->rest_s - 0.5 * t->period_s;
}

static inline void propagate(lanes q[4], const lanes h[3])
{
    const lanes square = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
    const lanes c = 1.0 - square * (1.0 / 2.0 - square * (1.0 / 24.0));
    const lanes sinc = 1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0));
    const lanes x = h[0] * sinc, y = h[1] * sinc, z = h[2] * sinc;
    const lanes q0 = q[0], q1 = q[1], q2 = q[2], q3 = q[3];

    q[0] = q0 * c - q1 * x - q2 * y - q3 * z;
    q[1] = q1 * c + q0 * x + q2 * z - q3 * y;
    q[2] = q2 * c + q0 * y + q3 * x - q1 * z;
    q[3] = q3 * c + q0 * z + q1 * y - q2 * x;
}

static inline void correct(lanes q[4], lanes x, lanes y)
{
    const lanes q0 = q[0], q1 = q[1], q2 = q[2], q3 = q[3];

    q[0] = q0 - x * q1 - y * q2;
    q[1] = q1 + x * q0 + y * q3;
    q[2] = q2 + y * q0 - x * q3;
    q[3] = q3 + x * q2 - y * q1;
    normalise(q);
}

static inline void take(state *s, const lanes *p, const hk_terms *t, const double *rate,
                        const double *force)
{
    const mask rest = rested(s, p, t, rate, force);
    const double dt = t->period_s;
    const lanes gain = p[KT] * dt, kept = 1.0 - p[KV] * dt, limit = t->correction_limit / gain;
    lanes h[3], f[3], x_row[3], y_row[3], a_x, a_y, d_x, d_y, s_x, s_y, alpha;
    lanes *q = s->q;
    const double largest = fmax(fmax(fabs(rate[0]), fabs(rate[1])), fabs(rate[2]));

    find_bias(s, p, t, rest);
    s->alpha = chosen((largest > p[CLIP_RATE]) & (s->alpha < t->clip_gain), all(t->clip_gain),
                      s->alpha);
    for (int i = 0; i < 3; i++) {
        s->turn[i] = (1.0 + p[RATE_SCALE_X + i]) * rate[i] - s->b[i];
        h[i] = 0.5 * dt * s->turn[i];
        f[i] = force_of(p, force, i);
    }
    propagate(q, h);
    x_row[0] = 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]);
    x_row[1] = 2.0 * (q[1] * q[2] - q[0] * q[3]);
    x_row[2] = 2.0 * (q[1] * q[3] + q[0] * q[2]);
    y_row[0] = 2.0 * (q[1] * q[2] + q[0] * q[3]);
    y_row[1] = 1.0 - 2.0 * (q[1] * q[1] + q[3] * q[3]);
    y_row[2] = 2.0 * (q[2] * q[3] - q[0] * q[1]);
    a_x = clamped(x_row[0] * f[0] + x_row[1] * f[1] + x_row[2] * f[2], all(t->acceleration_limit));
    a_y = clamped(y_row[0] * f[0] + y_row[1] * f[1] + y_row[2] * f[2], all(t->acceleration_limit));
    s->v[0] = clamped(s->v[0] + a_x * dt, limit);
    s->v[1] = clamped(s->v[1] + a_y * dt, limit);
    d_x = gain * s->v[1];
    d_y = -gain * s->v[0];

    alpha = s->alpha;
    s_x = clamped(alpha * a_y * (1.0 / t->gravity), all(t->start_limit));
    s_y = -clamped(alpha * a_x * (1.0 / t->gravity), all(t->start_limit));
    s->alpha = alpha - alpha * alpha;
    s->alpha = chosen(s->alpha > p[START_END], s->alpha, all(0));
    s->v[0] *= 1.0 - s->alpha;
    s->v[1] *= 1.0 - s->alpha;

    correct(q, 0.5 * (d_x + s_x), 0.5 * (d_y + s_y));
    for (int i = 0; i < 3; i++) {
        const lanes moving = -p[KB] * (x_row[i] * d_x + y_row[i] * d_y);

        s->b[i] = clamped(s->b[i] + chosen(rest, p[REST_GAIN] * dt * s->turn[i], moving),
                          all(t->bias_limit));
    }
    s->v[0] *= kept;
    s->v[1] *= kept;
}

/* The direction of up in sensor axes, not quite of unit length. */
static inline void up_of(const state *s, const lanes *p, const hk_terms *t, lanes led[3])
{
    const lanes *q = s->q;
    const lanes x = 2.0 * (q[1] * q[3] - q[0] * q[2]), y = 2.0 * (q[2] * q[3] + q[0] * q[1]);
    const lanes z = 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);
    lanes l[3];

    for (int i = 0; i < 3; i++) {
        l[i] = clamped(p[LEAD] * s->turn[i], all(t->lead_limit));
    }
    led[0] = x + y * l[2] - z * l[1];
    led[1] = y + z * l[0] - x * l[2];
    led[2] = z + x * l[1] - y * l[0];
}

/* The square of the angle to the reference, from the chord c: (2 arcsin(c / 2))^2 as a series. */
static inline lanes inclination_squared(const lanes up[3], const double *reference)
{
    const lanes length = root(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    lanes square = all(0);

    for (int i = 0; i < 3; i++) {
        const lanes apart = up[i] / length - reference[i];

        square += apart * apart;
    }
    return square * (1.0 + square * (1.0 / 12.0 + square * (1.0 / 90.0 + square * (1.0 / 560.0))));
}

static double angle_of(const hk_terms *t, double x, double y, double z)
{
    const double *m = t->body;
    const double b_x = m[0] * x + m[1] * y + m[2] * z, b_y = m[3] * x + m[4] * y + m[5] * z;
    const double b_z = m[6] * x + m[7] * y + m[8] * z;

    return t->quantity == 1 ? atan2(b_y, b_z) : atan2(-b_x, sqrt(b_y * b_y + b_z * b_z));
}

static inline lanes axis_squared(const hk_terms *t, const lanes up[3], const double *reference)
{
    const double wanted = angle_of(t, reference[0], reference[1], reference[2]);
    lanes square;

    for (int i = 0; i < HK_LANES; i++) {
        const double apart = remainder(angle_of(t, up[0][i], up[1][i], up[2][i]) - wanted,
                                       6.283185307179586);

        square[i] = apart * apart;
    }
    return square;
}

/* Add up the error of HK_LANES candidates over a recording, block by block.
 *
 * candidates   PARAMETERS rows of HK_LANES numbers
 * edges        where blocks begin, and where the last one ends: blocks + 1 numbers
 * sums         blocks rows of HK_LANES numbers, added to
 * ups          if not null: directions of up of the first candidate, three numbers a sample */
void hk_observer_run(const hk_track *track, const hk_terms *terms, const double *candidates,
                     const long *edges, long blocks, double *sums, double *ups)
{
    const hk_terms t = *terms;
    lanes p[PARAMETERS];
    state s;

    memcpy(p, candidates, sizeof p);
    memset(&s, 0, sizeof s);
    for (long block = 0; block < blocks; block++) {
        lanes sum = all(0), up[3];

        for (long k = edges[block]; k < edges[block + 1]; k++) {
            const double *rate = track->rate_rad_s + 3 * k, *force = track->force_m_s2 + 3 * k;

            if (k == 0) {
                load(&s, p, &t, rate, force);
            } else {
                take(&s, p, &t, rate, force);
            }
            if (ups || track->scored[k]) {
                up_of(&s, p, &t, up);
            }
            if (ups) {
                for (int i = 0; i < 3; i++) {
                    ups[3 * k + i] = up[i][0];
                }
            }
            if (track->scored[k]) {
                const double *reference = track->reference + 3 * k;
                const lanes square = t.quantity ? axis_squared(&t, up, reference)
                                                : inclination_squared(up, reference);

                sum += t.squared ? square : root(square);
            }
        }
        for (int i = 0; i < HK_LANES; i++) {
            sums[block * HK_LANES + i] += sum[i];
        }
    }
}
