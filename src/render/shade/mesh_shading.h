/* Shading of rays that hit meshes. Ownership: mesh_begin allocates the tracer's memory, mesh_end frees it. */
#pragma once

#include "geometry/regions/instance_set.h"
#include "render/tracer/tracer.h"

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
