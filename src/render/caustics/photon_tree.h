/* The tree of a photon map, for photon_map.c alone: boxes around every eight photons in order, around every eight of
 * these boxes, and so on; a box is found by its number, without pointers. */
#pragma once

#include "render/caustics/photon_map.h"

#include <math.h>

#define PHOTON_PI 3.14159265358979323846
/* The least cosine between the normals of neighbours, about 37 degrees: round surfaces are one, edges part two. */
#define PHOTON_FACING 0.8
/* The radius in cells of samples from which on a disc is looked up at points: along a line of light across the samples
 * the sum then varies by 96 J_3(q) / q^3, q = 2 pi radius, below 1e-3 (see photon_footprint.c). */
#define PHOTON_RESOLVED 4.0

enum { PHOTON_WIDE = 8, PHOTON_LEVELS_MAX = 22 };

typedef struct photon_box {
    double low[3], high[3];
} photon_box;
#define PHOTON_BOX_EMPTY                                            \
    {                                                               \
        {(double)INFINITY, (double)INFINITY, (double)INFINITY},     \
        {                                                           \
            -(double)INFINITY, -(double)INFINITY, -(double)INFINITY \
        }                                                           \
    }

struct photon_map {
    photon *photons;
    size_t count;
    struct photon_sums *sums;             /* until the radii are known; NULL for photons of several wavelengths */
    photon_box *level[PHOTON_LEVELS_MAX]; /* level 0: boxes of PHOTON_WIDE photons; the last one has one box */
    size_t boxes[PHOTON_LEVELS_MAX];
    int levels; /* 0 without photons */
};

/* The cosine between two photons' normals. */
static inline double photon_cosine(const photon *a, const photon *b)
{
    const float *n = a->normal, *o = b->normal;
    return (double)(n[0] * o[0] + n[1] * o[1] + n[2] * o[2]);
}

void photon_box_add(photon_box *b, vec3 at, double radius);
/* The square of the distance from a point to a box. */
double photon_box_distance2(const photon_box *b, vec3 at);
/* The numbers of a box's children, photons or boxes one level below: first .. end - 1. */
static inline size_t photon_box_first(size_t box)
{
    return box * PHOTON_WIDE;
}
static inline size_t photon_box_end(const photon_map *m, int level, size_t box)
{
    const size_t below = level == 0 ? m->count : m->boxes[level - 1], end = (box + 1) * PHOTON_WIDE;
    return end < below ? end : below;
}

/* photon_order.c: the number of photons in the lists; these photons in the map's order, to as many places; false when
 * out of memory or cancelled. */
size_t photon_lists_total(const photon_list *lists, size_t count);
bool photon_order(const photon_list *lists, size_t count, photon *out);

/* The numbers of boxes for the map's count of photons. */
void photon_tree_count(photon_map *m);
/* Allocates the boxes; false when out of memory. */
bool photon_tree_make(photon_map *m);
/* Fits the boxes to the photons' discs, or to their positions; false when cancelled. */
bool photon_tree_fit(photon_map *m, bool discs);
/* The distance from photon i to its k-th nearest neighbour on the same surface, at most `widest`. Boxes must be those
 * of the positions, or larger. */
double photon_tree_reach(const photon_map *m, size_t i, int k, double widest);
/* Calls visit for the photons near the point, at least those whose disc may come closer to it than `within`, in order.
 */
void photon_tree_around(const photon_map *m, vec3 point, double within, void (*visit)(const photon *one, void *context),
                        void *context);

/* photon_footprint.c: how far from the ray's hit, on a surface with that normal, a photon can be and still be seen. */
typedef struct photon_reach {
    double beyond;          /* its radius; infinite if the footprint is unknown, too oblique or too wide */
    double at_0, by_radius; /* also at most at_0 + by_radius times its radius, or else its radius */
} photon_reach;
photon_reach photon_footprint_reach(const photon_footprint *f, vec3 normal);
/* A photon as the ray's samples see it, in cells: its place from the ray's sample, the deviation that its light has
 * there in each direction, and the radius of its disc in the direction in which cells are widest. */
typedef struct photon_place {
    double x, y, deviation_x, deviation_y, radius;
} photon_place;
/* The density per area with which a photon at point + off counts for the ray, of integral 1 over the photon's surface;
 * negative if its disc is wide enough to be looked up at the point alone. */
double photon_footprint_density(const photon_footprint *f, const photon *one, vec3 off, photon_place *place);
