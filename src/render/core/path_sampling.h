/* The sample points of random paths: which point of which replicate a path has, and its coordinates for each random
 * choice. A pixel's paths are divided into equal replicates, whose means are independent estimates: their differences
 * give the standard error. Under render.sampler=philox all paths are independent, and consecutive ones take turns;
 * under sobol the points of one replicate are a low-discrepancy set, and each replicate has its own scrambling (Owen,
 * "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995): the differences between parts of one such set would
 * overestimate its error. Every pair of dimensions has its own scrambling and order (padding). Pure; plain values. */
#pragma once

#include "base/random.h"
#include "render/core/draw.h"
#include "scene/model/render_settings.h"

typedef struct path_sampling {
    int64_t seed, sampler;
    uint64_t seed_hash;
    int64_t replicates, each; /* paths in each */
    int64_t paths;            /* per pixel */
    const uint32_t *by_pixel; /* borrowed: the number of paths of each pixel instead; NULL: none */
    int64_t turns;            /* consecutive paths of one replicate under philox */
} path_sampling;

path_sampling path_sampling_of(const render_settings *r);

/* For the points on the lens of a film with that many camera rays per pixel in a regular grid, as of Whitted's
 * integrator: one scrambled Sobol set. */
path_sampling path_sampling_of_grid(const render_settings *r, int64_t rays);

/* The pixel's number of paths. */
static inline int64_t path_count(const path_sampling *p, int64_t pixel)
{
    return p->by_pixel ? p->by_pixel[pixel] : p->paths;
}

/* The pixel's number of paths in each replicate. 32 bits, of which there are enough, are divided faster. */
static inline uint32_t path_replicate_count(const path_sampling *p, int64_t pixel)
{
    return p->by_pixel ? p->by_pixel[pixel] / (uint32_t)p->replicates : (uint32_t)p->each;
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

/* The key of a replicate's points for one random choice. Of a depth, 8 bits have their own place; those above are
 * spread by an odd number (that of a golden section of 2^64). */
static inline uint64_t path_draw_key(const path_sampling *p, int64_t pixel, uint64_t replicate, int depth, int purpose)
{
    const uint64_t near = (uint64_t)depth & 0xff, far = ((uint64_t)depth >> 8) * 0x9e3779b97f4a7c15;
    return ((uint64_t)pixel << 32 | replicate << 24 | near << 16 | (uint64_t)purpose) ^ far ^ p->seed_hash;
}

/* For one random choice of a path: purpose is one of draw.h. */
static inline unit_pair path_draw(const path_sampling *p, int64_t sample_key, int depth, int purpose)
{
    if (p->sampler == SAMPLER_SOBOL) {
        const uint32_t sample = (uint32_t)sample_key_sample(sample_key),
                       each = path_replicate_count(p, sample_key_pixel(sample_key)), replicate = sample / each,
                       index = sample - replicate * each;
        const sobol_point s =
            sobol_at(index, path_draw_key(p, sample_key_pixel(sample_key), replicate, depth, purpose));
        return (unit_pair){random_unit(s.x), random_unit(s.y)};
    }
    const random_words drawn = draw(p->seed, sample_key, depth, purpose);
    return (unit_pair){random_unit(drawn.word[0]), random_unit(drawn.word[1])};
}
