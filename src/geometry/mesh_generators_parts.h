/* What the files of geometry/bodies*.c share, and no other needs. */
#pragma once

#include "geometry/mesh_generators.h"

/* Finishes a made mesh and hands it over; on failure it is released. One that ought to be closed and is not has
 * features too small for doubles: STATUS_BAD_INPUT. */
status body_end(mesh *m, bool ought_to_be_closed, mesh **out, diagnostic *why);

/* Is it a length greater than 0, not above MESH_FAR? */
bool body_length(double x);

/* Texture coordinates by direction: u = 1/2 looks along -z, towards a viewer in front, and grows to that viewer's
 * right, +x. Longitude in degrees -180..180; latitude by 1/180. */
double generate_longitude_deg(vec3 p);
double generate_latitude_v(vec3 p);
/* Unit vector of longitude 360 u - 180 with u = at / around; the same bits at 0 and around. */
vec3 body_azimuth(int at, int around);

/* Two triangles between four corners of a grid: a, then b to its right, c above b, d above a, seen from the front. */
void generate_quad(mesh *m, size_t *triangle, size_t a, size_t b, size_t c, size_t d);
