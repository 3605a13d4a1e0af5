/* The work that a scene's parameters imply, for limits before anything is loaded or rendered. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* The number of triangles of generated meshes; a mesh from a file counts as 12, because its size is unknown. */
double scene_planned_triangles(const scene *s);

/* The number of camera rays, times wavelengths. */
double scene_camera_rays(const struct render_settings *r);

/* An upper bound of the number of rays, without shadow rays. A level of a tree has at most twice the rays of the level
 * above it, and at most 1 / min_weight, because the weights of a level sum to at most 1. */
double scene_rays_bound(const struct render_settings *r);

/* The work of a slime: steps to its time_s, times masses. */
double slime_work(const mesh_entry *m);
