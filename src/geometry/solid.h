/* The analytic solids, as a person describes them, and the convex primitives that the kernels work on.
 * A solid stands in a frame of its own: local y is its axis; it is turned by rotation_deg (about x, then y,
 * then z, right-hand rule on the axes' names) and then moved to position.
 *
 *   plane     the half-space y <= 0
 *   cylinder  x^2 + m^2 z^2 <= radius^2, 0 <= y <= height (position is the centre of its base)
 *   cup       a cylinder of radius, m and height less one of inner_radius and the same m that stands on the floor's
 *             thickness and is open at the top (position is the centre of its base): the ellipses are similar, so that
 * the wall is radius - inner_radius thick along x, and 1 / m of that along z box       |x| <= size.x/2 and so on
 * (position is its centre) sphere    x^2 + y^2 + z^2 <= radius^2 mesh      a triangle mesh, each axis times scale, as
 * often as copies says, spacing apart. A closed mesh is solid; an open one is a skin, which contains nothing. Copies
 * may touch but not overlap, and a mesh's own parts neither
 *
 * Pure; ownership: values; a shape borrows its mesh. */
#ifndef CUVETTE_GEOMETRY_SOLID_H
#define CUVETTE_GEOMETRY_SOLID_H

#include "base/status.h"
#include "base/vec3.h"
#include "geometry/mesh.h"
#include <stdbool.h>

typedef enum shape_kind {
    SHAPE_PLANE,
    SHAPE_CYLINDER,
    SHAPE_CUP,
    SHAPE_BOX,
    SHAPE_SPHERE,
    SHAPE_MESH,
    SHAPE_COUNT
} shape_kind;

typedef struct solid_shape {
    shape_kind kind;
    vec3 position;                                 /* scene units */
    vec3 rotation_deg;                             /* about x, then y, then z */
    double radius, height, m, inner_radius, floor; /* those that kind has; the others are ignored */
    vec3 size;
    const struct mesh *mesh; /* NULL until it is there */
    vec3 scale;              /* above 0 */
    vec3 copies;             /* whole numbers from 1, along the axes of the solid's frame */
    vec3 spacing;            /* from copy to copy, in that frame */
} solid_shape;

/* Of all copies together, and of shapes of all kinds at most. */
enum { SHAPE_COPIES_MAX = 1 << 22 };

/* Checks what single ranges cannot: inner_radius < radius, floor < height. */
status solid_shape_check(const solid_shape *shape, diagnostic *why);

/* Does the closed solid contain the point? By its definition above; for tests and for hints. Of a mesh it is not known
 * here, and false. */
bool solid_shape_contains(const solid_shape *shape, vec3 point);

/* The rotation of rotation_deg: local to world. */
mat3 rotation_from_deg(vec3 rotation_deg);

#endif
