/* Queries: a scene prepared for the caller's rays. A query is immutable; the scratch memory of a call (query_buffers)
 * is taken from a free list and returned to it, so that any number of threads may query, and a single ray costs no
 * allocation. */
#include "base/number.h"
#include "engine/engine_private.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void cuvette_query_destroy(cuvette_query *query)
{
    if (!query || atomic_fetch_sub(&query->owners, 1) > 1)
        return;
    while (query->free_buffers) {
        query_buffers *b = query->free_buffers;
        query->free_buffers = b->next;
        free(b);
    }
    probe_destroy(query->inspector);
    plan_destroy(query->ready);
    scene_destroy(query->model);
    pthread_mutex_destroy(&query->lock);
    pthread_mutex_destroy(&query->tracing);
    free(query);
}

/* lambda_nm: text of the only wavelength, or NULL. */
static status prepare(cuvette_query *q, const scene *s, const char *lambda_nm, const char *instructions,
                      diagnostic *why)
{
    static const geometry_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(geometry_kernels);
    isa level = ISA_BASE;
    scene traced = *s; /* borrows what s owns */
    if (integrator_traits_of(&s->render)->drawn)
        use_whitted(&traced.render); /* rays need the hierarchies, which rasterisation does not build */
    status code = engine_isa(instructions, &level, why);
    THEN(code, scene_check(s, why));
    if (code != STATUS_OK)
        return code;
    q->level = level;
    q->kernels = kernels[level];
    q->model = scene_clone(&traced);
    code = q->model ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && lambda_nm)
        code = scene_set(q->model, "render.lambda_nm", lambda_nm, why);
    q->one_wavelength = lambda_nm != NULL;
    THEN(code, plan_build(q->model, &q->ready, why));
    q->cover = (cover_source){q->ready, q->kernels};
    return code;
}

static cuvette_query *new_query(void)
{
    cuvette_query *q = calloc(1, sizeof *q);
    if (!q || pthread_mutex_init(&q->lock, NULL) != 0) {
        free(q);
        return NULL;
    }
    if (pthread_mutex_init(&q->tracing, NULL) != 0) {
        pthread_mutex_destroy(&q->lock);
        free(q);
        return NULL;
    }
    atomic_init(&q->owners, 1);
    return q;
}

cuvette_query *query_retain(cuvette_query *query)
{
    atomic_fetch_add(&query->owners, 1);
    return query;
}

void cuvette_query_cancel(cuvette_query *query)
{
    if (query)
        atomic_fetch_add_explicit(&query->cancels, 1, memory_order_relaxed);
}

status query_cancelled(diagnostic *why)
{
    return diagnose(why, STATUS_INTERRUPTED, "", "cancelled");
}

static bool is_cancelled(void *context)
{
    const query_call *call = context;
    return query_cancels(call->of) != call->cancels;
}

static void begin_since(query_call *call, const cuvette_query *query, unsigned cancels)
{
    *call = (query_call){.of = query, .cancels = cancels, .token = {.ask = is_cancelled, .context = call}};
    cancel_begin(&call->token);
}

void query_call_begin(query_call *call, const cuvette_query *query)
{
    begin_since(call, query, query_cancels(query));
}

void query_call_end(query_call *call)
{
    cancel_end(&call->token);
}

status query_begin_trace(const cuvette_query *query, cuvette_query **out, diagnostic *why)
{
    cuvette_query *q = (cuvette_query *)(uintptr_t)query; /* handles are never const objects */
    const unsigned cancels = query_cancels(q); /* whoever waits for another thread's trace is cancelled too */
    pthread_mutex_lock(&q->tracing);
    begin_since(&q->traced, q, cancels);
    const bool is_new = !q->inspector;
    const status code = is_new ? probe_create(q->model, q->level, &q->inspector, why) : STATUS_OK;
    if (code == STATUS_OK && is_new && q->one_wavelength)
        probe_use_one_wavelength(q->inspector);
    if (code != STATUS_OK)
        query_end_trace(q);
    *out = q;
    return code;
}

void query_end_trace(cuvette_query *query)
{
    query_call_end(&query->traced);
    pthread_mutex_unlock(&query->tracing);
}

static cuvette_status create(const cuvette_scene *s, const char *lambda_nm, const char *instructions,
                             cuvette_query **out, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    cuvette_query *q = new_query();
    if (!q)
        return engine_report(out_of_memory(&inner), &inner, why);
    status code = engine_load((cuvette_scene *)(uintptr_t)s, NULL, &inner); /* handles are never const objects */
    THEN(code, prepare(q, s->model, lambda_nm, instructions, &inner));
    if (code != STATUS_OK) {
        cuvette_query_destroy(q);
        return engine_report(code, &inner, why);
    }
    *out = q;
    return CUVETTE_OK;
}

cuvette_status cuvette_query_create(const cuvette_scene *s, const char *instructions, cuvette_query **out,
                                    cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(s);
    return create(s, NULL, instructions, out, why);
}

cuvette_status cuvette_query_wavelength_create(const cuvette_scene *s, double lambda_nm, const char *instructions,
                                               cuvette_query **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(s);
    char text[NUMBER_TEXT_MAX];
    return create(s, number_format(lambda_nm, text), instructions, out, why);
}

query_buffers *query_acquire_buffers(const cuvette_query *query)
{
    cuvette_query *q = (cuvette_query *)(uintptr_t)query; /* handles are never const objects */
    pthread_mutex_lock(&q->lock);
    query_buffers *b = q->free_buffers;
    if (b)
        q->free_buffers = b->next;
    pthread_mutex_unlock(&q->lock);
    if (!b && (b = aligned_alloc(64, (sizeof *b + 63) / 64 * 64))) {
        b->scratch.segments = NULL;
        b->scratch.crossings = NULL;
        b->scratch.meshes = &b->meshes;
        b->scratch.cover = (surface_cover){cover_cut, &q->cover};
        b->meshes.counts = NULL;
    }
    return b;
}

void query_release_buffers(const cuvette_query *query, query_buffers *b)
{
    cuvette_query *q = (cuvette_query *)(uintptr_t)query;
    pthread_mutex_lock(&q->lock);
    b->next = q->free_buffers;
    q->free_buffers = b;
    pthread_mutex_unlock(&q->lock);
}

cuvette_status cuvette_query_camera_ray(const cuvette_query *query, double x, double y, cuvette_ray *out,
                                        cuvette_diagnostic *why)
{
    ENGINE_CALL(query, out);
    if (!isfinite(x) || !isfinite(y))
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "use finite numbers", "the image point is not finite"),
                             &inner, why);
    const camera_ray chief = camera_chief_ray(&query->ready->view, &query->ready->render, x, y);
    const vec3 eye = chief.origin, d = chief.direction;
    memset(out, 0, sizeof *out);
    out->origin[0] = eye.x, out->origin[1] = eye.y, out->origin[2] = eye.z;
    out->direction[0] = d.x, out->direction[1] = d.y, out->direction[2] = d.z;
    return CUVETTE_OK;
}

cuvette_status cuvette_query_medium(const cuvette_query *query, const double *point, int32_t *at,
                                    cuvette_diagnostic *why)
{
    ENGINE_CALL(query, point);
    ENGINE_NEED_NAMED(at, "solid");
    if (!engine_is_finite(point))
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "use finite numbers", "the point is not finite"),
                             &inner, why);
    const scene_geometry *a = query->ready->geometry;
    *at = a->regions[scene_geometry_priority_index(a, scene_geometry_inside(a, engine_vector(point)))].solid;
    return CUVETTE_OK;
}
