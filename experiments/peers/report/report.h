/* The rod scene by the algorithm of the report on the rod in the vessel (course work, Bauman Moscow State Technical
 * University, 2024): its listings 1 to 3 in C, with their errors, for comparison with Cuvette. It has the costs of the
 * listings: a heap allocation for each intersection and each hit, and a call through a pointer for each shape.
 *
 * What the report does not print is ours: the sizes (those of experiments/scenes/rod.yaml), the colours, the plane, the
 * normals and the nearest hit. One difference is intended: camera rays go through the centres of pixels, as in all
 * programs of the comparison, and not through their upper left corners. Single precision throughout, as in the
 * listings. The program ends with a message when out of memory. */
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>

typedef struct vec3f {
    float x, y, z;
} vec3f;
typedef struct rgb {
    float r, g, b;
} rgb;
typedef struct ray {
    vec3f origin, direction;
} ray;

/* The counts of a frame: rays, by kind; camera rays, by the shape that they hit first; rays without a hit, which take
 * the colour of the sky. Private to a thread until it is joined. */
enum { SHAPE_GROUND, SHAPE_VESSEL, SHAPE_LIQUID, SHAPE_ROD, SHAPE_COUNT };
typedef struct tally {
    uint64_t camera, secondary, shadow, sky;
    uint64_t first_hits[SHAPE_COUNT];
    uint64_t busiest, busiest_sky; /* of a frame: the most rays, and the most sky colours, of one thread */
} tally;

static inline uint64_t tally_rays(const tally *t)
{
    return t->camera + t->secondary + t->shadow;
}

typedef struct shape shape;
struct shape {
    vec3f *(*intersect)(const shape *s, const ray *r); /* the nearest point, allocated; NULL if there is none */
    vec3f (*normal)(const shape *s, vec3f at);         /* points outwards */
    vec3f position;                                    /* cylinder: its centre; plane: any point */
    float radius, half_height;                         /* cylinder */
    vec3f low, high;                                   /* box */
    rgb color;
    float reflectivity, transparency, index, emission;
};

typedef struct hit {
    ray ray;
    const shape *shape;
    vec3f position, normal;
    float index; /* in front of the surface; always 1, because no media are tracked */
} hit;

typedef struct setting {
    int width, height, depth, threads;
    float glass_index, liquid_index;
    float fov_deg; /* over the shorter edge of the image */
} setting;

typedef struct room {
    shape shapes[SHAPE_COUNT];
    vec3f light, eye;
    float pitch, distance; /* pitch: radians, downwards; distance of the image plane, whose shorter edge is 2 */
    int depth;             /* the listings' MAX_BOUNCES */
} room;

static inline vec3f add(vec3f a, vec3f b)
{
    return (vec3f){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline vec3f sub(vec3f a, vec3f b)
{
    return (vec3f){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline vec3f scale(vec3f a, float k)
{
    return (vec3f){a.x * k, a.y * k, a.z * k};
}
static inline float dot(vec3f a, vec3f b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline vec3f unit(vec3f a)
{
    return scale(a, 1.0f / sqrtf(dot(a, a)));
}

/* std::min and std::max: one comparison each, whereas fminf and fmaxf are calls because of NaN. */
static inline float least(float a, float b)
{
    return b < a ? b : a;
}
static inline float most(float a, float b)
{
    return a < b ? b : a;
}

void room_fill(room *out, const setting *of);

/* The nearest hit of all shapes, which the caller frees. NULL if there is none. */
hit *room_cast(const room *in, const ray *r);

/* The colour of a pixel; u to the right and v upwards, -1 to 1 over the shorter edge. Adds its rays to `counted`. */
rgb room_pixel(const room *in, float u, float v, tally *counted);

/* Renders a frame with threads that are started for it, a block of columns each; pixels line by line from the top. Adds
 * its rays to `counted`. */
void room_frame(const room *in, const setting *of, rgb *pixels, tally *counted);

/* Allocates memory; when out of memory, ends the program with exit status 1. */
void *allocate(size_t bytes);
