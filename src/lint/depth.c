/* Compares small images of the scene at its depth limit and at greater depths, until deeper images stop changing or the
 * ray budget is spent. A thread per processing unit traces stripes of an image; the images, their ray counts and so the
 * notes do not depend on the number of threads. */
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
#define CHANGED_VALUE 0.05   /* ... that change by more than this fraction of the brighter value */
#define SETTLED_PIXELS 0.002 /* if fewer pixels change, deeper images count as equal */
#define DARK (1.0 / 255.0)   /* darker values are displayed as black */
enum { DEEPER_MAX = 24, SAFE_DEPTH = 8, THREADS_MAX = 8, STRIPES_PER_THREAD = 4 };

typedef struct depth_probe {
    plan *made;
    thread_team *team;
    tracer *rays[THREADS_MAX]; /* one per member of the team */
    int stripes;
    atomic_int next_stripe;
    film *image[DEEPER_MAX + 1]; /* by depth, starting at the scene's */
    double *pixel_rays;
    double spent;
} depth_probe;

static const atomic_bool go_on = false;

/* Traces stripes, whichever is next, with one of the tracers. */
static void trace_stripes(void *context, size_t index, int member)
{
    depth_probe *p = context;
    const int width = (int)p->made->render.width, height = (int)p->made->render.height;
    atomic_uint_fast64_t begun = 0;
    (void)member;
    for (int i; (i = atomic_fetch_add(&p->next_stripe, 1)) < p->stripes;) {
        const span stripe = {0, i * height / p->stripes, width, (i + 1) * height / p->stripes};
        tracer_span(p->rays[index], &stripe, &begun, &go_on);
    }
    tracer_finish(p->rays[index], &go_on);
}

static status trace_image(depth_probe *p, int deeper, diagnostic *why)
{
    const render_settings *r = &p->made->render;
    const size_t pixels = (size_t)(r->width * r->height), members = (size_t)thread_team_size(p->team);
    TRY(film_create((int)r->width, (int)r->height, 1, FILM_RGB, &p->image[deeper], why));
    const tracer_target target = {.frame_plan = p->made, .img = p->image[deeper], .pixel_rays = p->pixel_rays};
    for (size_t i = 0; i < pixels; i++)
        p->pixel_rays[i] = 0.0;
    for (size_t i = 0; i < members; i++)
        if (!tracer_begin(p->rays[i], &target))
            return out_of_memory(why);
    atomic_store(&p->next_stripe, 0);
    thread_team_run(p->team, trace_stripes, p, members);
    for (size_t i = 0; i < pixels; i++)
        p->spent += p->pixel_rays[i];
    return STATUS_OK;
}

/* Values above white are displayed as white. */
static double shown(const film *f, int x, int y, int channel)
{
    return fmin(1.0, film_value(f, x, y, channel));
}

static bool pixel_changes(const film *a, const film *b, int x, int y)
{
    double brightest = DARK, change = 0.0;
    for (int c = 0; c < 3; c++) {
        const double one = shown(a, x, y, c), two = shown(b, x, y, c);
        brightest = fmax(brightest, fmax(one, two));
        change = fmax(change, fabs(one - two));
    }
    return change > CHANGED_VALUE * brightest;
}

/* The fraction of pixels that change. */
static double changed_share(const film *a, const film *b)
{
    size_t changed = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            changed += pixel_changes(a, b, x, y);
    return (double)changed / ((double)a->width * a->height);
}

/* The number of rays may double with each level of a ray tree: images below the scene's depth limit predict whether the
 * limit itself exceeds the budget. *affordable: it does not. */
static status climb(depth_probe *p, int depth, double most, bool *affordable, diagnostic *why)
{
    status code = STATUS_OK;
    for (int d = SAFE_DEPTH; d < depth && code == STATUS_OK && p->spent <= most; d += 2) {
        p->made->render.depth = d;
        code = trace_image(p, 0, why);
        film_destroy(p->image[0]);
        p->image[0] = NULL;
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
        still = changed_share(p->image[d - 1], p->image[d]) <= SETTLED_PIXELS ? still + 1 : 0;
        if (still == 2) {
            *settled = true;
            return STATUS_OK;
        }
    }
    return STATUS_OK;
}

/* The uncertainty of the fraction: four standard errors for a random sample of pixels; 0 if the image is the scene's
 * own. */
static double doubt(const lint_room *room, const film *small)
{
    const render_settings *r = &room->of->render;
    const double pixels = (double)small->width * small->height;
    const bool own = r->width == small->width && r->height == small->height && r->samples == 1;
    return own ? 0.0 : 4.0 * sqrt(CHANGED_PIXELS * (1.0 - CHANGED_PIXELS) / pixels);
}

static void note_depth(const lint_room *room, const depth_probe *p, int depth, int last, bool settled)
{
    const double share = changed_share(p->image[0], p->image[last]);
    if (share <= CHANGED_PIXELS + doubt(room, p->image[0]))
        return;
    int enough = 1;
    while (enough < last && changed_share(p->image[enough], p->image[last]) > CHANGED_PIXELS)
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
        film_destroy(p->image[d]);
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
