/* The choice of the instruction set at run time. */
#include "base/isa.h"

#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"sse2", "avx2", "avx512"};

const char *isa_name(isa level)
{
    return names[level];
}

isa isa_best(void)
{
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl"))
        return ISA_AVX512;
    return __builtin_cpu_supports("avx2") ? ISA_AVX2 : ISA_SSE2;
}

status isa_choose(isa *out, diagnostic *why)
{
    const char *wanted = getenv("CUVETTE_ISA");
    *out = isa_best();
    if (!wanted || !*wanted)
        return STATUS_OK;
    for (int level = 0; level < ISA_COUNT; level++) {
        if (strcmp(wanted, names[level]) != 0)
            continue;
        if (level > (int)*out)
            return diagnose(why, STATUS_BAD_INPUT, "unset it, or choose a lower level",
                            "CUVETTE_ISA=%s is not supported by this processor, which has %s", wanted, names[*out]);
        *out = (isa)level;
        return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "use sse2, avx2 or avx512", "CUVETTE_ISA=%s is not an instruction set",
                    wanted);
}
