/* The ray counters of the tracer: plain integers, one set per worker, summed after the join, so that counting costs no
 * synchronisation and the totals do not depend on the number of threads. A ray is a straight segment between two
 * interactions. Camera rays, shadow rays and the rays by depth are counted when traced; reflected and refracted rays
 * when enqueued. Without an interruption the counts by kind and by depth agree, because every queued ray is traced. A
 * build with -DCUVETTE_COUNTERS=0 leaves the per-ray counters at zero. Ownership: values. */
#pragma once

#include "base/lanes.h"
#include <assert.h>
#include <stdint.h>

#ifndef CUVETTE_COUNTERS
#define CUVETTE_COUNTERS 1
#endif

enum {
    COUNTERS_DEPTH_MAX = 64, /* deeper rays are counted with those of this depth */
    COUNTERS_SOLID_MAX = 64, /* the first solids of a scene: only these are counted one by one */
    COUNTERS_FACTORS = 9     /* entries of `undersampled` */
};

/* The throughput of cut rays is summed in fixed point, COUNTERS_CUT_ONE for 1.0, so that the order of summation does
 * not matter. */
#define COUNTERS_CUT_ONE 68719476736.0 /* 2^36 */

/* Intersection tests in the hierarchies of meshes. Each ray counts as if it were alone in its packet: see
 * hierarchy_count in geometry/hierarchy/hierarchy.h. */
typedef struct query_counts {
    uint64_t rays;      /* queries of one ray each */
    uint64_t nodes;     /* nodes entered: inner nodes of a BVH, spheres of a tree of spheres */
    uint64_t boxes;     /* boxes, or spheres, tested */
    uint64_t triangles; /* triangles of entered leaves or nodes, each tested once */
} query_counts;

typedef struct ray_counters {
    uint64_t camera, reflect, refract, shadow; /* rays traced, by kind */
    uint64_t photon;                           /* rays of photons */
    /* camera, reflected and refracted rays by depth; the last element includes deeper rays */
    uint64_t by_depth[COUNTERS_DEPTH_MAX + 1];
    uint64_t total_internal;         /* total internal reflections */
    uint64_t cut_depth, cut_weight;  /* rays not traced: beyond the last depth; under min_weight */
    int64_t cut_depth_throughput[3]; /* RGB throughput of cut_depth, in units of 1/COUNTERS_CUT_ONE */
    int64_t cut_weight_throughput[3];
    /* light of photons on footprints that are guessed, summed over pixels and channels, in the same units. [k]: samples
     * k times as dense along each side would resolve it; [1]: the present ones do; [0]: a larger factor is needed. See
     * photon_map_seen */
    int64_t undersampled[COUNTERS_FACTORS];
    /* rays tested against the solid; 0 for a solid in a hierarchy (geometry/regions/solid_tree.h). Shadow rays count
     * for solids that cast shadows (region_casts_shadow), and for all solids if the surroundings attenuate light. A
     * shadow ray counts once, even if the quick test leaves it undecided and it is tested again */
    uint64_t tests[COUNTERS_SOLID_MAX];
    uint64_t hits[COUNTERS_SOLID_MAX];       /* hits on the solid's interfaces, without shadow rays and photons */
    uint64_t first_hits[COUNTERS_SOLID_MAX]; /* camera rays whose first interface is on the solid */
    query_counts queries;                    /* 0 without render.count_tests */
} ray_counters;

/* Throughput (0 .. 1) rounded to units of 1/COUNTERS_CUT_ONE, by the bits of 1.5 2^52 + v: a conversion that every
 * instruction set supports. */
static inline int64_t counters_cut_units(double throughput)
{
    return lanes_bits(throughput * COUNTERS_CUT_ONE + 6755399441055744.0) - lanes_bits(6755399441055744.0);
}

static_assert(sizeof(ray_counters) % sizeof(uint64_t) == 0, "ray_counters consists only of 64-bit integers");

/* Adds *from to *into, field by field. */
static inline void ray_counters_add(ray_counters *into, const ray_counters *from)
{
    uint64_t *sum = (uint64_t *)into;
    const uint64_t *term = (const uint64_t *)from;
    for (unsigned i = 0; i < sizeof *into / sizeof *sum; i++)
        sum[i] += term[i];
}

static inline uint64_t ray_counters_total(const ray_counters *counters)
{
    return counters->camera + counters->reflect + counters->refract + counters->shadow + counters->photon;
}
