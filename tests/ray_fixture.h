/* One ray through the kernels of geometry/rays.h, and the scene geometry of a few shapes, for tests. Ownership: free
 * the result of scene_geometry_of with scene_geometry_destroy. */
#pragma once

#include "base/isa.h"
#include "geometry/regions/instance_set.h"
#include "geometry/rays.h"

typedef struct one_ray {
    vec3 o, d;
    int64_t start;
    uint64_t inside;
} one_ray;

typedef struct one_hit {
    double t;
    int hit_primitive, before, after, surface; /* hit_primitive -1: a miss */
    uint64_t inside_before, inside_after;
    vec3 point, normal;
    double cos_i, error;
    int64_t face;
} one_hit;

static inline const geometry_kernels *kernels_of(isa level)
{
    static const geometry_kernels *const all[ISA_COUNT] = ISA_ARRAY(geometry_kernels);
    return all[level];
}

static inline ray_batch batch_of_one(const one_ray *r)
{
    return (ray_batch){1, &r->o.x, &r->o.y, &r->o.z, &r->d.x, &r->d.y, &r->d.z, &r->start, &r->inside};
}

static inline one_hit nearest_interface(const scene_geometry *a, one_ray r)
{
    static mesh_scratch meshes;
    static ray_scratch scratch;
    static hit_batch hits;
    static surface_batch points;
    scratch.meshes = &meshes;
    const geometry_kernels *kernels = kernels_of(isa_best());
    const ray_batch batch = batch_of_one(&r);
    kernels->nearest(a, &batch, &scratch, &hits);
    one_hit h = {.t = hits.t[0],
                 .hit_primitive = (int)hits.hit_primitive[0],
                 .before = (int)hits.before[0],
                 .after = (int)hits.after[0],
                 .surface = (int)hits.surface[0],
                 .inside_before = hits.inside_before[0],
                 .inside_after = hits.inside_after[0],
                 .face = FACE_NONE};
    if (h.hit_primitive < 0)
        return h;
    r.inside = h.inside_before;
    if (!a->primitives[h.hit_primitive].rule)
        kernels->mesh_surface(a->meshes, &batch, meshes.hit, false, &points, NULL);
    else
        kernels->surface(a, h.hit_primitive, &batch, hits.t, &points);
    h.point = vec3_make(points.px[0], points.py[0], points.pz[0]);
    h.normal = vec3_make(points.nx[0], points.ny[0], points.nz[0]);
    h.cos_i = points.cos_i[0];
    h.error = points.error[0];
    h.face = points.face[0];
    return h;
}

static inline double light_through(const scene_geometry *a, one_ray r, int solid_shadows)
{
    static mesh_scratch meshes;
    static ray_scratch scratch;
    static double transmitted[ROW];
    scratch.meshes = &meshes;
    const ray_batch batch = batch_of_one(&r);
    kernels_of(isa_best())->shadow(a, &batch, solid_shadows, &scratch, transmitted);
    return transmitted[0];
}

/* Shapes of different transparent media, the first with the highest priority; free with scene_geometry_destroy. */
static inline scene_geometry *scene_geometry_of(const solid_shape *shapes, int count)
{
    region_source sources[8];
    for (int i = 0; i < count; i++)
        sources[i] = (region_source){
            .shape = &shapes[i], .priority = count - i, .medium = i + 1, .shadow_transmittance = 1.0, .solid = i};
    scene_geometry *a = NULL;
    assert_int_equal(scene_geometry_build(sources, count, 0, TREE_IF_MANY, &a, NULL), STATUS_OK);
    return a;
}
