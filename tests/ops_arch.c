/* One architecture's vector operations in one tier, as functions. The Makefile compiles this file once for each, with
 * FACET_ARCH_HEADER and FACET_STRICT as for a kernel, and OPS_TABLE: the table's name. */
#include FACET_ARCH_HEADER

#include "ops.h"

extern const ops_table OPS_TABLE;

#define A vf_load(a + i)
#define B vf_load(b + i)
#define C vf_load(c + i)
#define MASK(x) vf_lt(vf_splat(0.0f), x)

OP void store_bits(float *out, uint32_t bits)
{
    const uint32_t beyond = VF_LANES < 32 ? bits >> VF_LANES : 0;
    for (int lane = 0; lane < VF_LANES; lane++) out[lane] = beyond ? OPS_BROKEN : (float)(bits >> lane & 1);
}

/* Each lane alone. */
OP void store_any(float *out, const float *a)
{
    for (int lane = 0; lane < VF_LANES; lane++) {
        float all[VF_LANES] = { 0.0f };
        __builtin_memcpy(&all[lane], &a[lane], sizeof(float));
        out[lane] = vf_any_sign(vf_load(all)) ? 1.0f : 0.0f;
    }
}

OP void store_splats(float *out, const float *a)
{
    for (int lane = 0; lane < VF_LANES; lane++) {
        float all[VF_LANES];
        vf_store(all, vf_splat(a[lane]));
        out[lane] = all[lane];
        for (int other = 0; other < VF_LANES; other++)
            if (__builtin_memcmp(&all[other], &all[lane], sizeof(float))) out[lane] = OPS_BROKEN;
    }
}

/* To an address of no more than a uint16_t's alignment, nothing beside. */
OP void store_halves(float *out, const float *a)
{
    float inside[VF_LANES];
    uint16_t half[VF_LANES + 2];
    for (int lane = 0; lane < VF_LANES; lane++)
        inside[lane] = a[lane] > 0.0f ? a[lane] < 65504.0f ? a[lane] : 65504.0f : 0.0f;
    half[0] = half[VF_LANES + 1] = 0xa5a5;
    vf_store_half(half + 1, vf_load(inside));
    const int kept = half[0] == 0xa5a5 && half[VF_LANES + 1] == 0xa5a5;
    for (int lane = 0; lane < VF_LANES; lane++) out[lane] = kept ? (float)half[lane + 1] : OPS_BROKEN;
}

OP void store_streamed(float *out, vf a)
{
    _Alignas(vf) float all[VF_LANES];
    vf_stream(all, a);
    vf_streamed();
    vf_store(out, vf_load(all));
}

/* A case for every constant that a shift can have. */
#define SHIFT(name, n)   case n: vf_store(all, name(A, n)); break;
#define SHIFT_4(name, n) SHIFT(name, n) SHIFT(name, n + 1) SHIFT(name, n + 2) SHIFT(name, n + 3)
#define SHIFTS(name)                                                                                                  \
    SHIFT_4(name, 0) SHIFT_4(name, 4) SHIFT_4(name, 8) SHIFT_4(name, 12)                                              \
    SHIFT_4(name, 16) SHIFT_4(name, 20) SHIFT_4(name, 24) SHIFT_4(name, 28)

/* One vector of an operation, by shape. */
#define APPLY_UNARY(name)   vf_store(out + i, name(A))
#define APPLY_BINARY(name)  vf_store(out + i, name(A, B))
#define APPLY_TERNARY(name) vf_store(out + i, name(A, B, C))
#define APPLY_COMPARE(name) store_bits(out + i, vm_bits(name(A, B)))
#define APPLY_BITS(name)    store_bits(out + i, name(MASK(A)))
#define APPLY_SIGNS(name)   store_bits(out + i, name(A))
#define APPLY_ANY(name)     store_any(out + i, a + i)
#define APPLY_SELECT(name)  vf_store(out + i, name(MASK(A), B, C))
#define APPLY_WHERE(name)   vf_store(out + i, name(MASK(A), B))
#define APPLY_SHIFT(name)                                                                                             \
    for (int lane = 0; lane < VF_LANES; lane++) {                                                                     \
        float all[VF_LANES];                                                                                          \
        uint32_t n;                                                                                                   \
        __builtin_memcpy(&n, b + i + lane, sizeof n);                                                                 \
        switch (n & 31) { SHIFTS(name) }                                                                              \
        __builtin_memcpy(out + i + lane, &all[lane], sizeof(float));                                                  \
    }
#define APPLY_SPLAT(name)   store_splats(out + i, a + i)
#define APPLY_LOAD(name)    vf_store(out + i, name(a + i))
#define APPLY_STORE(name)   name(out + i, A)
#define APPLY_STREAM(name)  store_streamed(out + i, A)
#define APPLY_HALF(name)    store_halves(out + i, a + i)

#define FUNCTION(name, apply)                                                                                         \
    static void apply_##name(const float *a, const float *b, const float *c, float *out, size_t count)               \
    {                                                                                                                \
        (void)b, (void)c;                                                                                            \
        for (size_t i = 0; i < count; i += VF_LANES) apply;                                                          \
    }
#define OPERATION(name, shape, meaning) FUNCTION(name, APPLY_##shape(name))
#define OPERATOR(name, sign)            FUNCTION(name, vf_store(out + i, A sign B))
#include "ops.def"

const ops_table OPS_TABLE = {
    .lanes = VF_LANES,
    .operations = {
#define OPERATION(name, ...) [OPERATION_##name] = apply_##name,
#include "ops.def"
    },
};
