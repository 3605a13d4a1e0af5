/* The tracer's inside, shared by tracer.c (which rays when) and shading.c (what becomes of rays that met a surface). */
#ifndef CUVETTE_RENDER_TRACER_PRIVATE_H
#define CUVETTE_RENDER_TRACER_PRIVATE_H

#include "render/shade.h"
#include "render/tracer.h"

struct tracer {
    const geometry_kernels *geometry;
    const shade_kernels *shade;
    tracer_target target;
    int depth_limit, queue_count;
    ray_queue *waiting;      /* by depth, 0 .. depth_limit */
    ray_queue shadows;
    ray_counters counters;
    uint64_t frame;          /* of its tracer_set, in which it was last begun; 0 before */
    int64_t overflow;        /* negative: a sum or contribution left the film's range */
    _Alignas(64) ray_scratch scratch; /* whole vectors on whole cache lines, here and below */
    _Alignas(64) hit_batch hits;
    _Alignas(64) group gathered;
    _Alignas(64) lit_group lit;
    _Alignas(64) branch_group branches;
    _Alignas(64) double transmitted[ROW];
    int list[PRIMITIVES_MAX + 2][ROW], listed[PRIMITIVES_MAX + 2]; /* see sort_by_primitive */
};

/* A build without counters compiles the statement and throws it away. */
#define COUNT(statement) ((void)(CUVETTE_COUNTERS ? (statement) : 0))

/* Adds radiance to a pixel. */
void shading_expose(tracer *t, int64_t pixel, double r, double g, double b);

/* Adds what the sky sends along a direction, weighted. */
void shading_expose_sky(tracer *t, int64_t pixel, vec3 direction, double wr, double wg, double wb);

/* Shades rays list[0 .. count-1] of the batch at `first` in the queue of a depth, all of which met primitive `met` as the surface of the
 * body of that rank: local light, shadow rays and children put in line. */
void shading_group(tracer *t, int depth, int first, int met, int rank, const int *list, int count);

#endif
