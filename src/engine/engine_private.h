/* Internals of the engine: the content of its handles, and the conversion of the library's errors into those of
 * cuvette.h. Ownership as in cuvette.h. */
#pragma once

#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/isa.h"
#include "base/vec3.h"
#include "cuvette.h"
#include "geometry/rays.h"
#include "geometry/regions/instance_set.h"
#include "image/codec.h"
#include "job/job.h"
#include "render/inspect/probe.h"
#include "render/plan/film.h"
#include "render/plan/plan.h"
#include "render/shade/shading.h"
#include "scene/model/open.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

struct cuvette_scene {
    scene *model;
    pthread_mutex_t loading; /* held while files are loaded; what was loaded is read-only afterwards */
    atomic_int renders;      /* renders in progress */
    atomic_bool advancing;   /* a motion advances its slimes */
    /* the handle and the motions created from it: the last owner frees this struct; destroying the handle frees the
     * model */
    atomic_int owners;
    /* number of changes that invalidate a motion: a slime was changed, a mesh was removed, or another motion was
     * created */
    uint64_t slimes_changed;
    bool grabbed; /* hands moved its slimes, so that its text does not describe their shapes */
};

struct cuvette_engine {
    job *workers;
    atomic_bool busy;
    cancel_token token; /* cuvette_engine_cancel sets it */
};

struct cuvette_frame {
    job_account account;
    size_t solid_count;
    double preview_s;
    scene *scene; /* as it was rendered, for image files; NULL if it cannot be shared */
};

/* Converts the library's status and diagnostic to the caller's; why is written only when code is not STATUS_OK. */
cuvette_status engine_report(status code, const diagnostic *inner, cuvette_diagnostic *why);

/* CUVETTE_BAD_INPUT: `name` must not be NULL. */
cuvette_status engine_missing(const char *name, cuvette_diagnostic *why);

/* CUVETTE_OK when none of the arguments is NULL; names lists them as "name, by", and &engine_list_end ends
 * arguments. */
cuvette_status engine_need(const char *names, const void *const *arguments, cuvette_diagnostic *why);
/* The same, and the first argument, a scene, must not be in use by a render or an advance. */
cuvette_status engine_need_change(const char *names, const void *const *arguments, cuvette_diagnostic *why);
extern const char engine_list_end;

/* The instruction set of that name, or the default one if name is NULL. */
status engine_isa(const char *name, isa *out, diagnostic *why);

