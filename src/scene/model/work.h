/* The work that a scene's parameters imply, before anything is loaded or rendered, for limits. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"

/* Triangles of generated meshes; those of files are counted on loading. */
double scene_planned_triangles(const scene *s);

/* Camera rays times wavelengths. */
double scene_camera_rays(const struct render_settings *r);

/* At most that many rays of its trees or paths, without shadow rays: a level has at most twice the rays of the one
 * before, and at most 1 / min_weight, because weights divide what arrives. */
double scene_most_rays(const struct render_settings *r);

/* A slime: steps to its time_s, times masses. */
double slime_work(const mesh_entry *m);
