/* The result of a frame: its memory and noise; and frames whose tiles several processes render. */
#include "render/frame/renderer.h"

#include "render/frame/caustics.h"
#include "render/frame/tracers.h"
#include "render/shade/footprints.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A map of zeros, written explicitly, so that no pixel's time includes a page fault; compilers turn malloc and memset
 * into calloc, which writes nothing. */
double *render_map_create(size_t pixels)
{
    double *map = malloc(pixels * sizeof *map);
    if (map)
        explicit_bzero(map, pixels * sizeof *map);
    return map;
}

int renderer_replicates(const scene *s)
{
    const integrator *method = integrator_for(&s->render);
    return method->replicates ? method->replicates(&s->render) : 1;
}

uint64_t renderer_result_bytes(const scene *s, const render_options *options)
{
    const uint64_t replicates = (uint64_t)renderer_replicates(s),
                   pixels = (uint64_t)s->render.width * (uint64_t)s->render.height;
    const uint64_t maps =
        options ? (uint64_t)options->pixel_rays + (uint64_t)options->pixel_time + (uint64_t)options->pixel_cut : 0;
    const uint64_t named = options && options->layers && integrator_traits_of(&s->render)->layers ? layers_bytes() : 0;
    if (options && options->source)
        return (uint64_t)s->render.threads * (uint64_t)options->source->side * (uint64_t)options->source->side *
               (3 * sizeof(int64_t) * replicates + (replicates > 1 ? 3 * sizeof(double) : 0));
    return pixels * (named + 3 * sizeof(int64_t) * replicates + (replicates > 1 ? 3 * sizeof(double) : 0) +
                     maps * sizeof(double));
}

uint64_t renderer_tracing_bytes(const scene *s)
{
    return (uint64_t)scene_threads(&s->render) *
               tracer_bytes(s->render.depth, scene_crystals(s) > 0, footprints_are_followed(&s->render)) +
           caustics_bytes(&s->render);
}

film_space render_film_space(const scene *s)
{
    return s->render.spectrum == SPECTRUM_SPECTRAL && s->render.bands == 0 ? FILM_XYZ : FILM_RGB;
}

status renderer_film(const scene *s, film **img, double **variance, diagnostic *why)
{
    *variance = NULL;
    TRY(film_create((int)s->render.width, (int)s->render.height, 1, render_film_space(s), img, why));
    if (renderer_replicates(s) == 1 ||
        (*variance = render_map_create(3 * (size_t)s->render.width * (size_t)s->render.height)))
        return STATUS_OK;
    film_destroy(*img);
    *img = NULL;
    return out_of_memory(why);
}

status render_result_create(const scene *s, const render_options *options, render_result **out, diagnostic *why)
{
    const size_t pixels = (size_t)s->render.width * (size_t)s->render.height;
    render_result *result = calloc(1, sizeof *result);
    if (!result)
        return out_of_memory(why);
    result->replicates = renderer_replicates(s);
    result->few.solid = -1;
    const bool by_source = options && options->source;
    status code = by_source ? STATUS_OK
                            : film_create((int)s->render.width, (int)s->render.height, renderer_replicates(s),
                                          render_film_space(s), &result->img, why);
    if (code == STATUS_OK) {
        result->worker_count = (int)s->render.threads;
        result->workers = calloc((size_t)result->worker_count, sizeof *result->workers);
        bool missing = !result->workers;
        if (options && options->pixel_rays)
            missing |= !(result->pixel_rays = render_map_create(pixels));
        if (options && options->pixel_time)
            missing |= !(result->pixel_ns = render_map_create(pixels));
        if (options && options->pixel_cut)
            missing |= !(result->pixel_cut = render_map_create(pixels));
        if (options && options->layers && integrator_traits_of(&s->render)->layers)
            missing |= !(result->layers = layers_create((int)s->render.width, (int)s->render.height));
        if (renderer_replicates(s) > 1 && !by_source)
            missing |= !(result->variance = render_map_create(3 * pixels));
        if (missing)
            code = diagnose(why, STATUS_FAILURE, "render a smaller image", "out of memory");
    }
    if (code != STATUS_OK) {
        render_result_destroy(result);
        return code;
    }
    *out = result;
    return STATUS_OK;
}

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

/* --- a frame whose tiles several processes render --- */

render_settings tiles_settings(const render_settings *r, int side)
{
    render_settings settings = *r;
    settings.schedule = SCHEDULE_DYNAMIC;
    settings.tile = side;
    settings.tiles_per_worker = 0;
    settings.threads = 1;
    return settings;
}

status tiled_frame_begin(const scene *s, int side, tiled_frame *out, diagnostic *why)
{
    const render_settings settings = tiles_settings(&s->render, side);
    schedule_start(&out->places, &settings);
    return renderer_film(s, &out->img, &out->variance, why);
}

void tiled_frame_release(tiled_frame *f)
{
    film_destroy(f->img);
    free(f->variance);
    f->img = NULL;
    f->variance = NULL;
}

static size_t sums_of(const image_tile *at)
{
    return 3 * (size_t)(at->x1 - at->x0) * (size_t)(at->y1 - at->y0);
}

size_t tiled_frame_values(const tiled_frame *f, int64_t tile)
{
    image_tile at;
    return schedule_tile(&f->places, tile, &at) ? sums_of(&at) * (f->variance ? 2 : 1) : 0;
}

static void put_variance(const tiled_frame *f, const image_tile *at, const int64_t *values)
{
    const size_t length = 3 * (size_t)(at->x1 - at->x0);
    for (int y = at->y0; y < at->y1; y++, values += length)
        memcpy(&f->variance[3 * ((size_t)y * (size_t)f->img->width + (size_t)at->x0)], values,
               length * sizeof *f->variance);
}

void tiled_frame_store(tiled_frame *f, int64_t tile, const int64_t *values)
{
    image_tile at;
    if (!schedule_tile(&f->places, tile, &at))
        return;
    film_store_tile(f->img, at.x0, at.y0, at.x1, at.y1, values);
    if (f->variance)
        put_variance(f, &at, values + sums_of(&at));
}
