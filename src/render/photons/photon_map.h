/* A photon map: where light from the lamps arrived on matte surfaces after mirrors and clear solids (Jensen, "Global
 * Illumination using Photon Maps", Eurographics Workshop on Rendering 1996). Each photon spreads its power over a disc
 * in its surface's plane, whose radius is the distance to its PHOTON_NEIGHBOURS-th neighbour: narrow where light is
 * dense, so that sharp caustics stay sharp (the sample-point estimator of Silverman, Density Estimation, 1986, 5.3).
 * The disc is wider where light is uniform all around, and where the lamp's size blurs the caustic anyway; it is
 * nowhere much narrower than a pixel (photon_radius.c). The discs overlap; irradiance at a point is the sum over the
 * discs around it. Discs that are narrow in the image are averaged over the cell of the sample that sees them
 * (photon_map.c), so that light narrower than a pixel keeps its power.
 *
 * The map is a function of the set of photons: they are sorted, so that sums have one order, whatever the order in
 * which workers added the photons. Ownership: photon_map_create allocates, photon_map_destroy releases; once built, any
 * number of threads may read. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct photon {
    vec3 position;
    float normal[3]; /* of the surface, on the side where it arrived */
    float flux[3];   /* its power over pi, by channel: a matte surface's radiance is its albedo times irradiance / pi */
    float radius;    /* of its disc, set by photon_map_spread; before, the radius of the blur by the lamp's size */
    /* in a spectral film the number of its wavelength, or for a spectral line, photon_of_line of this number; in an rgb
     * film equal for all photons */
    int32_t wavelength;
} photon;

static inline int32_t photon_of_line(int32_t wavelength)
{
    return ~wavelength;
}

/* Photons of one worker, in any order. Zeros at first; the owner frees list. */
typedef struct photon_list {
    photon *list;
    size_t count, room;
} photon_list;

/* False when out of memory, with the list unchanged. */
bool photon_list_add(photon_list *l, const photon *one);

typedef struct photon_map photon_map;

/* A map of the photons of all lists. STATUS_FAILURE when out of memory, STATUS_INTERRUPTED when cancelled. */
status photon_map_create(const photon_list *lists, size_t count, photon_map **out, diagnostic *why);
void photon_map_destroy(photon_map *m);

/* Limits to the radii of discs, scene units: at most `widest`, at least least + least_at_1 times the distance from the
 * eye. */
typedef struct photon_limits {
    double widest, least, least_at_1;
    vec3 eye;
} photon_limits;

/* Computes the radii of photons first .. first + PHOTON_BLOCK - 1; threads may process different blocks at the same
 * time. */
enum { PHOTON_BLOCK = 512, PHOTON_NEIGHBOURS = 48, PHOTON_WIDER = 2 };
void photon_map_spread(photon_map *m, size_t first, const photon_limits *limits);
/* Completes the map after the last photon_map_spread; false when cancelled or out of memory. Merges photons that are
 * much closer together than their discs are wide. */
bool photon_map_finish(photon_map *m);

/* The number of photons, which photon_map_finish may reduce. */
size_t photon_map_count(const photon_map *m);
/* Photon i in the map's order. */
const photon *photon_map_at(const photon_map *m, size_t i);

/* Irradiance over pi at a point of a surface with that normal, by channel. In a spectral map it is per wavelength
 * number; a photon contributes to wavelengths near its own, a line's photon only to its own. wavelength: the ray's, or
 * -1 in an rgb map. */
vec3 photon_map_irradiance(const photon_map *m, vec3 point, vec3 normal, int wavelength);

/* A ray at the point that it hits, and its neighbours one sample of the image away in x and y. The neighbour at (x, y)
 * passes through point + x across[0] + y across[1], in the direction toward + x turn[0] + y turn[1] (ray_footprint,
 * render/tracer/queue.h). */
typedef struct photon_footprint {
    vec3 toward, across[2], turn[2];
    vec3 along;   /* for a photon at an offset from point, t = offset . along is its parameter on point + t toward */
    double reach; /* scene units: if photons farther away contribute, photons close together are evaluated as one */
    double blur;  /* samples: least half width of densities; above 0 if neighbouring rays disagree about positions */
} photon_footprint;

/* photon_map_irradiance averaged over the cell of the ray's sample in the image (photon_map.c), so that the sum over
 * all samples does not depend on a photon's position between them. Sets narrow[k], unless NULL, to the part of the
 * light, summed over channels, for which samples k times as dense along each side would suffice even if the footprint
 * were wrong: k = 1 for the present samples, and 0 for light that needs a factor of PHOTON_FACTORS or more. */
