/* The selection of vector instructions for the kernels. The kernels are plain C, compiled once per instruction set from
 * one source; the best set that the processor supports is chosen at run time, and CUVETTE_ISA selects a lower one. The
 * results are bit-identical, on every architecture. */
#pragma once

#include "base/status.h"

/* The instruction sets of this architecture, from the one that all its processors have to the best: X(set, ...) for
 * each. The Makefile compiles the kernels for the same list. Another architecture has one set, the compiler's
 * default. */
#if defined __x86_64__
#define ISA_BASELINE sse2
#define ISA_EACH(X, ...) X(sse2, __VA_ARGS__) X(avx2, __VA_ARGS__) X(avx512, __VA_ARGS__)
#elif defined __aarch64__
#define ISA_BASELINE neon
#define ISA_EACH(X, ...) X(neon, __VA_ARGS__)
#elif defined __wasm_simd128__
#define ISA_BASELINE simd128
#define ISA_EACH(X, ...) X(simd128, __VA_ARGS__)
#else
#define ISA_BASELINE plain
#define ISA_EACH(X, ...) X(plain, __VA_ARGS__)
#endif

#define ISA_MEMBER(set, ...) ISA_##set,
typedef enum isa { ISA_EACH(ISA_MEMBER, ) ISA_COUNT, ISA_BASE = 0 } isa;

/* The functions that *_kernel.c defines as KERNEL(name): ISA_DECLARE declares one per set, ISA_ARRAY lists them, and
 * ISA_BASE_OF names the baseline's. A function's type needs no `extern`. */
#define ISA_DECLARED(set, type, name) extern type name##_##set;
#define ISA_DECLARE(type, name) ISA_EACH(ISA_DECLARED, type, name)
#define ISA_ADDRESS(set, name) &name##_##set,
#define ISA_ARRAY(name)             \
    {                               \
        ISA_EACH(ISA_ADDRESS, name) \
    }
#define ISA_PASTE(name, set) name##_##set
#define ISA_PASTED(name, set) ISA_PASTE(name, set)
#define ISA_BASE_OF(name) ISA_PASTED(name, ISA_BASELINE)

/* ---- in *_kernel.c ---- */

/* Names of functions that are compiled once per instruction set: KERNEL(f) is f_SET, such as f_avx2, by the
 * KERNEL_ISA that the Makefile defines for *_kernel.c. A loop under the comment VECTORISE must be vectorised for AVX2
 * and AVX-512 by gcc and clang; `make vectorise` checks it. */
#define KERNEL_PASTE(name, isa) name##_##isa
#define KERNEL_NAME(name, isa) KERNEL_PASTE(name, isa)
#define KERNEL(name) KERNEL_NAME(name, KERNEL_ISA)

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* Precedes a loop in which no iteration reads what another writes. clang ignores restrict of local variables: without
 * this pragma it compares every pair of arrays at run time, and leaves loops with many arrays scalar. */
#ifdef __clang__
#define INDEPENDENT_LANES _Pragma("clang loop vectorize(assume_safety)")
#else
#define INDEPENDENT_LANES _Pragma("GCC ivdep")
#endif

/* ---- choice at run time ---- */

/* The best set that this processor supports. */
isa isa_best(void);

/* The set to use: CUVETTE_ISA if set, otherwise the best one. STATUS_BAD_INPUT for an unknown set or one that this
 * processor does not support. */
status isa_choose(isa *out, diagnostic *why);
/* The same for a name that the caller of the engine passes. */
status isa_named(const char *name, isa *out, diagnostic *why);

/* Such as "avx2". */
const char *isa_name(isa level);
