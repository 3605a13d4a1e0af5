/* What the program knows of a shape: one constant rule each, in the file of its name, from which readers, writers,
 * parameters, checks, hints, drawings and the kernels' primitives are all derived. A new shape is its file here, its
 * row in geometry/solid.h, and rows in scene/model/params_table.c for parameters that no shape has had before.
 *
 * Functions get a shape that passes its check, unless they are the check. "Local" is the solid's own frame; directions
 * are unit vectors. Pure; ownership: rules are constant; shapes borrow their meshes. */
#pragma once

#include "geometry/solid.h"
#include <stddef.h>

struct primitive;

enum { SHAPE_PRIMITIVES = 2, RINGS_MAX = 16 }; /* of one shape, at most */

/* The least box around a shape in its own frame, and the radius of a ball about that box's middle that holds it. */
typedef struct shape_extent {
    bounds3 box;
    double ball;
} shape_extent;

/* Corners of a level ring in a drawing: at height y, of the ellipse of half axes x and z, the first one so many degrees
 * from +x towards +z. */
typedef struct shape_ring {
    int part; /* a convex piece, drawn as the outline of all its rings */
    double y, x, z;
    int corners; /* 0: it is round */
    double from_deg;
} shape_ring;

/* A shape and its rotation, local to world. */
typedef struct placed_shape {
    solid_shape shape;
    mat3 turn;
} placed_shape;

/* Distances from an axis along local y (x^2 + m^2 z^2), or from a point. */
typedef struct round_frame {
    vec3 origin;
    mat3 turn;
    double m;
    bool from_point;
} round_frame;

typedef struct shape_rule {
    const char *word;              /* in files: "cylinder" */
    const char *meaning;           /* one line for the manual, in its own frame, no full stop */
    const char *const *parameters; /* of the parameter table, those that it has and not every solid, with NULL behind;
                                    * NULL for none */

    /* What makes it unlike others. */
    bool triangles; /* its surface is that of a mesh, which it names; that has materials, texture coordinates and a
                     * hierarchy of its own, and may be open or not yet loaded */
    bool unbounded; /* it has no extent: it can only be a ground or a wall to others, and has a size of texture */
    bool hollow;    /* it is a vessel: what is inside its wall is outside the solid */
    bool isotropic; /* no rotation changes it */
    bool curved;    /* some of its surface is not flat */

    /* Finds numbers that are wrong together, or no lengths. NULL: nothing can be. */
    status (*check)(const solid_shape *shape, diagnostic *why);
    /* Does the closed solid contain the local point? NULL: not known. */
    bool (*contains)(const solid_shape *shape, vec3 local);
    /* Writes what the kernels intersect: primitive_count of them, the second one hollows the first one out. */
    int primitive_count;
    int further_rows; /* how many more than one each of them takes: see geometry/scene_geometry.h */
    void (*primitives)(const solid_shape *shape, struct primitive *out);
    /* By primitive, names of its faces by their number there; the last one is that of all that follow. */
    const char *const *faces[SHAPE_PRIMITIVES];
    /* The i-th of its flat faces by its normal and one of its points, both local; false past the last one. */
    bool (*flat)(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point);

    /* NULL of an unbounded one. */
    shape_extent (*extent)(const solid_shape *shape);
    /* The most of direction . p over its local points p; of an unbounded one INFINITY where it has no end. */
    double (*farthest)(const solid_shape *shape, vec3 direction);
    /* The most of round_distance over its points, or more. NULL: that of the corners of its box. */
    double (*farthest_from)(const placed_shape *placed, const round_frame *frame);
    /* Is all of the other one known to lie in it? NULL: nothing is. */
    bool (*covers)(const placed_shape *cover, const placed_shape *hidden);
    /* How thick it is where it is thinnest. */
    double (*thickness)(const solid_shape *shape);
    /* Makes it fill about a cube of that edge. NULL where there is nothing to set. */
    void (*fit)(solid_shape *shape, double size);

    /* Writes what it is drawn by in outline, and returns how many. NULL: it has none, or none that is known here. */
    int (*rings)(const solid_shape *shape, shape_ring out[RINGS_MAX]);
    /* The surface of one of its primitives, part, as triangles in its own frame, to be scaled by tessellation_scale.
     * NULL: it is drawn otherwise. */
    status (*tessellation)(const solid_shape *shape, int part, mesh **out, diagnostic *why);
    vec3 (*tessellation_scale)(const solid_shape *shape); /* NULL: 1 */
    bool one_tessellation;                                /* it is the same for all, but for the scale */
} shape_rule;

/* NULL past the last kind. */
const shape_rule *shape_of_kind(shape_kind kind);
/* False when there is none. */
bool shape_named(const char *word, shape_kind *out);
bool shape_has(const shape_rule *rule, const char *parameter);
/* "surface" where it has no name. face: of the solid, a hollow's from HOLLOW_FACES on. */
const char *shape_face_name(const shape_rule *rule, int64_t face);

/* A point, as a solid that holds nothing else. */
solid_shape shape_point(vec3 at);
placed_shape shape_placed(const solid_shape *shape);
/* How far it reaches along a local direction: as farthest says, of triangles as the box around them does. */
double shape_reach(const solid_shape *shape, vec3 direction);
/* The box around it in the world, that of a mesh around its local box; infinite for an unbounded one. */
bounds3 shape_world_box(const solid_shape *shape);

/* What the shape takes of an arrangement's places, PRIMITIVES_MAX in all. */
static inline int shape_places(const solid_shape *shape)
{
    return shape_of(shape)->primitive_count + shape_of(shape)->further_rows;
}

#define SHAPE_DECLARED(KIND, file) extern const shape_rule shape_##file;
SHAPES(SHAPE_DECLARED)
#undef SHAPE_DECLARED
