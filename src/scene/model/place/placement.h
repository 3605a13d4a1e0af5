/* Position and size of a new object in a scene: at the centre of the image, next to existing objects, on the ground if
 * it is visible; its size is a sixth of the distance from the camera, or a fifth of the height of an orthographic view.
 * Lengths in scene units. Pure. */
#pragma once

#include "scene/model/open.h"
#include "scene/model/solids.h"
#include <stdbool.h>

typedef struct placement {
    vec3 looked_at;   /* the camera's target, or a point ahead of it */
    vec3 right, away; /* horizontal unit vectors of the camera */
    double distance;  /* from the camera to looked_at */
    double size;      /* of a new object */
} placement;

placement placement_of(const scene *s);

/* The lowest point of a free place for an object of this size. */
vec3 placement_free(const scene *s, const placement *where, double size);

/* The height of the highest floor plane below the camera, at x and z; false for none. */
bool placement_ground(const scene *s, double x, double z, double *y);

/* A bounding ball of the solid, estimated for a mesh that is not loaded; false for a plane. */
bool placement_bounding_sphere(const scene *s, const solid *of, vec3 *centre, double *radius);

/* Half of the solid's extent along a unit vector, estimated for a mesh that is not loaded; 0 for a plane. */
double placement_half_size(const scene *s, const solid *of, vec3 along);

bool placement_in_view(const scene *s, vec3 point);

/* Rounds a value to the digits that an object of this size needs. */
double placement_round(double value, double size);
