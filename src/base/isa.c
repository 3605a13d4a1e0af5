/* The choice of the instruction set at run time. */
#include "base/isa.h"

#include <stdlib.h>
#include <string.h>

#define NAME(set, ...) #set,
#define LISTED(set, ...) " " #set
static const char *const names[] = {ISA_EACH(NAME, )};
static const char listed[] = ISA_EACH(LISTED, );

const char *isa_name(isa level)
{
    return names[level];
}

isa isa_best(void)
{
#if defined __x86_64__
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl"))
        return ISA_avx512;
    return __builtin_cpu_supports("avx2") ? ISA_avx2 : ISA_sse2;
#else
    return (isa)(ISA_COUNT - 1);
#endif
}

/* The index of the name in the list; ISA_COUNT if it is not there. */
static isa find(const char *name)
{
    int level = 0;
    while (level < ISA_COUNT && strcmp(name, names[level]) != 0)
        level++;
    return (isa)level;
}

status isa_choose(isa *out, diagnostic *why)
{
    const char *wanted = getenv("CUVETTE_ISA");
    const isa best = isa_best();
    const isa level = wanted && *wanted ? find(wanted) : best;
    if (level == ISA_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "unset it, or use one of these",
                        "CUVETTE_ISA=%s is not an instruction set; this architecture has%s", wanted, listed);
    if (level > best)
        return diagnose(why, STATUS_BAD_INPUT, "unset it, or choose a lower level",
                        "CUVETTE_ISA=%s is not supported by this processor, which has %s", wanted, names[best]);
    *out = level;
    return STATUS_OK;
}

status isa_named(const char *name, isa *out, diagnostic *why)
{
    const isa level = find(name);
    if (level == ISA_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "pass NULL for the best one, or use one of these",
                        "unknown instruction set '%.64s'; this architecture has%s", name, listed);
    if (level > isa_best())
        return diagnose(why, STATUS_BAD_INPUT, "pass NULL for the best supported one",
                        "this processor does not support %s", name);
    *out = level;
    return STATUS_OK;
}
