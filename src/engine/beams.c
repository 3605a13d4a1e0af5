/* The rays of a scene's beams, each with its tree. */
#include "engine/query_private.h"

#include "render/inspect/beams.h"
#include "scene/model/scene.h"

typedef struct beam_call {
    cuvette_query *of;
    bool (*visit)(void *context, const cuvette_beam_ray *ray, cuvette_tree *tree);
    void *context;
    float_environment *host; /* the caller's, for the callback */
    bool stopped;
} beam_call;

static status pass_ray(void *context, const beam_ray *ray, const ray_tree *grown, const probe *p, diagnostic *why)
{
    beam_call *c = context;
    cuvette_tree *tree;
    (void)p;
    TRY(tree_copy(c->of, grown, &tree, why));
    const cuvette_beam_ray one = {.beam_name = c->of->model->beams[ray->beam].name,
                                  .beam = ray->beam,
                                  .number = ray->number,
                                  .rays = ray->rays,
                                  .lambda_nm = ray->lambda_nm,
                                  .power = ray->power};
    float_environment_leave(c->host);
    c->stopped = !c->visit(c->context, &one, tree);
    float_environment_enter(c->host);
    return c->stopped ? STATUS_INTERRUPTED : STATUS_OK;
}

cuvette_status cuvette_query_each_beam_ray(const cuvette_query *query,
                                           bool (*visit)(void *context, const cuvette_beam_ray *ray,
                                                         cuvette_tree *tree),
                                           void *context, cuvette_diagnostic *why)
{
    ENGINE_CALL(query);
    ENGINE_NEED_NAMED(visit, "visit");
    cuvette_query *q = (cuvette_query *)(uintptr_t)query; /* handles are never const objects */
    beam_call call = {q, visit, context, &host, false};
    query_call cancellable;
    query_call_begin(&cancellable, query);
    const status code = beams_each_ray(q->model, q->level, 0, pass_ray, &call, &inner);
    query_call_end(&cancellable);
    return engine_report(call.stopped ? STATUS_OK : code, &inner, why);
}
