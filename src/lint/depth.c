/* Notes on light that render.depth and render.min_weight cut, estimated by small images at several depths. */
#include "lint/parts.h"
#include "lint/probe_images.h"
#include "scene/model/scene.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* --- ray trees ---
 * Compares small images of the scene at its depth limit and at greater depths, until deeper images stop changing and
 * cut little light, or the ray budget is spent. It is not enough that images stop changing: between two mirrors every
 * ray is cut at every depth, and every image shows render.beyond instead (lint/probe_images.h). */

#define RAYS_MAX 400000.0    /* budget of all images, in rays: about ten milliseconds */
#define MESH_RAY 10.0        /* cost of a ray in a scene with triangles, relative to a scene without */
#define CHANGED_VALUE 0.05f  /* a pixel changes if a channel changes by more than this fraction of the brightest */
#define CHANGED_PIXELS 0.05  /* a depth is too small if a larger fraction of the pixels changes */
#define SETTLED_PIXELS 0.002 /* deeper images count as equal if at most this fraction of the pixels changes */
enum { DEEPER_MAX = 24, SAFE_DEPTH = 8 };

typedef struct depth_search {
    const lint_input *input;
    probe_images images;
    probe_image at[DEEPER_MAX + 1]; /* by depth, starting at the scene's */
    int depth, last;                /* the scene's depth limit; index of the deepest image */
    bool settled;                   /* deeper images stopped changing */
    int climbed;                    /* the last depth that climb() rendered; 0: none */
    double cut[2];                  /* cut throughput of the last two images of climb() */
} depth_search;

static size_t pixels_of(const depth_search *s)
{
    return probe_pixels(&s->images);
}

static float white_at_most(float value)
{
    return value < 1.0f ? value : 1.0f;
}

/* Whether a pixel's displayed values differ. It compares by itself, because fmax and fmin are calls. */
static bool pixel_changes(const float *a, const float *b)
{
    float brightest = PROBE_DARK, change = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float one = white_at_most(a[c]), two = white_at_most(b[c]), step = one < two ? two - one : one - two;
        brightest = one > brightest ? one : brightest;
        brightest = two > brightest ? two : brightest;
        change = step > change ? step : change;
    }
    return change > CHANGED_VALUE * brightest;
}

/* The fraction of pixels that change. */
static double changed_fraction(const depth_search *s, int one, int two)
{
    const size_t pixels = pixels_of(s);
    size_t changed = 0;
    for (size_t i = 0; i < pixels; i++)
        changed += pixel_changes(s->at[one].rgb + 3 * i, s->at[two].rgb + 3 * i);
    return (double)changed / (double)pixels;
}

/* Renders images below the scene's depth limit while the budget lasts: the number of rays may double with each level of
 * a ray tree. *affordable: the budget is not spent, so the scene's own depth can be rendered. */
static status climb(depth_search *s, double most, bool *affordable, diagnostic *why)
{
    for (int d = SAFE_DEPTH; d < s->depth && s->images.spent <= most; d += 2) {
        TRY(probe_images_render(&s->images, d, &s->at[0], why));
        s->climbed = d;
        s->cut[0] = s->cut[1];
        s->cut[1] = lack_cut(pixels_of(s), &s->at[0]);
    }
    *affordable = s->images.spent <= most;
    return STATUS_OK;
}

/* The factor by which a level reduces the cut throughput, measured over two levels, because reflections in a plate
 * alternate. NaN: unknown. */
static double decay_at_last(const depth_search *s)
{
    const size_t pixels = pixels_of(s);
    const double last = lack_cut(pixels, &s->at[s->last]);
    if (s->last >= 2)
        return lack_decay(lack_cut(pixels, &s->at[s->last - 2]), last, 2);
    return s->climbed ? lack_decay(s->cut[1], last, s->depth + s->last - s->climbed) : (double)NAN;
}

/* Renders deeper images until they are nearly equal and nearly all light is known. */
static status look_deeper(depth_search *s, double most, diagnostic *why)
{
    TRY(probe_images_render(&s->images, s->depth, &s->at[0], why));
    int still = 0;
    for (int d = 1; d <= DEEPER_MAX && s->depth + d <= COUNTERS_DEPTH_MAX && s->images.spent <= most; d++) {
        TRY(probe_images_render(&s->images, s->depth + d, &s->at[d], why));
        s->last = d;
        still = changed_fraction(s, d - 1, d) <= SETTLED_PIXELS ? still + 1 : 0;
        s->settled |= still >= 2;
        if (s->settled && lack_of(pixels_of(s), &s->at[d], &s->at[d]).unknown <= 0.5 * LACK_ACCEPTED)
            break;
    }
    return STATUS_OK;
}

