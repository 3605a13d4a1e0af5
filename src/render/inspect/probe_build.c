/* Building a ray tree: each ray is traced as a batch of one, and the tracer's hits, gathered group, branches and queues
 * are read back. */
#include "render/inspect/probe_private.h"

#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "geometry/regions/instance_set.h"
#include "optics/interface.h"
#include "render/shade/media.h"
#include "render/shade/polarisation.h"
#include "render/shade/rough.h"
#include "render/shade/shading.h"
#include "scene/model/medium.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

status probe_check_ray(vec3 origin, vec3 direction, diagnostic *why)
{
    const double far = 1e6;
    if (!(fabs(origin.x) <= far && fabs(origin.y) <= far && fabs(origin.z) <= far))
        return diagnose(why, STATUS_BAD_INPUT, "start within 1e6 scene units of 0,0,0", "the ray starts too far away");
    if (!(isfinite(direction.x) && isfinite(direction.y) && isfinite(direction.z)))
        return diagnose(why, STATUS_BAD_INPUT, "give finite numbers", "the ray's direction is not finite");
    if (direction.x == 0.0 && direction.y == 0.0 && direction.z == 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "give a direction that is not 0,0,0", "the ray has no direction");
    return STATUS_OK;
}

ray_record probe_free_ray(const probe *p, vec3 origin, vec3 direction)
{
    const double largest = fmax(fabs(direction.x), fmax(fabs(direction.y), fabs(direction.z)));
    /* Avoids over- and underflow of squares; the reciprocal of a subnormal number would overflow. */
    const vec3 scaled = vec3_make(direction.x / largest, direction.y / largest, direction.z / largest);
    const double length2 = vec3_dot(scaled, scaled);
    ray_record r = {.origin = origin, .weight = {1.0, 1.0, 1.0}, .start = FACE_NONE, .depth = 0};
    /* A unit vector up to rounding stays bit-identical, so that a ray of a tree can be traced again. */
    const bool is_unit = fabs(vec3_dot(direction, direction) - 1.0) <= 0x1p-50;
    r.direction = is_unit ? direction : direction_tidy(vec3_scale(scaled, 1.0 / sqrt(length2)));
    r.inside = scene_geometry_inside(p->frame_plan->geometry, origin);
    r.medium_priority_index = scene_geometry_priority_index(p->frame_plan->geometry, r.inside);
    return r;
}

static void read_ray(const ray_queue *q, int i, ray_record *out)
{
    *out = (ray_record){.origin = vec3_make(q->ox[i], q->oy[i], q->oz[i]),
                        .direction = vec3_make(q->dx[i], q->dy[i], q->dz[i]),
                        .weight = {q->wr[i], q->wg[i], q->wb[i]},
                        .stokes = {q->sq[i], q->su[i], q->sv[i]},
                        .start = q->start[i],
                        .inside = q->inside[i]};
}

void probe_read_ray(const probe *p, int depth, int i, ray_record *out)
{
    read_ray(tracer_queue_at(p->rays, depth), i, out);
    out->depth = depth;
    out->medium_priority_index = scene_geometry_priority_index(p->frame_plan->geometry, out->inside);
    const bool in_crystal = p->frame_plan->crystals && p->frame_plan->crystals[out->medium_priority_index].uniaxial;
    if (!p->frame_plan->render.polarisation && !in_crystal)
        memset(out->stokes, 0, sizeof out->stokes);
}

static void enqueue_only(ray_queue *q, const ray_record *r)
{
    q->count = 1;
    q->ox[0] = r->origin.x, q->oy[0] = r->origin.y, q->oz[0] = r->origin.z;
    q->dx[0] = r->direction.x, q->dy[0] = r->direction.y, q->dz[0] = r->direction.z;
    q->wr[0] = r->weight[0], q->wg[0] = r->weight[1], q->wb[0] = r->weight[2];
    q->sq[0] = r->stokes[0], q->su[0] = r->stokes[1], q->sv[0] = r->stokes[2];
    q->start[0] = r->start, q->inside[0] = r->inside, q->sample_key[0] = 0;
}

