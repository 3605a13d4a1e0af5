/* The division of a pixel's paths into replicates. */
#include "render/plan/sampling.h"

#include "render/plan/film.h"

/* Replicates under sobol. */
enum { SOBOL_REPLICATES = 4, SPECTRAL_REPLICATE_MIN = 8 };

/* A round has one path for each point of the pixel's grid. Under philox, as many replicates as possible: the paths are
 * independent, so that the number of replicates costs no accuracy. */
static int64_t philox_replicates(int64_t rounds)
{
    int64_t count = FILM_REPLICATES_MAX;
    while (rounds % count != 0)
        count--;
    return count;
}

/* Under sobol, few replicates: n paths in R replicates have R^0.25 to R times the error of one set of n points (errors
 * that fall like n^-0.75 to n^-1.5). If four do not divide the rounds, the smallest number that does. least: the
 * minimum number of rounds per replicate. */
static int64_t sobol_replicates(int64_t rounds, int64_t least)
{
    if (rounds % SOBOL_REPLICATES == 0 && rounds >= SOBOL_REPLICATES * least)
        return SOBOL_REPLICATES;
    for (int64_t count = 2; count <= FILM_REPLICATES_MAX && count * least <= rounds; count++)
        if (rounds % count == 0)
            return count;
    return 1;
}

path_sampling path_sampling_of(const render_settings *r)
{
    const int64_t turns = r->filter == PIXEL_FILTER_CENTRE ? r->samples : 1;
    int64_t count = 1;
    /* under sobol each replicate has its own wavelengths, and needs enough for a white sum */
    const int64_t least = r->spectrum == SPECTRUM_SPECTRAL ? SPECTRAL_REPLICATE_MIN : 1;
    if (r->paths % turns == 0) /* each replicate covers the whole grid */
        count = r->sampler == SAMPLER_SOBOL ? sobol_replicates(r->paths / turns, least)
                                            : philox_replicates(r->paths / turns);
    return (path_sampling){.seed = r->seed,
                           .sampler = r->sampler,
                           .seed_hash = sobol_mix((uint64_t)r->seed + 1),
                           .replicates = count,
                           .per_replicate = r->paths / count,
                           .paths = r->paths,
                           .turns = turns};
}

path_sampling path_sampling_of_grid(const render_settings *r, int64_t rays)
{
    return (path_sampling){.seed = r->seed,
                           .sampler = SAMPLER_SOBOL,
                           .seed_hash = sobol_mix((uint64_t)r->seed + 1),
                           .replicates = 1,
                           .per_replicate = rays,
                           .paths = rays,
                           .turns = 1};
}
