/* Solids as the kernels see them: primitives, and bodies ordered by priority. A body is one primitive, or a convex one
 * less another convex one (a cup: its outside less its hollow).
 *
 * A primitive that is not convex owns several rows of the scratch for a ray (ray_scratch): its next intervals ahead, in
 * order. The places behind its own in the list of primitives hold these rows and nothing else; a ray's set never has
 * their bits.
 *
 * The medium at a point is the body of the highest rank that contains it (rank 0: none, the surrounding medium). A ray
 * carries one bit for each primitive that it is in. A closed mesh is a primitive too, though not convex; an open one is
 * a skin, in which no ray ever is. An interface is a point of the ray where the medium changes: crossings that a higher
 * body hides, or that lead into an equal medium, are none (Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced
 * Images", JGT 7(2), 2002).
 *
 * Ownership: scene_geometry_build gives, scene_geometry_destroy releases; kernels borrow. Geometry knows no colour: of
 * a medium it knows a number (equal numbers, equal indices: no interface between them), whether it is opaque, and
 * whether it absorbs. */
#pragma once

#include "base/status.h"
#include "geometry/solid.h"
#include <stdbool.h>
#include <stdint.h>

enum {
    PRIMITIVES_MAX = 64, /* one bit each in a ray's set */
    FACES_MAX = 64,      /* a face's number is primitive * FACES_MAX + face; a power of two */
    HOLLOW_FACES = 8,    /* a hollow's faces, as one of its solid's: from here */
    FACE_NONE = -1
};

/* The files of primitives/ say what a kind is and how its faces are numbered. Meshes number theirs otherwise: see
 * instance_set.h. */
typedef struct primitive {
    const struct primitive_rule *rule; /* of its kind (primitives/primitive.h); NULL for a mesh */
    bool turned;                       /* rotation is not the identity */
    mat3 rotation;                     /* local to world */
    vec3 origin;                       /* of the local frame, in the world */
    double radius, m2;                 /* cylinder x^2 + m2 z^2 <= radius^2; others (m2 = 1) */
    double bottom, top;                /* local y; a cylinder's top may be infinite */
    vec3 half;                         /* box */
    double second_radius;              /* a second length across, of those kinds that have one */
    int sides;                         /* that are alike and stand around the axis; 0 for none */
    const vec3 *normals;               /* of the sides; the arrangement's own */
    int64_t first_face;
    int rows;           /* of the scratch: from its own on, so many intervals as a ray has at most in it */
    int priority_index; /* of its body */
    double extent;      /* farthest finite coordinate from the world's origin, for error bounds */
} primitive;

typedef struct region {
    int outside, hollow; /* primitives; hollow = -1 for none */
    int64_t medium;      /* equal numbers are equal media */
    bool opaque;
    double shadow_transmittance; /* share of light that a shadow ray keeps at each of its interfaces; 0 when opaque */
    const double
        *face_shadow_transmittance; /* the same by slot of a mesh whose faces differ, clearness being the least;
                                   * borrowed, or NULL */
    bool attenuates;                /* its medium takes light away with length */
    bool reflects; /* by the angle: shadow rays note where they cross its surface (see ray_crossings) */
    int solid;     /* index of the solid it came from */
} region;

typedef struct scene_geometry {
    int primitive_count;
    primitive *primitives;
    int region_count;            /* ranks 1 .. region_count */
    region *regions;             /* [0] is the surrounding medium */
    solid_shape *shapes;         /* by rank, what the bodies were made of; [0] is none */
    double extent;               /* largest of the primitives' */
    uint64_t further;            /* rows that hold further intervals of a primitive before them */
    uint64_t opaque_regions;     /* bit r - 1: the body of rank r is opaque */
    bool distinct;               /* no two bodies are of one medium, nor is any of the surrounding one */
    bool attenuates;             /* one of the bodies does, or the surrounding medium */
    struct instance_set *meshes; /* all of them; NULL when there is none */
    vec3 *normals;               /* of all primitives with sides */
    int normal_count;
} scene_geometry;

/* Can a body take light away from a shadow ray by itself? With solid_shadows every body does. */
static inline bool region_casts_shadow(const region *b, bool solid_shadows)
{
    return b->opaque || solid_shadows || b->shadow_transmittance < 1.0 || b->attenuates || b->reflects;
}

/* What scene_geometry_build wants to know of a solid. */
typedef struct region_source {
    const solid_shape *shape;
    const struct hierarchy *tree; /* over the triangles of a mesh; borrowed, like the mesh */
    int64_t priority;             /* higher wins; of equals the one that comes first */
    int64_t medium;
    bool opaque;
    double shadow_transmittance;
    const double *face_shadow_transmittance; /* by slot; borrowed, or NULL */
    bool attenuates, reflects;
    int solid;
} region_source;

/* outside_medium is the medium of rank 0. STATUS_BAD_INPUT for more than PRIMITIVES_MAX primitives. */
status scene_geometry_build(const region_source *sources, int count, int64_t outside_medium, scene_geometry **out,
                            diagnostic *why);
void scene_geometry_destroy(scene_geometry *a);

/* The surrounding medium takes light away with length: then what every shadow ray goes through is noted. */
void scene_geometry_surroundings_absorb(scene_geometry *a);

/* The set of primitives that contain a point, bit by bit, by the primitives' own definitions (surfaces included). */
uint64_t scene_geometry_inside(const scene_geometry *a, vec3 point);

/* The rank of the body whose surface an interface between two ranks is: an opaque body's if either is opaque (the one
 * behind, if both are), else that of the higher rank. */
int scene_geometry_surface(const scene_geometry *a, int before, int after);

/* The rank of the medium where a ray is in that set of primitives. */
int scene_geometry_priority_index(const scene_geometry *a, uint64_t inside);
