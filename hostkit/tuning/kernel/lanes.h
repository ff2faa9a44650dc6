/* The recursions for one type of number, REAL, on streams of another, VALUE: included once for each
 * pair.
 *
 * A lane is one candidate of the tuning. LANES of them stand in one vector, and BLOCK vectors are
 * stepped together, so that the multiply-adds of one hide the latency of the others. The sums of a
 * chunk are taken in the type itself and added up in double. */

typedef REAL NAME(vector) __attribute__((vector_size(HK_VECTOR_BYTES)));
typedef MASK NAME(mask) __attribute__((vector_size(HK_VECTOR_BYTES)));

#define LANES (HK_VECTOR_BYTES / (int)sizeof(REAL))

static inline NAME(vector) NAME(masked)(NAME(vector) value, NAME(mask) where)
{
    return (NAME(vector))((NAME(mask))value & where);
}

static inline NAME(vector) NAME(magnitude)(NAME(vector) value)
{
    return (NAME(vector))((NAME(mask))value & MAGNITUDE_BITS);
}

static inline NAME(vector) NAME(clamped)(NAME(vector) value, REAL limit)
{
    const NAME(mask) above = value > limit;
    const NAME(mask) below = value < -limit;

    return NAME(masked)(value, ~(above | below)) + NAME(masked)(limit + 0 * value, above)
           - NAME(masked)(limit + 0 * value, below);
}

/* e <- eta e + (eta c + v) over some samples; sums |e| or e^2 of each lane unless sum is null. With
 * squares there are three multiply-adds a step, and adding first takes one off their ports. */
static inline __attribute__((always_inline)) void NAME(plain_run)(
    const int vectors, const int squared, const VALUE *c, const VALUE *v, long samples,
    const NAME(vector) *eta, NAME(vector) *e, NAME(vector) *sum)
{
    for (long k = 0; k < samples; k++) {
        for (int i = 0; i < vectors; i++) {
            if (squared) {
                e[i] = eta[i] * (e[i] + (REAL)c[k]) + (REAL)v[k];
            } else {
                e[i] = eta[i] * e[i] + (eta[i] * (REAL)c[k] + (REAL)v[k]);
            }
            if (sum) {
                sum[i] += squared ? e[i] * e[i] : NAME(magnitude)(e[i]);
            }
        }
    }
}

/* The filter with all its parameters, in error form (see objective.py). */
static inline __attribute__((always_inline)) void NAME(full_run)(
    const int vectors, const int squared, const NAME(hk_stream) *s, long begin, long samples,
    const NAME(vector) (*p)[HK_BLOCK], NAME(vector) *e, NAME(vector) *bias, REAL bias_limit,
    NAME(vector) *sum)
{
    for (long k = begin; k < begin + samples; k++) {
        for (int i = 0; i < vectors; i++) {
            const NAME(vector) predicted =
                e[i] + (p[HK_SCALE][i] * (REAL)s->rate_step[k] - bias[i])
                - (REAL)s->reference_step[k];
            const NAME(vector) innovation =
                NAME(masked)((REAL)s->start[k] - p[HK_OFFSET][i] - predicted,
                             (REAL)s->force_deviation[k] < p[HK_GATE][i]);

            e[i] = predicted + (1 - p[HK_ETA][i]) * innovation;
            bias[i] = NAME(clamped)(bias[i] - p[HK_INTEGRAL][i] * innovation, bias_limit);
            if (sum) {
                sum[i] += squared ? e[i] * e[i] : NAME(magnitude)(e[i]);
            }
        }
    }
}

