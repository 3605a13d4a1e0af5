/* Names of functions that are compiled once per instruction set: KERNEL(f) is f_sse2, f_avx2 or f_avx512, by the
 * KERNEL_ISA that the Makefile defines for *_kernel.c. A loop under the comment VECTORISE must be vectorised for AVX2
 * and AVX-512; `make vectorise` checks it. */
#pragma once

#define KERNEL_PASTE(name, isa) name##_##isa
#define KERNEL_NAME(name, isa) KERNEL_PASTE(name, isa)
#define KERNEL(name) KERNEL_NAME(name, KERNEL_ISA)

#define ALWAYS_INLINE static inline __attribute__((always_inline))
