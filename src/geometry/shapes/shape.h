/* The interface of a shape: one constant rule each, in the file of its name, from which readers, writers, parameters,
 * checks, hints, drawings and the kernels' primitives are all derived. A new shape is a file in this folder, a row in
 * geometry/solid.h, and rows in scene/model/params_table.c for parameters that no shape had before.
 *
 * Functions except `check` receive a shape that passes its check. "Local" is the solid's own frame; directions are unit
 * vectors. Pure; ownership: rules are constant; shapes borrow their meshes. */
#pragma once

#include "geometry/solid.h"
#include <stddef.h>

struct primitive;

enum { SHAPE_PRIMITIVES = 2, RINGS_MAX = 20 }; /* the most per shape */

/* The bounding box of a shape in its own frame, and the radius of a ball about the box's centre that contains the
 * shape. */
typedef struct shape_extent {
    bounds3 box;
    double ball;
} shape_extent;

/* Corners of a horizontal ring in a drawing: at height y, on the ellipse of half axes x and z; the first corner is at
 * from_deg degrees from +x towards +z. */
typedef struct shape_ring {
    int part; /* a convex piece, drawn as the outline of all its rings */
    double y, x, z;
    int corners; /* 0: a smooth curve */
    double from_deg;
} shape_ring;

/* A shape, its rotation matrix, local to world, and its rule. */
typedef struct placed_shape {
    solid_shape shape;
    mat3 turn;
    const struct shape_rule *rule;
} placed_shape;

/* What round_distance measures from: an axis along local y, by sqrt(x^2 + m^2 z^2), or the point `origin`. */
typedef struct round_frame {
    vec3 origin;
    mat3 turn;
    double m;
    bool from_point;
} round_frame;

typedef struct shape_rule {
    const char *word;              /* in files: "cylinder" */
    const char *meaning;           /* one line for the manual, in the local frame, no full stop */
    const char *const *parameters; /* without the parameters that every solid has; NULL-terminated, NULL for none */

    /* Properties that distinguish it from other shapes. */
    /* Its surface is a triangle mesh, given by name; the mesh has its own materials, texture coordinates and hierarchy,
     * and may be open or not yet loaded. */
    bool triangles;
    bool unbounded; /* no finite extent: serves only as a ground or wall for others, and has a texture size */
    bool hollow;    /* it is a vessel: the space within its wall is outside the solid */
    bool isotropic; /* no rotation changes it */
    bool curved;    /* part of its surface is not flat */

    /* Checks for numbers that are invalid together, and for invalid lengths. NULL: nothing to check. */
    status (*check)(const solid_shape *shape, diagnostic *why);
    /* Whether the closed solid contains the local point. NULL: unknown. */
    bool (*contains)(const solid_shape *shape, vec3 local);
    /* Writes the primitives for the kernels, primitive_count of them; the second one is subtracted from the first. */
    int primitive_count;
    int further_rows; /* scratch rows beyond one per primitive: see geometry/scene_geometry.h */
    int (*more_rows)(const solid_shape *shape); /* further rows of this shape only; NULL: none */
    void (*primitives)(const solid_shape *shape, struct primitive *out);
    /* The bytes of the data that its first primitive refers to (primitive.details), 0 for none; writes them unless out
     * is NULL. NULL: it never has any. */
    size_t (*details)(const solid_shape *shape, void *out);
    /* By primitive, the names of its faces by number; the last name also applies to all higher numbers. */
    const char *const *faces[SHAPE_PRIMITIVES];
    /* The numbers of the faces of material_1 and material_2, if these are among its parameters. */
    int ends[2];
    /* The normal and one point of its i-th flat face, both local; false past the last one. */
    bool (*flat)(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point);

    /* NULL for an unbounded shape. */
    shape_extent (*extent)(const solid_shape *shape);
    /* The maximum of direction . p over its local points p; INFINITY where an unbounded shape has no end. */
    double (*farthest)(const solid_shape *shape, vec3 direction);
    /* An upper bound of round_distance over the points of the shape. NULL: the caller uses the corners of its bounding
     * box. */
    double (*farthest_from)(const placed_shape *placed, const round_frame *frame);
    /* Whether `hidden` is known to be entirely inside `cover`. NULL: never. */
    bool (*covers)(const placed_shape *cover, const placed_shape *hidden);
    /* The shape's least thickness. */
    double (*thickness)(const solid_shape *shape);
    /* Scales it to fill about a cube with that edge length. NULL: the shape has no size to set. */
    void (*fit)(solid_shape *shape, double size);

    /* Writes the rings of its outline drawing and returns their number. NULL: it has none, or the outline is computed
     * elsewhere. */
    int (*rings)(const solid_shape *shape, shape_ring out[RINGS_MAX]);
    /* The surface of one of its primitives (number `part`) as triangles in its own frame, to be scaled by
     * tessellation_scale. NULL: it is drawn in another way. */
    status (*tessellation)(const solid_shape *shape, int part, mesh **out, diagnostic *why);
    vec3 (*tessellation_scale)(const solid_shape *shape); /* NULL: 1 */
    bool one_tessellation;                                /* all solids of the kind share it, up to the scale */
} shape_rule;