/* Traces a batch of one ray; contribution: the radiance that the ray added to the film. */
static void run_one(probe *p, int depth, double contribution[3])
{
    film_sum before[3];
    memcpy(before, p->img->sum, sizeof before);
    tracer_run_batch(p->rays, depth);
    for (int c = 0; c < 3; c++)
        contribution[c] = film_radiance(p->img->sum[c] - before[c]);
}

static status add_node(probe *p, ray_tree *tree, const ray_record *r, ray_kind kind, int parent, size_t *at,
                       diagnostic *why)
{
    TRY(cancel_check(why));
    if (tree->count >= PROBE_NODES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, p->remedy, "the tree has more than %d rays", (int)PROBE_NODES_MAX);
    if (tree->count == tree->capacity)
        TRY(memory_budget_check(2 * tree->count * sizeof *tree->node, p->remedy, why, "the tree of rays"));
    if (!GROW(tree->node, tree->capacity, tree->count + 1))
        return diagnose(why, STATUS_FAILURE, p->remedy, "out of memory");
    *at = tree->count++;
    tree->node[*at] = (ray_node){.kind = kind,
                                 .end = RAY_END_SKY,
                                 .depth = r->depth,
                                 .parent = parent,
                                 .first_child = RAY_NONE,
                                 .next = RAY_NONE,
                                 .origin = r->origin,
                                 .direction = r->direction,
                                 .throughput = {r->weight[0], r->weight[1], r->weight[2]},
                                 .stokes = {1.0, r->stokes[0], r->stokes[1], r->stokes[2]},
                                 .medium = p->frame_plan->geometry->regions[r->medium_priority_index].solid,
                                 .n = p->frame_plan->ior[r->medium_priority_index],
                                 .light = RAY_NONE,
                                 .shadow_transmittance = 1.0};
    return STATUS_OK;
}

/* Appends a node to its parent's children. */
static void append_child(ray_tree *tree, int parent, size_t child)
{
    int *link = &tree->node[parent].first_child;
    while (*link != RAY_NONE)
        link = &tree->node[*link].next;
    *link = (int)child;
}

/* The factors of radiance from behind the interface. Simple transmission does not refract, so the indices do not
 * matter. absorbed: the fraction that stays in the surface's layers. */
static void read_gain(const probe *p, double absorbed, ray_hit *h)
{
    const render_settings *r = &p->frame_plan->render;
    const material *m = &p->rays->surface.mat->surface;
    if (h->opaque || h->tir)
        return;
    h->T = m->transparency * (scene_has_constant_weights(r) ? 1.0 : 1.0 - h->R - absorbed);
    const double ratio = r->transmission == TRANSMISSION_SIMPLE ? 1.0 : h->n_from / h->n_to;
    h->gain_classic = h->T;
    h->gain_basic = ratio * ratio * h->T;
}

/* The reflectances of a metal or of layers, at render.lambda_nm, and what the layers absorb. */
typedef struct layer_losses {
    double s, p, mean;
} layer_losses;

static layer_losses read_layers(const probe *p, ray_hit *h)
{
    const layered_work *w = p->rays->layered;
    const bool absorbs = w->surface->stack && w->surface->stack->absorbs;
    const sp_amplitudes a =
        layered_amplitudes(w->surface, w->inward[0], h->cos_i, h->n_from, h->n_to, p->frame_plan->render.lambda_nm);
    if (h->tir && !h->opaque && !absorbs)
        return (layer_losses){0.0, 0.0, 0.0};
    h->R_s = complex_norm2(a.r_s), h->R_p = complex_norm2(a.r_p);
    h->R = 0.5 * (h->R_s + h->R_p);
    if (h->opaque || !absorbs)
        return (layer_losses){0.0, 0.0, 0.0};
    const double s = 1.0 - h->R_s - complex_norm2(a.t_s), of_p = 1.0 - h->R_p - complex_norm2(a.t_p);
    return (layer_losses){s, of_p, 0.5 * (s + of_p)};
}

/* The fraction of this ray's light that a crystal's surface reflects. cos_t remains the ordinary ray's. */
static void read_crystal(const tracer *t, ray_hit *h)
{
    const crystal_children *c = &t->crystals->children[0];
    double reflected = 0.0;
    h->tir = true;
    for (int i = 0; i < c->count; i++) {
        reflected += c->ray[i].reflected ? c->ray[i].row.i : 0.0;
        h->tir = h->tir && c->ray[i].reflected;
    }
    h->R_s = h->R_p = h->R = reflected;
}

