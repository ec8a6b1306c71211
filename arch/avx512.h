/* The vector layer, sixteen lanes: AVX-512 F, VL, DQ, BW. scalar.h says what each operation means. */
#ifndef FACET_ARCH_AVX512_H
#define FACET_ARCH_AVX512_H

#include <immintrin.h>
#include <stdint.h>

#include "op.h"

typedef __m512 vf;
typedef float vf_memory __attribute__((vector_size(64), aligned(4), may_alias));
typedef uint32_t vf_bits __attribute__((vector_size(64)));
typedef struct { __mmask16 m; } vm;

#define VF_LANES 16
#define VF_INTERLEAVE 1
#define VF_INTERLEAVE_WIDE 2
#define VF_STREAMS 1

OP vf vf_load(const float *p) { return *(const vf_memory *)p; }
OP void vf_store(float *p, vf a) { *(vf_memory *)p = a; }
OP void vf_store_half(uint16_t *p, vf a) { _mm256_storeu_si256((__m256i_u *)p, _mm512_maskz_cvtps_ph(0xffff, a, 0)); }
OP void vf_stream(float *p, vf a) { _mm512_stream_ps(p, a); }
OP void vf_streamed(void) { _mm_sfence(); }
OP vf vf_splat(float a) { return _mm512_set1_ps(a); }

OP vf vf_div(vf a, vf b) { return a / b; }
OP vf vf_sqrt(vf a) { return _mm512_sqrt_ps(a); }
OP vf vf_min(vf a, vf b) { return _mm512_min_ps(a, b); }
OP vf vf_max(vf a, vf b) { return _mm512_max_ps(a, b); }
OP vf vf_at_least(vf a, vf low) { return vf_max(low, a); }
OP vf vf_at_most(vf a, vf high) { return vf_min(high, a); }
OP vf vf_not_negative(vf a) { return vf_max(a, vf_splat(0.0f)); }
OP vf vf_abs(vf a) { return _mm512_andnot_ps(_mm512_set1_ps(-0.0f), a); }
OP vf vf_flip(vf a, vf s) { return _mm512_xor_ps(a, _mm512_and_ps(s, _mm512_set1_ps(-0.0f))); }

#if FACET_STRICT
OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }
#else
OP vf vf_mad(vf a, vf b, vf c) { return _mm512_fmadd_ps(a, b, c); }
OP vf vf_nmad(vf a, vf b, vf c) { return _mm512_fnmadd_ps(a, b, c); }
#endif

OP vf vf_bits_max(vf a, vf b)
{
    return _mm512_castsi512_ps(_mm512_max_epu32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
}
OP vf vf_bits_minus(vf a, vf b)
{
    return _mm512_castsi512_ps(_mm512_sub_epi32(_mm512_castps_si512(a), _mm512_castps_si512(b)));
}
OP vf vf_or(vf a, vf b) { return _mm512_or_ps(a, b); }
OP vf vf_shift_left(vf a, int n) { return (vf)((vf_bits)a << n); }
OP vf vf_shift_right(vf a, int n) { return (vf)((vf_bits)a >> n); }
OP uint32_t vf_signs(vf a) { return _mm512_movepi32_mask(_mm512_castps_si512(a)); }
OP uint32_t vf_any_sign(vf a) { return vf_signs(a); }

OP vm vf_lt(vf a, vf b) { return (vm){ _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ) }; }
OP vm vf_eq(vf a, vf b) { return (vm){ _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ) }; }
OP vf vf_select(vm m, vf a, vf b) { return _mm512_mask_blend_ps(m.m, b, a); }
OP vf vf_where(vm m, vf a) { return _mm512_maskz_mov_ps(m.m, a); }
OP uint32_t vm_bits(vm m) { return m.m; }

#endif
