/* The ray counters of the tracer: plain integers, one set per worker, summed after the join, so that counting costs no
 * synchronisation and the totals do not depend on the number of threads. A ray is one straight segment between two
 * events; it is counted when it is traced, not when it is spawned. A build with -DCUVETTE_COUNTERS=0 leaves the per-ray
 * counters at zero. Ownership: values. */
#pragma once

#include "base/lanes.h"
#include <stdint.h>

#ifndef CUVETTE_COUNTERS
#define CUVETTE_COUNTERS 1
#endif

enum {
    COUNTERS_DEPTH_MAX = 64, /* render.depth is 0..64 */
    COUNTERS_SOLID_MAX = 64  /* solids of a scene */
};

/* Throughput is summed in fixed point, CUT_ONE = 1.0, so that the sum is independent of the order. */
#define COUNTERS_CUT_ONE 68719476736.0 /* 2^36 */

typedef struct ray_counters {
    uint64_t camera, reflect, refract, shadow; /* rays traced, by kind */
    uint64_t by_depth[COUNTERS_DEPTH_MAX + 1]; /* camera, reflected and refracted rays by depth */
    uint64_t total_internal;                   /* total internal reflections */
    uint64_t cut_depth, cut_weight;            /* rays not traced: beyond the maximum depth; under min_weight */
    int64_t cut_depth_throughput[3];           /* their throughput, RGB, in units of 1/COUNTERS_CUT_ONE */
    int64_t cut_weight_throughput[3];
    /* Rays tested against the solid: all except shadow rays, and the shadow rays tested against solids that can reduce
     * light by themselves (the second, exact test of a few undecided shadow rays is not counted again). */
    uint64_t tests[COUNTERS_SOLID_MAX];
    uint64_t hits[COUNTERS_SOLID_MAX];       /* interfaces hit on the solid, without shadow rays */
    uint64_t first_hits[COUNTERS_SOLID_MAX]; /* camera rays whose first interface is on the solid */
} ray_counters;

/* Throughput (0 .. 1) in those units, rounded to nearest; by the bits of 1.5 2^52 + v, a conversion that every
 * instruction set supports. */
static inline int64_t counters_cut_units(double throughput)
{
    return lanes_bits(throughput * COUNTERS_CUT_ONE + 6755399441055744.0) - lanes_bits(6755399441055744.0);
}

/* Adds from to *into, field by field. */
void ray_counters_add(ray_counters *into, const ray_counters *from);

/* camera + reflect + refract + shadow. */
uint64_t ray_counters_total(const ray_counters *counters);
