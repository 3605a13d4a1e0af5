/* Ray trees: traced by the query's probe, copied into the caller's form of a node; and the rays of a scene's beams,
 * each with its tree. */
#include "base/file.h"
#include "engine/engine_private.h"
#include "render/inspect/beams.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct cuvette_tree {
    cuvette_query *query;
    ray_tree traced;
    cuvette_node *nodes;
};

_Static_assert((int)CUVETTE_RAY_CAMERA == (int)RAY_CAMERA && (int)CUVETTE_RAY_SHADOW == (int)RAY_SHADOW, "kinds");
_Static_assert((int)CUVETTE_END_HIT == (int)RAY_END_HIT && (int)CUVETTE_END_BLOCKED == (int)RAY_END_BLOCKED, "ends");
_Static_assert((int)CUVETTE_OUTSIDE == (int)RAY_OUTSIDE, "media");

static void put_hit(const cuvette_query *q, const ray_hit *h, cuvette_node *out)
{
    out->distance = h->t;
    engine_put_vector(out->point, h->point);
    engine_put_vector(out->normal, h->normal);
    out->error = h->error_bound;
    out->solid = h->solid, out->before = h->from, out->after = h->to;
    out->opaque = h->opaque, out->total_internal = h->tir;
    out->solid_name = scene_solid_name(q->model, h->solid);
    out->face_name = probe_face_name(q->inspector, h);
    out->n_before = h->n_from, out->n_after = h->n_to;
    out->cos_in = h->cos_i, out->cos_out = h->cos_t;
    out->R_s = h->R_s, out->R_p = h->R_p, out->R = h->R, out->T = h->T;
    out->gain_classic = h->gain_classic, out->gain_basic = h->gain_basic;
    out->length_m = h->path_length_m;
    memcpy(out->transmittance, h->transmittance, sizeof out->transmittance);
    out->angle_in_deg = trace_angle_deg(h->cos_i);
    out->angle_out_deg = h->opaque || h->tir ? 0 : trace_angle_deg(h->cos_t);
}

static void put_node(const cuvette_query *q, const ray_node *n, cuvette_node *out)
{
    *out = (cuvette_node){.kind = (int32_t)n->kind,
                          .end = (int32_t)n->end,
                          .depth = n->depth,
                          .parent = n->parent,
                          .first_child = n->first_child,
                          .next = n->next,
                          .n = n->n,
                          .medium_name = probe_medium_name(q->inspector, n->medium),
                          .medium = n->medium,
                          .light = n->light,
                          .light_distance = n->light_distance,
                          .light_transmittance = n->shadow_transmittance};
    engine_put_vector(out->origin, n->origin);
    engine_put_vector(out->direction, n->direction);
    memcpy(out->weight, n->throughput, sizeof out->weight);
    memcpy(out->stokes, n->stokes, sizeof out->stokes);
    memcpy(out->added, n->contribution, sizeof out->added);
    if (n->end == RAY_END_HIT)
        put_hit(q, &n->hit, out);
}

cuvette_node *tree_nodes_make(const cuvette_query *query, const ray_node *nodes, size_t count)
{
    cuvette_node *made = calloc(count + 1, sizeof *made);
    for (size_t i = 0; made && i < count; i++)
        put_node(query, &nodes[i], &made[i]);
    return made;
}

void cuvette_tree_destroy(cuvette_tree *tree)
{
    if (!tree)
        return;
    free(tree->nodes);
    ray_tree_release(&tree->traced);
    cuvette_query_destroy(tree->query);
    free(tree);
}

static status copy_tree(const ray_tree *from, ray_tree *out, diagnostic *why)
{
    *out = *from;
    out->node = malloc((from->count + 1) * sizeof *out->node);
    out->capacity = from->count + 1;
    if (!out->node) {
        *out = (ray_tree){0};
        return out_of_memory(why);
    }
    memcpy(out->node, from->node, from->count * sizeof *out->node);
    return STATUS_OK;
}

/* Names come from the query's probe, because the beam's probe does not outlive the visit. */
static status add_nodes(cuvette_query *query, cuvette_tree *tree, diagnostic *why)
{
    cuvette_query *q = NULL;
    TRY(query_begin_trace(query, &q, why));
    tree->nodes = tree_nodes_make(q, tree->traced.node, tree->traced.count);
    query_end_trace(q);
    return tree->nodes ? STATUS_OK : out_of_memory(why);
}

/* Copies a tree, which another probe of the query's scene traced, for the caller. */
static status tree_copy(cuvette_query *query, const ray_tree *from, cuvette_tree **out, diagnostic *why)
{
    *out = NULL;
    cuvette_tree *tree = calloc(1, sizeof *tree);
    if (!tree)
        return out_of_memory(why);
    tree->query = query_retain(query);
    status code = copy_tree(from, &tree->traced, why);
    THEN(code, add_nodes(query, tree, why));
    if (code == STATUS_OK)
        *out = tree;
    else
        cuvette_tree_destroy(tree);
    return code;
}