/* Reads the ray's hit; false for the background. */
static bool read_hit(const probe *p, ray_node *node)
{
    const tracer *t = p->rays;
    const scene_geometry *geometry = p->frame_plan->geometry;
    if (t->batch.hits.hit_primitive[0] < 0)
        return false;
    const group *g = &t->surface.gathered;
    const surface_batch *s = &g->points;
    const int hit_primitive = (int)t->batch.hits.hit_primitive[0], priority_index = (int)t->batch.hits.surface[0];
    const region *owner = &geometry->regions[priority_index],
                 *bounded = &geometry->regions[geometry->primitives[hit_primitive].priority_index];
    const fresnel f = fresnel_dielectric(s->cos_i[0], g->n_from[0], g->n_to[0]);
    const bool opaque = surface_is_opaque(t, priority_index);
    ray_hit *h = &node->hit;
    *h = (ray_hit){.solid = owner->solid,
                   .face_solid = bounded->solid,
                   .opaque = opaque,
                   .t = t->batch.hits.t[0],
                   .point = vec3_make(s->px[0], s->py[0], s->pz[0]),
                   .normal = vec3_make(s->nx[0], s->ny[0], s->nz[0]),
                   .from = geometry->regions[t->batch.hits.before[0]].solid,
                   .to = geometry->regions[t->batch.hits.after[0]].solid,
                   .n_from = g->n_from[0],
                   .n_to = g->n_to[0],
                   .cos_i = s->cos_i[0],
                   .cos_t = f.cos_t,
                   .R_s = f.R_s,
                   .R_p = f.R_p,
                   .R = f.R,
                   .tir = f.total != 0,
                   .error_bound = s->error[0]};
    h->face = is_mesh_face(s->face[0])
                  ? (int)instance_set_triangle(geometry->meshes, s->face[0])
                  : (int)(s->face[0] % FACES_MAX) + (hit_primitive == bounded->hollow ? HOLLOW_FACES : 0);
    layer_losses lost = {0.0, 0.0, 0.0};
    if (surface_is_layered(t))
        lost = read_layers(p, h);
    const double reflectivity = opaque ? 0.0 : material_reflectivity(&t->surface.mat->surface, &p->frame_plan->render);
    h->R_s += (1.0 - h->R_s - lost.s) * reflectivity, h->R_p += (1.0 - h->R_p - lost.p) * reflectivity,
        h->R += (1.0 - h->R - lost.mean) * reflectivity;
    if (opaque) {
        if (!surface_is_layered(t))
            h->R_s = h->R_p = h->R = t->surface.mat->surface.reflectivity;
        h->cos_t = 0.0;
        h->tir = false;
    }
    if (!opaque && p->frame_plan->render.transmission == TRANSMISSION_SIMPLE) {
        h->R_s = h->R_p = h->R = t->surface.mat->surface.reflectivity;
        h->cos_t = h->cos_i;
        h->tir = false;
    }
    if (crystals_meet(t, 0) && !opaque)
        read_crystal(t, h);
    read_gain(p, lost.mean, h);
    h->path_length_m = h->t * p->frame_plan->render.unit_m;
    for (int c = 0; c < 3; c++)
        h->transmittance[c] = geometry->attenuates ? t->media->transmittance[c][0] : 1.0;
    node->end = RAY_END_HIT;
    return true;
}

/* The branches of the ray just traced: their records, kinds, and the ends of those that were not enqueued. */
typedef struct branches {
    int count;
    ray_record record[CRYSTAL_RAYS_MAX];
    ray_kind kind[CRYSTAL_RAYS_MAX];
    ray_end end[CRYSTAL_RAYS_MAX];
} branches;

static bool is_below_least_weight(const double weight[3], double least)
{
    return least > 0.0 && weight[0] < least && weight[1] < least && weight[2] < least;
}

