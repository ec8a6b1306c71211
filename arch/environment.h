/* The floating-point environment that results are defined in: round to nearest, subnormals kept, traps masked.
 * environment_enter sets it where it differs and returns the caller's; environment_leave gives that back, sticky flags
 * included, without a look: on x86 reading the register costs more than writing it (6 ns, 1 ns). Both are compiler
 * barriers: floating-point arithmetic belongs in a function that is not inlined beside them. On a machine without a row
 * here they do nothing: the caller's environment counts. */
#ifndef FACET_ARCH_ENVIRONMENT_H
#define FACET_ARCH_ENVIRONMENT_H

#include <stdint.h>

/* READ and WRITE move the control and status register; CONTROL masks its control bits, WANTED is what they shall be. */
#if defined(__x86_64__) || defined(__SSE__)
#define ENVIRONMENT_READ(r)  __asm__ volatile("stmxcsr %0" : "=m"(r) : : "memory")
#define ENVIRONMENT_WRITE(r) __asm__ volatile("ldmxcsr %0" : : "m"(r) : "memory")
#define ENVIRONMENT_CONTROL  0xffc0u
#define ENVIRONMENT_WANTED   0x1f80u
typedef uint32_t environment;
#elif defined(__aarch64__)
#define ENVIRONMENT_READ(r)                                                                                           \
    do {                                                                                                              \
        uint64_t fpsr;                                                                                                \
        __asm__ volatile("mrs %0, fpcr" : "=r"(r) : : "memory");                                                      \
        __asm__ volatile("mrs %0, fpsr" : "=r"(fpsr) : : "memory");                                                   \
        (r) |= fpsr << 32;                                                                                            \
    } while (0)
#define ENVIRONMENT_WRITE(r)                                                                                          \
    do {                                                                                                              \
        __asm__ volatile("msr fpcr, %0" : : "r"((r) & 0xffffffffu) : "memory");                                       \
        __asm__ volatile("msr fpsr, %0" : : "r"((r) >> 32) : "memory");                                               \
    } while (0)
#define ENVIRONMENT_CONTROL  UINT64_C(0x07ff9f07)
#define ENVIRONMENT_WANTED   UINT64_C(0)
typedef uint64_t environment;
#elif defined(__arm__) && defined(__ARM_FP)
#define ENVIRONMENT_READ(r)  __asm__ volatile("vmrs %0, fpscr" : "=r"(r) : : "memory")
#define ENVIRONMENT_WRITE(r) __asm__ volatile("vmsr fpscr, %0" : : "r"(r) : "memory")
#define ENVIRONMENT_CONTROL  0x07ff9f00u
#define ENVIRONMENT_WANTED   0u
typedef uint32_t environment;
#elif defined(__s390x__)
#define ENVIRONMENT_READ(r)  __asm__ volatile("efpc %0" : "=d"(r) : : "memory")
#define ENVIRONMENT_WRITE(r) __asm__ volatile("sfpc %0" : : "d"(r) : "memory")
#define ENVIRONMENT_CONTROL  0xfc000007u
#define ENVIRONMENT_WANTED   0u
typedef uint32_t environment;
#elif defined(__riscv) && defined(__riscv_flen)
#define ENVIRONMENT_READ(r)  __asm__ volatile("frcsr %0" : "=r"(r) : : "memory")
#define ENVIRONMENT_WRITE(r) __asm__ volatile("fscsr %0" : : "r"(r) : "memory")
#define ENVIRONMENT_CONTROL  0xe0ul
#define ENVIRONMENT_WANTED   0ul
typedef unsigned long environment;
#else
#define ENVIRONMENT_READ(r)  ((r) = 0)
#define ENVIRONMENT_WRITE(r) ((void)(r))
#define ENVIRONMENT_CONTROL  0u
#define ENVIRONMENT_WANTED   0u
typedef uint32_t environment;
#endif

static inline environment environment_enter(void)
{
    environment callers;
    ENVIRONMENT_READ(callers);
    if ((callers & ENVIRONMENT_CONTROL) != ENVIRONMENT_WANTED) {
        environment ours = (callers & ~(environment)ENVIRONMENT_CONTROL) | ENVIRONMENT_WANTED;
        ENVIRONMENT_WRITE(ours);
    }
    return callers;
}

static inline void environment_leave(environment callers)
{
    ENVIRONMENT_WRITE(callers);
}

#endif
