/* Shipped scenes at reduced size, and films of them with one parameter changed. Errors are returned in the outcome, so
 * that several threads may run it. Ownership: acts_open creates, acts_close releases. */
#pragma once

#include "acts_values.h"

#include "lint/lint.h"
#include "render/frame/renderer.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

/* Reductions: meshes of fewer triangles, fewer wavelengths. The features of each scene remain. */
typedef struct acts_small {
    const char *scene, *assignments;
} acts_small;
static const acts_small acts_smaller[] = {
    {"models", "ball.level=2 torus.around=24 torus.tube=12 lathe.around=16"},
    {"slime", "toy.level=2 toy.dt_s=0.008"},
    {"soup", "soup.count=500"},
    {"vessel-mesh", "cup.around=16"},
    {"rainbow", "render.wavelengths=8 render.samples=1"},
    {"rainbow-landscape", "render.samples=1 ridge.around=30 downs.around=30 fir.around=6"},
    {"prism", "render.wavelengths=4 render.width=300 render.height=150"},
    {"plates", "render.width=120 render.height=90"},
    {"frosted", "render.paths=4"},
    {"milky", "render.width=160 render.height=120 render.paths=2 render.depth=5"},
    {"sunlit-glass", "render.width=144 render.height=96 render.paths=2 render.photons=2000 render.depth=6"},
    {"solids", "render.samples=1"},
    {"shapes", "render.samples=1 render.depth=6"},
    {"focus", "render.samples=4"},
    {"caustic", "render.samples=1 render.photons=2000"},
    {"films", "render.samples=1 render.depth=3"},
    {"window", "render.samples=4 render.photons=300 render.width=360 render.height=120"},
    {"spectroscope", "render.wavelengths=4 render.samples=1 render.photons=4000"},
    {"calcite", "render.samples=1 render.depth=4"},
    {"meniscus", "render.depth=3"},
    {"coin", "render.samples=1"},
    {"soap", "render.samples=1 render.spectrum=spectral render.wavelengths=4 render.width=36 render.height=48"},
    {"arrow", "render.samples=1 render.depth=6"},
    {"polarisers", "render.samples=1 render.wavelengths=2"},
    {"laser", "render.photons=4000 render.width=80 render.height=60"},
};

/* Heights of the films, tried in this order until a value has an effect: a slit may lie between the rays of a small
 * film. */
enum { ACTS_SIZES = 3 };
static const int acts_heights[ACTS_SIZES] = {48, 120, 240};

typedef struct acts {
    scene *s; /* as shipped, except for acts_smaller */
    renderer *r;
    uint64_t base[ACTS_SIZES];
    bool has_base[ACTS_SIZES];
    ray_counters counters; /* of the largest film, once it is rendered */
} acts;

static inline bool acts_set_all(scene *s, const char *assignments, diagnostic *why)
{
    char text[NOTE_TEXT_MAX], *rest = text;
    snprintf(text, sizeof text, "%s", assignments);
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        const size_t length = strlen(word);
        word[length - 1] = word[length - 1] == ',' ? 0 : word[length - 1];
        if (strchr(word, '=') && scene_set_assignment(s, word, why) != STATUS_OK)
            return false;
    }
    return true;
}

static inline bool acts_resize(scene *s, int height)
{
    char text[80];
    if (s->render.height <= height)
        return true;
    snprintf(text, sizeof text, "render.width=%d render.height=%d", (int)(s->render.width * height / s->render.height),
             height);
    return acts_set_all(s, text, NULL);
}

/* The film's hash; counters may be NULL. */
static inline bool acts_hash(renderer *r, scene *s, uint64_t *hash, ray_counters *counters, diagnostic *why)
{
    render_result *result = NULL;
    if (scene_check(s, why) != STATUS_OK || scene_load(s, why) != STATUS_OK || scene_check(s, why) != STATUS_OK ||
        renderer_render(r, s, NULL, &result, why) != STATUS_OK)
        return false;
    *hash = film_hash(result->img);
    if (counters)
        *counters = result->counters;
    render_result_destroy(result);
    return true;
}

