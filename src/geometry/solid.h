/* Solids as a scene file describes them. Each shape is a row of SHAPES here and a file in geometry/shapes/ with
 * everything that is specific to it (geometry/shapes/shape.h); the kernels work on the primitives that a shape consists
 * of.
 *
 * A solid has its own local frame with its axis along y. It is rotated by rotation_deg (about x, then y, then z; see
 * rotation_from_deg) and then moved to position.
 *
 * Pure; ownership: values; a shape borrows its mesh. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include "geometry/mesh/mesh.h"
#include <stdbool.h>

/* In order of introduction: hashes of studies contain the number of a kind, so a new kind goes last. */
#define SHAPES(X)         \
    X(PLANE, plane)       \
    X(CYLINDER, cylinder) \
    X(CUP, cup)           \
    X(BOX, box)           \
    X(SPHERE, sphere)     \
    X(MESH, mesh)         \
    X(TORUS, torus)       \
    X(CONE, cone)         \
    X(PRISM, prism)       \
    X(LENS, lens)

#define SHAPE_KIND(KIND, file) SHAPE_##KIND,
typedef enum shape_kind { SHAPES(SHAPE_KIND) SHAPE_COUNT } shape_kind;
#undef SHAPE_KIND

typedef struct solid_shape {
    shape_kind kind;
    vec3 position;                                 /* scene units */
    vec3 rotation_deg;                             /* about x, then y, then z */
    double radius, height, m, inner_radius, floor; /* only those that the kind uses */
    /* the meniscus of a cylinder; no meniscus if capillary_length is 0; contact_radius 0: the radius */
    double contact_angle_deg, capillary_length, contact_radius;
    double tube_radius, top_radius;
    int64_t sides;
    double radius_1, radius_2, conic_1, conic_2, thickness, diameter; /* lens */
    double diameter_1, diameter_2;                                    /* of its sides; 0: the rim's */
    double chamfer_1, chamfer_2; /* radial lengths of the bevels between its sides and the rim; 0: none */
    double even_1[9], even_2[9]; /* of its sides' sag: coefficients of the 4th, 6th, ... 20th power of the radius */
    double odd_1[9], odd_2[9];   /* of the powers 1, 2, 3, 5, 7, ... 15 */
    int64_t form_1, form_2;      /* side_form (primitives/asphere.h) */
    /* of a side that is not round: its curvature along x */
    double radius_1_x, radius_2_x, conic_1_x, conic_2_x;
    vec3 size;
    const struct mesh *mesh;   /* NULL until loaded */
    const struct mesh *points; /* a copy of the solid is at each vertex; NULL: one solid, or not loaded */
    vec3 scale;                /* of the solid, or of the points: see shape_is_scaled; all 0: none */
    vec3 copies;               /* integers from 1, along the axes of the local frame */
    vec3 spacing;              /* between copies, in the local frame */
} solid_shape;

/* The most copies of one mesh, and of all meshes together: a face number has 22 bits for the copy
 * (mesh_face_number). */
enum { COPIES_MAX = 1 << 22 };

/* The rule of the shape's kind: geometry/shapes/shape.h. */
struct shape_rule;
const struct shape_rule *shape_of(const solid_shape *shape);

/* The number of solids that the shape stands for, 1 without points, and solid i: the shape at that point, without
 * points. Points are along the axes of the local frame, multiplied by scale; each copy has the shape's rotation. */
size_t solid_shape_count(const solid_shape *shape);
solid_shape solid_shape_copy(const solid_shape *shape, size_t i);

/* Checks the parameters, and constraints between them such as inner_radius < radius. */
status solid_shape_check(const solid_shape *shape, diagnostic *why);

/* Whether the closed solid contains the point, by its definition. For tests and hints. Always false for a mesh and for
 * a solid at points. */
bool solid_shape_contains(const solid_shape *shape, vec3 point);

/* The rotation matrix of rotation_deg: local to world. A positive angle takes y to z about x, z to x about y, x to y
 * about z: counter-clockwise for an eye that looks along the axis, because the world is left-handed (x right, y up, z
 * away). */
mat3 rotation_from_deg(vec3 rotation_deg);
/* Angles whose rotation_from_deg is r, settled. */
vec3 rotation_to_deg(mat3 r);
/* a b: first b, then a. */
mat3 mat3_product(mat3 a, mat3 b);
/* The nearest multiple of 1e-6 degrees if the angle is within 1e-12 of it, so that round numbers stay round. */
double settled_deg(double degrees);
