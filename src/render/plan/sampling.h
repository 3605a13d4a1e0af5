/* Random numbers of rays: pure functions of the seed, pixel, sample, depth and purpose, so that an image does not
 * depend on which worker draws when.
 *
 * The sample points of random paths: which point of which replicate a path has, and its coordinates for each random
 * choice. A pixel's paths are divided into equal replicates, whose means are independent estimates: their differences
 * give the standard error. Under render.sampler=philox all paths are independent, and consecutive ones belong to the
 * replicates in turn; under sobol the points of one replicate are a low-discrepancy set, and each replicate has its own
 * scrambling (Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995): the differences between parts of one
 * such set would overestimate its error. Every pair of dimensions has its own scrambling and order (padding, as in
 * pbrt-v4's PaddedSobolSampler). Plain values. */
#pragma once

#include "base/random.h"
#include "base/status.h"
#include "base/vec3.h"
#include "scene/model/lights.h"
#include "scene/model/render_settings.h"
#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

/* --- sample keys --- */

/* A sample key is one number that identifies the pixel of a ray, for films with more than one sample per pixel
 * (spectral films, random paths) also the sample, and for spectral films also the wavelength. An rgb film with
 * Whitted's rays uses only the pixel.
 *     bits 0..27 the pixel, below SCENE_PIXELS_MAX
 *          28..49 the sample: at most 1048576 paths, 64 x 65536 wavelengths
 *          50..61 the wavelength's number (render/plan/spectra.h)
 *          62     see SAMPLE_KEY_SPECULAR_BOUNCE
 *          63     see SAMPLE_KEY_PHOTONS */

/* The ray may hit a light source and collect its emission: it starts at the camera or at a specular surface. */
#define SAMPLE_KEY_SPECULAR_BOUNCE ((int64_t)1 << 62)
/* The path has left a matte surface, where photons supply the light from mirrors and clear solids. */
#define SAMPLE_KEY_PHOTONS INT64_MIN

static inline int64_t sample_key_make(int64_t pixel, int64_t sample)
{
    return pixel | sample << 28;
}

static inline int64_t sample_key_with_wavelength(int64_t sample_key, int64_t number)
{
    return sample_key | number << 50;
}

static inline int64_t sample_key_pixel(int64_t sample_key)
{
    return sample_key & 0xfffffff;
}

static inline int64_t sample_key_sample(int64_t sample_key)
{
    return sample_key >> 28 & 0x3fffff;
}

static inline int64_t sample_key_wavelength(int64_t sample_key)
{
    return sample_key >> 50 & 0xfff;
}

/* --- random draws --- */

/* These numbers affect every image and must never change. New purposes are numbered from DRAW_NEXT, below 2^16; each
 * light has its own number from DRAW_LIGHT on. */
enum {
    DRAW_WAVELENGTH = 0,
    DRAW_BRANCH = 1,
    DRAW_DIRECTION = 2,
    DRAW_ROULETTE = 3,
    DRAW_LIGHT = 4,
    DRAW_PIXEL = 0x1000,
    DRAW_PHOTON = 0x1001, /* and the next number */
    DRAW_LENS = 0x1003,
    DRAW_FACET = 0x1004,       /* of a rough surface */
    DRAW_FACET_LIGHT = 0x1005, /* a lamp on the ray's side of a rough surface; the next number: on the other side */
    DRAW_FLIGHT = 0x1007,      /* the free flight of a ray in a medium that scatters */
    DRAW_PHASE = 0x1008,       /* the direction after scattering */
    DRAW_AIRLIGHT = 0x1009,    /* airlight: one number for each light, from this one on */
    DRAW_FURTHER =
        DRAW_AIRLIGHT + SCENE_LIGHTS_MAX, /* whether light meets further facets; the next number: its new direction */
    DRAW_PHOTON_END = DRAW_FURTHER + 2,   /* Russian roulette of deep photons, and their branch */
    DRAW_COVER = DRAW_PHOTON_END + 1,     /* whether a ray meets a blended surface; plus the crossing times 2^16 */
    DRAW_NEXT
};
static_assert(DRAW_LIGHT + SCENE_LIGHTS_MAX <= DRAW_PIXEL,
              "the lights' numbers must not overlap those of the next purpose");

static inline random_words draw(int64_t seed, int64_t sample_key, int depth, int purpose)
{
    return random_at((uint64_t)seed, (uint32_t)sample_key_pixel(sample_key), (uint32_t)sample_key_sample(sample_key),
                     (uint32_t)depth, (uint32_t)purpose);
}

/* --- sample points of random paths --- */

typedef struct path_sampling {
    int64_t seed, sampler;
    uint64_t seed_hash;
    int64_t replicates, per_replicate; /* per_replicate: paths in each replicate */
    int64_t paths;                     /* per pixel */
    const uint32_t *by_pixel;          /* borrowed: numbers of paths by pixel, which replace `paths`; NULL: none */
    int64_t turns;                     /* consecutive paths of one replicate under philox */
} path_sampling;

path_sampling path_sampling_of(const render_settings *r);

/* Sample points on the lens, and for soft shadows on lights, for `rays` camera rays per pixel in a regular grid, as in
 * Whitted's integrator: one scrambled Sobol set. */
path_sampling path_sampling_of_grid(const render_settings *r, int64_t rays);

