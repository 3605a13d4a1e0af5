/* The sky: radiance of the background, which is uniform, a vertical gradient, or an equirectangular image whose middle
 * column faces +z, whose right half covers x > 0, and whose top row is straight up. A background of rain is a gradient
 * here; the rain's own light is in render/shade/rain.h. A CIE sky must be that of a plan (plan.c).
 * Pure; cannot fail. */
#pragma once

#include "scene/model/view_settings.h"

/* direction: unit vector. */
vec3 sky_radiance(const background *sky, vec3 direction);

/* The mean radiance over all directions, by solid angle: for a gradient (3 horizon + zenith) / 4, since the mean of
 * max(0, sin(elevation)) over the sphere is 1/4; for an image, that of its interpolated texels. */
vec3 sky_mean(const background *sky);
