/* Radiance from where there is nothing: uniform, a vertical gradient, or an equirectangular picture whose
 * middle column is +z and whose right half is +x, top row straight up. Pure; cannot fail. */
#ifndef CUVETTE_RENDER_SKY_H
#define CUVETTE_RENDER_SKY_H

#include "scene/scene.h"

/* direction: unit vector. */
vec3 sky_radiance(const background *sky, vec3 direction);

#endif
