/* Tests of the library in every floating-point environment of a caller: bit-identical films, numbers, hits and motions,
 * and the caller's environment unchanged. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/worker_pool.h"
#include "cuvette.h"
#include <fenv.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* --- environments of callers --- */

enum { X86_DAZ = 0x0040, X86_FTZ = 0x8000, X87_PRECISION = 0x0300 };

typedef struct surroundings {
    int rounding;      /* FE_UPWARD ... */
    unsigned flushing; /* bits of MXCSR; other processors have none */
    bool narrow;       /* x87 registers with 24-bit significands */
    int traps;         /* for feenableexcept */
} surroundings;

static const int roundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
static const unsigned flushings[] = {0, X86_FTZ, X86_DAZ, X86_FTZ | X86_DAZ};

/* Every rounding mode with every flushing; then narrow registers and traps, alone and combined. */
enum { PLAIN = COUNT(roundings) * COUNT(flushings), SURROUNDINGS = PLAIN + 4 };

static surroundings surroundings_at(size_t i)
{
    const surroundings unusual[] = {{FE_TONEAREST, 0, true, 0},
                                    {FE_TONEAREST, 0, false, FE_ALL_EXCEPT},
                                    {FE_UPWARD, X86_FTZ | X86_DAZ, true, 0},
                                    {FE_UPWARD, X86_FTZ | X86_DAZ, false, FE_ALL_EXCEPT}};
    if (i >= PLAIN)
        return unusual[i - PLAIN];
    return (surroundings){roundings[i / COUNT(flushings)], flushings[i % COUNT(flushings)], false, 0};
}

static void set_surroundings(const surroundings *wanted)
{
    fesetenv(FE_DFL_ENV);
#if defined(__x86_64__) && defined(__GLIBC__)
    fenv_t now;
    fegetenv(&now);
    now.__mxcsr |= wanted->flushing;
    if (wanted->narrow)
        now.__control_word &= (unsigned short)~X87_PRECISION;
    fesetenv(&now);
#endif
    fesetround(wanted->rounding);
    if (!wanted->traps)
        feraiseexcept(FE_OVERFLOW); /* a raised exception, which the library must not clear */
    feenableexcept(wanted->traps);
}

/* The part of the environment that a caller can observe. */
typedef struct noticed {
    int rounding, raised, traps;
    unsigned mxcsr, control;
} noticed;

static noticed notice(void)
{
    noticed n = {fegetround(), fetestexcept(FE_ALL_EXCEPT), fegetexcept(), 0, 0};
#if defined(__x86_64__) && defined(__GLIBC__)
    fenv_t now;
    fegetenv(&now);
    n.mxcsr = now.__mxcsr, n.control = now.__control_word;
#endif
    return n;
}

static void expect_unchanged(const noticed *before)
{
    const noticed after = notice();
    fesetenv(FE_DFL_ENV);
    if (memcmp(before, &after, sizeof after) != 0)
        fail_msg("rounding %x to %x, raised %x to %x, traps %x to %x, mxcsr %x to %x, control word %x to %x",
                 (unsigned)before->rounding, (unsigned)after.rounding, (unsigned)before->raised, (unsigned)after.raised,
                 (unsigned)before->traps, (unsigned)after.traps, before->mxcsr, after.mxcsr, before->control,
                 after.control);
}

/* --- the caller's requests; without arithmetic on numbers here, which would run in the caller's environment --- */

static void fine(cuvette_status code, const cuvette_diagnostic *why)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    if (code == CUVETTE_OK)
        return;
    fesetenv(FE_DFL_ENV);
    fail_msg("%d: %s", (int)code, cuvette_diagnostic_text(why, text, sizeof text));
}

/* FNV-1a. */
static uint64_t mix(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
    return hash;
}

static uint64_t mix_text(uint64_t hash, const char *text)
{
    return mix(hash, text, strlen(text) + 1);
}

static void turn(cuvette_scene *s, const char *path, const char *value)
{
    cuvette_diagnostic why;
    fine(cuvette_scene_set(s, path, value, &why), &why);
}

