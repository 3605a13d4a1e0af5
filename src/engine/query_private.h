/* A query and what a call works on, shared by query.c (what it is) and query_rays.c (what it is asked). */
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
    /* Those of the batch that met one primitive, side by side. */
    _Alignas(64) double gox[ROW], goy[ROW], goz[ROW], gdx[ROW], gdy[ROW], gdz[ROW], t[ROW];
    int64_t gstart[ROW];
    uint64_t ginside[ROW];
    int list[ROW];
    surface_batch points;
    mesh_scratch meshes;
    instance_hit mesh_hits[ROW];
    mesh_points on_mesh;
    double transmitted[ROW];
    size_t asked[ROW]; /* which of the caller's rays a column is */
    struct bench *next;
} bench;

struct cuvette_query {
    scene *model; /* its own copy, which the plan borrows from */
    plan *ready;
    const geometry_kernels *kernels;
    pthread_mutex_t lock;
    bench *shelf;
};

/* From the shelf, or new; NULL when memory is out. */
bench *query_take_bench(const cuvette_query *query);
void query_give_bench(const cuvette_query *query, bench *b);
