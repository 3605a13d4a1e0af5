/* Rays that met meshes. Ownership: mesh_begin gives the tracer its memory, mesh_end frees it. */
#pragma once

#include "geometry/instance_set.h"
#include "render/core/tracer.h"
#include "render/shade/shade.h"

typedef struct mesh_work {
    mesh_scratch scratch;
    instance_hit hits[ROW]; /* of the gathered group */
    mesh_points points;
    group corner; /* Gouraud's: the group with a corner of each triangle in place of the point */
    lit_group corner_light;
} mesh_work;

bool mesh_begin(tracer *t); /* a frame; false when memory is out */
void mesh_end(tracer *t);

/* Points of the gathered group on a mesh; the light and the branches that its triangles do not let through; Gouraud's
 * light; which directions lead out of the triangle of record k; and how the group's list falls into faces that look
 * alike. */
void mesh_surface(tracer *t, int priority_index, const int *list);
void mesh_bound_light(tracer *t);
void mesh_bound_branches(tracer *t);
bool mesh_lets_out(const tracer *t, int k, vec3 direction);
bool mesh_has_corner_light(const tracer *t, int priority_index);
void mesh_corner_light(tracer *t, const material *m, const light *lamp, int priority_index);
int mesh_next_material(const tracer *t, int *list, int count, int *slot);
