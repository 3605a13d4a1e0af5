/* Internals of a query, shared by query.c (creation), query_rays.c (ray queries), tree.c, fan.c and wasm/api/query.c
 * (ray trees): the query, the scratch memory of a call, and the nodes of a tree. */
#pragma once

#include "base/cancel.h"
#include "engine/engine_private.h"
#include "geometry/rays.h"
#include "geometry/regions/instance_set.h"
#include "render/inspect/probe.h"
#include "render/plan/plan.h"
#include "render/shade/shading.h"

#include <stdio.h>

typedef struct query_buffers {
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
    struct query_buffers *next;
} query_buffers;

/* A call of the query that another thread can cancel, from query_call_begin to query_call_end on one thread. */
typedef struct query_call {
    const cuvette_query *of;
    unsigned cancels; /* the query's value when the call began */
    cancel_token token;
} query_call;

struct cuvette_query {
    scene *model; /* a copy of the scene, from which the plan borrows */
    plan *ready;
    const geometry_kernels *kernels;
    cover_source cover; /* of partial surfaces, for the batches */
    pthread_mutex_t lock;
    query_buffers *free_buffers;
    isa level;
    pthread_mutex_t tracing; /* held while the probe traces */
    query_call traced;       /* the call that holds it */
    probe *inspector;        /* created by the first tree */
    atomic_uint cancels;     /* number of calls of cuvette_query_cancel, which ends the work that began before */
    bool one_wavelength;     /* absorption, too, is taken at render.lambda_nm */
    atomic_int owners;       /* the handle, and the trees and fans, which use the scene's names */
};

void query_call_begin(query_call *call, const cuvette_query *query);
void query_call_end(query_call *call);
/* For loops over many rays, which check this instead of a token. */
static inline unsigned query_cancels(const cuvette_query *query)
{
    return atomic_load_explicit(&query->cancels, memory_order_relaxed);
}
status query_cancelled(diagnostic *why);

/* Locks the query's probe for the caller until query_end_trace. */
status query_begin_trace(const cuvette_query *query, cuvette_query **out, diagnostic *why);
void query_end_trace(cuvette_query *query);
/* Adds an owner; cuvette_query_destroy removes one. */
cuvette_query *query_retain(cuvette_query *query);

/* The nodes of a tree for the caller, newly allocated; NULL when out of memory. */
cuvette_node *tree_nodes_make(const cuvette_query *query, const ray_node *nodes, size_t count);

/* Writes a text file with one of the writers of a traced result, by the path's ending; remedy: names the endings. */
typedef struct ray_writer {
    const char *ending;
    status (*write)(const void *content, FILE *out, diagnostic *why);
} ray_writer;
status query_write_file(const ray_writer *writers, size_t count, const char *remedy, const void *content,
                        const char *path, diagnostic *why);

/* The memory of one call, from the free list or newly allocated; NULL when out of memory. */
query_buffers *query_acquire_buffers(const cuvette_query *query);
void query_release_buffers(const cuvette_query *query, query_buffers *b);
