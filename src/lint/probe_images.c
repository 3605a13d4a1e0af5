/* Renders small images of a plan in stripes, and estimates the light that they lack (probe_images.h). */
#include "lint/probe_images.h"
#include "base/cancel.h"
#include "render/tracer/integrator.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

enum { STRIPES_PER_THREAD = 4 };

/* Renders stripes with one of the tracers until none is left. */
static void render_stripes(void *context, size_t index, int member)
{
    probe_images *p = context;
    const int width = (int)p->made->render.width, height = (int)p->made->render.height;
    atomic_uint_fast64_t begun = 0;
    (void)member;
    for (int i; (i = atomic_fetch_add(&p->next_stripe, 1)) < p->stripes;) {
        const image_tile stripe = {0, i * height / p->stripes, width, (i + 1) * height / p->stripes};
        tracer_render_tile(p->tracers[index], &stripe, &begun);
    }
    tracer_finish(p->tracers[index]);
}

/* Allocates the maps for that number of pixels, all layers together, or clears them. */
static bool reserve_maps(probe_images *p, size_t pixels)
{
    free(p->pixel_rays);
    free(p->pixel_cut);
    p->pixel_rays = calloc(pixels, sizeof *p->pixel_rays);
    p->pixel_cut = calloc(pixels, sizeof *p->pixel_cut);
    return p->pixel_rays && p->pixel_cut;
}

/* layered: the integrator of all depth limits at once (render/tracer/integrator.h), or NULL. */
static status render_film(probe_images *p, const integrator *layered, film *f, diagnostic *why)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height, members = (size_t)thread_team_size(p->team);
    if (!reserve_maps(p, pixels))
        return out_of_memory(why);
    const tracer_target target = {.frame_plan = p->made,
                                  .img = f,
                                  .pixel_rays = p->pixel_rays,
                                  .pixel_cut = p->pixel_cut,
                                  .integrator_override = layered};
    for (size_t i = 0; i < members; i++)
        if (!tracer_begin(p->tracers[i], &target))
            return out_of_memory(why);
    atomic_store(&p->next_stripe, 0);
    thread_team_run(p->team, render_stripes, p, members);
    TRY(cancel_check(why));
    for (size_t i = 0; i < pixels; i++)
        p->spent += p->pixel_rays[i];
    return STATUS_OK;
}

static bool reserve(probe_image *to, size_t pixels)
{
    if (!to->rgb)
        to->rgb = malloc(3 * pixels * sizeof *to->rgb);
    if (!to->cut)
        to->cut = malloc(pixels * sizeof *to->cut);
    return to->rgb && to->cut;
}

static void store_cut(const probe_images *p, probe_image *to)
{
    const size_t pixels = probe_pixels(p);
    const double one = 3.0 * COUNTERS_CUT_ONE;
    double all = 0.0, by_weight = 0.0;
    for (int i = 0; i < thread_team_size(p->team); i++)
        for (int c = 0; c < 3; c++)
            by_weight += (double)tracer_counters(p->tracers[i])->cut_weight_throughput[c];
    for (size_t i = 0; i < pixels; i++)
        all += p->pixel_cut[i];
    const double by_depth = all > 0.0 ? 1.0 - by_weight / all : 0.0;
    for (size_t i = 0; i < pixels; i++)
        to->cut[i] = (float)(by_depth * p->pixel_cut[i] / one);
    to->by_weight = by_weight / (one * (double)pixels);
}

static status store(const probe_images *p, const film *f, probe_image *to, diagnostic *why)
{
    const size_t pixels = probe_pixels(p);
    if (!reserve(to, pixels))
        return out_of_memory(why);
    film_read(f, 0, 0, f->width, f->height, to->rgb, 3 * (size_t)f->width);
    store_cut(p, to);
    return STATUS_OK;
}

status probe_images_render(probe_images *p, int depth, probe_image *to, diagnostic *why)
{
    const render_settings *r = &p->made->render;
    const integrator *rule = integrator_for(r);
    film *f;
    p->made->render.depth = depth;
    TRY(film_create((int)r->width, (int)r->height, rule->replicates ? rule->replicates(r) : 1, FILM_RGB, &f, why));
    status code = render_film(p, NULL, f, why);
    if (code == STATUS_OK) {
        film_merge_replicates(f, NULL);
        code = store(p, f, to, why);
    }
    film_destroy(f);
    return code;
}

/* --- all depth limits at once --- */

static double sum_of(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum;
}

/* Adds the light of the layer 2 (k - 1) to that of layer 2 k, which then is that of all rays of depth k or less, and
 * stores their sum with what replaces the branches. */
static void store_light(film *f, int k, size_t values, float *rgb)
{
    film_sum *direct = f->sum + 2 * (size_t)k * values;
    const film_sum *shallower = direct - 2 * values, *beyond = direct + values;
    for (size_t i = 0; k > 0 && i < values; i++)
        direct[i] = film_add(direct[i], shallower[i]);
    for (size_t i = 0; i < values; i++)
        rgb[i] = (float)film_radiance(film_add(direct[i], beyond[i]));
}

