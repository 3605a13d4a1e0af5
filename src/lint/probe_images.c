#include "lint/probe_images.h"

#include "base/cancel.h"
#include "render/integrators/integrator.h"

#include <stdlib.h>

enum { STRIPES_PER_THREAD = 4 };

/* Traces stripes, whichever is next, with one of the tracers. */
static void trace_stripes(void *context, size_t index, int member)
{
    probe_images *p = context;
    const int width = (int)p->made->render.width, height = (int)p->made->render.height;
    atomic_uint_fast64_t begun = 0;
    (void)member;
    for (int i; (i = atomic_fetch_add(&p->next_stripe, 1)) < p->stripes;) {
        const span stripe = {0, i * height / p->stripes, width, (i + 1) * height / p->stripes};
        tracer_span(p->rays[index], &stripe, &begun);
    }
    tracer_finish(p->rays[index]);
}

static status trace_film(probe_images *p, film *f, diagnostic *why)
{
    const size_t pixels = probe_pixels(p), members = (size_t)thread_team_size(p->team);
    const tracer_target target = {
        .frame_plan = p->made, .img = f, .pixel_rays = p->pixel_rays, .pixel_cut = p->pixel_cut};
    for (size_t i = 0; i < pixels; i++)
        p->pixel_rays[i] = p->pixel_cut[i] = 0.0;
    for (size_t i = 0; i < members; i++)
        if (!tracer_begin(p->rays[i], &target))
            return out_of_memory(why);
    atomic_store(&p->next_stripe, 0);
    thread_team_run(p->team, trace_stripes, p, members);
    TRY(cancel_check(why));
    for (size_t i = 0; i < pixels; i++)
        p->spent += p->pixel_rays[i];
    return STATUS_OK;
}

static bool make_room(probe_image *to, size_t pixels)
{
    if (!to->rgb)
        to->rgb = malloc(3 * pixels * sizeof *to->rgb);
    if (!to->cut)
        to->cut = malloc(pixels * sizeof *to->cut);
    return to->rgb && to->cut;
}

static void keep_cut(const probe_images *p, probe_image *to)
{
    const size_t pixels = probe_pixels(p);
    const double one = 3.0 * COUNTERS_CUT_ONE;
    double all = 0.0, by_weight = 0.0;
    for (int i = 0; i < thread_team_size(p->team); i++)
        for (int c = 0; c < 3; c++)
            by_weight += (double)tracer_counters(p->rays[i])->cut_weight_throughput[c];
    for (size_t i = 0; i < pixels; i++)
        all += p->pixel_cut[i];
    const double by_depth = all > 0.0 ? 1.0 - by_weight / all : 0.0;
    for (size_t i = 0; i < pixels; i++)
        to->cut[i] = (float)(by_depth * p->pixel_cut[i] / one);
    to->by_weight = by_weight / (one * (double)pixels);
}

static status keep(const probe_images *p, const film *f, probe_image *to, diagnostic *why)
{
    const size_t pixels = probe_pixels(p);
    if (!make_room(to, pixels))
        return out_of_memory(why);
    film_read(f, 0, 0, f->width, f->height, to->rgb, 3 * (size_t)f->width);
    keep_cut(p, to);
    return STATUS_OK;
}

status probe_images_trace(probe_images *p, int depth, probe_image *to, diagnostic *why)
{
    const render_settings *r = &p->made->render;
    const integrator *rule = integrator_for(r);
    film *f;
    p->made->render.depth = depth;
    TRY(film_create((int)r->width, (int)r->height, rule->shares ? rule->shares(r) : 1, FILM_RGB, &f, why));
    status code = trace_film(p, f, why);
    if (code == STATUS_OK) {
        film_merge_shares(f, NULL);
        code = keep(p, f, to, why);
    }
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
    const size_t pixels = probe_pixels(p);
    const int units = thread_team_units(), height = (int)made->render.height;
    p->pixel_rays = calloc(pixels, sizeof *p->pixel_rays);
    p->pixel_cut = calloc(pixels, sizeof *p->pixel_cut);
    p->team = thread_team_create(units < PROBE_THREADS_MAX ? units : PROBE_THREADS_MAX);
    if (!p->pixel_rays || !p->pixel_cut || !p->team)
        return false;
    const int members = thread_team_size(p->team), most = members == 1 ? 1 : members * STRIPES_PER_THREAD;
    p->stripes = height < most ? height : most;
    for (int i = 0; i < members; i++)
        if (!(p->rays[i] = tracer_create(level)))
            return false;
    return true;
}

bool probe_images_overflowed(const probe_images *p)
{
    bool any = false;
    for (int i = 0; i < thread_team_size(p->team); i++)
        any |= tracer_overflowed(p->rays[i]);
    return any;
}

void probe_images_end(probe_images *p)
{
    p->made->render.depth = p->depth;
    for (int i = 0; i < PROBE_THREADS_MAX; i++)
        tracer_destroy(p->rays[i]);
    thread_team_destroy(p->team);
    free(p->pixel_rays);
    free(p->pixel_cut);
}
