/* Beams drawn into an image: their segments as lines, dimmed where an opaque solid hides them. The film is not
 * touched. Ownership: everything is borrowed. */
#pragma once

#include "image/image.h"
#include "render/inspect/beams.h"

/* A copy of the scene that shows only opaque solids, without beams, as the layer of distances (integrator aov): render
 * it with the same size, and pass its layer `depth` to beams_draw. The caller destroys it. */
status beams_hiding_scene(const scene *s, scene **out, diagnostic *why);

/* distance: from the camera to the first opaque surface by pixel, 0 where there is none. */
status beams_draw(const scene *s, isa level, const float *distance, image *img, diagnostic *why);
