/* The number of random paths of each pixel, from a pilot render. */
#include "render/core/path_counts.h"

#include "base/elementary.h"
#include "render/core/path_sampling.h"
#include <stdlib.h>

render_settings path_counts_pilot(const render_settings *r)
{
    render_settings pilot = *r;
    pilot.paths = PILOT_PATHS;
    pilot.error = 0.0;
    pilot.seed = r->seed + ((int64_t)1 << 31); /* above the largest seed of a scene */
    return pilot;
}

/* The pilot's variance of a pixel, mean of the channels over the 3 x 3 pixels around it: that of one pixel alone is
 * known too little, and is often 0 where light is rare. */
static double variance_around(const render_result *pilot, int x, int y)
{
    const int width = pilot->img->width, height = pilot->img->height;
    double sum = 0.0;
    int count = 0;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++) {
            const double *of = &pilot->variance[3 * ((size_t)v * (size_t)width + (size_t)u)];
            sum += of[0] + of[1] + of[2];
            count += 3;
        }
    return sum / count;
}

/* Independent variance falls like n^-1, that of sobol at least like n^-1.25 where it is measured. Doubled as often as
 * needed: sobol is best with powers of two. */
static int64_t paths_for(double variance, const render_settings *r, int64_t replicates)
{
    const double excess = variance / (r->error * r->error),
                 wanted =
                     PILOT_PATHS * (r->sampler == SAMPLER_SOBOL && excess > 0.0 ? elementary_pow(excess, 0.8) : excess);
    int64_t count = replicates;
    while (count < PILOT_PATHS || ((double)count < wanted && count < r->paths))
        count *= 2;
    return count < r->paths ? count : r->paths;
}

status path_counts_create(const render_settings *r, const render_result *pilot, uint32_t **out, diagnostic *why)
{
    const int width = pilot->img->width, height = pilot->img->height;
    const int64_t replicates = path_sampling_of(r).replicates;
    uint32_t *counts = malloc((size_t)width * (size_t)height * sizeof *counts);
    if (!counts)
        return out_of_memory(why);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            counts[(size_t)y * (size_t)width + (size_t)x] =
                (uint32_t)paths_for(variance_around(pilot, x, y), r, replicates);
    *out = counts;
    return STATUS_OK;
}
