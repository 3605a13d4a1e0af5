/* Facets of rough surfaces, and the branches of rays at them. */
#include "render/shade/rough.h"

#include "base/lanes.h"
#include "optics/mueller.h"
#include "render/shade/shading.h"
#include <math.h>

/* The least cosine between the normal and a ray: an interpolated normal may be turned away from the ray. */
#define LEAST_COSINE 1e-9
#define PI 3.14159265358979323846

static void begin_further(const tracer *t, rough_energy *all, int k, rough_surface *r)
{
    const group *g = &t->surface.gathered;
    const double mirror = t->surface.mat->surface.reflectivity;
    const facet_energy *e = &r->energy[k];
    r->energy[k] = facet_energy_at(all, r->finish, g->n_from[k], g->n_to[k], r->i[k].z);
    r->kept[k] = vec3_make(1.0, 1.0, 1.0);
    if (!r->opaque)
        return;
    const vec3 R = surface_is_layered(t) ? layered_mean(t, k) : vec3_make(mirror, mirror, mirror);
    r->kept[k] = vec3_make(facet_energy_kept(e, R.x), facet_energy_kept(e, R.y), facet_energy_kept(e, R.z));
}

void rough_begin(const tracer *t, double alpha, bool opaque, rough_surface *r)
{
    const group *g = &t->surface.gathered;
    rough_energy *all = t->target.frame_plan->energy;
    const material *m = &t->surface.mat->surface;
    r->alpha = alpha;
    r->opaque = opaque;
    r->finish =
        all ? rough_energy_find(all, alpha, material_reflectivity(m, &t->target.frame_plan->render), opaque) : NULL;
    for (int k = 0; k < g->count; k++) {
        r->n[k] = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
        r->cos_i[k] = g->points.cos_i[k];
        polarisation_frame(r->n[k], &r->x[k], &r->y[k]);
        const vec3 i = rough_in_frame(r, k, vec3_make(-g->dx[k], -g->dy[k], -g->dz[k]));
        r->i[k] = i.z > LEAST_COSINE ? i : vec3_normalize(vec3_make(i.x, i.y, LEAST_COSINE));
        if (r->finish)
            begin_further(t, all, k, r);
    }
}

static void set_normal(surface_batch *at, int k, vec3 n, double cos_i)
{
    at->nx[k] = n.x, at->ny[k] = n.y, at->nz[k] = n.z, at->cos_i[k] = cos_i;
}

/* Sets the normals of the group; its padding repeats the last ray. */
static void set_normals(tracer *t, const vec3 *n, const double *cos_i)
{
    group *g = &t->surface.gathered;
    for (int k = 0; k < g->padded; k++) {
        const int from = k < g->count ? k : g->count - 1;
        set_normal(&g->points, k, n[from], cos_i[from]);
    }
}

void rough_branches(tracer *t, const rough_surface *r)
{
    const group *g = &t->surface.gathered;
    vec3 n[ROW];
    double cos_i[ROW];
    for (int k = 0; k < g->count; k++) {
        const vec3 m = r->m[k];
        n[k] = vec3_add(vec3_add(vec3_scale(r->x[k], m.x), vec3_scale(r->y[k], m.y)), vec3_scale(r->n[k], m.z));
        cos_i[k] = lesser(greater(-vec3_dot(vec3_make(g->dx[k], g->dy[k], g->dz[k]), n[k]), LEAST_COSINE), 1.0);
    }
    set_normals(t, n, cos_i);
    shading_branches_at_facets(t, r->opaque);
    set_normals(t, r->n, r->cos_i);
}

bool rough_lets_out(const tracer *t, const rough_surface *r, int k, vec3 o, bool refracted)
{
    const vec3 direction =
        vec3_add(vec3_add(vec3_scale(r->x[k], o.x), vec3_scale(r->y[k], o.y)), vec3_scale(r->n[k], o.z));
    if (refracted)
        return o.z < 0.0 && (!t->surface.on_mesh || !mesh_lets_out(t, k, direction));
    return o.z > 0.0 && mesh_lets_out(t, k, direction);
}

double rough_masking(const tracer *t, const rough_surface *r, int k, vec3 o, bool refracted)
{
    return rough_lets_out(t, r, k, o, refracted) ? ggx_masking(r->alpha, o) : 0.0;
}

/* A(o) / a of light that further facets send to a side, times the fraction that they reflect or transmit. */
static vec3 further_towards(const tracer *t, const rough_surface *r, int k, bool refracted, double cosine)
{
    const double passed = refracted ? t->surface.mat->surface.transparency : 1.0;
    return vec3_scale(r->kept[k], passed * facet_energy_towards(&r->energy[k], refracted, cosine));
}

vec3 rough_further(const tracer *t, const rough_surface *r, int k, vec3 o)
{
    const facet_energy *e = &r->energy[k];
    const bool refracted = o.z < 0.0;
    const double cosine = magnitude(o.z);
    return vec3_scale(further_towards(t, r, k, refracted, cosine), e->lost * e->fraction[refracted] * cosine / PI);
}

further_light rough_draw_further(const tracer *t, const rough_surface *r, int k, double chance, unit_pair place)
{
    const facet_energy *e = &r->energy[k];
    further_light out = {.refracted = chance >= e->fraction[0]};
    double sine, cosine;
    elementary_sincos_turn_inline(place.v, &sine, &cosine);
    const double across = sqrt(place.u), z = sqrt(greater(1.0 - place.u, 0.0));
    const vec3 o = vec3_make(across * cosine, across * sine, out.refracted ? -z : z);
    out.direction = vec3_normalize(
        vec3_add(vec3_add(vec3_scale(r->x[k], o.x), vec3_scale(r->y[k], o.y)), vec3_scale(r->n[k], o.z)));
    out.factor = rough_lets_out(t, r, k, o, out.refracted) ? further_towards(t, r, k, out.refracted, z)
                                                           : vec3_make(0.0, 0.0, 0.0);
    return out;
}

facet rough_facet(const tracer *t, const rough_surface *r, int k, vec3 o)
{
    const group *g = &t->surface.gathered;
    return o.z > 0.0 ? reflecting_facet(r->alpha, r->i[k], o)
                     : refracting_facet(r->alpha, r->i[k], o, g->n_from[k], g->n_to[k]);
}
