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