static inline void acts_close(acts *a)
{
    scene_destroy(a->s);
    if (a->r)
        renderer_destroy(a->r);
    *a = (acts){.s = NULL};
}

/* For a scene that is already loaded; takes ownership of it. */
static inline bool acts_of(scene *s, acts *out, diagnostic *why)
{
    *out = (acts){.s = s};
    scene *small = scene_clone(s);
    bool fine = small && renderer_create(isa_best(), NULL, &out->r, why) == STATUS_OK &&
                scene_check(s, why) == STATUS_OK && scene_load(s, why) == STATUS_OK &&
                acts_resize(small, acts_heights[0]);
    if (fine)
        scene_retain_meshes(small, s);
    fine = fine && acts_hash(out->r, small, &out->base[0], NULL, why);
    out->has_base[0] = fine;
    scene_destroy(small);
    if (!fine)
        acts_close(out);
    return fine;
}

static inline bool acts_open(const char *path, acts *out, diagnostic *why)
{
    scene *s = NULL;
    *out = (acts){.s = NULL};
    if (scene_read(path, &s, why) != STATUS_OK)
        return false;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    for (size_t i = 0; i < sizeof acts_smaller / sizeof *acts_smaller; i++)
        if (strncmp(name, acts_smaller[i].scene, strcspn(name, ".")) == 0 &&
            acts_smaller[i].scene[strcspn(name, ".")] == 0)
            if (!acts_set_all(s, acts_smaller[i].assignments, why)) {
                scene_destroy(s);
                return false;
            }
    return acts_of(s, out, why);
}

/* The number of other legal values, and the number of those that changed the film; why holds the error of the last
 * value that was refused. */
typedef struct acts_outcome {
    int legal, changed;
    diagnostic why;
} acts_outcome;

static inline bool acts_base(acts *a, int size)
{
    scene *s = a->has_base[size] ? NULL : scene_clone(a->s);
    if (s)
        a->has_base[size] = acts_resize(s, acts_heights[size]) &&
                            acts_hash(a->r, s, &a->base[size], size == ACTS_SIZES - 1 ? &a->counters : NULL, NULL);
    scene_destroy(s);
    return a->has_base[size];
}

/* Tries values until `enough` of them have changed the film of that size. */
static inline acts_outcome acts_try(acts *a, const char *path, const acts_values *v, int size, int enough)
{
    acts_outcome o = {.legal = 0};
    for (int i = 0; i < v->count && o.changed < enough && acts_base(a, size); i++) {
        scene *s = scene_clone(a->s);
        uint64_t hash;
        const bool small = s && acts_resize(s, acts_heights[size]);
        if (small && scene_set(s, path, v->text[i], &o.why) == STATUS_OK && acts_hash(a->r, s, &hash, NULL, &o.why))
            o.legal++, o.changed += hash != a->base[size];
        scene_destroy(s);
    }
    return o;
}

/* The renderer's answer to param_is_inert, for the largest film. */
static inline bool acts_same(void *context, const char *assignment)
{
    acts *a = context;
    scene *s = scene_clone(a->s);
    uint64_t hash;
    const bool same = s && acts_base(a, ACTS_SIZES - 1) && acts_resize(s, acts_heights[ACTS_SIZES - 1]) &&
                      scene_set_assignment(s, assignment, NULL) == STATUS_OK && acts_hash(a->r, s, &hash, NULL, NULL) &&
                      hash == a->base[ACTS_SIZES - 1];
    scene_destroy(s);
    return same;
}

static inline bool acts_ask(acts *a, const char *path, inert_answer *out)
{
    const bool seen = acts_base(a, ACTS_SIZES - 1);
    const inert_witness renderer_says = {seen ? &a->counters : NULL, acts_same, a};
    return param_is_inert(a->s, path, &renderer_says, out);
}

/* acts_try at one size after another, until a value changes the film. */
static inline acts_outcome acts_try_sizes(acts *a, const char *path, const acts_values *v, int enough)
{
    acts_outcome o = {.legal = 0};
    for (int size = 0; size < ACTS_SIZES && o.changed == 0; size++)
        o = acts_try(a, path, v, size, enough);
    return o;
}
