/* Solids, as a person describes them. Each shape is a row of SHAPES here and a file in geometry/shapes/ with all that
 * the program knows of it (geometry/shapes/shape.h); the kernels work on the primitives that a shape is made of.
 *
 * A solid stands in a frame of its own: local y is its axis; it is turned by rotation_deg (about x, then y, then z,
 * right-hand rule on the axes' names) and then moved to position.
 *
 * Pure; ownership: values; a shape borrows its mesh. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "geometry/mesh.h"
#include <stdbool.h>

/* By age: studies' hashes hold a kind's number, so that a new one comes last. */
#define SHAPES(X)         \
    X(PLANE, plane)       \
    X(CYLINDER, cylinder) \
    X(CUP, cup)           \
    X(BOX, box)           \
    X(SPHERE, sphere)     \
    X(MESH, mesh)         \
    X(TORUS, torus)       \
    X(CONE, cone)         \
    X(PRISM, prism)

#define SHAPE_KIND(KIND, file) SHAPE_##KIND,
typedef enum shape_kind { SHAPES(SHAPE_KIND) SHAPE_COUNT } shape_kind;
#undef SHAPE_KIND

typedef struct solid_shape {
    shape_kind kind;
    vec3 position;                                 /* scene units */
    vec3 rotation_deg;                             /* about x, then y, then z */
    double radius, height, m, inner_radius, floor; /* those that kind has; the others are ignored */
    double tube_radius, top_radius;
    int64_t sides;
    vec3 size;
    const struct mesh *mesh; /* NULL until it is there */
    vec3 scale;              /* above 0 */
    vec3 copies;             /* whole numbers from 1, along the axes of the solid's frame */
    vec3 spacing;            /* from copy to copy, in that frame */
} solid_shape;

/* Copies of one mesh, and of all meshes together. */
enum { COPIES_MAX = 1 << 22 };

/* All that is known of the shape's kind: geometry/shapes/shape.h. */
struct shape_rule;
const struct shape_rule *shape_of(const solid_shape *shape);

/* Checks what single ranges cannot: inner_radius < radius, floor < height. */
status solid_shape_check(const solid_shape *shape, diagnostic *why);

/* Does the closed solid contain the point? By its definition; for tests and for hints. Of a mesh it is not known here,
 * and false. */
bool solid_shape_contains(const solid_shape *shape, vec3 point);

/* The rotation of rotation_deg: local to world. */
mat3 rotation_from_deg(vec3 rotation_deg);
