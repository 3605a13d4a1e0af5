/* Double refraction: the children of rays that meet crystals. */

#include "optics/interface.h"
#include "render/shade/exposure.h"
#include "render/shade/footprints.h"
#include "render/shade/shading.h"
#include <stdlib.h>

bool crystals_begin(tracer *t)
{
    const bool has_crystals = t->target.frame_plan->crystals != NULL;
    if (has_crystals && !t->crystals && !(t->crystals = malloc(sizeof *t->crystals)))
        return false;
    if (t->crystals)
        t->crystals->any = false;
    return true;
}

void crystals_end(tracer *t)
{
    free(t->crystals);
}

void crystals_gather(tracer *t, const ray_queue *q, int first, const int *list)
{
    const optical_medium *crystals = t->target.frame_plan->crystals;
    const group *g = &t->surface.gathered;
    crystal_work *w = t->crystals;
    w->any = false;
    for (int k = 0; crystals && k < g->count; k++) {
        w->from[k] = crystals[t->batch.hits.before[list[k]]], w->from[k].n_o = g->n_from[k];
        w->to[k] = crystals[t->batch.hits.after[list[k]]], w->to[k].n_o = g->n_to[k];
        w->meets[k] = w->from[k].uniaxial || w->to[k].uniaxial;
        w->mode[k] = !w->from[k].uniaxial           ? MODE_ANY
                     : q->sq[first + list[k]] < 0.0 ? MODE_EXTRAORDINARY
                                                    : MODE_ORDINARY;
        w->any |= w->meets[k];
    }
}

bool crystals_meet(const tracer *t, int k)
{
    return t->crystals && t->crystals->any && t->crystals->meets[k];
}

/* Scales ray k's children by the fraction that the surface reflects or transmits; an opaque surface in a crystal is a
 * mirror that loses the rest. Along the crystal's symmetries one mode has only a rounding error, 1e-32, and is dropped,
 * because it would double the tree at each surface. */
static void weigh_children(tracer *t, int k, bool opaque)
{
    const double rounding_error = 1e-24;
    const material *m = &t->surface.mat->surface;
    crystal_children *c = &t->crystals->children[k];
    int kept = 0;
    for (int i = 0; i < c->count; i++) {
        const double fraction = opaque ? t->surface.branches.reflect[k] : c->ray[i].reflected ? 1.0 : m->transparency;
        stokes *row = &c->ray[i].row;
        row->i *= fraction, row->q *= fraction, row->u *= fraction, row->v *= fraction;
        if (row->i > rounding_error)
            c->ray[kept++] = c->ray[i];
    }
    c->count = kept;
}

/* Corrects the number of total reflections, which shading_branches counts by the ordinary index alone. */
static void count_total(tracer *t, int k, bool opaque)
{
    const group *g = &t->surface.gathered;
    const crystal_children *c = &t->crystals->children[k];
    const bool is_total = c->count > 0 && c->ray[c->count - 1].reflected,
               was_total = fresnel_dielectric(g->points.cos_i[k], g->n_from[k], g->n_to[k]).total != 0;
    if (!opaque)
        COUNT(t->account.counters.total_internal += (uint64_t)is_total - (uint64_t)was_total);
}

void crystals_branches(tracer *t, bool opaque)
{
    const group *g = &t->surface.gathered;
    branch_group *b = &t->surface.branches;
    crystal_work *w = t->crystals;
    for (int k = 0; k < g->count; k++) {
        const bool inside = !opaque || w->from[k].uniaxial; /* a mirror outside crystals reflects as usual */
        w->meets[k] = w->meets[k] && inside;
        if (!w->meets[k])
            continue;
        crystal_incidence in = {.from = w->from[k],
                                .to = w->to[k],
                                .d = vec3_make(g->dx[k], g->dy[k], g->dz[k]),
                                .n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]),
                                .mode = w->mode[k],
                                .mirror = opaque};
        if (t->surface.on_mesh)
            in.n = mesh_face_normal(t, k);
        stokes row = {1.0, 0.0, 0.0, 0.0};
        if (t->target.frame_plan->render.polarisation && !w->from[k].uniaxial)
            row.q = t->surface.polar.q[k], row.u = t->surface.polar.u[k], row.v = t->surface.polar.v[k];
        w->children[k].count = crystal_split(&in, row, w->children[k].ray);
        count_total(t, k, opaque);
        weigh_children(t, k, opaque);
        b->reflect[k] = b->refract[k] = 0.0;
    }
}

static void push(ray_queue *q, const group *g, int k, const crystal_ray *ray, vec3 weight)
{
    const int at = q->count++;
    const double over = ray->mode == MODE_ANY ? 1.0 / ray->row.i : 0.0;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = ray->d.x, q->dy[at] = ray->d.y, q->dz[at] = ray->d.z;
    q->wr[at] = weight.x, q->wg[at] = weight.y, q->wb[at] = weight.z;
    q->start[at] = g->points.face[k], q->sample_key[at] = g->sample_key[k];
    q->inside[at] = ray->reflected ? g->inside_before[k] : g->inside_after[k];
    q->sq[at] = ray->row.q * over, q->su[at] = ray->row.u * over, q->sv[at] = ray->row.v * over;
    if (ray->mode != MODE_ANY)
        q->sq[at] = ray->mode == MODE_ORDINARY ? 1.0 : -1.0;
}

static void follow(tracer *t, int depth, int k, const crystal_ray *ray)
{
    const group *g = &t->surface.gathered;
    ray_counters *c = &t->account.counters;
    const vec3 weight = vec3_make(g->wr[k] * ray->row.i, g->wg[k] * ray->row.i, g->wb[k] * ray->row.i);
    const double least = t->least_weight;
    if (depth == t->queues.depth_limit) {
        count_cut_by_depth(t, g->sample_key[k], weight.x, weight.y, weight.z);
        shading_expose_at_depth_limit(t, g->sample_key[k], ray->d, weight.x, weight.y, weight.z);
    } else if (least > 0.0 && weight.x < least && weight.y < least && weight.z < least) {
        count_cut_by_weight(t, g->sample_key[k], weight.x, weight.y, weight.z);
    } else {
        ray_queue *next = tracer_queue_at(t, depth + 1);
        push(next, g, k, ray, weight);
        if (t->footprints)
            footprint_straight(t, next, next->count - 1, k);
        COUNT(ray->reflected ? c->reflect++ : c->refract++);
    }
}

void crystals_follow(tracer *t, int depth)
{
    for (int k = 0; k < t->surface.gathered.count; k++) {
        const crystal_children *c = &t->crystals->children[k];
        for (int i = 0; t->crystals->meets[k] && i < c->count; i++)
            follow(t, depth, k, &c->ray[i]);
    }
}
