/* What every operation of the vector layer, and every function of a kernel, is declared as: part of whatever calls it.
 * Without optimisation it stays a function: a kernel that kept the variables of all of them apart would take megabytes
 * of stack (clang 14 at -O0: 9). */
#ifndef FACET_ARCH_OP_H
#define FACET_ARCH_OP_H

#ifdef __OPTIMIZE__
#define OP static inline __attribute__((always_inline, unused))
#else
#define OP static inline __attribute__((unused))
#endif

/* Before a loop over a few vectors, which becomes none. Clang 14, told a number, unrolls it too late for its arrays to
 * be registers. */
#ifdef __clang__
#define UNROLLED _Pragma("clang loop unroll(full)")
#else
#define UNROLLED _Pragma("GCC unroll 4")
#endif

#endif
