/* Sunlit rain: what a thin sheet of falling drops adds to the sky, with rainbows around the antisolar point. The sun's
 * light is white (D65) and comes from a disc. Radiance = background.rain times the drops' scattering function
 * (optics/phase_function.h). The tables are computed once per frame. Ownership: rain_create allocates, rain_destroy
 * releases; the background is borrowed during the call only. Lookups are pure. */
#pragma once

#include "scene/model/view_settings.h"
#include <stdbool.h>

typedef struct rain rain;

/* to_sun: unit vector. spectral: for a film that is traced by wavelength; else for three channels. NULL when out of
 * memory. */
rain *rain_create(const background *sky, vec3 to_sun, bool spectral);
void rain_destroy(rain *r);

/* Linear sRGB, for a film of three channels: the spectrum as the CIE 1931 observer sees it. A component can be
 * negative: a rainbow's colours are outside the gamut until the sky's light is added. direction: unit vector. */
vec3 rain_color(const rain *r, vec3 direction);
vec3 rain_color_mean(const rain *r);

/* Relative to white light of radiance 1, for a spectral film. */
double rain_share(const rain *r, double lambda_nm, vec3 direction);
double rain_share_mean(const rain *r, double lambda_nm);