/* One block of lanes over one chunk: scored runs are summed, the rest is stepped through. */
static inline __attribute__((always_inline)) void NAME(block)(
    const int vectors, const int full, const int squared, const NAME(hk_stream) *s, long begin,
    long end, const REAL *parameters, long stride, REAL *state, REAL *bias_state, double *sums,
    long lanes)
{
    NAME(vector) p[HK_PARAMETERS][HK_BLOCK];
    NAME(vector) e[HK_BLOCK];
    NAME(vector) bias[HK_BLOCK];
    NAME(vector) sum[HK_BLOCK];
    REAL *const sum_lanes = (REAL *)sum;
    const long width = (long)vectors * LANES;
    long at = begin;

    memset(p, 0, sizeof p);
    memset(e, 0, sizeof e);
    memset(bias, 0, sizeof bias);
    memset(sum, 0, sizeof sum);
    for (int j = 0; j < (full ? HK_PARAMETERS : 1); j++) {
        memcpy(p[j], parameters + j * stride, (size_t)lanes * sizeof(REAL));
    }
    memcpy(e, state, (size_t)lanes * sizeof(REAL));
    if (full) {
        memcpy(bias, bias_state, (size_t)lanes * sizeof(REAL));
    }
    for (long r = hk_first_run(s->runs, s->run_count, begin); at < end; r++) {
        const int scored = r < s->run_count && s->runs[2 * r] < end;
        const long from = scored ? HK_MAX(s->runs[2 * r], at) : end;
        const long to = scored ? HK_MIN(s->runs[2 * r + 1], end) : end;

        if (full) {
            NAME(full_run)(vectors, squared, s, at, from - at, p, e, bias, (REAL)s->bias_limit,
                           0);
            NAME(full_run)(vectors, squared, s, from, to - from, p, e, bias,
                           (REAL)s->bias_limit, sum);
        } else {
            NAME(plain_run)(vectors, squared, s->drive + at, s->start + at, from - at, p[0], e, 0);
            NAME(plain_run)(vectors, squared, s->drive + from, s->start + from, to - from, p[0], e,
                            sum);
        }
        at = to;
    }
    memcpy(state, e, (size_t)lanes * sizeof(REAL));
    if (full) {
        memcpy(bias_state, bias, (size_t)lanes * sizeof(REAL));
    }
    for (long i = 0; i < lanes && i < width; i++) {
        sums[i] += (double)sum_lanes[i];
    }
}

/* All candidates over the samples of [from, to), in chunks that stay in the cache. The state is
 * carried in and out, and `sums` is added to. */
static void NAME(stretch)(const NAME(hk_stream) *s, long from, long to, int full, int squared,
                          long count, const REAL *parameters, REAL *state, REAL *bias_state,
                          double *sums)
{
    for (long begin = from; begin < to; begin += HK_CHUNK) {
        const long end = HK_MIN(begin + HK_CHUNK, to);

        for (long first = 0; first < count; first += (long)HK_BLOCK * LANES) {
            const long lanes = HK_MIN(count - first, (long)HK_BLOCK * LANES);
            const int vectors = (int)((lanes + LANES - 1) / LANES);

#define HK_CALL(VECTORS, FULL, SQUARED)                                                            \
    NAME(block)(VECTORS, FULL, SQUARED, s, begin, end, parameters + first, count, state + first,   \
                bias_state + first, sums + first, lanes)
#define HK_PICK(VECTORS)                                                                           \
    if (full) {                                                                                    \
        if (squared) {                                                                             \
            HK_CALL(VECTORS, 1, 1);                                                                \
        } else {                                                                                   \
            HK_CALL(VECTORS, 1, 0);                                                                \
        }                                                                                          \
    } else if (squared) {                                                                          \
        HK_CALL(VECTORS, 0, 1);                                                                    \
    } else {                                                                                       \
        HK_CALL(VECTORS, 0, 0);                                                                    \
    }
            if (vectors == 1) {
                HK_PICK(1)
            } else if (vectors == 2) {
                HK_PICK(2)
            } else if (vectors == 3) {
                HK_PICK(3)
            } else {
                HK_PICK(HK_BLOCK)
            }
#undef HK_PICK
#undef HK_CALL
        }
    }
}

/* All candidates over one stream, block by block: a row of `sums` for each of the blocks that lie
 * between `edges`. */
void NAME(hk_sums)(const NAME(hk_stream) *s, long blocks, const int64_t *edges, int full,
                   int squared, long count, const REAL *parameters, REAL *state, REAL *bias_state,
                   double *sums)
{
    for (long i = 0; i < blocks; i++) {
        NAME(stretch)(s, edges[i], edges[i + 1], full, squared, count, parameters, state,
                      bias_state, sums + i * count);
    }
}
#undef LANES
