/* Shading functions for integrators: each works on the tracer's gathered group. */
#pragma once

#include "geometry/rays.h"
#include "geometry/regions/instance_set.h"
#include "optics/crystal.h"
#include "render/shade/rough.h"
#include "render/tracer/tracer.h"

/* Coverage of partial surfaces for rays that are neither divided nor drawn: a surface is there where its alpha is at
 * least 1/2. For surface_cover; context is a cover_source. */
typedef struct cover_source {
    const plan *frame_plan;
    const geometry_kernels *geometry;
} cover_source;
double cover_cut(void *context, const ray_batch *rays, const ray_crossing *x);

/* Begins a frame: partial surfaces (scene_geometry.h) have the alpha of their materials. */
void cover_begin(tracer *t);

/* The nearest interfaces of a batch: the default of most integrators. */
void intersect_nearest(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays);

/* True if the surface of the region with that priority index transmits no light with the tracer's current material. */
static inline bool surface_is_opaque(const tracer *t, int priority_index)
{
    return t->target.frame_plan->geometry->regions[priority_index].opaque ||
           t->surface.mat->surface.transparency == 0.0;
}

/* The terms of a surface's emission and direct light. */
typedef struct light_terms {
    bool ambient, highlights;
    bool as_points;     /* lights with a size are treated as points at their centres */
    bool emission_only; /* no direct light of lamps */
} light_terms;
/* Adds the gathered group's local light to the film, and enqueues its shadow rays. */
void local_light(tracer *t, int priority_index, light_terms terms);
/* The terms of Phong's model that render.lighting selects. */
static inline light_terms light_terms_of(const render_settings *r)
{
    return (light_terms){
        .ambient = true, .highlights = r->lighting != LIGHTING_LAMBERT, .as_points = !scene_has_soft_shadows(r)};
}

/* Computes directions and weights of the gathered group's branches at a surface, and counts total reflections. */
void shading_branches(tracer *t, bool opaque);
/* shading_branches without the correction for meshes and without counting; the points' normals may be normals of facets
 * (rough.h). */
void shading_branches_at_facets(tracer *t, bool opaque);

/* Throughputs of the gathered group before cover_weigh. */
typedef struct cover_saved {
    double r[ROW], g[ROW], b[ROW];
} cover_saved;
/* Weight the group's local light by the part of a blended surface that is there, and restore its throughputs; no effect
 * on other surfaces. */
void cover_weigh(tracer *t, cover_saved *saved);
void cover_weigh_back(tracer *t, const cover_saved *saved);
/* Makes the branches of a blended, opaque surface: the reflected ones, if it reflects, weighted; and those that go
 * straight on, as refracted ones. */
void cover_branches(tracer *t, bool reflects);

/* Whether the gathered group's surface is a metal or has a thin film (rough.h). */
static inline bool surface_is_layered(const tracer *t)
{
    return t->layered && t->layered->surface;
}
/* Whether an opaque surface reflects rays. */
static inline bool surface_reflects(const tracer *t)
{
    return t->surface.mat->surface.reflectivity > 0.0 || surface_is_layered(t);
}

/* Enqueues children of one kind, reflected or refracted, with the sample keys of the gathered rays, except those that
 * do not exist or have too small a weight. Returns their number. */
int enqueue_children(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                     const uint64_t *inside);

/* Gathers the rays of groups of one shading class, of the batch at `first` in the queue of a depth, computes their
 * colours, and calls the integrator for each shading material. */
void shading_groups(tracer *t, int depth, int first, const hit_group *groups, int count);

/* Basic radiance (L / n^2), for a plan whose rays carry it (render.radiance). Ownership: radiance_begin allocates the
 * tracer's memory, radiance_end frees it. */

typedef struct radiance_work radiance_work;

bool radiance_begin(tracer *t); /* begins a frame; false when out of memory */
void radiance_end(tracer *t);

/* The factor of radiance emitted in the medium of a priority index, as the camera receives it, (n_eye / n)^2. */
double radiance_scale(const plan *p, int64_t sample_key, int priority_index);
/* radiance_scale for a medium of that index; 1 with classic radiance. */
double radiance_scale_at_index(const plan *p, int64_t sample_key, double index);

