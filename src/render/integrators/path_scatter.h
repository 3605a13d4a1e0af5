/* Media that scatter on random paths (render/shade/scattering.h). Where a flight ends, the path goes on by the phase
 * function, and each lamp, or one that is chosen, is sampled: a lamp with a size by a point of it and by the path's own
 * direction, weighted as for rough surfaces (path_rough.h); a point by its direction. A point's light is also sampled
 * along the ray (render/shade/airlight.h), with the same weights. Shadow rays go straight through clear solids, as
 * those of surfaces do, and lose what is absorbed and scattered on their way. Nothing fails. */
#pragma once

#include "render/shade/shading.h"

/* hits.hit_primitive of a ray that scatters. */
enum { PATH_SCATTERED = -2 - SCENE_LIGHTS_MAX };

/* After the search for the nearest interfaces and lamps of a batch: samples lamps along its rays, and marks those that
 * scatter. */
void path_scatter_mark(tracer *t, const ray_queue *q, int first, int count);
/* Scatters rays list[0 .. count - 1] of the batch, which are marked. */
void path_scatter(tracer *t, const ray_queue *q, int first, const int *list, int count);
