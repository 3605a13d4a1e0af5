/* The meniscus of a cylinder of liquid: if it is enabled, the shape's top is the capillary surface that
 * geometry/primitives/capillary.h solves for. Pure; cannot fail. */
#pragma once

#include "geometry/mesh/mesh_generators.h"
#include "geometry/primitives/capillary.h"
#include "geometry/shapes/shape.h"

/* radius, capillary_length: above 0, their quotient at most CAPILLARY_WIDEST; contact_angle_deg: within 1..179. The
 * volume below the surface equals the volume below a level surface at y = height: the mean of u is 2 a^2 cos(contact
 * angle) / radius, by the balance of the wall's force and the weight that it carries. */
void capillary_solve(double radius, double capillary_length, double contact_angle_deg, double height,
                     capillary_profile *out);

bool has_meniscus(const solid_shape *shape);

/* The surface of a shape that has one; valid until the thread's next call for another shape. */
const capillary_profile *meniscus_of(const solid_shape *shape);

/* Checks the lengths of the meniscus: STATUS_BAD_INPUT unless it is within its cylinder. */
status meniscus_check(const solid_shape *shape, diagnostic *why);

/* The height of the cylinder that contains the shape outside the tube: up to the contact with the wall, or up to
 * `height` without a meniscus. */
double meniscus_wall(const solid_shape *shape);
/* The least and the largest height of the top. */
double meniscus_low(const solid_shape *shape);
double meniscus_high(const solid_shape *shape);

/* The largest direction . p over the surface. */
double meniscus_farthest(const solid_shape *shape, vec3 direction);

/* Points of the surface from the wall to the axis, denser towards the wall. */
enum { MENISCUS_POINTS = 49 };
void meniscus_points(const solid_shape *shape, int count, profile_point *out);
