/* The recursion of the tuner for exactly 32 candidates in double, written for speed and nothing
 * else: every sample counts, there are no masks, no chunks and no other parameters. What the real
 * kernel is held against.
 *
 * e <- eta e + (eta c + v), and the sum of |e| or e^2. Two ways of computing the same: with two
 * multiply-adds a step, of which one is off the chain, or as eta (e + c) + v, where the chain is
 * longer but the addition may find a unit of its own. Which is faster depends on the processor. */
#include <stdint.h>

#if defined(__AVX512F__)
#define BYTES 64
#elif defined(__AVX__)
#define BYTES 32
#else
#define BYTES 16
#endif
#define LANES 32
#define VECTORS (LANES * 8 / BYTES)

typedef double vector __attribute__((vector_size(BYTES)));
typedef int64_t bits __attribute__((vector_size(BYTES)));

#define MAGNITUDE(x) ((vector)((bits)(x) & INT64_C(0x7FFFFFFFFFFFFFFF)))
#define SQUARE(x) ((x) * (x))
#define OFF_CHAIN(e, eta, c, v) ((eta) * (e) + ((eta) * (c) + (v)))
#define ON_CHAIN(e, eta, c, v) ((eta) * ((e) + (c)) + (v))

#define LOOP(NAME, STEP, PENALTY)                                                                  \
    void NAME(long samples, const double *c, const double *v, const double *eta_lanes,             \
              double *sums)                                                                        \
    {                                                                                              \
        vector eta[VECTORS], e[VECTORS], sum[VECTORS];                                             \
                                                                                                   \
        __builtin_memcpy(eta, eta_lanes, sizeof eta);                                              \
        __builtin_memset(e, 0, sizeof e);                                                          \
        __builtin_memset(sum, 0, sizeof sum);                                                      \
        for (long k = 0; k < samples; k++) {                                                       \
            _Pragma("GCC unroll 16") for (int i = 0; i < VECTORS; i++)                             \
            {                                                                                      \
                e[i] = STEP(e[i], eta[i], c[k], v[k]);                                             \
                sum[i] += PENALTY(e[i]);                                                           \
            }                                                                                      \
        }                                                                                          \
        __builtin_memcpy(sums, sum, sizeof sum);                                                   \
    }

LOOP(mae_off_chain, OFF_CHAIN, MAGNITUDE)
LOOP(mae_on_chain, ON_CHAIN, MAGNITUDE)
LOOP(rmse_off_chain, OFF_CHAIN, SQUARE)
LOOP(rmse_on_chain, ON_CHAIN, SQUARE)
