/* Functions that the mesh generators (geometry/generate_*.c) share. */
#pragma once

#include "geometry/mesh_generators.h"

/* Finishes a generated mesh and returns it; releases it on failure. A mesh that should be closed and is not has
 * features too small for doubles: STATUS_BAD_INPUT. A generator may leave its loops early when it is cancelled. */
status generate_finish(mesh *m, bool must_be_closed, mesh **out, diagnostic *why);

/* Returns whether it is a length greater than 0 and not above MESH_FAR. */
bool generate_is_length(double x);

/* Texture coordinates by direction: u = 1/2 is at -z, facing a viewer in front, and increases to that viewer's right,
 * +x. Longitude in degrees -180..180; latitude by 1/180. */
double generate_longitude_deg(vec3 p);
double generate_latitude_v(vec3 p);
/* Unit vector of longitude 360 u - 180 with u = at / around; identical bits at 0 and at around. */
vec3 generate_azimuth(int at, int around);

/* Adds two triangles between four corners of a grid: seen from the front, b is to the right of a, c above b, d above
 * a. */
void generate_quad(mesh *m, size_t *triangle, size_t a, size_t b, size_t c, size_t d);