static cuvette_scene *scene_of(const char *file, const char *assignments)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    char path[128], text[256];
    snprintf(path, sizeof path, "experiments/scenes/%s", file);
    fine(cuvette_scene_read(path, &s, &why), &why);
    snprintf(text, sizeof text, "render.width=48 render.height=36 render.threads=2 %s", assignments);
    char *rest = text;
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        char *value = strchr(word, '=');
        *value = 0;
        turn(s, word, value + 1);
    }
    return s;
}

/* The film, and images made from it: floats, bytes. */
static uint64_t film_of(const cuvette_scene *s)
{
    enum { WIDTH = 48, HEIGHT = 36 };
    static float rgb[3 * WIDTH * HEIGHT];
    static unsigned char srgb[sizeof rgb / sizeof *rgb];
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_frame *frame;
    cuvette_counters counters = {.size = sizeof counters};
    cuvette_request request = CUVETTE_REQUEST;
    request.width = WIDTH, request.height = HEIGHT, request.rgb = rgb, request.srgb = srgb;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_engine_render(engine, s, &request, &frame, &why), &why);
    uint64_t hash = cuvette_frame_hash(frame);
    hash = mix(hash, rgb, sizeof rgb);
    hash = mix(hash, srgb, sizeof srgb);
    fine(cuvette_frame_rgb(frame, 0, 0, WIDTH, HEIGHT, rgb, 0, &why), &why);
    fine(cuvette_frame_srgb(frame, 0, 0, WIDTH, HEIGHT, srgb, 0, &why), &why);
    fine(cuvette_frame_counters(frame, &counters, &why), &why);
    hash = mix(hash, rgb, sizeof rgb);
    hash = mix(hash, srgb, sizeof srgb);
    hash = mix(hash, &counters, sizeof counters);
    cuvette_frame_destroy(frame);
    cuvette_engine_destroy(engine);
    return hash;
}

static uint64_t film_of_file(const char *file, const char *assignments)
{
    cuvette_scene *s = scene_of(file, assignments);
    const uint64_t hash = film_of(s);
    cuvette_scene_destroy(s);
    return hash;
}

typedef uint64_t question(void);

static uint64_t ask_whitted(void)
{
    return film_of_file("rod.yaml", "render.depth=5");
}

static uint64_t ask_path(void)
{
    return film_of_file("rod.yaml", "render.integrator=path render.samples=4 render.depth=6");
}

static uint64_t ask_spectral(void)
{
    return film_of_file("prism.yaml", "render.wavelengths=16");
}

static uint64_t ask_polarised(void)
{
    return film_of_file("plates.yaml", "render.polarisation=on");
}

static uint64_t ask_meshes(void)
{
    return film_of_file("models.yaml", "ball.level=3 render.depth=4 lamp.kind=soft_cone");
}

static uint64_t ask_slime(void)
{
    return film_of_file("slime.yaml", "toy.level=2 toy.time_s=0.2");
}

static uint64_t ask_zbuffer(void)
{
    return film_of_file("models.yaml", "ball.level=2 render.integrator=zbuffer");
}

static uint64_t ask_absorption(void)
{
    return film_of_file("absorber.yaml", "render.samples=4");
}

static bool mix_parameter(void *context, const cuvette_parameter *one)
{
    uint64_t *hash = context;
    *hash = mix_text(mix_text(*hash, one->path), one->value);
    return true;
}

static void mix_note(void *context, const char *text)
{
    uint64_t *hash = context;
    *hash = mix_text(*hash, text);
}

