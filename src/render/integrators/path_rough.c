/* Rough surfaces on random paths: random facets, and direct light by multiple importance sampling (Veach and Guibas
 * 1995). */
#include "render/integrators/path.h"

#include "render/shade/polarisation.h"
#include "render/shade/rough.h"
#include "render/shade/shading.h"

#define PI 3.14159265358979323846

double path_matte_weight(const group *g, const material *m, int k)
{
    return m->diffuse * fmax(g->cr[k], fmax(g->cg[k], g->cb[k]));
}

/* The estimate for choosing a lamp on one side, without a cosine, since some facets face any lamp there. */
static light_estimate estimate_on(double side)
{
    return (light_estimate){0.0f, 1.0f, side, side > 0.0 ? DRAW_FACET_LIGHT : DRAW_FACET_LIGHT + 1};
}

/* Whether record k samples lamps: after a matte surface, photons supply their light. */
static bool samples_lamps(const tracer *t, int k)
{
    return !t->target.frame_plan->photons || !(t->surface.gathered.sample_key[k] & SAMPLE_KEY_PHOTONS);
}

/* path_enqueue_lamp with the polarisation of a branch of record k. */
static void enqueue(tracer *t, int k, int lamp, vec3 to_lamp, bool refracted, vec3 factor)
{
    const group *g = &t->surface.gathered;
    const plan *p = t->target.frame_plan;
    ray_queue *q = &t->queues.shadows;
    const int before = q->count;
    path_enqueue_lamp(t, k, lamp, to_lamp, refracted ? g->n_to[k] : g->n_from[k],
                      refracted ? g->inside_after[k] : g->inside_before[k], factor);
    if (!p->render.polarisation || q->count == before)
        return;
    if (p->sheets)
        polarised_shadow(t, k, refracted, before);
    else if (p->lights[lamp].polarised > 0.0) { /* nothing between facet and lamp changes the row */
        polarised_shadow(t, k, refracted, before);
        const stokes row = {1.0, q->sq[before], q->su[before], q->sv[before]};
        const double seen = lamp_seen(p, lamp, row, vec3_normalize(to_lamp));
        q->wr[before] *= seen, q->wg[before] *= seen, q->wb[before] *= seen;
    }
}

/* --- points of lamps --- */

/* The lamps of the group's records: directions in the world, directions o in the record's frame (o.z = 0: no lamp), and
 * light. */
typedef struct lamp_aims {
    vec3 to[ROW], o[ROW];
    double distance[ROW], light[ROW], density[ROW]; /* as in lamp_aim */
} lamp_aims;

static void aim(const tracer *t, const rough_surface *r, const lamp_samples *s, int k, lamp_aims *a)
{
    const lamp_aim one = path_lamp_aim(t, s, k);
    a->to[k] = one.to, a->distance[k] = one.distance, a->light[k] = one.light, a->density[k] = one.density;
    a->o[k] = rough_in_frame(r, k, a->to[k]);
}

/* Sets the directions of records whose lamp is on that side (0: either). */
static void aim_all(const tracer *t, const rough_surface *r, const lamp_samples *s, double side, lamp_aims *a)
{
    const plan *p = t->target.frame_plan;
    for (int k = 0; k < t->surface.gathered.count; k++) {
        const bool any = samples_lamps(t, k) && path_lamp_is_outside(p, s, k);
        if (any)
            aim(t, r, s, k, a);
        if (!any || side * a->o[k].z < 0.0 || (r->opaque && a->o[k].z < 0.0) || a->light[k] == 0.0 ||
            !rough_lets_out(t, r, k, a->o[k], a->o[k].z < 0.0))
            a->o[k].z = 0.0;
    }
}

/* The probability of a branch at r->m, as in path.c. */
static double chance_of(const tracer *t, const rough_surface *r, int k, bool reflected)
{
    const branch_group *b = &t->surface.branches;
    const double other =
        r->opaque ? path_matte_weight(&t->surface.gathered, &t->surface.mat->surface, k) : b->refract[k];
    const double both = b->reflect[k] + other;
    return both > 0.0 ? (reflected ? b->reflect[k] : other) / both : 0.0;
}

