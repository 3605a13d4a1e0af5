/* Radiance from where there is nothing: uniform, a vertical gradient, or an equirectangular picture whose
 * middle column is +z and whose right half is +x, top row straight up. Pure; cannot fail. */
#pragma once

#include "scene/model/view_settings.h"

/* direction: unit vector. */
vec3 sky_radiance(const background *sky, vec3 direction);

/* Its mean over all directions, each solid angle counting alike: of a gradient (3 horizon + zenith) / 4, since the mean
 * of max(0, sin(elevation)) over the sphere is 1/4; of a picture, of its texels as they are interpolated. */
vec3 sky_mean(const background *sky);