/* Decimal numbers that are not doubles, parsed and formatted; rotations, which need sines. */
static uint64_t ask_numbers(void)
{
    static const char text[] =
        "render: {width: 48, height: 36}\n"
        "camera: {position: [0.1, 1.7, -5.3], fov_deg: 41.7}\n"
        "materials: {g: {transparency: 0.3, medium: water, absorb_per_m: [1e-310, 0.1, 4.9e-324]}}\n"
        "lights: {lamp: {position: [0.7, 6.1, -4.3], intensity: 0.9}}\n"
        "solids: {ball: {shape: sphere, material: g, radius: 0.7, position: [0.1, 0.2, 0.3],\n"
        "                rotation: [10.1, 20.2, 30.3]},\n"
        "         mote: {shape: sphere, radius: 0.01, position: [3e-310, 2, 0]}}\n";
    static char written[65536];
    static const double third[] = {1.0 / 3.0, 2.0 / 3.0, 0.1}, degrees[] = {10.7, -33.3, 71.1};
    static const double subnormal[] = {1e-310, 0, 5e-324}; /* values that flushing makes 0 */
    static const float pixels[] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.0f, 0.15f, 0.25f};
    static const float corners[] = {-0.3f, 0.1f, 0.2f, 0.9f, 0.3f, -0.1f, 0.1f, 1.1f, 0.7f};
    static const uint32_t triangle[] = {0, 1, 2};
    cuvette_diagnostic why;
    cuvette_scene *s;
    double number, three[3];
    size_t length;
    uint64_t hash = 0;
    fine(cuvette_scene_read_text("text.yaml", text, strlen(text), &s, &why), &why);
    fine(cuvette_scene_get_double(s, "camera.fov_deg", &number, &why), &why);
    hash = mix(hash, &number, sizeof number);
    turn(s, "ball.radius", "0.123456789012345678901234567890123456789");
    fine(cuvette_scene_set_double(s, "ball.position.x", third[0], &why), &why);
    fine(cuvette_scene_set_vector(s, "lamp.position", third, 3, &why), &why);
    fine(cuvette_scene_turn(s, "ball", degrees, &why), &why);
    fine(cuvette_scene_turn(s, "camera", degrees, &why), &why);
    fine(cuvette_scene_move(s, "ball", third, &why), &why);
    fine(cuvette_scene_move(s, "mote", subnormal, &why), &why);
    fine(cuvette_scene_look_at(s, third, &why), &why);
    fine(cuvette_scene_get_vector(s, "camera.position", three, 3, &length, &why), &why);
    hash = mix(hash, three, sizeof three);
    fine(cuvette_scene_hints(s, mix_note, &hash, &why), &why);
    fine(cuvette_scene_each_parameter(s, mix_parameter, &hash, &why), &why);
    fine(cuvette_scene_write_text(s, written, sizeof written, &length, &why), &why);
    hash = mix_text(hash, written);
    fine(cuvette_scene_add_pixels(s, "tiles", 2, 2, pixels, &why), &why);
    const cuvette_triangles one = {.size = sizeof one,
                                   .vertex_count = 3,
                                   .triangle_count = 1,
                                   .vertices_float = corners,
                                   .corners = triangle,
                                   .normals_float = corners,
                                   .uvs_float = corners};
    fine(cuvette_scene_add_triangles(s, "shard", &one, &why), &why);
    fine(cuvette_scene_add_solid(s, "splinter", "mesh", NULL, &why), &why);
    turn(s, "splinter.mesh", "shard");
    turn(s, "splinter.texture", "tiles");
    hash = mix(hash, &(uint64_t){film_of(s)}, sizeof hash);
    cuvette_scene_destroy(s);
    return hash;
}

/* Camera rays, and their continuations after the first hit. */
static uint64_t ask_rays(void)
{
    enum { SIDE = 12, RAYS = SIDE * SIDE };
    static const double columns[SIDE] = {0.5, 4.3, 8.9, 12.1, 16.7, 20.2, 24.6, 28.4, 32.8, 36.1, 40.7, 47.9},
                        inside[] = {0.1, 0.7, 0.2};
    static cuvette_ray rays[RAYS];
    static cuvette_hit hits[RAYS];
    static unsigned char blocked[RAYS];
    cuvette_diagnostic why;
    cuvette_query *query;
    cuvette_scene *s = scene_of("rod.yaml", "liquid.medium=water");
    int32_t medium;
    fine(cuvette_query_create(s, NULL, &query, &why), &why);
    for (size_t i = 0; i < RAYS; i++)
        fine(cuvette_query_camera_ray(query, columns[i % SIDE], columns[i / SIDE], &rays[i], &why), &why);
    uint64_t hash = mix(0, rays, sizeof rays);
    for (int depth = 0; depth < 3; depth++) {
        memset(hits, 0, sizeof hits);
        fine(cuvette_query_nearest(query, rays, RAYS, hits, &why), &why);
        fine(cuvette_query_occluded(query, rays, RAYS, blocked, &why), &why);
        hash = mix(mix(hash, hits, sizeof hits), blocked, sizeof blocked);
        for (size_t i = 0; i < RAYS; i++)
            if (hits[i].solid != CUVETTE_OUTSIDE) {
                memcpy(rays[i].origin, hits[i].point, sizeof rays[i].origin);
                rays[i].start = hits[i].transmitted;
            }
    }
    fine(cuvette_query_medium(query, inside, &medium, &why), &why);
    cuvette_query_destroy(query);
    cuvette_scene_destroy(s);
    return mix(hash, &medium, sizeof medium);
}

static uint64_t ask_motion(void)
{
    static const double by[] = {-0.3, 0.1, 0.05};
    cuvette_diagnostic why;
    cuvette_motion *m;
    cuvette_ray ray = {.origin = {0.1, 1.3, -5.1}, .direction = {-0.01, -0.03, 1.0}};
    cuvette_slime body;
    memset(&body, 0, sizeof body);
    body.size = sizeof body;
    int hand;
    double where[3], distance;
    cuvette_scene *s = scene_of("slime.yaml", "toy.level=2");
    fine(cuvette_motion_create(s, &m, &why), &why);
    fine(cuvette_motion_advance(m, 0.05, &why), &why);
    fine(cuvette_motion_pick(m, "body", &ray, where, &distance, &why), &why);
    fine(cuvette_motion_grab(m, "body", &ray, 0.4, &hand, where, &why), &why);
    fine(cuvette_motion_move(m, hand, by, &why), &why);
    fine(cuvette_motion_advance(m, 0.1, &why), &why);
    fine(cuvette_motion_release(m, hand, &why), &why);
    fine(cuvette_motion_advance(m, 0.12, &why), &why);
    fine(cuvette_motion_state(m, "toy", &body, &why), &why);
    uint64_t hash = mix(0, where, sizeof where);
    hash = mix(mix(hash, &distance, sizeof distance), &body, sizeof body);
    hash = mix(hash, &(uint64_t){film_of(s)}, sizeof hash);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
    return hash;
}

/* --- one result in every environment --- */

static void expect_one_answer(question *ask)
{
    fesetenv(FE_DFL_ENV);
    const uint64_t expected = ask();
    for (size_t i = 0; i < SURROUNDINGS; i++) {
        const surroundings now = surroundings_at(i);
        set_surroundings(&now);
        const noticed before = notice();
        const uint64_t answer = ask();
        expect_unchanged(&before);
        if (answer != expected)
            fail_msg("rounding %x, MXCSR bits %x, narrow %d, traps %x: %016llx, not %016llx", (unsigned)now.rounding,
                     now.flushing, now.narrow, (unsigned)now.traps, (unsigned long long)answer,
                     (unsigned long long)expected);
    }
}

#define ONE_ANSWER(name, ask)      \
    static void name(void **state) \
    {                              \
        (void)state;               \
        expect_one_answer(ask);    \
    }
ONE_ANSWER(ray_trees_are_the_same_in_every_environment, ask_whitted)
ONE_ANSWER(random_paths_are_the_same_in_every_environment, ask_path)
ONE_ANSWER(spectral_films_are_the_same_in_every_environment, ask_spectral)
ONE_ANSWER(polarised_films_are_the_same_in_every_environment, ask_polarised)
ONE_ANSWER(absorption_is_the_same_in_every_environment, ask_absorption)
ONE_ANSWER(meshes_and_textures_are_the_same_in_every_environment, ask_meshes)
ONE_ANSWER(a_slime_at_a_time_is_the_same_in_every_environment, ask_slime)
ONE_ANSWER(rasterised_films_are_the_same_in_every_environment, ask_zbuffer)
ONE_ANSWER(parsed_and_formatted_numbers_are_the_same_in_every_environment, ask_numbers)
ONE_ANSWER(query_rays_are_the_same_in_every_environment, ask_rays)
ONE_ANSWER(motions_are_the_same_in_every_environment, ask_motion)

/* The hash that tests/render/frame/test_determinism.c checks and `cuvette render` prints. */
static void the_reference_film_is_the_same_in_a_changed_environment(void **state)
{
    (void)state;
    char line[64] = "";
    FILE *file = fopen("tests/golden/rod-hash.txt", "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    fclose(file);
    const surroundings now = {FE_UPWARD, X86_FTZ | X86_DAZ, true, 0};
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_frame *frame;
    set_surroundings(&now);
    cuvette_scene *s = scene_of("rod.yaml", "render.width=160 render.height=120 render.depth=4");
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    fesetenv(FE_DFL_ENV);
    assert_true(cuvette_frame_hash(frame) == strtoull(line, NULL, 16));
    cuvette_frame_destroy(frame);
    cuvette_engine_destroy(engine);
    cuvette_scene_destroy(s);
}

/* --- the caller's functions, and early returns --- */

typedef struct listener {
    noticed expected;
    int calls, wrong;
    bool cancels, changes;
} listener;

static void hear(listener *l)
{
    const noticed now = notice();
    l->wrong += memcmp(&now, &l->expected, sizeof now) != 0;
    l->calls++;
}

static bool hear_progress(void *context, double share)
{
    listener *l = context;
    (void)share;
    hear(l);
    if (l->changes) {
        fesetround(FE_DOWNWARD);
        feraiseexcept(FE_DIVBYZERO);
        l->expected = notice();
    }
    return !l->cancels;
}

static void hear_tile(void *context, const cuvette_tile *tile)
{
    (void)tile;
    hear(context);
}

static bool hear_parameter(void *context, const cuvette_parameter *one)
{
    (void)one;
    hear(context);
    return true;
}

static void hear_note(void *context, const char *text)
{
    (void)text;
    hear(context);
}

static cuvette_status render_with(cuvette_engine *engine, const cuvette_scene *s, listener *l)
{
    static float rgb[3 * 48 * 36];
    cuvette_frame *frame;
    cuvette_request request = CUVETTE_REQUEST;
    request.width = 48, request.height = 36, request.rgb = rgb, request.preview = 4;
    request.progress = hear_progress, request.tile = hear_tile, request.context = l;
    const cuvette_status code = cuvette_engine_render(engine, s, &request, &frame, NULL);
    cuvette_frame_destroy(frame);
    return code;
}

static void callbacks_run_in_the_callers_environment(void **state)
{
    (void)state;
    const surroundings now = {FE_UPWARD, X86_FTZ, false, 0};
    cuvette_diagnostic why;
    cuvette_engine *engine;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    cuvette_scene *s = scene_of("rod.yaml", "lamp.intensity=0");
    for (int changes = 0; changes < 2; changes++) {
        set_surroundings(&now);
        listener l = {.expected = notice(), .changes = changes};
        const cuvette_status code = render_with(engine, s, &l);
        fine(cuvette_scene_each_parameter(s, hear_parameter, &l, &why), &why);
        fine(cuvette_scene_hints(s, hear_note, &l, &why), &why);
        expect_unchanged(&l.expected); /* the caller's changes remain */
        assert_int_equal(code, CUVETTE_OK);
        assert_int_equal(l.wrong, 0);
        assert_true(l.calls > 50);
    }
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

static void the_callers_environment_is_restored_after_errors_and_cancellation(void **state)
{
    (void)state;
    const surroundings now = {FE_TOWARDZERO, X86_DAZ, true, 0};
    static const char slip[] = "solids:\n  ball: {shape: sphere, raduis: 0.1}\n";
    const cuvette_ray nowhere = {.origin = {0, 0, 0}};
    cuvette_engine *engine;
    cuvette_scene *none;
    cuvette_query *query;
    cuvette_hit hit;
    cuvette_diagnostic why;
    cuvette_scene *s = scene_of("rod.yaml", "");
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_query_create(s, NULL, &query, &why), &why);
    set_surroundings(&now);
    listener l = {.expected = notice(), .cancels = true};
    const cuvette_status cancelled = render_with(engine, s, &l);
    const cuvette_status wrong[] = {cuvette_engine_render(engine, NULL, NULL, NULL, NULL),
                                    cuvette_scene_read("no/such.yaml", &none, NULL),
                                    cuvette_scene_read_text("slip.yaml", slip, strlen(slip), &none, NULL),
                                    cuvette_scene_set(s, "camera.fov_deg", "0.1.2", NULL),
                                    cuvette_query_nearest(query, &nowhere, 1, &hit, NULL),
                                    cuvette_scene_move(s, "nobody", nowhere.origin, NULL)};
    expect_unchanged(&l.expected);
    assert_int_equal(cancelled, CUVETTE_CANCELLED);
    for (size_t i = 0; i < COUNT(wrong); i++)
        assert_int_equal(wrong[i], CUVETTE_BAD_INPUT);
    cuvette_query_destroy(query);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

/* --- threads, whoever starts them --- */

typedef struct roll {
    pthread_barrier_t all_there;
    noticed seen[4];
} roll;

static void sign_in_team(void *context, size_t index, int member)
{
    roll *r = context;
    (void)index;
    pthread_barrier_wait(&r->all_there); /* no member runs two */
    r->seen[member] = notice();
}

static void sign_in_pool(void *context, int worker)
{
    roll *r = context;
    r->seen[worker] = notice();
}

static void threads_start_in_the_default_environment(void **state)
{
    (void)state;
    enum { THREADS = 4 };
    const surroundings now = {FE_UPWARD, X86_FTZ | X86_DAZ, true, 0};
    fesetenv(FE_DFL_ENV);
    const noticed expected = notice();
    roll r;
    for (int kind = 0; kind < 3; kind++) {
        memset(&r, 0xff, sizeof r);
        pthread_barrier_init(&r.all_there, NULL, THREADS);
        set_surroundings(&now);
        thread_team *t = kind == 0 ? thread_team_create(THREADS) : NULL;
        worker_pool *p = kind == 0 ? NULL : worker_pool_create(0);
        if (t)
            thread_team_run(t, sign_in_team, &r, THREADS);
        else
            worker_pool_run(p, THREADS, kind == 1, sign_in_pool, NULL, 0.1, &r, NULL);
        thread_team_destroy(t);
        worker_pool_destroy(p);
        fesetenv(FE_DFL_ENV);
        pthread_barrier_destroy(&r.all_there);
        for (int i = kind == 0 ? 1 : 0; i < THREADS; i++) /* member 0 of a team is the caller */
            assert_memory_equal(&r.seen[i], &expected, sizeof expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ray_trees_are_the_same_in_every_environment),
        cmocka_unit_test(random_paths_are_the_same_in_every_environment),
        cmocka_unit_test(spectral_films_are_the_same_in_every_environment),
        cmocka_unit_test(polarised_films_are_the_same_in_every_environment),
        cmocka_unit_test(absorption_is_the_same_in_every_environment),
        cmocka_unit_test(meshes_and_textures_are_the_same_in_every_environment),
        cmocka_unit_test(a_slime_at_a_time_is_the_same_in_every_environment),
        cmocka_unit_test(rasterised_films_are_the_same_in_every_environment),
        cmocka_unit_test(parsed_and_formatted_numbers_are_the_same_in_every_environment),
        cmocka_unit_test(query_rays_are_the_same_in_every_environment),
        cmocka_unit_test(motions_are_the_same_in_every_environment),
        cmocka_unit_test(the_reference_film_is_the_same_in_a_changed_environment),
        cmocka_unit_test(callbacks_run_in_the_callers_environment),
        cmocka_unit_test(the_callers_environment_is_restored_after_errors_and_cancellation),
        cmocka_unit_test(threads_start_in_the_default_environment),
    };
    return cmocka_run_group_tests_name("float_environment", tests, NULL, NULL);
}
