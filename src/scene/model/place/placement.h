/* Position and size of a new object in a scene: at the centre of the image, a sixth of the distance from the camera in
 * size, next to existing objects, on the ground if it is visible. Lengths in scene units. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"
#include <stdbool.h>

typedef struct placement {
    vec3 looked_at;
    vec3 right, away; /* horizontal unit vectors of the camera */
    double distance;  /* from the camera to looked_at */
    double size;
} placement;

placement placement_of(const scene *s);

/* The lowest point of a free place for an object of that size. */
vec3 placement_free(const scene *s, const placement *where, double size);

/* The height of the highest floor plane below the camera, at x and z; false for none. */
bool placement_ground(const scene *s, double x, double z, double *y);

/* A bounding ball of the solid, as far as known; false for a plane. */
bool placement_bounding_sphere(const scene *s, const solid *of, vec3 *centre, double *radius);

/* Half of the solid's extent along a unit vector, as far as known; 0 for a plane. */
double placement_half_size(const scene *s, const solid *of, vec3 along);

bool placement_in_view(const scene *s, vec3 point);

/* value rounded to the digits that an object of that size needs. */
double placement_round(double value, double size);
