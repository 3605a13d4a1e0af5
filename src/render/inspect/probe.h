/* One ray, taken apart: the whole tree of rays that a camera ray, or any ray, grows into, as the tracer traces it. A
 * probe drives the same tracer with batches of one ray and writes down what it sees, so that what it reports is what a
 * render does, to the bit: a tree's radiance is the film's value of that pixel.
 *
 * Ownership: probe_create gives, probe_destroy releases; it borrows the scene, whose pictures are loaded. A ray_tree is
 * the caller's; zero it before its first use (its memory is used again by the next ray), and release it with
 * ray_tree_release. One probe serves one thread. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "base/vec3.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum ray_kind { RAY_CAMERA, RAY_REFLECT, RAY_REFRACT, RAY_SHADOW } ray_kind;

/* How a ray ended: at an interface; in the background; not traced because of the depth limit, or of render.min_weight;
 * of a shadow ray, whether its light came through (a part of it, perhaps). */
typedef enum ray_end {
    RAY_END_HIT,
    RAY_END_SKY,
    RAY_END_CUT_DEPTH,
    RAY_END_CUT_WEIGHT,
    RAY_END_LIT,
    RAY_END_BLOCKED
} ray_end;

/* A medium: the index in scene.solids of the solid that it belongs to, or RAY_OUTSIDE for what surrounds all solids. */
enum { RAY_OUTSIDE = -1, RAY_NONE = -1 };

typedef struct ray_hit {
    int solid; /* index in scene.solids: whose surface it is */
    int face_solid,
        face;    /* the geometric surface that was crossed: the solid that it bounds, and probe_face_name's number */
    bool opaque; /* nothing goes on behind it */
    double t;    /* distance from the ray's origin, scene units */
    vec3 point, normal; /* normal: unit vector towards the ray */
    int from, to;       /* media before and behind it */
    double n_from, n_to;
    double cos_i, cos_t; /* cos_t is 0 under total internal reflection */
    double R_s, R_p, R;  /* power reflectances of the interface with its coating; of an opaque surface or under simple
                          * transmission,  its reflectivity */
    bool tir;
    double T; /* power transmittance of the surface, with coating and transparency; 0 of an opaque one */
    double gain_classic, gain_basic; /* what radiance from beyond is multiplied by: T, and T (n_from / n_to)^2 */
    double path_length_m;            /* length of the ray up to here in metres: t render.unit_m */
    double transmittance[3]; /* share of the light that the medium lets through over it (Beer and Lambert), RGB */
    double error_bound;      /* on the point's distance from the exact one across the surface, scene units */
} ray_hit;

typedef struct ray_node {
    ray_kind kind;
    ray_end end;
    int depth;                     /* 0: camera ray; of a shadow ray, that of the ray whose hit it leaves */
    int parent, first_child, next; /* indices in the tree; RAY_NONE */
    vec3 origin, direction;        /* unit vector; of a shadow ray, towards the light */
    double throughput[3]; /* RGB weight at the ray's start (with basic radiance of L / n^2); of a shadow ray the
                           * radiance that it brings if nothing is in the way */
    double stokes[4]; /* with render.polarisation: the analyser's Stokes vector relative to its first element, in the
                       * ray's canonical frame (optics/mueller.h); else 1 0 0 0 */
    int medium;       /* in which it sets out */
    double n;
    int light;             /* of a shadow ray: index in scene.lights, else RAY_NONE */
    double let_through;    /* of a shadow ray: share that the surfaces in its path let through; else 1 */
    double light_distance; /* of a shadow ray: from its origin to the light */
    double brought[3];     /* radiance that this ray itself puts into the film (its children's not counted) */
    ray_hit hit;           /* when end is RAY_END_HIT */
} ray_node;

typedef struct ray_tree {
    ray_node *node; /* node[0] is the first root */
    size_t count, capacity;
    int depth_limit;
    double lambda_nm;   /* at which indices of refraction were taken */
    double radiance[3]; /* what the film holds after the tree, exactly */
} ray_tree;

void ray_tree_release(ray_tree *tree);

typedef struct probe probe;

status probe_create(const scene *s, isa level, probe **out, diagnostic *why);
void probe_destroy(probe *p);

/* From now on absorption by wavelength is taken at render.lambda_nm for all channels, as indices are; of a scene whose
 * picture is spectral that is so from the start. Its pixels are then not those of an rgb film. */
void probe_one_wavelength(probe *p);

/* The tree of a pixel; with more samples a pixel it has as many roots, linked by next. STATUS_BAD_INPUT outside the
 * picture, and for a tree of more than PROBE_NODES_MAX rays. */
enum { PROBE_NODES_MAX = 2000000 };
status probe_pixel(probe *p, int x, int y, ray_tree *tree, diagnostic *why);

/* The tree of any ray; the direction need not be a unit vector. It sets out in the medium at its origin. */
status probe_ray(probe *p, vec3 origin, vec3 direction, ray_tree *tree, diagnostic *why);

/* The same, but of a hit's branches only one is followed, as an array of nodes each of which is its predecessor's
 * child: the refracted one where there is any, else the reflected one; or with `reflect_at` >= 0, at the interface of
 * that number (counted from 0) the reflected one. No shadow rays. */
status probe_path(probe *p, vec3 origin, vec3 direction, int reflect_at, ray_tree *tree, diagnostic *why);

/* "vessel", or the catalogue's name of its medium; "air" for what surrounds all when its index is 1. */
const char *probe_medium_name(const probe *p, int at);

/* "outer side", "floor", "top": the name of a hit's face. */
const char *probe_face_name(const probe *p, const ray_hit *hit);

/* Which solid holds a point by the rule of priorities, or RAY_OUTSIDE: read from the solids' own shapes, not from the
 * tracer; where there are meshes, by the arrangement. An open mesh holds nothing. */
int probe_medium_at(const probe *p, vec3 point);

/* A camera ray's direction through a point of the picture, in pixels from its top left corner; unit vector. */
vec3 probe_camera_direction(const probe *p, double x, double y);
