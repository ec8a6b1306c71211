/* The vector layer, one lane: plain C, and the meaning of every operation of every other header here.
 *
 * vf_load and vf_store keep the bits of whatever has a float's alignment.
 * vf: VF_LANES floats, with native + - * / alone (each rounds to nearest, lane by lane). vm: a mask, opaque.
 * Comparisons are false where an operand is NaN. FACET_STRICT 1: vf_mad and vf_nmad round twice, as everywhere; 0:
 * once where the ISA fuses. VF_INTERLEAVE: vectors that the kernel of all models takes side by side;
 * VF_INTERLEAVE_WIDE: those that rows of special.def take which are wide at VF_LANES. VF_STREAMS: whether vf_stream is
 * more than vf_store. */
#ifndef FACET_ARCH_SCALAR_H
#define FACET_ARCH_SCALAR_H

#include <stdint.h>

#include "op.h"

typedef float vf;
typedef float __attribute__((may_alias)) vf_memory;
typedef struct { int m; } vm;

#define VF_LANES 1
#define VF_INTERLEAVE 1          /* 2: 1.0 to 1.3 times as fast, for a quarter more code than small machines want */
#define VF_INTERLEAVE_WIDE 1
#define VF_STREAMS 0

OP vf vf_load(const float *p) { return *(const vf_memory *)p; }
OP void vf_store(float *p, vf a) { *(vf_memory *)p = a; }

/* To an address that is a multiple of a vector's size, past the caches where the ISA can; vf_streamed comes before
 * another thread may look. */
OP void vf_stream(float *p, vf a) { vf_store(p, a); }
OP void vf_streamed(void) { }

OP vf vf_splat(float a) { return a; }

/* a / b; in the fast tier it may be near that. Where b is a normal float and |a/b| < 2^127: within 0.51 units in the
 * last place plus 2^-149/|b|; 0 for a = 0, 1 for 1/1, at most 1 for |a| <= |b|. NaN of a NaN; elsewhere anything. */
OP vf vf_div(vf a, vf b) { return a / b; }
OP vf vf_sqrt(vf a) { return __builtin_sqrtf(a); }
OP vf vf_min(vf a, vf b) { return a < b ? a : b; }
OP vf vf_max(vf a, vf b) { return a > b ? a : b; }
OP vf vf_abs(vf a) { return __builtin_fabsf(a); }

/* The larger of a and low, the smaller of a and high, which are no NaN; a NaN in a stays one. Of two zeros it is
 * either: what they limit must not show a zero's sign. */
OP vf vf_at_least(vf a, vf low) { return vf_max(low, a); }
OP vf vf_at_most(vf a, vf high) { return vf_min(high, a); }

/* a where it is > 0, else 0; of a signalling NaN either 0 or NaN. */
OP vf vf_not_negative(vf a) { return vf_max(a, vf_splat(0.0f)); }

/* a with its sign turned where s has one. */
OP vf vf_flip(vf a, vf s) { return __builtin_signbit(s) ? -a : a; }

/* a b + c and c - a b. */
#if !FACET_STRICT && defined(__FP_FAST_FMAF)
OP vf vf_mad(vf a, vf b, vf c) { return __builtin_fmaf(a, b, c); }
OP vf vf_nmad(vf a, vf b, vf c) { return __builtin_fmaf(-a, b, c); }
#else
OP vf vf_mad(vf a, vf b, vf c) { return a * b + c; }
OP vf vf_nmad(vf a, vf b, vf c) { return c - a * b; }
#endif

/* On the bits: the one of a and b whose bits, as an unsigned number, are larger (negatives, infinities and NaN beat
 * all); the bits of a less those of b; the bits that either has; the bits of a, moved by a constant n of 0 to 31, zeros
 * behind them. vf_signs: bit k is the sign of lane k; vf_any_sign: not 0 where a lane has one. */
typedef union { float f; uint32_t u; } float_bits;
OP uint32_t bits_of(vf a) { return ((float_bits){ .f = a }).u; }
OP vf from_bits(uint32_t u) { return ((float_bits){ .u = u }).f; }
OP vf vf_bits_max(vf a, vf b) { return bits_of(a) > bits_of(b) ? a : b; }
OP vf vf_bits_minus(vf a, vf b) { return from_bits(bits_of(a) - bits_of(b)); }
OP vf vf_or(vf a, vf b) { return from_bits(bits_of(a) | bits_of(b)); }
OP vf vf_shift_left(vf a, int n) { return from_bits(bits_of(a) << n); }
OP vf vf_shift_right(vf a, int n) { return from_bits(bits_of(a) >> n); }
OP uint32_t vf_signs(vf a) { return bits_of(a) >> 31; }
OP uint32_t vf_any_sign(vf a) { return vf_signs(a); }

/* IEEE 754 binary16 of 0 <= a <= 65504, to nearest, ties to even; addresses have a uint16_t's alignment. Below 2^-14
 * the last place of a + 1/2 is that of the least half. */
OP void vf_store_half(uint16_t *p, vf a)
{
    const uint32_t bits = bits_of(a), odd = bits >> 13 & 1, small = bits_of(a + 0.5f) - 0x3f000000;
    *p = (uint16_t)(a < 0x1p-14f ? small : (bits - 0x38000000 + 0xfff + odd) >> 13);
}

OP vm vf_lt(vf a, vf b) { return (vm){ a < b }; }
OP vm vf_eq(vf a, vf b) { return (vm){ a == b }; }

/* m ? a : b, and m ? a : +0. */
OP vf vf_select(vm m, vf a, vf b) { return m.m ? a : b; }
OP vf vf_where(vm m, vf a) { return m.m ? a : 0.0f; }

/* Bit k is lane k's. */
OP uint32_t vm_bits(vm m) { return (uint32_t)m.m; }

#endif
