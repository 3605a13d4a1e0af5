/* The sky: radiance of the background, which is uniform, a vertical gradient, or an equirectangular image whose middle
 * column faces +z, whose right half covers x > 0, and whose top row is straight up. For a background of rain,
 * sky_radiance returns only the gradient; callers add the light of the rain (rain_color). A CIE sky must come from a
 * plan, which computes its constants (plan.c). Lookups are pure and cannot fail.
 *
 * Sunlit rain: what a thin sheet of falling drops adds to the sky, with rainbows around the antisolar point. The sun's
 * light is white (D65) and comes from a disc. Radiance = background.rain times the drops' scattering function
 * (optics/phase_function.h). Its tables are computed once per frame. Ownership: rain_create allocates, rain_destroy
 * releases; the background is borrowed during the call only. */
#pragma once

#include "scene/model/view_settings.h"
#include <stdbool.h>

/* direction: unit vector. */
vec3 sky_radiance(const background *sky, vec3 direction);

/* The mean radiance over all directions, by solid angle: for a gradient (3 horizon + zenith) / 4, since the mean of
 * max(0, sin(elevation)) over the sphere is 1/4; for an image, the mean of its interpolated texels. */
vec3 sky_mean(const background *sky);

/* --- rain --- */

typedef struct rain rain;

/* to_sun: unit vector. spectral: tables by wavelength, for a spectral film; else one table by channel. Returns NULL
 * when out of memory. */
rain *rain_create(const background *sky, vec3 to_sun, bool spectral);
void rain_destroy(rain *r);

/* The rain's radiance in linear sRGB, for a film of three channels: the spectrum as the CIE 1931 observer sees it. A
 * component can be negative: a rainbow's colours are outside the gamut until the sky's light is added. direction: unit
 * vector. */
vec3 rain_color(const rain *r, vec3 direction);
vec3 rain_color_mean(const rain *r);

/* The rain's radiance relative to white light of radiance 1, for a spectral film. */
double rain_radiance(const rain *r, double lambda_nm, vec3 direction);
double rain_radiance_mean(const rain *r, double lambda_nm);
