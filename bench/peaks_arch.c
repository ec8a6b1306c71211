/* Loops that do one thing: compiled once for each architecture, with PEAK_TABLE its table and PEAK_ARCH its word.
 * Values stay near 1, where no operation takes longer than elsewhere. */
#include "peaks.h"

#include <math.h>

#if defined(PEAK_SCALAR)
#define LANES 1
#elif defined(__AVX512F__)
#define LANES 16
#elif defined(__AVX__)
#define LANES 8
#else
#define LANES 4
#endif

#if defined(__FMA__) || defined(__AVX512F__) || defined(__ARM_FEATURE_FMA)
#define FUSED true
#else
#define FUSED false
#endif

#if LANES > 1
typedef float vf __attribute__((vector_size(4 * LANES)));
typedef int vi __attribute__((vector_size(4 * LANES)));
#else
typedef float vf;
typedef int vi;
#endif

/* Enough chains to hide an operation's latency, and few enough for the registers of SSE. */
enum { CHAINS = 12, REPEATS = PEAK_OPERATIONS / PEAK_VECTORS, STEPS = PEAK_OPERATIONS / CHAINS };

static union { vf v[PEAK_VECTORS]; vi i[PEAK_VECTORS]; float f[PEAK_VECTORS * LANES]; } from, to;
static volatile float one = 1.0f;

/* What was computed is used, and memory may have changed. */
#define BARRIER() __asm__ volatile("" : : : "memory")

#define CHAIN(name, expression)                                                                                       \
    static void name(long passes)                                                                                     \
    {                                                                                                                 \
        vf a[CHAINS], k = to.v[CHAINS] * 0.0f + one;                                                                  \
        for (int i = 0; i < CHAINS; i++) a[i] = to.v[i];                                                              \
        for (long i = 0; i < passes * STEPS; i++) {                                                                   \
            _Pragma("GCC unroll 12")                                                                                  \
            for (int c = 0; c < CHAINS; c++) a[c] = expression;                                                       \
        }                                                                                                             \
        for (int i = 0; i < CHAINS; i++) to.v[i] = a[i];                                                              \
        BARRIER();                                                                                                    \
    }
CHAIN(fma_chain, FUSED ? a[c] * k + k : a[c] * k)
CHAIN(add_chain, a[c] + k)

static void fill(void)
{
    for (int i = 0; from.f[0] != one && i < PEAK_VECTORS; i++) from.v[PEAK_VECTORS - 1 - i] = to.v[0] * 0.0f + one;
}

#define SWEEP(name, count, statement)                                                                                 \
    static void name(long passes)                                                                                     \
    {                                                                                                                 \
        fill();                                                                                                       \
        for (long pass = 0; pass < passes * REPEATS; pass++) {                                                        \
            _Pragma("GCC unroll 8")                                                                                   \
            for (int i = 0; i < count; i++) statement;                                                                \
            BARRIER();                                                                                                \
        }                                                                                                             \
    }
SWEEP(divide_sweep, PEAK_VECTORS, to.v[i] = from.v[i] / from.v[i])
SWEEP(sqrt_sweep, PEAK_VECTORS * LANES, to.f[i] = sqrtf(from.f[i]))
SWEEP(store_sweep, PEAK_VECTORS, to.v[i] = from.v[0])

static void load_sweep(long passes)
{
    vi a = from.i[0], b = a, c = a, d = a;
    for (long pass = 0; pass < passes * REPEATS; pass++) {
        for (int i = 0; i < PEAK_VECTORS; i += 4) {
            a ^= from.i[i];
            b ^= from.i[i + 1];
            c ^= from.i[i + 2];
            d ^= from.i[i + 3];
        }
        BARRIER();
    }
    to.i[0] = a ^ b ^ c ^ d;
    BARRIER();
}

static void clock_chain(long passes)
{
    unsigned long x = 0, k = (unsigned long)passes;
    for (long i = 0; i < passes * STEPS; i++) {
        _Pragma("GCC unroll 12")
        for (int c = 0; c < CHAINS; c++) {
            x += k;
            __asm__ volatile("" : "+r"(x));
        }
    }
}

static void copy(void *to_bytes, const void *from_bytes, size_t bytes)
{
    vf *restrict target = to_bytes;
    const vf *restrict source = from_bytes;
    for (size_t i = 0; i < bytes / sizeof(vf); i++) target[i] = source[i];
    BARRIER();
}

extern const peak_table PEAK_TABLE;
const peak_table PEAK_TABLE = {
    PEAK_ARCH, LANES, FUSED,
    { [PEAK_FMA] = fma_chain, [PEAK_ADD] = add_chain, [PEAK_DIVIDE] = divide_sweep, [PEAK_SQRT] = sqrt_sweep,
      [PEAK_LOAD] = load_sweep, [PEAK_STORE] = store_sweep, [PEAK_CLOCK] = clock_chain },
    copy,
};
