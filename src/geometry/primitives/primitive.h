/* What a kind of primitive is to the rest of the program: one constant table of functions, in the file of its name
 * here, compiled for each instruction set. A primitive carries its kind's rule, so that there is no list of kinds: a
 * new one is its file, and the shapes that are made of it name it with PRIMITIVE_RULE.
 *
 * Points and rays are in the primitive's own frame, faces are numbered from 0. Functions are pure and cannot fail. A
 * mesh has no rule (geometry/instance_set.h): to the functions at the end its answers are none, nothing and zero. */
#pragma once

#include "geometry/primitives/mapping.h"
#include "geometry/rays.h"
#include "geometry/roots.h"

typedef struct interval {
    double in, out;
} interval;

enum { CHORDS_MAX = 2 };

/* A face on which a local coordinate is constant: axis 0 x, 1 y, 2 z. `outwards` is the side of the face that the
 * primitive is not on: +1 or -1; 0 for a surface that is looked up where it lies. */
enum { FLATS_MAX = 6 };
typedef struct flat_face {
    int face, axis;
    double at, outwards;
} flat_face;

typedef struct primitive_functions {
    int intervals; /* in which a line is in it, at most: 1 if it is convex, else CHORDS_MAX or fewer */
    /* First pass (intervals_kernel.c): s->in[bit] and s->out[bit] for every ray, and so many rows. */
    void (*rows)(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s);
    /* Third pass: geometry_kernels.surface. */
    void (*points)(const primitive *p, const ray_batch *rays, const double *t, int bit, surface_batch *points);
    /* Is q in it, by its definition, surfaces included? */
    bool (*contains)(const primitive *p, vec3 q);
    /* Where the whole line of r is in it, in order; returns how many. */
    int (*chords)(const primitive *p, local_ray r, interval chords[CHORDS_MAX]);
    /* The faces across a local axis; returns how many. NULL: none. */
    int (*flats)(const primitive *p, flat_face flat[FLATS_MAX]);
    /* Texture coordinates of the point q of a face. */
    surface_mapping (*mapping)(const primitive *p, int64_t face, vec3 q, double size);
} primitive_functions;

typedef struct primitive_rule {
    const primitive_functions *sse2, *avx2, *avx512;
} primitive_rule;

/* Declares name_rule, that of the kind in name_kernel.c. */
#define PRIMITIVE_RULE(name)                                                                                \
    extern const primitive_functions name##_functions_sse2, name##_functions_avx2, name##_functions_avx512; \
    static const primitive_rule name##_rule = {&name##_functions_sse2, &name##_functions_avx2, &name##_functions_avx512}

/* Does it contain the point, of the world? */
bool primitive_contains(const primitive *p, vec3 point);

/* Where a line of the world is in it; returns how many pieces. */
int primitive_chords(const primitive *p, vec3 origin, vec3 direction, interval chords[CHORDS_MAX]);

/* Its faces across an axis of its own; returns how many. */
int primitive_flats(const primitive *p, flat_face flat[FLATS_MAX]);

/* The point of the world lies on that face (a face's number, see scene_geometry.h). */
surface_mapping primitive_mapping(const primitive *p, int64_t face, vec3 point, double size);
