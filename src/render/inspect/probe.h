/* The probe: the complete ray tree of a camera ray, or of any ray, as the tracer traces it. A probe drives the same
 * tracer with batches of one ray and records them. For an rgb film of ray trees or ray casting that uses no random
 * numbers (no lens, soft shadows or photons), its result is bit-identical to a render: a tree's radiance is the film's
 * value of that pixel. For other settings it traces the tree of the integrator whitted, for the chief ray and at
 * render.lambda_nm, without photons.
 *
 * Ownership: probe_create allocates, probe_destroy releases; it borrows the scene, whose images must be loaded. The
 * caller owns a ray_tree: zero it before its first use (the next ray reuses its memory), and release it with
 * ray_tree_release. One probe serves one thread. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "base/vec3.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum ray_kind { RAY_CAMERA, RAY_REFLECT, RAY_REFRACT, RAY_SHADOW } ray_kind;

/* The end of a ray: at an interface; in the background; not traced because of the depth limit, or of render.min_weight;
 * for a shadow ray, whether some of its light arrives. */
typedef enum ray_end {
    RAY_END_HIT,
    RAY_END_SKY,
    RAY_END_CUT_DEPTH,
    RAY_END_CUT_WEIGHT,
    RAY_END_LIT,
    RAY_END_BLOCKED
} ray_end;

/* A medium: the index in scene.solids of its solid, or RAY_OUTSIDE for the medium around all solids. */
enum { RAY_OUTSIDE = -1, RAY_NONE = -1 };

typedef struct ray_hit {
    int solid; /* index in scene.solids of the solid whose surface is hit */
    /* the geometric surface that was hit: the solid that it bounds, and the face's number for probe_face_name */
    int face_solid, face;
    bool opaque;        /* no ray continues behind it */
    double t;           /* distance from the ray's origin, scene units */
    vec3 point, normal; /* normal: unit vector towards the ray */
    int from, to;       /* media before and behind the surface */
    double n_from, n_to;
    double cos_i, cos_t; /* cos_t: 0 under total internal reflection and at an opaque surface */
    /* power reflectances of the interface with its half mirror; for an opaque surface or simple transmission, its
     * reflectivity; for a metal or a thin film, at the tree's wavelength; at a crystal all are equal, the fraction of
     * this ray's light that is reflected */
    double R_s, R_p, R;
    bool tir;
    double T; /* power transmittance of the surface, with half mirror and transparency; 0 for an opaque one */
    double gain_classic, gain_basic; /* factor of radiance from behind: T, and T (n_from / n_to)^2 */
    double path_length_m;            /* length of the ray to this hit in metres: t render.unit_m */
    double transmittance[3];         /* of the medium over this length (Beer and Lambert), RGB */
    double error_bound;              /* bound on the point's distance from the exact surface, scene units */
} ray_hit;

typedef struct ray_node {
    ray_kind kind;
    ray_end end;
    int depth;                     /* 0: camera ray; for a shadow ray, the depth of the ray at whose hit it starts */
    int parent, first_child, next; /* indices in the tree, or RAY_NONE */
    vec3 origin, direction;        /* unit vector; for a shadow ray, towards the light */
    /* RGB weight at the ray's start (with basic radiance, of L / n^2); for a shadow ray the radiance that it
     * contributes if unblocked */
    double throughput[3];
    double stokes[4]; /* with render.polarisation: the analyser's Stokes vector relative to its first element, in the
                       * ray's canonical frame (optics/mueller.h); else 1 0 0 0; in a crystal 1 1 0 0 for an ordinary
                       * and 1 -1 0 0 for an extraordinary ray, always */
    int medium;       /* medium in which it starts */
    double n;
    int light;                   /* for a shadow ray: index in scene.lights, else RAY_NONE */
    double shadow_transmittance; /* for a shadow ray: transmittance of the surfaces in its path; else 1 */
    double light_distance;       /* for a shadow ray: from its origin to the light */
    double contribution[3];      /* radiance that this ray adds to the film, excluding its children */
    ray_hit hit;                 /* valid if end is RAY_END_HIT */
} ray_node;

typedef struct ray_tree {
    ray_node *node; /* node[0] is the first root */
    size_t count, capacity;
    int depth_limit;
    double lambda_nm;   /* wavelength of the refractive indices */
    double radiance[3]; /* the exact film value after the tree */
} ray_tree;

void ray_tree_release(ray_tree *tree);

typedef struct probe probe;

status probe_create(const scene *s, isa level, probe **out, diagnostic *why);
/* Replaces render.depth; values above DEPTH_TREE_MAX are only for paths. remedy: what errors advise for too large a
 * tree; borrowed. */
void probe_limit_depth(probe *p, int depth, const char *remedy);
void probe_destroy(probe *p);

/* From this call on, absorption by wavelength, metals and thin films are evaluated at render.lambda_nm for all
 * channels, as refractive indices are; for a spectral scene this is always so. The pixel values then differ from those
 * of an rgb film. */
void probe_use_one_wavelength(probe *p);

/* The tree of a pixel; with several samples per pixel it has as many roots, linked by next. STATUS_BAD_INPUT outside
 * the image, and for a tree of more than PROBE_NODES_MAX rays. It can be cancelled at every ray (base/cancel.h). */
enum { PROBE_NODES_MAX = 2000000 };
status probe_pixel(probe *p, int x, int y, ray_tree *tree, diagnostic *why);

/* The tree of any ray; the direction need not be a unit vector. The ray starts in the medium at its origin. */
status probe_ray(probe *p, vec3 origin, vec3 direction, ray_tree *tree, diagnostic *why);

/* Follows only one branch of each hit; the result is an array of nodes, each the child of the one before. The refracted
 * branch is followed if there is one, else the reflected one; with `reflect_at` >= 0, the reflected one at the
 * interface of that number (counted from 0). No shadow rays. */
status probe_path(probe *p, vec3 origin, vec3 direction, int reflect_at, ray_tree *tree, diagnostic *why);

/* The catalogue name of a medium, or else its solid's name, such as "vessel"; "air" for the surrounding medium if its
 * index is 1. */
const char *probe_medium_name(const probe *p, int at);

/* The name of a hit's face: "outer side", "floor", "top". */
const char *probe_face_name(const probe *p, const ray_hit *hit);

/* The solid that contains a point by the rule of priorities, or RAY_OUTSIDE: computed from the solids' own shapes,
 * independent of the tracer; with meshes, from the scene geometry. An open mesh contains nothing. */
int probe_medium_at(const probe *p, vec3 point);

/* The direction of the camera ray through a point of the image, in pixels from the top left corner; a unit vector. */
vec3 probe_camera_direction(const probe *p, double x, double y);
