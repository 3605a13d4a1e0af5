/* Where something new goes in a scene, and how large it is to be: into the middle of the picture, a sixth of the way
 * from the eye in size, beside what is there already, on the ground where there is one in the picture. Lengths are
 * scene units. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"
#include <stdbool.h>

typedef struct placement {
    vec3 looked_at;
    vec3 right, away; /* horizontal unit vectors of the camera */
    double distance;  /* from the eye to looked_at */
    double size;
} placement;

placement placement_of(const scene *s);

/* The lowest point of a thing of that size that stands free. */
vec3 placement_free(const scene *s, const placement *where, double size);

/* The height of the highest plane that lies under the eye like a floor, at x and z; false for none. */
bool placement_ground(const scene *s, double x, double z, double *y);

/* A ball that holds the solid, as far as is known; false for a plane. */
bool placement_bounding_sphere(const scene *s, const solid *of, vec3 *centre, double *radius);

/* Half of the solid's size along a unit vector, as far as is known; 0 for a plane. */
double placement_half_size(const scene *s, const solid *of, vec3 along);

bool placement_in_view(const scene *s, vec3 point);

/* value to so many digits as something of that size needs. */
double placement_round(double value, double size);
