/* Which vector instructions the kernels use. The kernels are plain C, compiled once for each level from
 * one source; the best level that this processor has is chosen at run time, and CUVETTE_ISA forces a
 * lower one (sse2, avx2, avx512). The results are the same to the bit. */
#pragma once

#include "base/status.h"

typedef enum isa { ISA_SSE2, ISA_AVX2, ISA_AVX512, ISA_COUNT } isa;

/* The best level of this processor. */
isa isa_best(void);

/* The level to use: CUVETTE_ISA if it is set, else the best one. STATUS_BAD_INPUT if it names no level or
 * one that this processor lacks. */
status isa_choose(isa *out, diagnostic *why);

/* "sse2", "avx2", "avx512". */
const char *isa_name(isa level);