/* The error of an estimate from a sample of the scene's pixels; 0 if the small images have all of them. */
static double random_error(const depth_search *s, double error)
{
    const render_settings *r = &s->input->original->render, *small = &s->images.made->render;
    return r->width == small->width && r->height == small->height && r->samples == 1 ? 0.0 : error;
}

/* The uncertainty of the fraction of pixels: four standard errors. */
static double doubt(const depth_search *s)
{
    return random_error(s, 4.0 * sqrt(CHANGED_PIXELS * (1.0 - CHANGED_PIXELS) / (double)pixels_of(s)));
}

/* enough: the depth that suffices, INT_MAX if none does; more: `enough` may be too small. */
static void write_remedy(char remedy[NOTE_TEXT_MAX], int enough, bool more)
{
    if (enough > COUNTERS_DEPTH_MAX)
        snprintf(remedy, NOTE_TEXT_MAX, "set render.integrator=path and " REMEDY_WITHOUT_LIMIT);
    else
        snprintf(remedy, NOTE_TEXT_MAX, "set render.depth=%d%s", enough, more ? " or more" : "");
}

/* unknown, largest: fractions. */
static void note_unknown(const lint_input *input, const char *remedy, int depth, double unknown, double largest)
{
    note_report(input->taker, "render", "depth", remedy,
                "rays that end at a depth of %d could carry about %.3g %% of the image's light, up to %.3g %% of a "
                "pixel's; that deeper images look alike proves nothing",
                depth, 100.0 * fmin(unknown, 1.0), 100.0 * fmin(largest, 1.0));
}

/* Whether the image of that level lacks more light than is accepted, compared with the deepest image. */
static bool is_lacking_at(const depth_search *s, int level)
{
    const size_t pixels = pixels_of(s);
    const lack l = lack_of(pixels, &s->at[level], &s->at[s->last]);
    return lack_cut(pixels, &s->at[level]) > LACK_ACCEPTED && l.mean > LACK_ACCEPTED + random_error(s, 2.0 * l.error);
}

static int enough_by_images(const depth_search *s)
{
    int enough = 1;
    while (enough < s->last && (changed_fraction(s, enough, s->last) > CHANGED_PIXELS || is_lacking_at(s, enough)))
        enough++;
    return enough;
}

static void note_depth(const depth_search *s)
{
    const size_t pixels = pixels_of(s);
    const probe_image *deepest = &s->at[s->last];
    const double changed = changed_fraction(s, 0, s->last);
    const bool visible = changed > CHANGED_PIXELS + doubt(s);
    const lack here = lack_of(pixels, &s->at[0], deepest);
    if (!visible && !is_lacking_at(s, 0))
        return;
    const int enough = enough_by_images(s), known = lack_depth_enough(s->depth + s->last, here.bound, decay_at_last(s));
    const bool guess = here.unknown > LACK_ACCEPTED || (!s->settled && here.bound > LACK_ACCEPTED);
    char remedy[NOTE_TEXT_MAX];
    write_remedy(remedy, guess ? known : s->depth + enough, guess || (!s->settled && enough == s->last));
    if (visible)
        note_report(s->input->taker, "render", "depth", remedy,
                    "a depth of %d is too small: a greater depth changes about %.0f %% of the pixels by more "
                    "than 5 %%",
                    s->depth, 100.0 * changed);
    else if (here.unknown > 0.5 * here.mean)
        note_unknown(s->input, remedy, s->depth, here.mean, here.largest);
    else
        note_report(s->input->taker, "render", "depth", remedy,
                    "a depth of %d is too small: a greater depth changes the image by about %.3g %% of its light",
                    s->depth, 100.0 * here.mean);
}

/* The scene's own depth is too expensive: extrapolates the decay of the shallower images. */
static void note_from_below(const depth_search *s)
{
    const size_t pixels = pixels_of(s);
    const lack there = lack_of(pixels, &s->at[0], &s->at[0]);
    if (s->cut[0] == 0.0) /* one image shows no decay */
        return;
    const double decay = lack_decay(s->cut[0], s->cut[1], 2), more = pow(decay, (double)(s->depth - s->climbed)),
                 unknown = there.unknown * more;
    if (unknown <= LACK_ACCEPTED)
        return;
    char remedy[NOTE_TEXT_MAX];
    write_remedy(remedy, lack_depth_enough(s->depth, there.bound * more, decay), true);
    note_unknown(s->input, remedy, s->depth, unknown, there.largest);
}