/* Adds a branch of the hit, with its weight by channel; unless it was cut, it is the next record of the queue. */
static void add_branch(const probe *p, int depth, bool reflected, vec3 direction, vec3 weight, const double polar[3],
                       int *queued, branches *out)
{
    const tracer *t = p->rays;
    const group *g = &t->surface.gathered;
    const scene_geometry *geometry = p->frame_plan->geometry;
    const bool straight = t->surface.blended && !reflected;
    const int i = out->count++;
    ray_record *r = &out->record[i];
    *r = (ray_record){.origin = vec3_make(g->points.px[0], g->points.py[0], g->points.pz[0]),
                      .direction = direction,
                      .weight = {g->wr[0] * weight.x, g->wg[0] * weight.y, g->wb[0] * weight.z},
                      .stokes = {polar[0], polar[1], polar[2]},
                      .start = g->points.face[0],
                      .inside = reflected ? g->inside_before[0] : g->inside_after[0],
                      .depth = depth + 1,
                      .medium_priority_index =
                          straight ? scene_geometry_priority_index(geometry, g->inside_after[0])
                                   : (int)(reflected ? t->batch.hits.before[0] : t->batch.hits.after[0])};
    out->kind[i] = reflected ? RAY_REFLECT : RAY_REFRACT;
    out->end[i] = RAY_END_CUT_DEPTH;
    if (depth == t->queues.depth_limit)
        return;
    if (is_below_least_weight(r->weight, p->frame_plan->render.min_weight)) {
        out->end[i] = RAY_END_CUT_WEIGHT;
        return;
    }
    out->end[i] = RAY_END_HIT; /* to be traced */
    probe_read_ray(p, depth + 1, (*queued)++, r);
}

/* Adds the reflected or the refracted branch, if there is one. */
static void add_ordinary(const probe *p, int depth, bool reflected, int *queued, branches *out)
{
    const branch_group *b = &p->rays->surface.branches;
    const polar_group *v = &p->rays->surface.polar;
    const bool polarised = p->frame_plan->render.polarisation;
    const double polar[3] = {polarised ? (reflected ? v->rq : v->tq)[0] : 0.0,
                             polarised ? (reflected ? v->ru : v->tu)[0] : 0.0,
                             polarised ? (reflected ? v->rv : v->tv)[0] : 0.0};
    const vec3 direction =
        reflected ? vec3_make(b->rx[0], b->ry[0], b->rz[0]) : vec3_make(b->tx[0], b->ty[0], b->tz[0]);
    if ((reflected ? b->reflect[0] : b->refract[0]) > 0.0)
        add_branch(p, depth, reflected, direction, layered_weight(p->rays, 0, reflected), polar, queued, out);
}

/* Adds the branches at a crystal's surface. */
static void add_crystal_rays(const probe *p, int depth, int *queued, branches *out)
{
    const crystal_children *c = &p->rays->crystals->children[0];
    for (int i = 0; i < c->count; i++) {
        const crystal_ray *ray = &c->ray[i];
        const double none[3] = {0.0, 0.0, 0.0}, fraction = ray->row.i;
        add_branch(p, depth, ray->reflected, ray->d, vec3_make(fraction, fraction, fraction), none, queued, out);
    }
}

static void read_branches(const probe *p, int depth, branches *out)
{
    const tracer *t = p->rays;
    const int priority_index = (int)t->batch.hits.surface[0];
    const bool opaque = surface_is_opaque(t, priority_index);
    int queued = 0;
    out->count = 0;
    if (!traces_ray_trees(&p->frame_plan->render) || (opaque && !surface_reflects(t) && !t->surface.blended))
        return;
    add_ordinary(p, depth, true, &queued, out);
    add_ordinary(p, depth, false, &queued, out);
    if (crystals_meet(t, 0))
        add_crystal_rays(p, depth, &queued, out);
}

/* The light of a shadow ray: the first light from index `from` that is exactly at its end and emits in its
 * direction. */
static int light_of(const plan *p, const ray_record *r, int from)
{
    for (int k = from; k < p->light_count; k++) {
        const vec3 to_light = light_towards(&p->lights[k], r->origin);
        if (light_fraction(&p->lights[k], &p->cones[k], vec3_scale(to_light, -1.0 / vec3_length(to_light))) == 0.0)
            continue;
        if (to_light.x == r->direction.x && to_light.y == r->direction.y && to_light.z == r->direction.z)
            return k;
    }
    return RAY_NONE;
}

