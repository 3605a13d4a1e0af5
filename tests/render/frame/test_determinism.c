/* Tests that the film is bit-identical for any threads, schedules, tiles, pool and instruction sets, and so are the
 * counters. */
#include <math.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define SMALL "render.width=160 render.height=120 render.depth=4"

typedef struct fingerprint {
    uint64_t hash;
    ray_counters counters;
} fingerprint;

static fingerprint fingerprint_at(const scene *s, isa level, const render_options *options)
{
    render_result *result = render_at(s, level, options);
    const fingerprint f = {film_hash(result->img), result->counters};
    uint64_t rays = 0;
    for (int i = 0; i < result->worker_count; i++) {
        const worker_report *w = &result->workers[i];
        rays += w->camera + w->reflect + w->refract + w->shadow;
    }
    assert_int_equal(rays, ray_counters_total(&f.counters));
    render_result_destroy(result);
    return f;
}

static void expect_same(const fingerprint *a, const fingerprint *b)
{
    assert_true(a->hash == b->hash);
    assert_memory_equal(&a->counters, &b->counters, sizeof a->counters);
}

/* The reference hash: film_hash of the reference scene at 160x120, depth 4. If the film changes on purpose, take its
 * hash from build/cuvette render experiments/scenes/rod.yaml -o out.png --json --set render.width=160 --set
 * render.height=120 or from this test's message, and explain in the commit why it changed. */
static void the_film_has_the_reference_hash(void **state)
{
    (void)state;
    FILE *file = fopen("tests/golden/rod-hash.txt", "r");
    assert_non_null(file);
    char line[64] = "";
    assert_non_null(fgets(line, sizeof line, file));
    fclose(file);
    scene *s = rod_scene(SMALL);
    const fingerprint f = fingerprint_at(s, isa_best(), NULL);
    if (strtoull(line, NULL, 16) != f.hash)
        fail_msg("film_hash is %016llx", (unsigned long long)f.hash);
    scene_destroy(s);
}

static void the_film_is_the_same_for_every_instruction_set(void **state)
{
    (void)state;
    static const char *const variants[] = {
        SMALL, SMALL " render.weights=constant vessel.reflectivity=0.1 vessel.transparency=0.9 render.shadows=opaque",
        SMALL
        " render.samples=4 render.min_weight=0.01 clear.shininess=80.5 rod.rotation=5,7,-18 ground.rotation=1,2,1"};
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = rod_scene(variants[v]);
        const fingerprint expected = fingerprint_at(s, ISA_BASE, NULL);
        for (int level = ISA_BASE + 1; level <= (int)isa_best(); level++) {
            const fingerprint f = fingerprint_at(s, (isa)level, NULL);
            expect_same(&f, &expected);
        }
        scene_destroy(s);
    }
}

static void the_film_is_the_same_for_all_threads_schedules_tiles_and_pool(void **state)
{
    (void)state;
    static const int threads[] = {1, 2, 3, 7, 64}, tiles[] = {1, 8, 64};
    scene *s = rod_scene(SMALL);
    const fingerprint expected = fingerprint_at(s, isa_best(), NULL);
    renderer *r = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    for (size_t t = 0; t < COUNT(threads); t++)
        for (int rule = SCHEDULE_COLUMNS; rule <= SCHEDULE_DYNAMIC; rule++)
            for (size_t k = 0; k < COUNT(tiles); k++) {
                if (rule < SCHEDULE_TILES && k > 0)
                    continue; /* they have no tiles */
                s->render.threads = threads[t];
                s->render.schedule = rule;
                s->render.tile = tiles[k];
                s->render.pool = (t + k) % 2 == 0;
                render_result *result = NULL;
                assert_int_equal(renderer_render(r, s, NULL, &result, NULL), STATUS_OK);
                const fingerprint f = {film_hash(result->img), result->counters};
                expect_same(&f, &expected);
                render_result_destroy(result);
            }
    renderer_destroy(r);
    scene_destroy(s);
}

/* More threads than columns, rows or tiles, persistent or new. */
static void the_film_is_the_same_with_1024_threads(void **state)
{
    (void)state;
    scene *s = rod_scene(SMALL " render.tile=8");
    const fingerprint expected = fingerprint_at(s, isa_best(), NULL);
    set(s, "render.threads=1024");
    for (int rule = SCHEDULE_COLUMNS; rule <= SCHEDULE_DYNAMIC; rule++) {
        s->render.schedule = rule;
        s->render.pool = rule % 2;
        const fingerprint f = fingerprint_at(s, rule == SCHEDULE_ROWS ? ISA_BASE : isa_best(), NULL);
        expect_same(&f, &expected);
    }
    scene_destroy(s);
}

static int workers_of(const scene *s)
{
    renderer *r = NULL;
    render_result *result = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    assert_int_equal(renderer_prepare(r, s, NULL), STATUS_OK);
    assert_int_equal(renderer_render(r, s, NULL, &result, NULL), STATUS_OK);
    const int count = result->worker_count;
    for (int i = 0; i < count; i++)
        assert_true(result->workers[i].wall_s > 0);
    render_result_destroy(result);
    renderer_destroy(r);
    return count;
}

