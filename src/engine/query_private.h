/* Internals of a query, shared by query.c (creation) and query_rays.c (ray queries): the query and the scratch memory
 * of a call. */
#pragma once

#include "engine/engine_private.h"
#include "geometry/instance_set.h"
#include "geometry/rays.h"
#include "render/core/plan.h"

typedef struct bench {
    _Alignas(64) ray_scratch scratch;
    _Alignas(64) hit_batch hits;
    _Alignas(64) double ox[ROW], oy[ROW], oz[ROW], dx[ROW], dy[ROW], dz[ROW];
    int64_t start[ROW];
    uint64_t inside[ROW];
    /* The rays of the batch that hit one primitive, contiguous. */
    _Alignas(64) double gox[ROW], goy[ROW], goz[ROW], gdx[ROW], gdy[ROW], gdz[ROW], t[ROW];
    int64_t gstart[ROW];
    uint64_t ginside[ROW];
    int list[ROW];
    surface_batch points;
    mesh_scratch meshes;
    instance_hit mesh_hits[ROW];
    mesh_points on_mesh;
    double transmitted[ROW];
    size_t caller_index[ROW]; /* the index of the caller's ray in each column */
    struct bench *next;
} bench;

struct cuvette_query {
    scene *model; /* its own copy, from which the plan borrows */
    plan *ready;
    const geometry_kernels *kernels;
    pthread_mutex_t lock;
    bench *free_benches;
};

/* Takes a bench from the free list, or allocates one; NULL when out of memory. */
bench *query_take_bench(const cuvette_query *query);
void query_give_bench(const cuvette_query *query, bench *b);
