/* The interface of a kind of primitive: one constant table of functions, in the file of its name in this folder,
 * compiled for each instruction set. A primitive points to its kind's rule, so that there is no list of kinds: a new
 * kind is one file, and the shapes that use it declare it with PRIMITIVE_RULE.
 *
 * Points and rays are in the primitive's local frame; faces are numbered from 0. Functions are pure and cannot fail. A
 * mesh has no rule (geometry/instance_set.h): the functions at the end return false, 0 or zeros for it. */
#pragma once

#include "base/isa.h"
#include "geometry/primitives/mapping.h"
#include "geometry/rays.h"
#include "geometry/roots.h"

typedef struct interval {
    double in, out;
} interval;

enum { CHORDS_MAX = 3 }; /* intervals of a line inside a primitive: a line crosses a biconcave lens up to six times */

/* A face with a constant local coordinate: axis 0 x, 1 y, 2 z. `outwards` is the direction away from the primitive: +1
 * or -1; 0 for a surface whose textures are looked up on the surface itself and not just inside it. */
enum { FLATS_MAX = 6 };
typedef struct flat_face {
    int face, axis;
    double at, outwards;
} flat_face;

typedef struct primitive_functions {
    int intervals; /* the most intervals of a line in it: 1 if it is convex, otherwise up to CHORDS_MAX */
    /* First pass (intervals_kernel.c): fills s->in[bit] and s->out[bit] for every ray, in that number of rows. */
    void (*rows)(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s);
    /* The same for ray i of the batch alone: `intervals` of them. inside: is its start in the primitive? s has the
     * terms that the rays of the batch share (KERNEL(shared_terms)). */
    void (*one)(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found);
    /* Third pass: geometry_kernels.surface. */
    void (*points)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);
    /* Is q in it, by its definition, surfaces included? */
    bool (*contains)(const primitive *p, vec3 q);
    /* The intervals of the whole line of r in it, in order; returns their number. */
    int (*chords)(const primitive *p, local_ray r, interval chords[CHORDS_MAX]);
    /* The faces perpendicular to a local axis; returns their number. NULL: none. */
    int (*flats)(const primitive *p, flat_face flat[FLATS_MAX]);
    /* Texture coordinates of the point q on a face. */
    surface_mapping (*mapping)(const primitive *p, int64_t face, vec3 q, double size);
} primitive_functions;

typedef struct primitive_rule {
#define PRIMITIVE_RULE_MEMBER(set, ...) const primitive_functions *set;
    ISA_EACH(PRIMITIVE_RULE_MEMBER, )
} primitive_rule;

/* Declares name_rule, the rule of the kind in name_kernel.c. */
#define PRIMITIVE_RULE(name)                                 \
    ISA_DECLARE(const primitive_functions, name##_functions) \
    static const primitive_rule name##_rule = ISA_ARRAY(name##_functions)

/* Does it contain the point, in world coordinates? */
bool primitive_contains(const primitive *p, vec3 point);

/* The intervals of a line (world coordinates) in it; returns their number. */
int primitive_chords(const primitive *p, vec3 origin, vec3 direction, interval chords[CHORDS_MAX]);

/* Its faces perpendicular to a local axis; returns their number. */
int primitive_flats(const primitive *p, flat_face flat[FLATS_MAX]);

/* Texture coordinates of a point (world coordinates) on that face (a face number, see scene_geometry.h). */
surface_mapping primitive_mapping(const primitive *p, int64_t face, vec3 point, double size);