/* The start of a tree: a pixel or a ray. */
typedef struct tree_root {
    const cuvette_ray *ray; /* NULL: the pixel */
    int x, y;
} tree_root;

static status trace_root(cuvette_query *q, const tree_root *root, cuvette_tree *tree, diagnostic *why)
{
    const cuvette_ray *r = root->ray;
    const status code =
        r ? probe_ray(q->inspector, engine_vector(r->origin), engine_vector(r->direction), &tree->traced, why)
          : probe_pixel(q->inspector, root->x, root->y, &tree->traced, why);
    if (code != STATUS_OK)
        return code;
    tree->nodes = tree_nodes_make(q, tree->traced.node, tree->traced.count);
    return tree->nodes ? STATUS_OK : out_of_memory(why);
}

static cuvette_status trace(const cuvette_query *query, const tree_root *root, cuvette_tree **out, diagnostic *inner,
                            cuvette_diagnostic *why)
{
    cuvette_query *q = NULL;
    status code = query_begin_trace(query, &q, inner);
    if (code != STATUS_OK)
        return engine_report(code, inner, why);
    cuvette_tree *tree = calloc(1, sizeof *tree);
    if (tree)
        tree->query = query_retain(q);
    code = tree ? trace_root(q, root, tree, inner) : out_of_memory(inner);
    query_end_trace(q);
    if (code == STATUS_OK)
        *out = tree;
    else
        cuvette_tree_destroy(tree);
    return engine_report(code, inner, why);
}

cuvette_status cuvette_query_trace(const cuvette_query *query, const cuvette_ray *ray, cuvette_tree **out,
                                   cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(query, ray);
    return trace(query, &(tree_root){.ray = ray}, out, &inner, why);
}

cuvette_status cuvette_query_trace_pixel(const cuvette_query *query, int x, int y, cuvette_tree **out,
                                         cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(query);
    return trace(query, &(tree_root){.x = x, .y = y}, out, &inner, why);
}

const cuvette_node *cuvette_tree_nodes(const cuvette_tree *tree, size_t *count)
{
    if (count)
        *count = tree ? tree->traced.count : 0;
    return tree ? tree->nodes : NULL;
}

cuvette_status cuvette_tree_radiance(const cuvette_tree *tree, double *rgb, cuvette_diagnostic *why)
{
    ENGINE_CALL(tree, rgb);
    memcpy(rgb, tree->traced.radiance, sizeof tree->traced.radiance);
    return CUVETTE_OK;
}

status query_write_file(const ray_writer *writers, size_t count, const char *remedy, const void *content,
                        const char *path, diagnostic *why)
{
    const char *ending = strrchr(path, '.');
    size_t which = 0;
    while (which < count && !(ending && strcasecmp(ending, writers[which].ending) == 0))
        which++;
    if (which == count)
        return diagnose_at(why, path, STATUS_BAD_INPUT, remedy, "unknown file name ending");
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    return file_writer_end(&writer, writers[which].write(content, writer.stream, why), why);
}

static status write_text(const void *content, FILE *out, diagnostic *why)
{
    return trace_write_text(content, out, why);
}

static status write_json(const void *content, FILE *out, diagnostic *why)
{
    return trace_write_json(content, out, why);
}

static status write_csv(const void *content, FILE *out, diagnostic *why)
{
    return trace_write_csv(content, out, why);
}

static status write_drawing(const void *content, FILE *out, diagnostic *why)
{
    return trace_write_drawing(content, out, why);
}

static const ray_writer writers[] = {
    {".txt", write_text}, {".json", write_json}, {".csv", write_csv}, {".svg", write_drawing}};

cuvette_status cuvette_tree_write(const cuvette_tree *tree, const char *path, cuvette_diagnostic *why)
{
    ENGINE_CALL(tree, path);
    cuvette_query *q = NULL;
    status code = query_begin_trace(tree->query, &q, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    const traced content = {q->model, q->inspector, &tree->traced, q->model->path ? q->model->path : "", false};
    code = query_write_file(writers, sizeof writers / sizeof *writers, "use .txt, .json, .csv or .svg", &content, path,
                            &inner);
    query_end_trace(q);
    return engine_report(code, &inner, why);
}

/* --- the rays of a scene's beams --- */

typedef struct beam_call {
    cuvette_query *query;
    bool (*visit)(void *context, const cuvette_beam_ray *ray, cuvette_tree *tree);
    void *context;
    float_environment *host; /* the caller's, for the callback */
    bool stopped;
} beam_call;

static status pass_ray(void *context, const beam_ray *ray, const ray_tree *from, const probe *p, diagnostic *why)
{
    beam_call *c = context;
    cuvette_tree *tree;
    (void)p;
    TRY(tree_copy(c->query, from, &tree, why));
    const cuvette_beam_ray one = {.beam_name = c->query->model->beams[ray->beam].name,
                                  .beam = ray->beam,
                                  .number = ray->number,
                                  .rays = ray->rays,
                                  .field = ray->field,
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
