/* The selection of vector instructions for the kernels. The kernels are plain C, compiled once per level from one
 * source; the best level that the processor supports is chosen at run time, and CUVETTE_ISA selects a lower one (sse2,
 * avx2, avx512). The results are bit-identical. */
#pragma once

#include "base/status.h"

typedef enum isa { ISA_SSE2, ISA_AVX2, ISA_AVX512, ISA_COUNT } isa;

/* The best level that this processor supports. */
isa isa_best(void);

/* The level to use: CUVETTE_ISA if set, otherwise the best one. STATUS_BAD_INPUT for an unknown level or one that this
 * processor does not support. */
status isa_choose(isa *out, diagnostic *why);

/* "sse2", "avx2", "avx512". */
const char *isa_name(isa level);
