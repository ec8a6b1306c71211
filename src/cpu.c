/* What this CPU runs: which architectures, and the best of them. */
#include "cpu.h"

enum { CPU_SSE2 = 1, CPU_SSE41 = 2, CPU_FMA_F16C = 4, CPU_AVX2 = 8, CPU_AVX512 = 16, CPU_NEON = 32 };

/* What this file's own flags let the compiler use anywhere, so that nobody needs to ask: SSE2 on x86-64, NEON on
 * aarch64, and with -march=native what the building machine has. */
static const unsigned assured = 0
#ifdef __SSE2__
    | CPU_SSE2
#endif
#ifdef __SSE4_1__
    | CPU_SSE41
#endif
#if defined(__FMA__) && defined(__F16C__)
    | CPU_FMA_F16C
#endif
#ifdef __AVX2__
    | CPU_AVX2
#endif
#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
    | CPU_AVX512
#endif
#ifdef __aarch64__
    | CPU_NEON
#endif
    ;

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>

/* The register states that the operating system saves and restores: 6 for YMM, 0xe6 for ZMM. */
static unsigned saved_states(void)
{
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

/* Virtual machines trap cpuid, which takes microseconds: there are two at most. The highest leaf is not asked for: with
 * SSE2 there is leaf 1; with XSAVE there is leaf 13, which lists the states to save, and so leaf 7. */
static unsigned ask_cpu(unsigned wanted)
{
    const unsigned ymm = 0x6, zmm = 0xe6, avx512 = bit_AVX512F | bit_AVX512VL | bit_AVX512DQ | bit_AVX512BW;
    unsigned a, b, c, d, features = 0;

    __cpuid(1, a, b, c, d);
    if (c & bit_SSE4_1) features |= CPU_SSE41;
    unsigned states = c & bit_OSXSAVE ? saved_states() : 0;
    if (!(c & bit_AVX) || (states & ymm) != ymm) return features;
    if (c & bit_FMA && c & bit_F16C) features |= CPU_FMA_F16C;

    if (!(wanted & (CPU_AVX2 | CPU_AVX512))) return features;
    __cpuid_count(7, 0, a, b, c, d);
    if (b & bit_AVX2) features |= CPU_AVX2;
    if ((b & avx512) == avx512 && (states & zmm) == zmm) features |= CPU_AVX512;
    return features;
}
#else
static unsigned ask_cpu(unsigned wanted) { (void)wanted; return 0; }
#endif

uint32_t facet_arches_among(uint32_t among)
{
    static const unsigned needed[ARCH_COUNT] = {
#define FACET_ARCH(id, name, word, needs, lanes) [FACET_ARCH_##id] = needs,
#include "arches.def"
    };
    uint32_t run = 0;
    unsigned wanted = 0;
    among &= ARCHES_BUILT;
    for (int arch = 0; arch < ARCH_COUNT; arch++)
        if (among >> arch & 1) wanted |= needed[arch] & ~assured;
    const unsigned features = assured | (wanted ? ask_cpu(wanted) : 0);
    for (int arch = 0; arch < ARCH_COUNT; arch++)
        if (among >> arch & 1 && !(needed[arch] & ~features)) run |= 1u << arch;
    return run;
}

facet_arch facet_arch_best_of(uint32_t arches)
{
    facet_arch best = FACET_ARCH_BEST;
#define FACET_ARCH(id, name, word, needs, lanes) if (arches >> FACET_ARCH_##id & 1) best = FACET_ARCH_##id;
#include "arches.def"
    return best;
}

uint32_t facet_arches(void) { return facet_arches_among(ARCHES_BUILT); }
facet_arch facet_arch_best(void) { return facet_arch_best_of(facet_arches()); }