/* NULL past the last kind. */
const shape_rule *shape_of_kind(shape_kind kind);
/* False if no shape has that name. */
bool shape_named(const char *word, shape_kind *out);
bool shape_has(const shape_rule *rule, const char *parameter);
/* "surface" for a face without a name. face: of the solid; a hollow's faces start at HOLLOW_FACES. */
const char *shape_face_name(const shape_rule *rule, int64_t face);

/* --- the functions above for a shape with its scale, which multiplies the local frame's coordinates --- */

/* Whether its scale differs from 1: a quick test before the next one. */
static inline bool shape_has_scale(const solid_shape *shape)
{
    return shape->scale.x != 1.0 || shape->scale.y != 1.0 || shape->scale.z != 1.0;
}
/* Whether it is scaled or mirrored; a mesh has its own scale, and that of a solid at points is theirs. */
bool shape_is_scaled(const solid_shape *shape);
/* Whether no rotation changes it. */
bool shape_is_isotropic(const solid_shape *shape);
/* Not for an unbounded shape. */
shape_extent shape_extent_of(const solid_shape *shape);
/* The maximum of d . p over its local points; d: a unit vector. */
double shape_farthest(const solid_shape *shape, vec3 d);
/* A lower bound of its thickness, exact without a scale. */
double shape_thickness(const solid_shape *shape);
int shape_rings(const solid_shape *shape, shape_ring out[RINGS_MAX]);
vec3 shape_tessellation_scale(const solid_shape *shape);
/* Its primitives, as shape_rule.primitives, up to SHAPE_PRIMITIVES; their details are not set. */
void shape_primitives(const solid_shape *shape, struct primitive *parts);
/* The bytes of the details of its primitive number k; writes them unless out is NULL. */
size_t shape_details(const solid_shape *shape, int k, void *out);

/* A point, as a solid that contains nothing else. */
solid_shape shape_point(vec3 at);
placed_shape shape_placed(const solid_shape *shape);
/* A local axis (0 x, 1 y, 2 z) in the world. */
vec3 placed_axis(const mat3 *turn, int k);

/* The maximum of direction . p over all points of the shape; INFINITY for an unbounded shape, and while its mesh is not
 * loaded. */
double placed_farthest(const placed_shape *placed, vec3 direction);
/* placed_farthest, but finite for an unbounded shape in the direction of its surface normal. */
double placed_limit(const placed_shape *placed, vec3 direction);

double round_distance(const round_frame *frame, vec3 point);
/* An upper bound of round_distance over all points of the shape. */
double placed_farthest_from(const placed_shape *placed, const round_frame *frame);

/* The maximum of d . p over a box. */
static inline double box_reach(bounds3 b, vec3 d)
{
    return (d.x > 0.0 ? b.high.x : b.low.x) * d.x + (d.y > 0.0 ? b.high.y : b.low.y) * d.y +
           (d.z > 0.0 ? b.high.z : b.low.z) * d.z;
}

/* What the points of a shape add to its reach along a local direction: the maximum over their bounding box, or 0. */
double points_reach(const solid_shape *shape, vec3 direction);
/* The maximum along a local direction: `farthest`, but for a mesh, and for points, over the bounding box. */
double shape_reach(const solid_shape *shape, vec3 direction);
/* The bounding box of a shape in the world (for a mesh, of its local box); infinite for an unbounded shape. */
bounds3 shape_world_box(const solid_shape *shape);

/* False: no face of one coincides with part of a face of the other, flat with flat (in the same plane) or curved with
 * curved. True: perhaps. Two meshes of many triangles are not compared. */
bool solid_shapes_may_coincide(const solid_shape *a, const solid_shape *b);

/* The number of PRIMITIVES_MAX entries of a scene geometry that the shape uses. */
static inline int shape_primitive_slots(const solid_shape *shape)
{
    const shape_rule *rule = shape_of(shape);
    return rule->primitive_count + rule->further_rows + (rule->more_rows ? rule->more_rows(shape) : 0);
}

#define SHAPE_DECLARED(KIND, file) extern const shape_rule shape_##file;
SHAPES(SHAPE_DECLARED)
#undef SHAPE_DECLARED
