/* Compares small images of the scene at its depth limit and at greater depths, until deeper images stop changing or the
 * ray budget is spent. A thread per processing unit traces stripes of an image; the images, their ray counts and so the
 * notes do not depend on the number of threads. */
#include "base/cancel.h"
#include "base/thread_team.h"
#include "lint/parts.h"
#include "render/core/tracer.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define RAYS_MAX 400000.0    /* budget of all images, in rays: some ten milliseconds */
#define MESH_RAY 10.0        /* cost of a ray in a scene with triangles, in rays */
#define CHANGED_PIXELS 0.05  /* fraction of the pixels ... */
#define CHANGED_VALUE 0.05f  /* ... that change by more than this fraction of the brighter value */
#define SETTLED_PIXELS 0.002 /* if fewer pixels change, deeper images count as equal */
#define DARK (1.0f / 255.0f) /* darker values are displayed as black */
enum { DEEPER_MAX = 24, SAFE_DEPTH = 8, THREADS_MAX = 8, STRIPES_PER_THREAD = 4 };

typedef struct depth_probe {
    plan *made;
    thread_team *team;
    tracer *rays[THREADS_MAX]; /* one per member of the team */
    int stripes;
    atomic_int next_stripe;
    float *shown[DEEPER_MAX + 1]; /* images as displayed, by depth, starting at the scene's: [pixel][channel], 0..1 */
    double *pixel_rays;
    double spent;
} depth_probe;

/* Traces stripes, whichever is next, with one of the tracers. */
static void trace_stripes(void *context, size_t index, int member)
{
    depth_probe *p = context;
    const atomic_bool *stop = cancel_flag();
    const int width = (int)p->made->render.width, height = (int)p->made->render.height;
    atomic_uint_fast64_t begun = 0;
    (void)member;
    for (int i; (i = atomic_fetch_add(&p->next_stripe, 1)) < p->stripes;) {
        const span stripe = {0, i * height / p->stripes, width, (i + 1) * height / p->stripes};
        tracer_span(p->rays[index], &stripe, &begun, stop);
    }
    tracer_finish(p->rays[index], stop);
}

static size_t pixels_of(const depth_probe *p)
{
    return (size_t)(p->made->render.width * p->made->render.height);
}

/* The image as displayed: values above white are white. */
static bool show(const depth_probe *p, const film *f, float **shown)
{
    const size_t values = 3 * pixels_of(p);
    float *rgb = *shown ? *shown : malloc(values * sizeof *rgb);
    *shown = rgb;
    if (!rgb)
        return false;
    film_read(f, 0, 0, f->width, f->height, rgb, 3 * (size_t)f->width);
    for (size_t i = 0; i < values; i++)
        rgb[i] = rgb[i] < 1.0f ? rgb[i] : 1.0f;
    return true;
}

static status trace_film(depth_probe *p, film *f, diagnostic *why)
{
    const size_t pixels = pixels_of(p), members = (size_t)thread_team_size(p->team);
    const tracer_target target = {.frame_plan = p->made, .img = f, .pixel_rays = p->pixel_rays};
    for (size_t i = 0; i < pixels; i++)
        p->pixel_rays[i] = 0.0;
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

static status trace_image(depth_probe *p, int deeper, diagnostic *why)
{
    const render_settings *r = &p->made->render;
    film *f;
    TRY(film_create((int)r->width, (int)r->height, 1, FILM_RGB, &f, why));
    status code = trace_film(p, f, why);
    if (code == STATUS_OK && !show(p, f, &p->shown[deeper]))
        code = out_of_memory(why);
    film_destroy(f);
    return code;
}

/* Whether a pixel's values, as displayed, differ. Comparisons alone: fmax and fmin are calls. */
static bool pixel_changes(const float *a, const float *b)
{
    float brightest = DARK, change = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float one = a[c], two = b[c], apart = one < two ? two - one : one - two;
        brightest = one > brightest ? one : brightest;
        brightest = two > brightest ? two : brightest;
        change = apart > change ? apart : change;
    }
    return change > CHANGED_VALUE * brightest;
}

/* The fraction of pixels that change. */
static double changed_share(const depth_probe *p, int one, int two)
{
    const size_t pixels = pixels_of(p);
    size_t changed = 0;
    for (size_t i = 0; i < pixels; i++)
        changed += pixel_changes(p->shown[one] + 3 * i, p->shown[two] + 3 * i);
    return (double)changed / (double)pixels;
}

