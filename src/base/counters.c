/* Sums of ray counters. */
#include "base/counters.h"

/* The struct consists only of 64-bit integers, so its sum is one loop. */
_Static_assert(sizeof(ray_counters) % sizeof(uint64_t) == 0, "ray_counters is an array of 64-bit integers");

void ray_counters_add(ray_counters *into, const ray_counters *from)
{
    uint64_t *sum = (uint64_t *)into;
    const uint64_t *term = (const uint64_t *)from;
    for (unsigned i = 0; i < sizeof *into / sizeof *sum; i++)
        sum[i] += term[i];
}

uint64_t ray_counters_total(const ray_counters *counters)
{
    return counters->camera + counters->reflect + counters->refract + counters->shadow + counters->photon;
}
