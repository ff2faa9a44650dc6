/* The evaluation kernel of the tuner: the error of the filter for many candidates at once. */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* As wide as the machine: the file is compiled for the one it runs on. */
#if defined(__AVX512F__)
#define HK_VECTOR_BYTES 64
#elif defined(__AVX__)
#define HK_VECTOR_BYTES 32
#else
#define HK_VECTOR_BYTES 16
#endif

#define HK_BLOCK 4    /* vectors in flight */
#define HK_CHUNK 4096 /* samples for which all candidates are stepped before the next ones */

#define HK_MAX(a, b) ((a) > (b) ? (a) : (b))
#define HK_MIN(a, b) ((a) < (b) ? (a) : (b))

/* Rows of the parameter table, one column a candidate. */
enum { HK_ETA, HK_SCALE, HK_OFFSET, HK_GATE, HK_INTEGRAL, HK_PARAMETERS };

/* First scored run that ends after a sample. */
static long hk_first_run(const int64_t *runs, long run_count, long sample)
{
    long low = 0;
    long high = run_count;

    while (low < high) {
        const long middle = low + (high - low) / 2;

        if (runs[2 * middle + 1] <= sample) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

#define HK_STREAM(VALUE)                                                                           \
    struct {                                                                                       \
        long samples;                                                                              \
        long run_count;                                                                            \
        const int64_t *runs; /* begin and end of each stretch that is scored */                    \
        const VALUE *drive;                                                                        \
        const VALUE *start;                                                                        \
        const VALUE *rate_step;                                                                    \
        const VALUE *reference_step;                                                               \
        const VALUE *force_deviation;                                                              \
        double bias_limit;                                                                         \
    }

/* Double throughout. */
#define REAL double
#define VALUE double
#define MASK int64_t
#define MAGNITUDE_BITS INT64_C(0x7FFFFFFFFFFFFFFF)
#define NAME(name) name##_f64
typedef HK_STREAM(double) NAME(hk_stream);
#include "lanes.h"
#undef VALUE
#undef NAME

/* Streams in float, which take half the room, stepped through in double. */
#define VALUE float
#define NAME(name) name##_mixed
typedef HK_STREAM(float) NAME(hk_stream);
#include "lanes.h"
#undef REAL
#undef VALUE
#undef MASK
#undef MAGNITUDE_BITS
#undef NAME

/* Float throughout: twice the lanes. */
#define REAL float
#define VALUE float
#define MASK int32_t
#define MAGNITUDE_BITS INT32_C(0x7FFFFFFF)
#define NAME(name) name##_f32
typedef HK_STREAM(float) NAME(hk_stream);
#include "lanes.h"
#undef REAL
#undef VALUE
#undef MASK
#undef MAGNITUDE_BITS
#undef NAME

/* The error itself, sample by sample, of one candidate; `bias` is carried in and out. */
void hk_trace(const hk_stream_f64 *s, const double *p, double *e_state, double *bias, double *error)
{
    double e = *e_state;

    for (long k = 0; k < s->samples; k++) {
        const double predicted =
            e + (p[HK_SCALE] * s->rate_step[k] - *bias) - s->reference_step[k];
        const double innovation = s->force_deviation[k] < p[HK_GATE]
                                      ? s->start[k] - p[HK_OFFSET] - predicted
                                      : 0.0;

        e = predicted + (1.0 - p[HK_ETA]) * innovation;
        *bias -= p[HK_INTEGRAL] * innovation;
        *bias = HK_MAX(-s->bias_limit, HK_MIN(s->bias_limit, *bias));
        error[k] = e;
    }
    *e_state = e;
}

/* Mean over streams of the root mean square or mean absolute error, for each time constant. */
static void hk_tau_costs(const hk_stream_f64 *streams, long stream_count, const double *weights,
                         int squared, double period, long count, const double *log_tau,
                         double *work, double *costs)
{
    double *const eta = work;
    double *const state = work + count;
    double *const sums = work + 2 * count;

    for (long i = 0; i < count; i++) {
        const double tau = exp(log_tau[i]);

        eta[i] = tau / (tau + period);
        costs[i] = 0.0;
    }
    for (long j = 0; j < stream_count; j++) {
        for (long i = 0; i < count; i++) {
            state[i] = 0.0;
            sums[i] = 0.0;
        }
        stretch_f64(&streams[j], 0, streams[j].samples, 0, squared, count, eta, state, state, sums);
        for (long i = 0; i < count; i++) {
            const double mean = sums[i] * weights[j];

            costs[i] += (squared ? sqrt(mean) : mean) / (double)stream_count;
        }
    }
}

/* The quantum-behaved swarm of optimisers/qpso.py on log tau, with the same draws in the same
 * order: draws[0 .. count) place the swarm; then each iteration takes phi, ln(1/u) and the sign.
 * Writes the best cost of each iteration to `history`, the best point to `best_x`. */
void hk_qpso_tau(const hk_stream_f64 *streams, long stream_count, const double *weights,
                 int squared, double period, double lower, double upper, long count,
                 long iterations, double alpha_first, double alpha_last, const double *draws,
                 double *work, double *history, double *best_x)
{
    double *const position = work;
    double *const best = work + count;
    double *const best_cost = work + 2 * count;
    double *const cost = work + 3 * count;
    const double width = upper - lower;

    for (long t = 0; t <= iterations; t++) {
        const double *const draw = draws + count + (t - 1) * 3 * count;
        long leader = 0;

        if (t == 0) {
            for (long i = 0; i < count; i++) {
                position[i] = lower + width * draws[i];
                best_cost[i] = INFINITY;
                best[i] = position[i];
            }
        } else {
            const double alpha =
                (alpha_first - alpha_last) * (1.0 - (double)t / (double)iterations) + alpha_last;
            double mean = 0.0;

            for (long i = 0; i < count; i++) {
                mean += best[i];
                leader = best_cost[i] < best_cost[leader] ? i : leader;
            }
            mean /= (double)count;
            for (long i = 0; i < count; i++) {
                const double attractor = draw[i] * best[i] + (1.0 - draw[i]) * best[leader];
                const double step = alpha * fabs(mean - position[i]) * draw[count + i];
                const double moved = attractor + (draw[2 * count + i] < 0.5 ? step : -step);
                double offset = fmod(moved - lower, 2.0 * width);

                offset = offset < 0.0 ? offset + 2.0 * width : offset;
                position[i] = lower + HK_MIN(offset, 2.0 * width - offset);
            }
        }
        hk_tau_costs(streams, stream_count, weights, squared, period, count, position,
                     work + 4 * count, cost);
        history[t] = INFINITY;
        for (long i = 0; i < count; i++) {
            if (cost[i] < best_cost[i]) {
                best_cost[i] = cost[i];
                best[i] = position[i];
            }
            if (best_cost[i] < history[t]) {
                history[t] = best_cost[i];
                *best_x = best[i];
            }
        }
    }
}

/* What a search for one parameter asks, and what it keeps. */
typedef struct {
    const hk_stream_f64 *streams;
    long stream_count;
    const double *weights;
    int squared;
    double period;
    double *work;
    double *history; /* best cost after each step */
    long steps;
    long evaluations;
    double best_x;
    double best_cost;
} hk_line_search;

static void hk_ask(hk_line_search *search, long count, const double *x, double *cost)
{
    double least = search->steps > 0 ? search->history[search->steps - 1] : INFINITY;

    hk_tau_costs(search->streams, search->stream_count, search->weights, search->squared,
                 search->period, count, x, search->work, cost);
    for (long i = 0; i < count; i++) {
        if (!isfinite(cost[i])) {
            cost[i] = INFINITY;
        }
        if (cost[i] < least) {
            least = cost[i];
            search->best_x = x[i];
            search->best_cost = cost[i];
        }
    }
    search->history[search->steps++] = least;
    search->evaluations += count;
}

/* The search of optimisers/grid_brent.py on log tau: an even grid, then R. P. Brent's search
 * ("Algorithms for minimization without derivatives", 1973, chapter 5) between the neighbours of
 * its best point. `history` has room for limit + 1 steps; returns how many there were. */
long hk_grid_brent_tau(const hk_stream_f64 *streams, long stream_count, const double *weights,
                       int squared, double period, double lower, double upper, long points,
                       double tolerance, long limit, double *work, double *history, double *best_x,
                       long *evaluations)
{
    const double golden = 0.5 * (3.0 - sqrt(5.0));
    const double precision = sqrt(2.2e-16);
    double *const grid = work + 4 * points;
    double *const cost = grid + points;
    hk_line_search search = {
        .streams = streams, .stream_count = stream_count, .weights = weights, .squared = squared,
        .period = period, .work = work, .history = history, .best_cost = INFINITY};
    long nearest = 0;
    double a, b, x, fx, second, f_second, third, f_third;
    double step = 0.0;
    double before = 0.0; /* the step before the last one */

    for (long i = 0; i < points; i++) {
        grid[i] = lower + (upper - lower) * (double)i / (double)(points - 1);
    }
    hk_ask(&search, points, grid, cost);
    for (long i = 1; i < points; i++) {
        nearest = cost[i] < cost[nearest] ? i : nearest;
    }
    a = grid[HK_MAX(nearest - 1, 0)];
    b = grid[HK_MIN(nearest + 1, points - 1)];
    x = second = third = a + golden * (b - a);
    hk_ask(&search, 1, &x, &fx);
    f_second = f_third = fx;
    while (search.steps < limit + 1) {
        const double middle = 0.5 * (a + b);
        const double least = precision * fabs(x) + tolerance / 3.0;
        int parabola = 0;
        double at, f_at;

        if (fabs(x - middle) <= 2.0 * least - 0.5 * (b - a)) {
            break;
        }
        if (fabs(before) > least) {
            double r = (x - second) * (fx - f_third);
            double q = (x - third) * (fx - f_second);
            double p = (x - third) * q - (x - second) * r;
            const double earlier = before;

            q = 2.0 * (q - r);
            p = q > 0.0 ? -p : p;
            q = fabs(q);
            before = step;
            if (fabs(p) < fabs(0.5 * q * earlier) && p > q * (a - x) && p < q * (b - x)) {
                parabola = 1;
                step = p / q;
                at = x + step;
                if (at - a < 2.0 * least || b - at < 2.0 * least) {
                    step = middle >= x ? least : -least;
                }
            }
        }
        if (!parabola) {
            before = x >= middle ? a - x : b - x;
            step = golden * before;
        }
        at = x + (step >= 0.0 ? 1.0 : -1.0) * HK_MAX(fabs(step), least);
        hk_ask(&search, 1, &at, &f_at);
        if (f_at <= fx) {
            *(at >= x ? &a : &b) = x;
            third = second;
            f_third = f_second;
            second = x;
            f_second = fx;
            x = at;
            fx = f_at;
        } else {
            *(at < x ? &a : &b) = at;
            if (f_at <= f_second || second == x) {
                third = second;
                f_third = f_second;
                second = at;
                f_second = f_at;
            } else if (f_at <= f_third || third == x || third == second) {
                third = at;
                f_third = f_at;
            }
        }
    }
    *best_x = search.best_x;
    *evaluations = search.evaluations;
    return search.steps;
}