static void note_weight(const lint_input *input, const probe_image *at)
{
    if (at->by_weight > LACK_ACCEPTED)
        note_report(input->taker, "render", "min_weight", "set render.min_weight=0",
                    "rays below render.min_weight could carry about %.3g %% of the image's light",
                    100.0 * at->by_weight);
}

static status search(depth_search *s, bool *affordable, diagnostic *why)
{
    const double most = s->images.made->geometry->meshes ? RAYS_MAX / MESH_RAY : RAYS_MAX;
    TRY(climb(s, most, affordable, why));
    return *affordable ? look_deeper(s, most, why) : STATUS_OK;
}

status lint_depth(const lint_input *input, diagnostic *why)
{
    depth_search s = {.input = input, .depth = (int)input->probe->render.depth};
    bool affordable = false;
    if (input->probe->render.depth > COUNTERS_DEPTH_MAX)
        return STATUS_OK;
    status code =
        probe_images_begin(&s.images, input->probe, input->level) ? search(&s, &affordable, why) : out_of_memory(why);
    if (code == STATUS_OK && !probe_images_overflowed(&s.images)) {
        if (affordable)
            note_depth(&s);
        else
            note_from_below(&s);
        note_weight(input, &s.at[0]);
    }
    for (int d = 0; d <= DEEPER_MAX; d++)
        probe_image_free(&s.at[d]);
    probe_images_end(&s.images);
    return code;
}

/* --- random paths ---
 * A path with a greater depth limit begins with the same random numbers as one with a smaller limit: the difference of
 * two images is the light of the deeper events, nearly free of noise. */

/* *enough: the least depth of a doubling sequence whose image lacks little light; COUNTERS_DEPTH_MAX, the depth of
 * `deepest`, if there is none. */
static status find_enough(probe_images *images, int depth, const probe_image *deepest, int *enough, diagnostic *why)
{
    const size_t pixels = probe_pixels(images);
    probe_image at = {.rgb = NULL};
    status code = STATUS_OK;
    for (*enough = 2 * depth + 2; *enough < COUNTERS_DEPTH_MAX && code == STATUS_OK; *enough *= 2) {
        code = probe_images_render(images, *enough, &at, why);
        if (code == STATUS_OK && lack_of(pixels, &at, deepest).mean <= LACK_ACCEPTED)
            break;
    }
    *enough = *enough < COUNTERS_DEPTH_MAX ? *enough : COUNTERS_DEPTH_MAX;
    probe_image_free(&at);
    return code;
}

static status note_paths(const lint_input *input, probe_images *images, lack here, const probe_image *deepest,
                         diagnostic *why)
{
    const int depth = (int)images->depth;
    char remedy[NOTE_TEXT_MAX] = "set " REMEDY_WITHOUT_LIMIT;
    if (here.unknown <= LACK_ACCEPTED) {
        int enough;
        TRY(find_enough(images, depth, deepest, &enough, why));
        snprintf(remedy, sizeof remedy, "set render.depth=%d", enough);
    }
    note_report(input->taker, "render", "depth", remedy,
                "paths that end at a depth of %d could carry about %.3g %% of the image's light", depth,
                100.0 * fmin(here.mean, 1.0));
    return STATUS_OK;
}

static status examine(const lint_input *input, probe_images *images, probe_image at[2], diagnostic *why)
{
    const size_t pixels = probe_pixels(images);
    const int depth = (int)images->depth;
    TRY(probe_images_render(images, depth, &at[0], why));
    if (lack_cut(pixels, &at[0]) == 0.0)
        return STATUS_OK;
    TRY(probe_images_render(images, COUNTERS_DEPTH_MAX, &at[1], why));
    const lack here = lack_of(pixels, &at[0], &at[1]);
    if (probe_images_overflowed(images) || here.mean <= LACK_ACCEPTED + 2.0 * here.error)
        return STATUS_OK;
    return note_paths(input, images, here, &at[1], why);
}

status lint_path_depth(const lint_input *input, diagnostic *why)
{
    probe_images images;
    probe_image at[2] = {{.rgb = NULL}};
    if (input->probe->render.depth > COUNTERS_DEPTH_MAX)
        return STATUS_OK;
    const status code =
        probe_images_begin(&images, input->probe, input->level) ? examine(input, &images, at, why) : out_of_memory(why);
    probe_image_free(&at[0]);
    probe_image_free(&at[1]);
    probe_images_end(&images);
    return code;
}
