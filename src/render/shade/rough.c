/* Facets of rough surfaces, and the branches of rays at them. */
#include "render/shade/rough.h"

#include "optics/mueller.h"

/* The least cosine between the normal and a ray: an interpolated normal may be turned away from it. */
#define LEAST_COSINE 1e-9

void rough_begin(const tracer *t, double alpha, bool opaque, rough_surface *r)
{
    const group *g = &t->surface.gathered;
    r->alpha = alpha;
    r->opaque = opaque;
    for (int k = 0; k < g->count; k++) {
        r->n[k] = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
        r->cos_i[k] = g->points.cos_i[k];
        polarisation_frame(r->n[k], &r->x[k], &r->y[k]);
        const vec3 i = rough_in_frame(r, k, vec3_make(-g->dx[k], -g->dy[k], -g->dz[k]));
        r->i[k] = i.z > LEAST_COSINE ? i : vec3_normalize(vec3_make(i.x, i.y, LEAST_COSINE));
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

double rough_share(const tracer *t, const rough_surface *r, int k, vec3 o, bool refracted)
{
    return rough_lets_out(t, r, k, o, refracted) ? ggx_visible_share(r->alpha, o) : 0.0;
}

facet rough_facet(const tracer *t, const rough_surface *r, int k, vec3 o)
{
    const group *g = &t->surface.gathered;
    return o.z > 0.0 ? facet_that_reflects(r->alpha, r->i[k], o)
                     : facet_that_refracts(r->alpha, r->i[k], o, g->n_from[k], g->n_to[k]);
}
