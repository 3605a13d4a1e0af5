/* Names of functions that are compiled once per instruction set: KERNEL(f) is f_SET, such as f_avx2, by the
 * KERNEL_ISA that the Makefile defines for *_kernel.c. A loop under the comment VECTORISE must be vectorised for AVX2
 * and AVX-512 by gcc and clang; `make vectorise` checks it. */
#pragma once

#define KERNEL_PASTE(name, isa) name##_##isa
#define KERNEL_NAME(name, isa) KERNEL_PASTE(name, isa)
#define KERNEL(name) KERNEL_NAME(name, KERNEL_ISA)

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* Before a loop none of whose iterations reads what another writes. clang ignores restrict of local variables; it would
 * otherwise compare every pair of arrays, and leaves loops with many arrays scalar. */
#ifdef __clang__
#define INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif
