/* The fuzzer of films: the first bytes are the seed of a random valid scene with meshes, every further four bytes set
 * one of its parameters, chosen by number, to a value of its range. The film must not depend on the instruction set,
 * the hierarchy, threads or tiles, and neither may an error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "fuzz.h"
#include "random_scene.h"
#include "render/frame/renderer.h"
#include "scene/model/params.h"

enum { SEED_BYTES = 4, CHANGE_BYTES = 4, PATHS_MAX = 2048 };

static scene *random_scene(uint64_t seed)
{
    static const char *const makers[] = {"icosphere, level: 2", "torus, around: 7, tube: 5", "box", "sparse, count: 60",
                                         "terrain, depth: 3"};
    const room m = random_room(&seed, random_below(&seed, 3) == 0);
    const vec3 eye = random_point(&seed, 3.0), target = random_point(&seed, 0.5), lamp = random_point(&seed, 4.0);
    scene_text t = {.length = 0};
    add(&t, "background: {color: [0.4, 0.6, 1]}\nrender: {width: 12, height: 9, depth: 3}\n");
    add(&t, "camera: {position: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], fov_deg: 50}\n", eye.x, eye.y,
        eye.z, target.x, target.y, target.z);
    add(&t, "lights:\n  lamp: {position: [%.17g, %.17g, %.17g], reach: 3}\n", lamp.x, lamp.y, lamp.z);
    add(&t, "meshes:\n");
    for (int i = 0; i < 2; i++)
        add(&t, "  m%d: {generate: %s}\n", i, makers[random_below(&seed, sizeof makers / sizeof *makers)]);
    add(&t, "solids:\n");
    add_room(&t, &seed, &m, 1.0, false, true);
    for (int i = 0; i < 2; i++) {
        const vec3 at = random_point(&seed, 1.0);
        add(&t, "  mesh%d: {shape: mesh, mesh: m%d, position: [%.17g, %.17g, %.17g], priority: %d, %s}\n", i, i, at.x,
            at.y, at.z, random_below(&seed, 4), i ? "transparency: 1, ior: 1.5" : "diffuse: 0.6, reflectivity: 0.3");
    }
    scene *s = NULL;
    diagnostic why = {.what = ""};
    char text[DIAGNOSTIC_TEXT_MAX];
    if (scene_read_text("fuzz.yaml", t.at, t.length, &s, &why) == STATUS_OK)
        return s;
    fprintf(stderr, "%s\n%s\n", t.at, diagnostic_text(&why, text, sizeof text));
    abort();
}

/* --- one change --- */

typedef struct chosen {
    size_t wanted, seen;
    char path[128];
    const param *row;
} chosen;

static status choose(void *context, const char *path, const param *row, const char *value)
{
    chosen *c = context;
    (void)value;
    if (c->seen++ == c->wanted) {
        snprintf(c->path, sizeof c->path, "%s", path);
        c->row = row;
    }
    return STATUS_OK;
}

static status count(void *context, const char *path, const param *row, const char *value)
{
    (void)path, (void)row, (void)value;
    ++*(size_t *)context;
    return STATUS_OK;
}

/* Ends and middle of the range, special numbers, or a share of what is common. */
static double number_of(const param *row, unsigned how)
{
    const double low = fmax(row->lowest, -8.0), high = fmin(row->highest, 8.0);
    switch (how % 16) {
    case 0: return row->lowest;
    case 1: return row->highest;
    case 2: return 0.0;
    case 3: return 1.0;
    case 4: return -1.0;
    case 5: return 1e-9;
    case 6: return 1e6;
    default: return low + (high - low) * (double)(how / 16) / 15.0;
    }
}

static void value_of(const param *row, unsigned how, char *text, size_t size)
{
    size_t words = 0;
    switch (row->type) {
    case PARAM_CHOICE:
        while (row->choices[words])
            words++;
        snprintf(text, size, "%s", row->choices[how % words]);
        break;
    case PARAM_INT: snprintf(text, size, "%d", (int)fmax(row->lowest, -4.0) + (int)(how % 8)); break;
    case PARAM_REAL: snprintf(text, size, "%.17g", number_of(row, how)); break;
    case PARAM_VECTOR:
    case PARAM_COLOR:
        snprintf(text, size, "%.17g,%.17g,%.17g", number_of(row, how), number_of(row, how >> 4),
                 number_of(row, how >> 8));
        break;
    case PARAM_LIST:
    case PARAM_PATH:
    case PARAM_WORD: text[0] = 0; break;
    case PARAM_LAYERS: snprintf(text, size, "ar-550"); break;
    }
}

/* What the scene refuses is left out. */
static void change_one(scene *s, const uint8_t *bytes)
{
    size_t all = 0;
    char value[128];
    scene_each_param(s, count, &all);
    chosen c = {.wanted = ((size_t)bytes[0] << 8 | bytes[1]) % all};
    scene_each_param(s, choose, &c);
    value_of(c.row, (unsigned)bytes[2] << 8 | bytes[3], value, sizeof value);
    scene *copy = scene_clone(s);
    must(copy);
    if (scene_set(copy, c.path, value, NULL) == STATUS_OK && scene_check(copy, NULL) == STATUS_OK)
        scene_set(s, c.path, value, NULL);
    scene_destroy(copy);
}

/* The work must stay small. */
static void bound(scene *s)
{
    static const struct {
        const char *path;
        int64_t most;
    } bounds[] = {{"render.width", 12},      {"render.height", 9},  {"render.depth", 5},    {"render.samples", 1},
                  {"render.wavelengths", 3}, {"render.threads", 2}, {"render.photons", 300}};
    const int64_t now[] = {s->render.width,       s->render.height,  s->render.depth,  s->render.samples,
                           s->render.wavelengths, s->render.threads, s->render.photons};
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        char text[24];
        snprintf(text, sizeof text, "%d", (int)bounds[i].most);
        if (now[i] > bounds[i].most)
            must(scene_set(s, bounds[i].path, text, NULL) == STATUS_OK);
    }
}

/* --- the films of a scene --- */

typedef struct outcome {
    status code;
    uint64_t hash;
} outcome;

static outcome film_of(const scene *s, isa level)
{
    static renderer *renderers[ISA_COUNT];
    render_result *result = NULL;
    if (!renderers[level])
        must(renderer_create(level, NULL, &renderers[level], NULL) == STATUS_OK);
    diagnostic why = {.what = ""};
    outcome got = {.code = renderer_render(renderers[level], s, NULL, &result, &why)};
    must(got.code == STATUS_OK || why.what[0]);
    if (got.code == STATUS_OK)
        got.hash = film_hash(result->img);
    render_result_destroy(result);
    return got;
}

static void must_agree(outcome a, outcome b, const char *what)
{
    if (a.code == b.code && a.hash == b.hash)
        return;
    fprintf(stderr, "another film: %s\n", what);
    abort();
}

static void compare_films(scene *s)
{
    static const char *const settings[] = {"accel=none", "accel=sphere", "accel=octant", "accel=bvh",
                                           "keep=off",   "threads=3",    "tile=3",       "tiles_per_worker=0"};
    const outcome first = film_of(s, isa_best());
    for (int level = 0; level < (int)isa_best(); level++)
        must_agree(first, film_of(s, (isa)level), isa_name((isa)level));
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        char path[32];
        const size_t name = strcspn(settings[i], "=");
        snprintf(path, sizeof path, "render.%.*s", (int)name, settings[i]);
        must(scene_set(s, path, settings[i] + name + 1, NULL) == STATUS_OK);
        must_agree(first, film_of(s, isa_best()), settings[i]);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { CHANGES_MAX = 12 };
    if (size < SEED_BYTES)
        return 0;
    uint32_t seed;
    memcpy(&seed, data, sizeof seed);
    scene *s = random_scene(seed);
    data += SEED_BYTES;
    size -= SEED_BYTES;
    for (int i = 0; i < CHANGES_MAX && size >= CHANGE_BYTES; i++, data += CHANGE_BYTES, size -= CHANGE_BYTES)
        change_one(s, data);
    bound(s);
    if (scene_check(s, NULL) == STATUS_OK && scene_load(s, NULL) == STATUS_OK)
        compare_films(s);
    scene_destroy(s);
    return 0;
}
