/* Notes on light that render.depth and render.min_weight cut, estimated by small images at several depths. */
#include "lint/inert.h"
#include "lint/probe_images.h"
#include "scene/model/scene.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* --- ray trees ---
 * Compares small images of the scene at its depth limit and at greater ones, until deeper images stop changing and
 * cut little light, or the ray budget is spent. It is not enough that images stop changing: between two mirrors every
 * ray is cut at every depth, and every image shows render.beyond instead (lint/probe_images.h).
 * One pass renders the images of all limits up to one. It is repeated with a greater limit while that is needed and, by
 * the number of rays of each depth so far, within the budget. */

#define CHANGED_VALUE 0.05f  /* a pixel changes if a channel changes by more than this fraction of the brightest */
#define CHANGED_PIXELS 0.05  /* a depth is too small if a larger fraction of the pixels changes */
#define SETTLED_PIXELS 0.002 /* deeper images count as equal if at most this fraction of the pixels changes */
#define FAINT_ACCEPTED (0.1 * LACK_ACCEPTED) /* faint rays may have this part of the throughput */
#define FIRST_IMAGES 3.0                     /* budgets that images a little deeper than the scene's may take */
enum { FIRST_LIMIT = 4, LEVELS_MAX = COUNTERS_DEPTH_MAX + 1 };

/* Limits beyond the scene's that are tried in turn. */
static const int deeper_by[] = {5, 14, 24};
enum { STEPS = sizeof deeper_by / sizeof deeper_by[0] };

typedef struct depth_search {
    const lint_input *input;
    double budget;    /* in rays */
    bool drops_faint; /* faint rays are not traced: render.min_weight of the small images is not the scene's */
    probe_images images;
    probe_image at[LEVELS_MAX]; /* by depth limit */
    double rays[LEVELS_MAX];    /* by depth, of the last pass */
    int depth, last;            /* the scene's limit; that of the deepest image, which is smaller if the scene's is too
                                 * expensive */
    bool settled;               /* deeper images stopped changing */
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

/* The factor by which a level multiplies a quantity, measured over two levels, because reflections in a plate
 * alternate. NaN: unknown. */
static double decay_at(const depth_search *s, int level)
{
    const size_t pixels = pixels_of(s);
    return level < 2 ? (double)NAN
                     : lack_decay(lack_cut(pixels, &s->at[level - 2]), lack_cut(pixels, &s->at[level]), 2);
}

/* The greatest limit up to `wanted` whose pass that budget allows, if the number of rays goes on growing or shrinking
 * as it did over the last two depths. */
static int limit_within(const depth_search *s, double budget, int wanted)
{
    const double growth =
        s->last >= 2 && s->rays[s->last - 2] > 0.0 ? sqrt(s->rays[s->last] / s->rays[s->last - 2]) : 2.0;
    double all = s->images.spent, next = s->rays[s->last];
    for (int d = 0; d <= s->last; d++)
        all += s->rays[d];
    int limit = s->last;
    while (limit < wanted && (all += next *= growth) <= budget)
        limit++;
    return limit;
}

/* Images a little deeper than the scene's decide most, and may take more. */
static int affordable_limit(const depth_search *s, int wanted)
{
    const int little = s->depth + deeper_by[0] < wanted ? s->depth + deeper_by[0] : wanted,
              least = limit_within(s, FIRST_IMAGES * s->budget, little), most = limit_within(s, s->budget, wanted);
    return most > least ? most : least;
}

/* Whether the limits of the scene's own image cut nothing: then no deeper image differs. */
static bool cuts_nothing(const depth_search *s)
{
    return s->last >= s->depth && lack_cut(pixels_of(s), &s->at[s->depth]) == 0.0;
}

/* Whether deeper images stopped changing and the deepest lacks little light. */
static bool is_found(depth_search *s)
{
    int still = 0;
    for (int d = s->depth + 1; d <= s->last && !s->settled; d++) {
        still = changed_fraction(s, d - 1, d) <= SETTLED_PIXELS ? still + 1 : 0;
        s->settled = still >= 2;
    }
    return s->settled && lack_of(pixels_of(s), &s->at[s->last], &s->at[s->last]).unknown <= 0.5 * LACK_ACCEPTED;
}

/* The greatest limit whose image shows nearly all light of its rays: where light is not lost, the faint ones carry all
 * of it in the end. */
static int known_limit(const depth_search *s, int limit)
{
    while (s->drops_faint && limit > 0 && s->at[limit].by_weight > FAINT_ACCEPTED)
        limit--;
    return limit;
}

static status search(depth_search *s, diagnostic *why)
{
    int limit = s->depth < FIRST_LIMIT ? s->depth : FIRST_LIMIT;
    for (int step = 0; step < STEPS;) {
        TRY(probe_images_render_levels(&s->images, limit, s->at, s->rays, why));
        s->last = known_limit(s, limit);
        if (cuts_nothing(s) || is_found(s) || s->last < limit)
            break;
        while (step < STEPS && s->depth + deeper_by[step] <= s->last)
            step++;
        const int wanted = step < STEPS ? s->depth + deeper_by[step] : s->last;
        limit = affordable_limit(s, wanted < COUNTERS_DEPTH_MAX ? wanted : COUNTERS_DEPTH_MAX);
        if (limit == s->last)
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

/* unknown: the fraction of the image's light that deeper rays could carry; largest: the same of one pixel. */
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
    int enough = s->depth + 1;
    while (enough < s->last && (changed_fraction(s, enough, s->last) > CHANGED_PIXELS || is_lacking_at(s, enough)))
        enough++;
    return enough;
}

static void note_depth(const depth_search *s)
{
    const size_t pixels = pixels_of(s);
    const probe_image *deepest = &s->at[s->last];
    const double changed = changed_fraction(s, s->depth, s->last);
    const bool visible = changed > CHANGED_PIXELS + doubt(s);
    const lack here = lack_of(pixels, &s->at[s->depth], deepest);
    if (!visible && !is_lacking_at(s, s->depth))
        return;
    const int enough = enough_by_images(s), known = lack_depth_enough(s->last, here.bound, decay_at(s, s->last));
    const bool guess = here.unknown > LACK_ACCEPTED || (!s->settled && here.bound > LACK_ACCEPTED);
    char remedy[NOTE_TEXT_MAX];
    write_remedy(remedy, guess ? known : enough, guess || (!s->settled && enough == s->last));
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
    const lack there = lack_of(pixels, &s->at[s->last], &s->at[s->last]);
    const double decay = decay_at(s, s->last);
    if (isnan(decay))
        return;
    const double more = pow(decay, (double)(s->depth - s->last)), unknown = there.unknown * more;
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

status lint_depth(const lint_input *input, double rays, diagnostic *why)
{
    if (input->probe->render.depth > COUNTERS_DEPTH_MAX)
        return STATUS_OK;
    depth_search s = {.input = input,
                      .budget = rays,
                      .drops_faint = input->probe->render.min_weight > input->original->render.min_weight,
                      .depth = (int)input->probe->render.depth};
    status code = probe_images_begin(&s.images, input->probe, input->level) ? search(&s, why) : out_of_memory(why);
    if (code == STATUS_OK && !probe_images_overflowed(&s.images)) {
        if (s.last >= s.depth)
            note_depth(&s);
        else
            note_from_below(&s);
        note_weight(input, &s.at[s.last < s.depth ? s.last : s.depth]);
    }
    for (int d = 0; d < LEVELS_MAX; d++)
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
