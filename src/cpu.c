/* What this CPU runs: facet_has for architectures, facet_arch_best. */
#include "cpu.h"

enum { CPU_SSE2 = 1, CPU_SSE41 = 2, CPU_FMA = 4, CPU_AVX2 = 8, CPU_AVX512 = 16, CPU_NEON = 32 };

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>

/* The register states that the operating system saves and restores: 6 for YMM, 0xe6 for ZMM. */
static unsigned saved_states(void)
{
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

static unsigned cpu_features(void)
{
    const unsigned ymm = 0x6, zmm = 0xe6;
    unsigned a, b, c, d, features = 0;

    if (!__get_cpuid(1, &a, &b, &c, &d)) return 0;
    if (d & bit_SSE2) features |= CPU_SSE2;
    if (c & bit_SSE4_1) features |= CPU_SSE41;
    unsigned states = c & bit_OSXSAVE ? saved_states() : 0;
    if (!(c & bit_AVX) || (states & ymm) != ymm) return features;
    if (c & bit_FMA) features |= CPU_FMA;

    const unsigned avx512 = bit_AVX512F | bit_AVX512VL | bit_AVX512DQ | bit_AVX512BW;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return features;
    if (b & bit_AVX2) features |= CPU_AVX2;
    if ((b & avx512) == avx512 && (states & zmm) == zmm) features |= CPU_AVX512;
    return features;
}
#elif defined(__aarch64__)
static unsigned cpu_features(void) { return CPU_NEON; }
#else
static unsigned cpu_features(void) { return 0; }
#endif

static bool runs(facet_arch arch, unsigned features)
{
    static const unsigned needed[ARCH_COUNT] = {
#define FACET_ARCH(id, name, word, needs, lanes) [FACET_ARCH_##id] = needs,
#include "arches.def"
    };
    return arch_built(arch) && (features & needed[arch]) == needed[arch];
}

bool facet_arch_runs(facet_arch arch)
{
    return runs(arch, arch == FACET_ARCH_SCALAR ? 0 : cpu_features());
}

facet_arch facet_arch_best(void)
{
    const unsigned features = cpu_features();
    facet_arch best = FACET_ARCH_SCALAR;
#define FACET_ARCH(id, name, word, needs, lanes) if (runs(FACET_ARCH_##id, features)) best = FACET_ARCH_##id;
#include "arches.def"
    return best;
}