enum { PHOTON_FACTORS = 9 };
vec3 photon_map_seen(const photon_map *m, vec3 point, vec3 normal, int wavelength, const photon_footprint *f,
                     double *narrow);

/* Memory for each photon, bytes. */
size_t photon_map_bytes(void);

/* The tree of a photon map, used only in this folder: boxes around every eight consecutive photons, around every eight
 * of these boxes, and so on. A box is found by its number, without pointers. */

#define PHOTON_PI 3.14159265358979323846
/* The least cosine of the angle between neighbours' normals (about 37 degrees), which connects photons on round
 * surfaces and separates those across edges. */
#define PHOTON_FACING 0.8
/* The radius, in cells of samples, from which a disc is evaluated at points: along a line of light across the samples
 * the sum then varies by 96 J_3(q) / q^3, q = 2 pi radius, below 1e-3 (see photon_map.c). */
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

/* The photons of a box as one: their flux at their centre, with a disc that has the variance of their positions and
 * discs. */
typedef struct photon_group {
    photon one;    /* radius 0: not a group, because the photons are of several wavelengths or surfaces */
    float disc2;   /* mean square of the discs' radii, weighted by power */
    float spread2; /* variance of positions, weighted by power and summed over both directions */
} photon_group;

struct photon_map {
    photon *photons;
    size_t count;
    struct photon_sums *sums;               /* until the radii are known; NULL for photons of several wavelengths */
    photon_box *level[PHOTON_LEVELS_MAX];   /* level 0: boxes of PHOTON_WIDE photons; the last one has one box */
    photon_group *group[PHOTON_LEVELS_MAX]; /* of each box, once the radii are known */
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

/* photon_order.c. photon_lists_total: the number of photons in the lists. photon_order: copies them to out in the map's
 * order; false when out of memory or cancelled. */
size_t photon_lists_total(const photon_list *lists, size_t count);
bool photon_order(const photon_list *lists, size_t count, photon *out);

/* Computes the numbers of levels and boxes from the map's count of photons. */
void photon_tree_count(photon_map *m);
/* Allocates the boxes; false when out of memory. */
bool photon_tree_make(photon_map *m);
/* Fits the boxes to the photons' discs, or to their positions; false when cancelled. */
bool photon_tree_fit(photon_map *m, bool discs);
/* The distance from photon i to its k-th nearest neighbour on the same surface, at most `widest`. Boxes must contain at
 * least the positions. */
double photon_tree_reach(const photon_map *m, size_t i, int k, double widest);
/* Makes the groups of all boxes from the photons; false when out of memory or cancelled. */
bool photon_groups_make(photon_map *m);

/* The region around a ray's hit in which photons contribute: three slabs, the sample's cell in x, in y, and the
 * surface's thickness. */
enum { REACH_X, REACH_Y, REACH_HEIGHT, REACH_SLABS };
typedef struct photon_reach {
    bool known; /* false: the surface is seen edge on or from behind, and discs are evaluated at the point */
    /* A photon can contribute if |slab[k] . offset| <= within[k] + length[k] * radius for all k. offset and radius are
     * in scene units; the product is in cells for REACH_X and REACH_Y, in scene units for REACH_HEIGHT. within and
     * length include a margin. */
    vec3 slab[REACH_SLABS];
    double within[REACH_SLABS], length[REACH_SLABS];
    double beyond; /* distance to the farthest disc that can contribute, scene units */
    bool groups;   /* photons close together are evaluated as one */
} photon_reach;
/* Photons are evaluated as one if the variance of their positions, over both directions, is at most this times 1 + r^2,
 * where r is the radius of their discs, all in cells. A square of side e has the variance e^2 / 6. */
#define PHOTON_ONE (2.0 / 6.0)

/* Called with each photon that a search finds, or with one photon that stands for a group. disc: the radius of the
 * photon's disc; for a group, the root mean square of its photons' radii, weighted by power. */
typedef void photon_visit(const photon *one, double disc, void *context);
/* Calls visit for photons near the point, in the map's order: at least for photons whose discs contain the point, or
 * with a reach, for photons that are within it. */
void photon_tree_around(const photon_map *m, vec3 point, const photon_reach *reach, photon_visit *visit, void *context);

/* photon_radius.c: sums over the photons of each box of the tree, for the test whether light is uniform in a disc.
 * photon_sums_make: NULL when out of memory or cancelled; photon_sums_free releases. */
typedef struct photon_sums photon_sums;
photon_sums *photon_sums_make(const photon_map *m);
void photon_sums_free(photon_sums *s);
size_t photon_sums_bytes(void); /* per box */