/* The number of rays may double with each level of a ray tree: images below the scene's depth limit predict whether the
 * limit itself exceeds the budget. *affordable: it does not. */
static status climb(depth_probe *p, int depth, double most, bool *affordable, diagnostic *why)
{
    status code = STATUS_OK;
    for (int d = SAFE_DEPTH; d < depth && code == STATUS_OK && p->spent <= most; d += 2) {
        p->made->render.depth = d;
        code = trace_image(p, 0, why);
    }
    p->made->render.depth = depth;
    *affordable = p->spent <= most;
    return code;
}

/* The deepest image; *settled: deeper ones would be nearly equal. */
static status look_deeper(depth_probe *p, int depth, int *last, bool *settled, diagnostic *why)
{
    const double most = p->made->geometry->meshes ? RAYS_MAX / MESH_RAY : RAYS_MAX;
    bool affordable;
    *last = 0;
    TRY(climb(p, depth, most, &affordable, why));
    if (!affordable)
        return STATUS_OK;
    TRY(trace_image(p, 0, why));
    int still = 0;
    for (int d = 1; d <= DEEPER_MAX && depth + d <= COUNTERS_DEPTH_MAX && p->spent <= most; d++) {
        p->made->render.depth = depth + d;
        TRY(trace_image(p, d, why));
        *last = d;
        still = changed_share(p, d - 1, d) <= SETTLED_PIXELS ? still + 1 : 0;
        if (still == 2) {
            *settled = true;
            return STATUS_OK;
        }
    }
    return STATUS_OK;
}

/* The uncertainty of the fraction: four standard errors for a random sample of pixels; 0 if the image is the scene's
 * own. */
static double doubt(const lint_room *room)
{
    const render_settings *r = &room->of->render, *small = &room->made->render;
    const double pixels = (double)small->width * (double)small->height;
    const bool own = r->width == small->width && r->height == small->height && r->samples == 1;
    return own ? 0.0 : 4.0 * sqrt(CHANGED_PIXELS * (1.0 - CHANGED_PIXELS) / pixels);
}

static void note_depth(const lint_room *room, const depth_probe *p, int depth, int last, bool settled)
{
    const double share = changed_share(p, 0, last);
    if (share <= CHANGED_PIXELS + doubt(room))
        return;
    int enough = 1;
    while (enough < last && changed_share(p, enough, last) > CHANGED_PIXELS)
        enough++;
    char remedy[NOTE_TEXT_MAX];
    snprintf(remedy, sizeof remedy, "set render.depth=%d%s", depth + enough,
             settled || enough < last ? "" : " or more");
    note_give(room->taker, "render", "depth", remedy,
              "a depth of %d is too small: a greater depth changes about %.0f %% of the pixels by more "
              "than 5 %%",
              depth, 100.0 * share);
}

static bool begin(depth_probe *p, isa level)
{
    const render_settings *r = &p->made->render;
    const int units = thread_team_units();
    p->pixel_rays = calloc((size_t)(r->width * r->height), sizeof *p->pixel_rays);
    p->team = thread_team_start(units < THREADS_MAX ? units : THREADS_MAX);
    if (!p->pixel_rays || !p->team)
        return false;
    const int members = thread_team_size(p->team), most = members == 1 ? 1 : members * STRIPES_PER_THREAD;
    p->stripes = r->height < most ? (int)r->height : most;
    for (int i = 0; i < members; i++)
        if (!(p->rays[i] = tracer_create(level)))
            return false;
    return true;
}

static bool overflowed(const depth_probe *p)
{
    bool any = false;
    for (int i = 0; i < thread_team_size(p->team); i++)
        any |= tracer_overflowed(p->rays[i]);
    return any;
}

static void end(depth_probe *p)
{
    for (int d = 0; d <= DEEPER_MAX; d++)
        free(p->shown[d]);
    for (int i = 0; i < THREADS_MAX; i++)
        tracer_destroy(p->rays[i]);
    thread_team_stop(p->team);
    free(p->pixel_rays);
}

status lint_depth(const lint_room *room, diagnostic *why)
{
    const int depth = (int)room->made->render.depth;
    depth_probe p = {.made = room->made};
    int last = 0;
    bool settled = false;
    status code = begin(&p, room->level) ? look_deeper(&p, depth, &last, &settled, why) : out_of_memory(why);
    if (code == STATUS_OK && last > 0 && !overflowed(&p))
        note_depth(room, &p, depth, last, settled);
    room->made->render.depth = depth;
    end(&p);
    return code;
}