/* render.threads=auto has one worker per unit of the process: here all of them, then one of them. */
static void automatic_threads_respect_the_affinity_of_the_process(void **state)
{
    (void)state;
    scene *s = rod_scene(SMALL);
    const fingerprint expected = fingerprint_at(s, isa_best(), NULL);
    set(s, "render.threads=auto");
    for (int pool = 0; pool < 2; pool++) {
        cpu_set_t all, one;
        assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
        s->render.pool = pool;
        assert_int_equal(workers_of(s), CPU_COUNT(&all));
        assert_int_equal(scene_build_threads(&s->render), CPU_COUNT(&all));
        const fingerprint f = fingerprint_at(s, isa_best(), NULL);
        expect_same(&f, &expected);
        size_t unit = 0;
        while (!CPU_ISSET(unit, &all))
            unit++;
        CPU_ZERO(&one);
        CPU_SET(unit, &one);
        assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
        assert_int_equal(workers_of(s), 1);
        assert_int_equal(scene_build_threads(&s->render), 1);
        assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
    }
    assert_int_equal(s->render.threads, 0); /* the scene keeps the word */
    scene_destroy(s);
}

/* Additional outputs do not change the film; rays by pixel add up to all rays. */
static void additional_outputs_do_not_change_the_film(void **state)
{
    (void)state;
    scene *s = rod_scene(SMALL " render.threads=3");
    const fingerprint expected = fingerprint_at(s, isa_best(), NULL);
    const render_options options = {.pixel_rays = true, .pixel_time = true, .timeline = true};
    render_result *result = render_at(s, isa_best(), &options);
    const fingerprint f = {film_hash(result->img), result->counters};
    expect_same(&f, &expected);
    double rays = 0.0, pixels = 0.0;
    for (int i = 0; i < 160 * 120; i++) {
        assert_true(result->pixel_rays[i] >= 1.0 && result->pixel_ns[i] >= 0.0);
        rays += result->pixel_rays[i];
    }
    if (CUVETTE_COUNTERS)
        assert_true(rays == (double)ray_counters_total(&f.counters));
    for (size_t i = 0; i < result->event_count; i++) {
        const tile_event *e = &result->events[i];
        assert_true(e->begin_s <= e->end_s && (i == 0 || result->events[i - 1].begin_s <= e->begin_s));
        pixels += (double)(e->x1 - e->x0) * (e->y1 - e->y0);
    }
    assert_true(pixels == 160 * 120);
    render_result_destroy(result);
    scene_destroy(s);
}

static void counters_are_consistent(void **state)
{
    (void)state;
    need_counters();
    scene *s = rod_scene(SMALL);
    const fingerprint f = fingerprint_at(s, isa_best(), NULL);
    uint64_t by_depth = 0, hits = 0, first = 0;
    for (int d = 0; d <= COUNTERS_DEPTH_MAX; d++)
        by_depth += f.counters.by_depth[d];
    for (int i = 0; i < COUNTERS_SOLID_MAX; i++) {
        hits += f.counters.hits[i];
        first += f.counters.first_hits[i];
        assert_true(f.counters.first_hits[i] <= f.counters.hits[i]);
    }
    /* Clear solids do not block light: shadow rays are not tested against them. */
    const uint64_t all = ray_counters_total(&f.counters), nearest = by_depth;
    assert_int_equal(f.counters.tests[scene_find_solid(s, "ground")], all);
    assert_int_equal(f.counters.tests[scene_find_solid(s, "rod")], all);
    assert_int_equal(f.counters.tests[scene_find_solid(s, "vessel")], nearest);
    assert_int_equal(f.counters.tests[scene_find_solid(s, "liquid")], nearest);
    assert_int_equal(f.counters.tests[s->solid_count], 0);
    assert_int_equal(f.counters.camera, 160 * 120);
    assert_int_equal(f.counters.by_depth[0], f.counters.camera);
    assert_int_equal(by_depth, f.counters.camera + f.counters.reflect + f.counters.refract);
    assert_int_equal(f.counters.by_depth[5], 0);
    assert_true(first < f.counters.camera && first > f.counters.camera / 2 && hits < by_depth);
    assert_true(f.counters.cut_depth > 0 && f.counters.cut_weight == 0);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_film_has_the_reference_hash),
        cmocka_unit_test(the_film_is_the_same_for_every_instruction_set),
        cmocka_unit_test(the_film_is_the_same_for_all_threads_schedules_tiles_and_pool),
        cmocka_unit_test(the_film_is_the_same_with_1024_threads),
        cmocka_unit_test(automatic_threads_respect_the_affinity_of_the_process),
        cmocka_unit_test(additional_outputs_do_not_change_the_film),
        cmocka_unit_test(counters_are_consistent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