/* The probability that a path leaves a facet in direction o, and not as light of further facets. */
static double chance_to_leave(const rough_surface *r, vec3 o)
{
    return r->finish ? ggx_masking(r->alpha, o) : 1.0;
}

/* Adds light of further facets, which is sampled only by points on lamps, as for a matte surface. */
static void light_further(tracer *t, const rough_surface *r, const lamp_samples *s, const lamp_aims *a)
{
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        if (a->o[k].z == 0.0)
            continue;
        const bool refracted = a->o[k].z < 0.0;
        const double lamp_light = a->density[k] > 0.0 ? a->light[k] / a->density[k] : a->light[k];
        const vec3 factor = vec3_scale(rough_further(t, r, k, a->o[k]), lamp_light);
        if (factor.x > 0.0 || factor.y > 0.0 || factor.z > 0.0)
            path_enqueue_lamp(t, k, s->lamp[k], vec3_scale(a->to[k], a->distance[k]),
                              refracted ? g->n_to[k] : g->n_from[k],
                              refracted ? g->inside_after[k] : g->inside_before[k], factor);
    }
}

/* Adds light from a point on each record's lamp, weighted against the path's direction. */
static void light_by_lamps(tracer *t, rough_surface *r, const lamp_samples *s, double side)
{
    lamp_aims a;
    facet f[ROW];
    const int count = t->surface.gathered.count;
    aim_all(t, r, s, side, &a);
    if (r->finish)
        light_further(t, r, s, &a);
    for (int k = 0; k < count; k++) {
        f[k] = a.o[k].z != 0.0 ? rough_facet(t, r, k, a.o[k]) : (facet){vec3_make(0.0, 0.0, 1.0), 0.0};
        r->m[k] = f[k].m;
    }
    rough_branches(t, r);
    for (int k = 0; k < count; k++) {
        if (!(f[k].density > 0.0))
            continue;
        const bool reflected = a.o[k].z > 0.0;
        const double path_density = chance_of(t, r, k, reflected) * f[k].density * chance_to_leave(r, a.o[k]),
                     weight = a.density[k] > 0.0 ? 1.0 / (a.density[k] + path_density) : 1.0;
        const vec3 factor = vec3_scale(layered_weight(t, k, reflected),
                                       ggx_masking(r->alpha, a.o[k]) * f[k].density * a.light[k] * weight);
        if (factor.x > 0.0 || factor.y > 0.0 || factor.z > 0.0)
            enqueue(t, k, s->lamp[k], vec3_scale(a.to[k], a.distance[k]), !reflected, factor);
    }
}

static void light_by_one_lamp(tracer *t, rough_surface *r, int depth, double side)
{
    const light_estimate by = estimate_on(side);
    lamp_samples s;
    light_choice_make(t, &by, depth, s.lamp, s.weight, s.spheres.u, s.spheres.v);
    area_lights_aim_at_spheres(t, &s);
    light_by_lamps(t, r, &s, side);
}

static void light_by_all_lamps(tracer *t, rough_surface *r, int depth)
{
    const plan *p = t->target.frame_plan;
    lamp_samples s;
    for (int lamp = 0; lamp < p->light_count; lamp++) {
        path_lamp_samples(t, lamp, depth, &s);
        light_by_lamps(t, r, &s, 0.0);
    }
}

/* --- the path's facets --- */

static void draw_further(tracer *t, int depth, rough_surface *r)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    double unused[ROW];
    t->sampling->draw(&p->draws, g->count, g->sample_key, depth, DRAW_FURTHER, r->chance, unused);
    t->sampling->draw(&p->draws, g->count, g->sample_key, depth, DRAW_FURTHER + 1, r->u, r->v);
}

/* Continues the path as light of further facets, which is unpolarised; chance: uniform in (0, 1). r->kept includes the
 * absorption of an opaque surface. */
