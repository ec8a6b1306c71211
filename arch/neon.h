/* The vector layer, four lanes: NEON as aarch64 has it. scalar.h says what each operation means. */
#ifndef FACET_ARCH_NEON_H
#define FACET_ARCH_NEON_H

#include <arm_neon.h>
#include <stdint.h>

#include "op.h"

typedef float32x4_t vf;
typedef float vf_memory __attribute__((vector_size(16), aligned(4), may_alias));
typedef struct { uint32x4_t m; } vm;

#define VF_LANES 4
#define VF_INTERLEAVE 2
#define VF_INTERLEAVE_WIDE 2
#define VF_STREAMS 0

OP vf vf_load(const float *p) { return (vf)*(const vf_memory *)p; }
OP void vf_store(float *p, vf a) { *(vf_memory *)p = (vf_memory)a; }
OP void vf_store_half(uint16_t *p, vf a) { vst1_u16(p, vreinterpret_u16_f16(vcvt_f16_f32(a))); }
OP void vf_stream(float *p, vf a) { vf_store(p, a); }
OP void vf_streamed(void) { }
OP vf vf_splat(float a) { return vdupq_n_f32(a); }

#if FACET_STRICT
OP vf vf_div(vf a, vf b) { return a / b; }
#else
/* The estimate of 1/b is within 2^-8.4, after a Newton step within 2^-16.8; q is corrected by what it leaves of a.
 * As llvm-mca computes them, the loops of special.def that divide take 9 to 53 % fewer cycles of a cortex-a72 than by
 * the divider alone, and 3 % fewer to 2 % more of a neoverse-n1. Square roots made likewise cost the latter 7 to
 * 14 %. */
OP vf vf_div(vf a, vf b)
{
    vf r = vrecpeq_f32(b);
    r = r * vrecpsq_f32(b, r);
    vf q = a * r;
    return vfmaq_f32(q, r, vfmsq_f32(a, b, q));
}
#endif

/* vminq and vmaxq treat NaN and -0 otherwise than a < b ? a : b does. */
OP vf vf_sqrt(vf a) { return vsqrtq_f32(a); }
OP vf vf_min(vf a, vf b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
OP vf vf_max(vf a, vf b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
OP vf vf_at_least(vf a, vf low) { return vmaxq_f32(a, low); }
OP vf vf_at_most(vf a, vf high) { return vminq_f32(a, high); }
OP vf vf_not_negative(vf a) { return vmaxnmq_f32(a, vdupq_n_f32(0.0f)); }
OP vf vf_abs(vf a) { return vabsq_f32(a); }
OP vf vf_flip(vf a, vf s)
{
    uint32x4_t sign = vandq_u32(vreinterpretq_u32_f32(s), vdupq_n_u32(0x80000000u));
    return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), sign));
}

#if FACET_STRICT
OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }
#else
OP vf vf_mad(vf a, vf b, vf c) { return vfmaq_f32(c, a, b); }
OP vf vf_nmad(vf a, vf b, vf c) { return vfmsq_f32(c, a, b); }
#endif

OP vf vf_bits_max(vf a, vf b)
{
    return vreinterpretq_f32_u32(vmaxq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}
OP vf vf_bits_minus(vf a, vf b)
{
    return vreinterpretq_f32_u32(vsubq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}
OP vf vf_or(vf a, vf b)
{
    return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}
OP vf vf_shift_left(vf a, int n) { return vreinterpretq_f32_u32(vreinterpretq_u32_f32(a) << n); }
OP vf vf_shift_right(vf a, int n) { return vreinterpretq_f32_u32(vreinterpretq_u32_f32(a) >> n); }
OP uint32_t vf_signs(vf a)
{
    static const int32_t place[4] = { 0, 1, 2, 3 };
    return vaddvq_u32(vshlq_u32(vshrq_n_u32(vreinterpretq_u32_f32(a), 31), vld1q_s32(place)));
}
OP uint32_t vf_any_sign(vf a) { return vmaxvq_u32(vreinterpretq_u32_f32(a)) >> 31; }

OP vm vf_lt(vf a, vf b) { return (vm){ vcltq_f32(a, b) }; }
OP vm vf_eq(vf a, vf b) { return (vm){ vceqq_f32(a, b) }; }
OP vf vf_select(vm m, vf a, vf b) { return vbslq_f32(m.m, a, b); }
OP vf vf_where(vm m, vf a) { return vreinterpretq_f32_u32(vandq_u32(m.m, vreinterpretq_u32_f32(a))); }
OP uint32_t vm_bits(vm m)
{
    static const uint32_t bit[4] = { 1, 2, 4, 8 };
    return vaddvq_u32(vandq_u32(m.m, vld1q_u32(bit)));
}

#endif
