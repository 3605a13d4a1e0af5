/* Where the sun is that the background shows: one direction for its light and its sky. Pure; cannot fail. */
#pragma once

#include "scene/model/scene.h"

/* The first light of kind sun, or NULL. */
const light *scene_sun(const scene *s);

/* A unit vector: to that light, or by the background's sun_elevation_deg and sun_azimuth_deg. */
vec3 scene_to_sun(const scene *s);