static bool follow_further(const tracer *t, const rough_surface *r, int k, double chance, continuation *c)
{
    const group *g = &t->surface.gathered;
    const further_light f = rough_draw_further(t, r, k, chance, (unit_pair){r->u[k], r->v[k]});
    const double clear = t->surface.mat->surface.transparency, chosen = r->opaque ? chance_of(t, r, k, true) : 1.0;
    const vec3 one = vec3_make(1.0, 1.0, 1.0),
               all = r->opaque ? one
                               : vec3_scale(c->factor, c->refracted ? 1.0 / clear : 1.0); /* a thin film's colours */
    c->direction = f.direction;
    c->factor = vec3_make(f.factor.x * all.x / chosen, f.factor.y * all.y / chosen, f.factor.z * all.z / chosen);
    c->refracted = f.refracted;
    c->inside = f.refracted ? g->inside_after[k] : g->inside_before[k];
    c->specular_bounce = false;
    c->q = c->u = c->v = 0.0;
    return f.factor.x > 0.0 || f.factor.y > 0.0 || f.factor.z > 0.0;
}

void path_rough_begin(tracer *t, double alpha, bool opaque, int depth, rough_surface *r)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    double u[ROW], v[ROW];
    rough_begin(t, alpha, opaque, r);
    if (!light_choice_applies(p))
        light_by_all_lamps(t, r, depth);
    else
        for (double side = 1.0; side >= (opaque ? 1.0 : -1.0); side -= 2.0)
            light_by_one_lamp(t, r, depth, side);
    t->sampling->draw(&p->draws, g->count, g->sample_key, depth, DRAW_FACET, u, v);
    for (int k = 0; k < g->count; k++)
        r->m[k] = ggx_sample_normal(alpha, r->i[k], u[k], v[k]);
    rough_branches(t, r);
    if (r->finish)
        draw_further(t, depth, r);
    if (!opaque)
        COUNT(t->account.counters.total_internal += (uint64_t)t->surface.branches.total);
}

/* Adds the light of lamps that the path's direction hits, weighted against points on these lamps. */
static void light_by_direction(tracer *t, const rough_surface *r, int k, vec3 o, const continuation *c)
{
    const plan *p = t->target.frame_plan;
    const surface_batch *at = &t->surface.gathered.points;
    const vec3 origin = vec3_make(at->px[k], at->py[k], at->pz[k]);
    for (int lamp = 0; lamp < p->light_count; lamp++) {
        double distance;
        const double radiance = path_lamp_ahead(p, lamp, origin, c->direction, &distance);
        if (!(radiance > 0.0))
            continue;
        const light_estimate by = estimate_on(o.z);
        const double chance = light_choice_applies(p) ? light_choice_chance(t, &by, k, lamp) : 1.0;
        const double density = chance * area_light_density(p, lamp, origin, c->direction, distance),
                     path_density =
                         chance_of(t, r, k, !c->refracted) * rough_facet(t, r, k, o).density * chance_to_leave(r, o);
        if (path_density > 0.0)
            enqueue(t, k, lamp, vec3_scale(c->direction, distance), c->refracted,
                    vec3_scale(c->factor, radiance * path_density / (density + path_density)));
    }
}

bool path_rough_scatter(tracer *t, const rough_surface *r, int k, continuation *c)
{
    const group *g = &t->surface.gathered;
    const vec3 o = rough_in_frame(r, k, c->direction);
    const double fraction = rough_masking(t, r, k, o, c->refracted);
    if (r->finish && r->chance[k] >= fraction)
        return follow_further(t, r, k, (r->chance[k] - fraction) / (1.0 - fraction), c);
    if (!(fraction > 0.0))
        return false;
    c->factor = r->finish ? c->factor : vec3_scale(c->factor, fraction);
    c->specular_bounce = c->refracted && g->n_from[k] == g->n_to[k]; /* undeflected: no other direction has density */
    if (!c->specular_bounce && samples_lamps(t, k))
        light_by_direction(t, r, k, o, c);
    return true;
}