static status build_shadows(probe *p, ray_tree *tree, int parent, diagnostic *why)
{
    enum { LIGHTS = SCENE_LIGHTS_MAX };
    tracer *t = p->rays;
    ray_record record[LIGHTS];
    const int count = t->queues.shadows.count;
    const int depth = tree->node[parent].depth, priority_index = (int)t->batch.hits.before[0];
    for (int i = 0; i < count; i++)
        read_ray(&t->queues.shadows, i, &record[i]);
    t->queues.shadows.count = 0;
    status code = STATUS_OK;
    for (int i = 0, lamp = 0; i < count && code == STATUS_OK; i++) {
        ray_record *r = &record[i];
        r->depth = depth;
        r->medium_priority_index = priority_index;
        memset(r->stokes, 0, sizeof r->stokes);
        size_t at = 0;
        code = add_node(p, tree, r, RAY_SHADOW, parent, &at, why);
        if (code != STATUS_OK)
            break;
        enqueue_only(&t->queues.shadows, r);
        ray_node *node = &tree->node[at];
        node->light = light_of(p->frame_plan, r, lamp);
        if (p->frame_plan->polarised_shadows && node->light != RAY_NONE)
            sheets_shadow_ray(t, node->light, 0);
        run_one(p, -1, node->contribution);
        node->end = t->batch.transmitted[0] > 0.0 ? RAY_END_LIT : RAY_END_BLOCKED;
        node->shadow_transmittance = t->batch.transmitted[0];
        node->light_distance = vec3_length(r->direction);
        node->direction = vec3_scale(r->direction, 1.0 / node->light_distance);
        lamp = node->light + 1;
        append_child(tree, parent, at);
    }
    return code;
}

/* Traces the ray of node `at`; returns its branches in *out and leaves its shadow rays in the queue. */
static void trace_node(probe *p, ray_tree *tree, size_t at, const ray_record *ray, branches *out)
{
    tracer *t = p->rays;
    ray_node *node = &tree->node[at];
    enqueue_only(tracer_queue_at(t, ray->depth), ray);
    run_one(p, ray->depth, node->contribution);
    out->count = 0;
    if (read_hit(p, node))
        read_branches(p, ray->depth, out);
    if (ray->depth < t->queues.depth_limit)
        tracer_queue_at(t, ray->depth + 1)->count = 0;
}

static status add_cut(probe *p, ray_tree *tree, int parent, const branches *b, int i, diagnostic *why)
{
    size_t at = 0;
    TRY(add_node(p, tree, &b->record[i], b->kind[i], parent, &at, why));
    tree->node[at].end = b->end[i];
    append_child(tree, parent, at);
    return STATUS_OK;
}

status probe_build(probe *p, ray_tree *tree, const ray_record *ray, ray_kind kind, int parent, size_t *at,
                   diagnostic *why)
{
    TRY(add_node(p, tree, ray, kind, parent, at, why));
    branches next;
    trace_node(p, tree, *at, ray, &next);
    status code = build_shadows(p, tree, (int)*at, why);
    for (int i = 0; i < next.count && code == STATUS_OK; i++) {
        if (next.end[i] != RAY_END_HIT) {
            code = add_cut(p, tree, (int)*at, &next, i, why);
            continue;
        }
        size_t child = 0;
        code = probe_build(p, tree, &next.record[i], next.kind[i], (int)*at, &child, why);
        if (code == STATUS_OK)
            append_child(tree, (int)*at, child);
    }
    return code;
}

status probe_follow(probe *p, ray_tree *tree, const ray_record *ray, int reflect_at, diagnostic *why)
{
    ray_record now = *ray;
    ray_kind kind = RAY_CAMERA;
    for (int parent = RAY_NONE, interface = 0;; interface++) {
        size_t at = 0;
        TRY(add_node(p, tree, &now, kind, parent, &at, why));
        if (parent != RAY_NONE)
            append_child(tree, parent, at);
        branches next;
        trace_node(p, tree, at, &now, &next);
        p->rays->queues.shadows.count = 0;
        if (next.count == 0)
            return STATUS_OK;
        /* The refracted branch is last. */
        const int i = interface == reflect_at ? 0 : next.count - 1;
        if (next.end[i] != RAY_END_HIT)
            return add_cut(p, tree, (int)at, &next, i, why);
        now = next.record[i];
        kind = next.kind[i];
        parent = (int)at;
    }
}
