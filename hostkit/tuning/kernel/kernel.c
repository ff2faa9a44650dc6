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
