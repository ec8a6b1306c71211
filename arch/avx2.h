/* The vector layer, eight lanes: AVX2 and FMA. scalar.h says what each operation means. */
#ifndef FACET_ARCH_AVX2_H
#define FACET_ARCH_AVX2_H

#include <immintrin.h>
#include <stdint.h>

#include "op.h"

typedef __m256 vf;
typedef float vf_memory __attribute__((vector_size(32), aligned(4), may_alias));
typedef uint32_t vf_bits __attribute__((vector_size(32)));
typedef struct { vf m; } vm;

#define VF_LANES 8
#define VF_INTERLEAVE 2
#define VF_INTERLEAVE_WIDE 1
#define VF_STREAMS 1

OP vf vf_load(const float *p) { return *(const vf_memory *)p; }
OP void vf_store(float *p, vf a) { *(vf_memory *)p = a; }
OP void vf_store_half(uint16_t *p, vf a) { _mm_storeu_si128((__m128i_u *)p, _mm256_cvtps_ph(a, 0)); }
OP void vf_stream(float *p, vf a) { _mm256_stream_ps(p, a); }
OP void vf_streamed(void) { _mm_sfence(); }
OP vf vf_splat(float a) { return _mm256_set1_ps(a); }

OP vf vf_div(vf a, vf b) { return a / b; }
OP vf vf_sqrt(vf a) { return _mm256_sqrt_ps(a); }
OP vf vf_min(vf a, vf b) { return _mm256_min_ps(a, b); }
OP vf vf_max(vf a, vf b) { return _mm256_max_ps(a, b); }
OP vf vf_at_least(vf a, vf low) { return vf_max(low, a); }
OP vf vf_at_most(vf a, vf high) { return vf_min(high, a); }
OP vf vf_not_negative(vf a) { return vf_max(a, vf_splat(0.0f)); }
OP vf vf_abs(vf a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
OP vf vf_flip(vf a, vf s) { return _mm256_xor_ps(a, _mm256_and_ps(s, _mm256_set1_ps(-0.0f))); }

#if FACET_STRICT
OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }
#else
OP vf vf_mad(vf a, vf b, vf c) { return _mm256_fmadd_ps(a, b, c); }
OP vf vf_nmad(vf a, vf b, vf c) { return _mm256_fnmadd_ps(a, b, c); }
#endif

OP vf vf_bits_max(vf a, vf b)
{
    return _mm256_castsi256_ps(_mm256_max_epu32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
}
OP vf vf_bits_minus(vf a, vf b)
{
    return _mm256_castsi256_ps(_mm256_sub_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b)));
}
OP vf vf_or(vf a, vf b) { return _mm256_or_ps(a, b); }
OP vf vf_shift_left(vf a, int n) { return (vf)((vf_bits)a << n); }
OP vf vf_shift_right(vf a, int n) { return (vf)((vf_bits)a >> n); }
OP uint32_t vf_signs(vf a) { return (uint32_t)_mm256_movemask_ps(a); }
OP uint32_t vf_any_sign(vf a) { return vf_signs(a); }

OP vm vf_lt(vf a, vf b) { return (vm){ _mm256_cmp_ps(a, b, _CMP_LT_OQ) }; }
OP vm vf_eq(vf a, vf b) { return (vm){ _mm256_cmp_ps(a, b, _CMP_EQ_OQ) }; }
OP vf vf_select(vm m, vf a, vf b) { return _mm256_blendv_ps(b, a, m.m); }
OP vf vf_where(vm m, vf a) { return _mm256_and_ps(m.m, a); }
OP uint32_t vm_bits(vm m) { return (uint32_t)_mm256_movemask_ps(m.m); }

#endif