static status store_levels(const probe_images *p, film *f, int limit, probe_image *levels, double *rays,
                           diagnostic *why)
{
    const size_t pixels = probe_pixels(p);
    const double one = 3.0 * COUNTERS_CUT_ONE;
    double by_weight = 0.0;
    for (int k = 0; k <= limit; k++) {
        const size_t layer = 2 * (size_t)k * pixels;
        if (!reserve(&levels[k], pixels))
            return out_of_memory(why);
        store_light(f, k, 3 * pixels, levels[k].rgb);
        for (size_t i = 0; i < pixels; i++)
            levels[k].cut[i] = (float)(p->pixel_cut[layer + pixels + i] / one);
        by_weight += sum_of(p->pixel_cut + layer, pixels) / (one * (double)pixels);
        levels[k].by_weight = by_weight;
        rays[k] = sum_of(p->pixel_rays + layer, pixels);
    }
    return STATUS_OK;
}

status probe_images_render_levels(probe_images *p, int limit, probe_image *levels, double *rays, diagnostic *why)
{
    const render_settings *r = &p->made->render;
    film *f;
    p->made->render.depth = limit;
    TRY(film_create((int)r->width, (int)r->height * LEVELS_LAYERS(limit), 1, FILM_RGB, &f, why));
    status code = render_film(p, &integrator_of_levels, f, why);
    THEN(code, store_levels(p, f, limit, levels, rays, why));
    film_destroy(f);
    return code;
}

void probe_image_free(probe_image *old)
{
    free(old->rgb);
    free(old->cut);
    *old = (probe_image){.rgb = NULL};
}

bool probe_images_begin(probe_images *p, plan *made, isa level)
{
    *p = (probe_images){.made = made, .depth = made->render.depth};
    const int units = thread_team_units(), height = (int)made->render.height;
    p->team = thread_team_create(units < PROBE_THREADS_MAX ? units : PROBE_THREADS_MAX);
    if (!p->team)
        return false;
    const int members = thread_team_size(p->team), most = members == 1 ? 1 : members * STRIPES_PER_THREAD;
    p->stripes = height < most ? height : most;
    for (int i = 0; i < members; i++)
        if (!(p->tracers[i] = tracer_create(level)))
            return false;
    return true;
}

bool probe_images_overflowed(const probe_images *p)
{
    bool any = false;
    for (int i = 0; i < thread_team_size(p->team); i++)
        any |= tracer_overflowed(p->tracers[i]);
    return any;
}

void probe_images_end(probe_images *p)
{
    p->made->render.depth = p->depth;
    for (int i = 0; i < PROBE_THREADS_MAX; i++)
        tracer_destroy(p->tracers[i]);
    thread_team_destroy(p->team);
    free(p->pixel_rays);
    free(p->pixel_cut);
}

/* --- what an image may lack --- */

static double mean_of_pixel(const probe_image *of, size_t pixel)
{
    const float *rgb = of->rgb + 3 * pixel;
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
}

static double difference(const probe_image *one, const probe_image *two, size_t pixel)
{
    double sum = 0.0;
    for (size_t c = 0; c < 3; c++)
        sum += fabs((double)one->rgb[3 * pixel + c] - (double)two->rgb[3 * pixel + c]);
    return sum / 3.0;
}

lack lack_of(size_t pixels, const probe_image *at, const probe_image *deepest)
{
    const double n = (double)pixels, cut = lack_cut(pixels, deepest);
    double radiance = 0.0, sum = 0.0, squares = 0.0, largest = 0.0;
    for (size_t i = 0; i < pixels; i++)
        radiance += mean_of_pixel(deepest, i) / n;
    radiance = fmax(radiance, (double)PROBE_DARK);
    for (size_t i = 0; i < pixels; i++) {
        const double one = difference(at, deepest, i) / radiance + (double)deepest->cut[i];
        sum += one, squares += one * one;
        largest = fmax(largest, (double)at->cut[i]);
    }
    const double mean = sum / n;
    return (lack){mean, cut, cut / radiance, sqrt(fmax(0.0, squares / n - mean * mean) / n), largest};
}

double lack_cut(size_t pixels, const probe_image *of)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels; i++)
        sum += (double)of->cut[i];
    return sum / (double)pixels;
}

double lack_decay(double before, double after, int levels)
{
    return before > after ? pow(after / before, 1.0 / levels) : 1.0;
}

int lack_depth_enough(int depth, double bound, double decay)
{
    if (bound <= LACK_ACCEPTED)
        return depth;
    if (isnan(decay))
        return 2 * depth;
    if (decay == 1.0)
        return INT_MAX;
    const double levels = decay > 0.0 ? ceil(log(LACK_ACCEPTED / bound) / log(decay)) : 1.0;
    return levels < 1000.0 ? depth + (int)levels : INT_MAX;
}
