/* One architecture's elementary functions in one tier. The Makefile compiles this file once for each, with
 * FACET_ARCH_HEADER and FACET_STRICT as for a kernel, and ELEMENTARY_TABLE: the table's name. */
#include FACET_ARCH_HEADER

#include "elementary.h"
#include "elementary.tmpl.h"

extern const elementary_table ELEMENTARY_TABLE;

#define FUNCTION(name, value)                                                                                         \
    static void apply_##name(const float *a, const float *b, float *out, size_t count)                               \
    {                                                                                                                \
        (void)b;                                                                                                     \
        for (size_t i = 0; i < count; i += VF_LANES) vf_store(out + i, value);                                       \
    }
#define ONE(name, worst) FUNCTION(name, name(vf_load(a + i)))
#define TWO(name, worst) FUNCTION(name, name(vf_load(a + i), vf_load(b + i)))
ELEMENTARY_FUNCTIONS(ONE, TWO)

/* How often vf_mad rounds: the square of 1 + 2^-12 is half an ulp more than its rounded value. */
static int roundings(void)
{
    volatile float a = 0x1.001p0f, c = -0x1.002p0f;
    float lost[VF_LANES];
    vf_store(lost, vf_mad(splat(a), splat(a), splat(c)));
    return lost[0] > 0.0f ? 1 : 2;
}

const elementary_table ELEMENTARY_TABLE = {
#define APPLY(name, worst) apply_##name,
#define WORST(name, worst) worst,
    .functions = { ELEMENTARY_FUNCTIONS(APPLY, APPLY) },
    .worst = { ELEMENTARY_FUNCTIONS(WORST, WORST) },
    .roundings = roundings,
};
