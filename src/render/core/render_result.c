/* Noise and release of a render result. */
#include "render/core/renderer.h"

#include <math.h>
#include <stdlib.h>

double render_noise_rms(const render_result *result)
{
    if (!result->variance)
        return (double)NAN;
    const size_t count = 3 * (size_t)result->img->width * (size_t)result->img->height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += result->variance[i];
    return sqrt(sum / (double)count);
}

void render_result_destroy(render_result *result)
{
    if (!result)
        return;
    film_destroy(result->img);
    free(result->workers);
    free(result->pixel_rays);
    free(result->pixel_ns);
    free(result->pixel_cut);
    free(result->variance);
    layers_destroy(result->layers);
    free(result->events);
    free(result->ranks);
    free(result);
}