/* A render and an advance exclude each other: the one that comes second returns CUVETTE_BUSY. */
cuvette_status engine_begin_render(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_render(cuvette_scene *s);
cuvette_status engine_begin_advance(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_advance(cuvette_scene *s);
cuvette_status engine_is_advancing(cuvette_diagnostic *why); /* always CUVETTE_BUSY, with a diagnostic */

/* Creates a handle that owns the model; destroys the model when out of memory. */
cuvette_status engine_own_scene(scene *model, cuvette_scene **out, cuvette_diagnostic *why);

/* Drops one reference; the last one frees the scene. */
void engine_release_scene(cuvette_scene *s);

/* scene_check while other threads may load the scene. */
status engine_check(const cuvette_scene *s, diagnostic *why);

/* Loads the files that the scene names, and its slimes, once; watch as for scene_load_until. */
status engine_load(cuvette_scene *s, const load_watch *watch, diagnostic *why);

/* The caller's progress function, called about ten times per second with a fraction that never decreases. When it
 * returns false, the token is set: the only place where a callback's result ends work. */
typedef struct host_progress {
    bool (*callback)(void *context, double fraction); /* may be NULL */
    void *context;
    float_environment *host; /* the caller's, for the callback */
    double fraction, next_s;
    cancel_token token;
} host_progress;
/* Begins the token, whose ask calls the function even without progress. */
void engine_begin_progress(host_progress *p);
void engine_end_progress(host_progress *p);
/* Calls the function now. */
void engine_report_progress(host_progress *p, double fraction);
/* Calls the function if a tenth of a second has passed. context: a host_progress, because this is a function for
 * load_watch.progress. */
void engine_report_if_due(void *context, double fraction);

/* Copies content, of `known` bytes, into the caller's struct of an older or a newer version, up to the caller's size;
 * the size field with which both begin is not changed. */
cuvette_status engine_copy_struct(const void *content, size_t known, void *out, cuvette_diagnostic *why);

static inline vec3 engine_vector(const double v[3])
{
    return vec3_make(v[0], v[1], v[2]);
}
static inline bool engine_is_finite(const double v[3])
{
    return vec3_is_finite(engine_vector(v));
}
static inline void engine_put_vector(double out[3], vec3 v)
{
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
}
/* Checks a ray of the caller: ray i of a query on the plan p, or, if p is NULL, a single ray whose start is ignored. */
struct plan;
status engine_check_ray(const struct plan *p, const cuvette_ray *ray, size_t i, diagnostic *why);

/* d / |d|, without intermediate over- or underflow; a vector that is a unit vector up to rounding is returned
 * unchanged, to the bit. */
vec3 engine_unit(const double *d);

/* Copies content, which it frees, into the caller's memory. */
cuvette_status engine_copy_text(char *content, char *text, size_t size, size_t *length, cuvette_diagnostic *why);

/* First statement of each function of cuvette.h that can fail: the function computes in the default floating-point
 * environment, and the caller's is restored on every return (the cleanup attribute is one of gcc and clang). Callbacks
 * run in the caller's environment: put float_environment_leave(&host) before and float_environment_enter(&host) after a
 * call of one. inner receives the diagnostics of the library's functions. */
#define ENGINE_ENTER()                                                        \
    float_environment host __attribute__((cleanup(float_environment_leave))); \
    float_environment_enter(&host);                                           \
    __attribute__((unused)) diagnostic inner = {.line = 0}

/* Returns CUVETTE_BAD_INPUT, with a diagnostic in why, when one of the arguments is NULL. An argument whose name in
 * cuvette.h is also a type of the library has another name in the definition: s for a scene; for others
 * ENGINE_NEED_NAMED has both names. */
#define ENGINE_NEED_NAMED(argument, name)     \
    do {                                      \
        if (!(argument))                      \
            return engine_missing(name, why); \
    } while (0)
#define ENGINE_NEED(...) ENGINE_TRY(engine_need(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

/* First statement of a function that needs these arguments; ENGINE_CHANGE for one that changes the scene, its first
 * argument: it also returns when the scene is being rendered, or its slimes are being advanced. */
#define ENGINE_CALL(...) \
    ENGINE_ENTER();      \
    ENGINE_NEED(__VA_ARGS__)
#define ENGINE_CHANGE(...) \
    ENGINE_ENTER();        \
    ENGINE_TRY(engine_need_change(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

#define ENGINE_LIST(...) ((const void *const[]){__VA_ARGS__, &engine_list_end})
/* Returns the call's result unless that is CUVETTE_OK. */
#define ENGINE_TRY(call)                    \
    do {                                    \
        const cuvette_status needed = call; \
        if (needed != CUVETTE_OK)           \
            return needed;                  \
    } while (0)

/* Internals of a query, shared by query.c (creation), query_rays.c (ray queries), tree.c, fan.c and wasm/api/query.c
 * (ray trees): the query, the scratch memory of a call, and the nodes of a tree. */

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

/* The canvas: the caller's buffers and the list of their finished tiles. Workers fill tiles and record them; the
 * calling thread passes the records to the caller. Ownership: canvas_open allocates, canvas_close releases; film and
 * request are borrowed. */

typedef struct canvas {
    const cuvette_request *request; /* validated; strides are not 0 */
    float_environment *host;        /* the caller's, for callbacks */
    codec_bytes *bytes;             /* NULL unless the request has srgb */
    pthread_mutex_t lock;           /* protects the fields below */
    cuvette_tile *noted;
    size_t count, capacity;
    bool out_of_memory;
} canvas;

/* Checks the caller's stride for height rows of width pixels, in elements of element_bytes; 0 becomes the stride of
 * contiguous rows. STATUS_BAD_INPUT if it is shorter than a row, or the last row would end beyond the largest object
 * (PTRDIFF_MAX bytes). */
status canvas_stride(size_t *stride, size_t element_bytes, int width, int height, diagnostic *why);

status canvas_open(const cuvette_request *request, float_environment *host, canvas *c, diagnostic *why);
void canvas_close(canvas *c);

/* Copies a rectangle of the film; each of its pixels becomes a square of `coarse` x `coarse` pixels, clipped at the
 * image's edge. */
void canvas_fill(const canvas *c, const film *f, int x0, int y0, int x1, int y1, int coarse);

/* canvas_note records a tile, from any thread; canvas_hand_out passes the recorded tiles to the callback, on the
 * caller's thread. */
void canvas_note(canvas *c, cuvette_tile tile);
status canvas_hand_out(canvas *c, diagnostic *why);
/* Passes a single tile to the callback. */
void canvas_hand_tile(canvas *c, const cuvette_tile *tile);

/* Writes a rectangle of the film as sRGB bytes; stride: bytes from one row to the next. */
void canvas_bytes(const film *f, const codec_bytes *bytes, int x0, int y0, int x1, int y1, unsigned char *srgb,
                  size_t stride);