/* Multiply the gathered group's throughput by radiance_scale, and restore it; no effect with classic radiance. */
void radiance_weigh(tracer *t);
void radiance_weigh_back(tracer *t);

/* Multiply t->batch.transmitted by the transmittances of the interfaces that a batch of shadow rays crosses; call them
 * before and after its search. No effect with classic radiance. */
void radiance_begin_shadows(tracer *t, const ray_batch *rays, const int64_t *sample_keys);
void radiance_end_shadows(tracer *t);

/* Shading of rays that hit meshes. Ownership: mesh_begin allocates the tracer's memory, mesh_end frees it. */

typedef struct mesh_work {
    mesh_scratch scratch;
    instance_hit hits[ROW]; /* of the gathered group */
    mesh_points points;
    surface_mapping mapping[ROW]; /* if the material has a texture */
    double glow_r[ROW], glow_g[ROW],
        glow_b[ROW]; /* light that the gathered group's points emit, if the material glows */
    group corner;    /* for Gouraud shading: the group with a corner of each triangle in place of the hit point */
    lit_group corner_light;
} mesh_work;

bool mesh_begin(tracer *t); /* begins a frame; false when out of memory */
void mesh_end(tracer *t);

/* mesh_tint: multiplies the gathered group's colours by those of the vertices, interpolated at the hit points.
 * mesh_surface: hit points of the gathered group on a mesh. mesh_bound_light: removes light from behind the geometric
 * triangle. mesh_bound_branches: corrects branches that an interpolated normal sends to the wrong side of the triangle.
 * mesh_face_normal: the normal of the triangle of record k, which faces the ray. mesh_lets_out: true if a direction
 * leads out of that triangle. mesh_corner_light: Gouraud's light. mesh_next_material: splits the group's list into
 * faces of equal material. */
void mesh_surface(tracer *t, int priority_index, const int *list);
void mesh_tint(tracer *t);
void mesh_bound_light(tracer *t);
void mesh_bound_branches(tracer *t);
vec3 mesh_face_normal(const tracer *t, int k);
bool mesh_lets_out(const tracer *t, int k, vec3 direction);
bool mesh_has_corner_light(const tracer *t, int priority_index);
void mesh_corner_light(tracer *t, const material *m, const light *lamp, int priority_index);
int mesh_next_material(const tracer *t, int *list, int count, int *slot);

/* Double refraction in the tracer (optics/crystal.h). A ray that meets a crystal's surface, from outside or inside, has
 * up to four children instead of two. A ray in a crystal has one mode, which is stored in place of Stokes's q: 1 for an
 * ordinary ray, -1 for an extraordinary one, with or without polarisation. Coatings and films are refused on crystals,
 * and meshes of crystals are shaded flat. Ownership: crystals_begin allocates the tracer's memory, crystals_end frees
 * it. */

/* The children of ray k of the gathered group. */
typedef struct crystal_children {
    int count;
    crystal_ray ray[CRYSTAL_RAYS_MAX];
} crystal_children;

/* Media, modes and children of the gathered group's rays. */
typedef struct crystal_work {
    bool any;        /* some ray of the group meets a crystal; otherwise the following arrays are unused */
    bool meets[ROW]; /* a crystal is on at least one side */
    optical_medium from[ROW], to[ROW];
    crystal_mode mode[ROW];
    crystal_children children[ROW];
} crystal_work;

bool crystals_begin(tracer *t); /* begins a frame; false when out of memory */
void crystals_end(tracer *t);

/* Records the media and modes of the gathered group: rays list[0 ..] of the batch that starts at `first` in its
 * queue. */
void crystals_gather(tracer *t, const ray_queue *q, int first, const int *list);

/* Call these if some ray of the group meets a crystal. crystals_branches computes the children of such rays, and clears
 * their two ordinary branches; crystals_follow enqueues the children, or cuts them off. */
void crystals_branches(tracer *t, bool opaque);
void crystals_follow(tracer *t, int depth);

/* Whether ray k of the gathered group meets a crystal. */
bool crystals_meet(const tracer *t, int k);