/* The pixel's number of paths. */
static inline int64_t path_count(const path_sampling *p, int64_t pixel)
{
    return p->by_pixel ? p->by_pixel[pixel] : p->paths;
}

/* The pixel's number of paths in each replicate. A division of 32 bits suffices, and is faster. */
static inline uint32_t path_replicate_count(const path_sampling *p, int64_t pixel)
{
    return p->by_pixel ? p->by_pixel[pixel] / (uint32_t)p->replicates : (uint32_t)p->per_replicate;
}

/* The replicate of a path. */
static inline int64_t path_replicate(const path_sampling *p, int64_t sample_key)
{
    const uint32_t sample = (uint32_t)sample_key_sample(sample_key);
    if (p->replicates == 1)
        return 0;
    if (p->sampler == SAMPLER_SOBOL)
        return sample / path_replicate_count(p, sample_key_pixel(sample_key));
    return sample / (uint32_t)p->turns % (uint32_t)p->replicates;
}

typedef struct unit_pair {
    double u, v; /* uniform in (0, 1) */
} unit_pair;

/* The key of a replicate's points for one random choice. The low 8 bits of the depth have their own field; the others
 * are spread by an odd factor, 2^64 over the golden ratio. */
static inline uint64_t path_draw_key(const path_sampling *p, int64_t pixel, uint64_t replicate, int depth, int purpose)
{
    const uint64_t near = (uint64_t)depth & 0xff, far = ((uint64_t)depth >> 8) * 0x9e3779b97f4a7c15;
    return ((uint64_t)pixel << 32 | replicate << 24 | near << 16 | (uint64_t)purpose) ^ far ^ p->seed_hash;
}

/* The sample point for one random choice of a path; purpose: a number of the enum above. */
static inline unit_pair path_draw(const path_sampling *p, int64_t sample_key, int depth, int purpose)
{
    if (p->sampler == SAMPLER_SOBOL) {
        const uint32_t sample = (uint32_t)sample_key_sample(sample_key),
                       per_replicate = path_replicate_count(p, sample_key_pixel(sample_key)),
                       replicate = sample / per_replicate, index = sample - replicate * per_replicate;
        const sobol_point s =
            sobol_at(index, path_draw_key(p, sample_key_pixel(sample_key), replicate, depth, purpose));
        return (unit_pair){random_unit(s.x), random_unit(s.y)};
    }
    const random_words drawn = draw(p->seed, sample_key, depth, purpose);
    return (unit_pair){random_unit(drawn.word[0]), random_unit(drawn.word[1])};
}

/* --- grids of sample points --- */

/* Cells along one side of the largest square grid with at most `points` cells. */
static inline int64_t cells_across(int64_t points)
{
    int64_t k = 1;
    while ((k + 1) * (k + 1) <= points)
        k++;
    return k;
}

/* Origins and directions of the rays of a fan or a beam. Pure; plain values. */

/* axis, across and normal are orthonormal; normal is perpendicular to the plane of the rays. */
typedef struct ray_axes {
    vec3 from, axis, across, normal;
} ray_axes;

/* normal: only its part perpendicular to the axis is used. NULL: up for a horizontal axis, else horizontal, so that the
 * plane is vertical. Returns STATUS_BAD_INPUT if the axis is zero or the normal is along it. */
status ray_axes_set(ray_axes *a, vec3 from, vec3 axis, const vec3 *normal, diagnostic *why);

/* Ray i of n in the plane: parallel, `size` scene units between the first and the last, or from one point, `size`
 * degrees between them; a single ray is on the axis. Returns the ray's offset from the axis, in the unit of size. */
double ray_axes_in_plane(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction);

/* Places over a disc or in a cone. count: the number of rays, as many as requested on a spiral and of Sobol'; else the
 * most, at least 1, that fill rings or a square grid. side: squares along the grid's edge. */
typedef struct ray_pattern {
    beam_pattern kind;
    int count;
    int64_t side;
} ray_pattern;

ray_pattern ray_pattern_of(beam_pattern kind, int wanted);

/* Ray i of a pattern over a disc of the diameter `size`, or within a cone of the full angle `size`. Each ray stands for
 * an equal part of the disc's area or the cone's solid angle:
 *   spiral  H. Vogel, Mathematical Biosciences 44 (1979); a single ray is on the axis;
 *   rings   ring k = 1, 2, ... has 6 k rays, at the radius that halves the area of its ring; ray 0 is on the axis;
 *   square  the centres within the disc of side x side equal squares around it, row by row;
 *   sobol   r^2 and the angle, over a full turn, are the coordinates of Sobol's first two dimensions, in natural order
 *           (Joe and Kuo 2008), not scrambled; ray 0 is on the axis. */
void ray_axes_round(const ray_axes *a, const ray_pattern *pattern, bool spreads, double size, int i, vec3 *origin,
                    vec3 *direction);

/* Field point of a grid of columns x rows, row by row: the axes turned (parallel rays, size in degrees between the
 * outermost directions) or moved across the axis (size in scene units). Columns are side by side along the
 * horizontal (x for an upright axis), rows one above the other. */
void ray_axes_field(const ray_axes *a, bool spreads, double size, int i, int columns, int rows, vec3 *from, vec3 *axis);
