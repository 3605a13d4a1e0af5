/* Rough surfaces (optics/microfacet.h) in the tracer: each ray of the gathered group meets one facet, at which it
 * reflects or refracts as at a smooth surface of that normal, including metals and thin films. Other facets mask a
 * fraction of each branch's light, which is lost, or leaves in all directions (rough_energy.h). Plain values; nothing
 * fails. */
#pragma once

#include "optics/microfacet.h"
#include "render/tracer/tracer.h"

/* The gathered group's surface, with a frame for each ray, whose z axis is the point's normal n. */
typedef struct rough_surface {
    double alpha;
    bool opaque;
    vec3 x[ROW], y[ROW], n[ROW], i[ROW]; /* i: towards the ray's origin, in the ray's frame */
    double cos_i[ROW];
    vec3 m[ROW];                /* the facets' normals, in the rays' frames; for rough_branches */
    const rough_finish *finish; /* NULL: light of further facets is lost */
    facet_energy energy[ROW];
    vec3 kept[ROW]; /* factor of light of further facets, by channel, at an opaque surface; else 1 */
    double chance[ROW], u[ROW], v[ROW]; /* random numbers for light of further facets */
} rough_surface;

/* Alpha of the gathered group's surface; 0: it is smooth. */
static inline double rough_alpha(const tracer *t)
{
    const material *m = &t->surface.mat->surface;
    return m->roughness > 0.0 ? material_roughness(m, &t->target.frame_plan->render) : 0.0;
}

void rough_begin(const tracer *t, double alpha, bool opaque, rough_surface *r);

/* A direction in the frame of ray k. */
static inline vec3 rough_in_frame(const rough_surface *r, int k, vec3 v)
{
    return vec3_make(vec3_dot(v, r->x[k]), vec3_dot(v, r->y[k]), vec3_dot(v, r->n[k]));
}

/* The branches of the group at the facets r->m. */
void rough_branches(tracer *t, const rough_surface *r);

/* Whether a direction in the frame of ray k leads away from the surface on the side of that branch. */
bool rough_lets_out(const tracer *t, const rough_surface *r, int k, vec3 o, bool refracted);

/* Masking: the fraction of a branch of ray k, whose direction is o in its frame, that other facets do not mask; 0 if it
 * leads back to the surface. */
double rough_masking(const tracer *t, const rough_surface *r, int k, vec3 o, bool refracted);

/* --- light of further facets; r->finish is not NULL --- */

/* The fraction of light per solid angle, f |cos o|, that leaves in a direction o of the frame of ray k. */
vec3 rough_further(const tracer *t, const rough_surface *r, int k, vec3 o);

/* Light that other facets mask leaves on a side drawn by `chance`, in a direction drawn from `place` by the cosine law,
 * with a factor of its throughput. Its mean over all facets is rough_further, whatever the error of the table at i. */
typedef struct further_light {
    vec3 direction, factor; /* direction: in the world; factor 0: it does not leave the surface */
    bool refracted;
} further_light;
further_light rough_draw_further(const tracer *t, const rough_surface *r, int k, double chance, unit_pair place);

/* --- */

/* The facet of ray k that scatters light from o in the ray's frame, and the density of such directions. */
facet rough_facet(const tracer *t, const rough_surface *r, int k, vec3 o);

/* Shading of layered surfaces (layered_table.h): the branches' weights, by channel in an rgb film. Ownership:
 * layered_begin allocates the tracer's memory, layered_end frees it. */

/* The layered surface of the gathered group, and its branches' weights. */
typedef struct layered_work {
    const layered_surface *surface; /* NULL: an ordinary surface */
    bool colored;     /* the branches have weights by channel; otherwise only the weights of branch_group */
    bool inward[ROW]; /* the ray meets the layers from outside of the solid */
    const layered_curves *curves[ROW];
    /* Weights of reflection and refraction by channel; their means are the weights of branch_group. */
    double rr[ROW], rg[ROW], rb[ROW], tr[ROW], tg[ROW], tb[ROW];
} layered_work;

bool layered_begin(tracer *t); /* begins a frame; false when out of memory */
void layered_end(tracer *t);

/* Records the surface of the gathered group, rays list[0 ..] of the batch, by its surface key (plan.h). */
void layered_gather(tracer *t, const int *list, int priority_index, int key);

/* Replaces the weights of the branches, whose directions are computed, and with polarisation their Stokes vectors. */
void layered_branches(tracer *t, const material *m);

/* Sends the refracted light of ray k back, as in total reflection. */
void layered_turn_back(tracer *t, int k);

/* The weight of a branch of ray k by channel. */
vec3 layered_weight(const tracer *t, int k, bool reflected);

/* The mean reflectance of the surface of ray k by channel: twice the integral over cosines of R times cosine. */
vec3 layered_mean(const tracer *t, int k);

/* Sets the throughputs by channel of children first .. of the queue, which were appended with mean weights; list: their
 * lanes in the gathered group. */
void layered_color_children(tracer *t, ray_queue *q, int first, bool reflected, const int *list, int count);
