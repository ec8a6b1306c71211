/* The vector layer, one lane, for `make HEADER.scalar=../tests/lint.h ARCHES=scalar`: scalar.h's numbers in vectors
 * of one. With scalar.h's own `typedef float vf`, a cast, a condition or a comparison compiles that on vectors means
 * something else; here it is an error. What compiles gives the bytes of every other layer. */
#ifndef TESTS_LINT_H
#define TESTS_LINT_H

#include <stdint.h>

#include "../arch/op.h"

typedef float vf __attribute__((vector_size(4)));
typedef int32_t lanes_of_bits __attribute__((vector_size(4)));
typedef struct { lanes_of_bits m; } vm;

#define VF_LANES 1
#define VF_INTERLEAVE 1
#define VF_INTERLEAVE_WIDE 2
#define VF_STREAMS 0

OP vf vf_load(const float *p) { return (vf){ *p }; }
OP void vf_store(float *p, vf a) { *p = a[0]; }
OP void vf_stream(float *p, vf a) { vf_store(p, a); }
OP void vf_streamed(void) { }
OP vf vf_splat(float a) { return (vf){ a }; }

OP vf vf_div(vf a, vf b) { return a / b; }
OP vf vf_sqrt(vf a) { return (vf){ __builtin_sqrtf(a[0]) }; }
OP vf vf_min(vf a, vf b) { return (vf){ a[0] < b[0] ? a[0] : b[0] }; }
OP vf vf_max(vf a, vf b) { return (vf){ a[0] > b[0] ? a[0] : b[0] }; }
OP vf vf_at_least(vf a, vf low) { return vf_max(low, a); }
OP vf vf_at_most(vf a, vf high) { return vf_min(high, a); }
OP vf vf_not_negative(vf a) { return vf_max(a, vf_splat(0.0f)); }
OP vf vf_abs(vf a) { return (vf){ __builtin_fabsf(a[0]) }; }
OP vf vf_flip(vf a, vf s) { return __builtin_signbit(s[0]) ? -a : a; }

OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }

OP uint32_t bits_of(vf a) { return (uint32_t)((lanes_of_bits)a)[0]; }
OP vf from_bits(uint32_t bits) { return (vf)(lanes_of_bits){ (int32_t)bits }; }
OP vf vf_bits_max(vf a, vf b) { return bits_of(a) > bits_of(b) ? a : b; }
OP vf vf_bits_minus(vf a, vf b) { return from_bits(bits_of(a) - bits_of(b)); }
OP vf vf_or(vf a, vf b) { return from_bits(bits_of(a) | bits_of(b)); }
OP vf vf_shift_left(vf a, int n) { return from_bits(bits_of(a) << n); }
OP vf vf_shift_right(vf a, int n) { return from_bits(bits_of(a) >> n); }
OP uint32_t vf_signs(vf a) { return bits_of(a) >> 31; }
OP uint32_t vf_any_sign(vf a) { return vf_signs(a); }

OP void vf_store_half(uint16_t *p, vf a)
{
    const uint32_t small = bits_of(a + 0.5f) - 0x3f000000, odd = bits_of(a) >> 13 & 1;
    *p = (uint16_t)(a[0] < 0x1p-14f ? small : (bits_of(a) - 0x38000000 + 0xfff + odd) >> 13);
}

OP vm vf_lt(vf a, vf b) { return (vm){ a < b }; }
OP vm vf_eq(vf a, vf b) { return (vm){ a == b }; }
OP vf vf_select(vm m, vf a, vf b) { return m.m[0] ? a : b; }
OP vf vf_where(vm m, vf a) { return m.m[0] ? a : (vf){ 0.0f }; }
OP uint32_t vm_bits(vm m) { return m.m[0] ? 1 : 0; }

#endif
