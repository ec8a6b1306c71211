/* The vector layer, four lanes: SSE2. scalar.h says what each operation means. */
#ifndef FACET_ARCH_SSE2_H
#define FACET_ARCH_SSE2_H

#include <immintrin.h>
#include <stdint.h>

#include "op.h"

typedef __m128 vf;
typedef float vf_memory __attribute__((vector_size(16), aligned(4), may_alias));
typedef uint32_t vf_bits __attribute__((vector_size(16)));
typedef struct { vf m; } vm;

#define VF_LANES 4
#define VF_INTERLEAVE 2
#define VF_INTERLEAVE_WIDE 1
#define VF_STREAMS 1

OP vf vf_load(const float *p) { return *(const vf_memory *)p; }
OP void vf_store(float *p, vf a) { *(vf_memory *)p = a; }
OP void vf_stream(float *p, vf a) { _mm_stream_ps(p, a); }
OP void vf_streamed(void) { _mm_sfence(); }
OP vf vf_splat(float a) { return _mm_set1_ps(a); }

/* As scalar.h has it. */
OP void vf_store_half(uint16_t *p, vf a)
{
    __m128i bits = _mm_castps_si128(a), odd = _mm_and_si128(_mm_srli_epi32(bits, 13), _mm_set1_epi32(1));
    __m128i least = _mm_sub_epi32(_mm_castps_si128(a + 0.5f), _mm_set1_epi32(0x3f000000));
    bits = _mm_srli_epi32(_mm_add_epi32(_mm_sub_epi32(bits, _mm_set1_epi32(0x38000000 - 0xfff)), odd), 13);
    __m128i small = _mm_castps_si128(_mm_cmplt_ps(a, _mm_set1_ps(0x1p-14f)));
    bits = _mm_or_si128(_mm_and_si128(small, least), _mm_andnot_si128(small, bits));
    _mm_storel_epi64((__m128i_u *)p, _mm_packs_epi32(bits, bits));
}

OP vf vf_div(vf a, vf b) { return a / b; }
OP vf vf_sqrt(vf a) { return _mm_sqrt_ps(a); }
OP vf vf_min(vf a, vf b) { return _mm_min_ps(a, b); }
OP vf vf_max(vf a, vf b) { return _mm_max_ps(a, b); }
OP vf vf_at_least(vf a, vf low) { return vf_max(low, a); }
OP vf vf_at_most(vf a, vf high) { return vf_min(high, a); }
OP vf vf_not_negative(vf a) { return vf_max(a, vf_splat(0.0f)); }
OP vf vf_abs(vf a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
OP vf vf_flip(vf a, vf s) { return _mm_xor_ps(a, _mm_and_ps(s, _mm_set1_ps(-0.0f))); }

OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }

OP vf vf_bits_max(vf a, vf b)
{
#ifdef __SSE4_1__
    return _mm_castsi128_ps(_mm_max_epu32(_mm_castps_si128(a), _mm_castps_si128(b)));
#else
    const __m128i top = _mm_set1_epi32(INT32_MIN);      /* turned, unsigned compares as signed */
    __m128i above = _mm_cmpgt_epi32(_mm_xor_si128(_mm_castps_si128(a), top), _mm_xor_si128(_mm_castps_si128(b), top));
    return _mm_or_ps(_mm_and_ps(_mm_castsi128_ps(above), a), _mm_andnot_ps(_mm_castsi128_ps(above), b));
#endif
}
OP vf vf_bits_minus(vf a, vf b) { return _mm_castsi128_ps(_mm_sub_epi32(_mm_castps_si128(a), _mm_castps_si128(b))); }
OP vf vf_or(vf a, vf b) { return _mm_or_ps(a, b); }
OP vf vf_shift_left(vf a, int n) { return (vf)((vf_bits)a << n); }
OP vf vf_shift_right(vf a, int n) { return (vf)((vf_bits)a >> n); }
OP uint32_t vf_signs(vf a) { return (uint32_t)_mm_movemask_ps(a); }
OP uint32_t vf_any_sign(vf a) { return vf_signs(a); }

OP vm vf_lt(vf a, vf b) { return (vm){ _mm_cmplt_ps(a, b) }; }
OP vm vf_eq(vf a, vf b) { return (vm){ _mm_cmpeq_ps(a, b) }; }
#ifdef __SSE4_1__
OP vf vf_select(vm m, vf a, vf b) { return _mm_blendv_ps(b, a, m.m); }
#else
OP vf vf_select(vm m, vf a, vf b) { return _mm_or_ps(_mm_and_ps(m.m, a), _mm_andnot_ps(m.m, b)); }
#endif
OP vf vf_where(vm m, vf a) { return _mm_and_ps(m.m, a); }
OP uint32_t vm_bits(vm m) { return (uint32_t)_mm_movemask_ps(m.m); }

#endif
