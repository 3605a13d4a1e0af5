/* What the program knows of a shape: one constant rule each, in the file of its name, from which readers, writers,
 * parameters, checks, hints, drawings and the kernels' primitives are all derived. A new shape is its file here, its
 * row in geometry/solid.h, and rows in scene/model/params_table.c for parameters that no shape has had before.
 *
 * Functions get a shape that passes its check, unless they are the check. "Local" is the frame of the solid. Pure;
 * ownership: rules are constant. */
#ifndef CUVETTE_GEOMETRY_SHAPES_SHAPE_H
#define CUVETTE_GEOMETRY_SHAPES_SHAPE_H

#include "geometry/solid.h"

struct primitive;

enum { SHAPE_PRIMITIVES = 2 }; /* of one shape, at most */

typedef struct shape_rule {
    const char *word; /* in files: "cylinder" */

    /* What makes it unlike others. */
    bool triangles; /* its surface is that of a mesh, which it names; what can be asked of that is not asked here */

    /* Finds numbers that are wrong together, or no lengths. NULL: nothing can be. */
    status (*check)(const solid_shape *shape, diagnostic *why);
    /* Does the closed solid contain the local point? NULL: not known. */
    bool (*contains)(const solid_shape *shape, vec3 local);
    /* Writes what the kernels intersect: primitive_count of them, the second one hollows the first one out. */
    int primitive_count;
    int further_rows; /* how many more than one each of them takes: see geometry/arrangement.h */
    void (*primitives)(const solid_shape *shape, struct primitive *out);
} shape_rule;

const shape_rule *shape_of_kind(shape_kind kind);

/* What the shape takes of an arrangement's places, PRIMITIVES_MAX in all. */
static inline int shape_places(const solid_shape *shape)
{
    return shape_of(shape)->primitive_count + shape_of(shape)->further_rows;
}

#define SHAPE_DECLARED(KIND, file) extern const shape_rule shape_##file;
SHAPES(SHAPE_DECLARED)
#undef SHAPE_DECLARED

#endif
