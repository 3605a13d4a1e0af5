/* Tests of the renderer besides its images, and of its tracer pool. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/cancel.h"
#include "render/frame/tracers.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

/* The renderer besides its images: errors by value, interruption, no state shared between two renderers. */

static status try_to_render(const scene *s, diagnostic *why)
{
    renderer *r = NULL;
    render_result *result = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    const status code = renderer_render(r, s, NULL, &result, why);
    assert_true((code == STATUS_OK) == (result != NULL));
    render_result_destroy(result);
    renderer_destroy(r);
    return code;
}

static void light_beyond_the_films_range_is_an_error(void **state)
{
    (void)state;
    diagnostic why = {0};
    scene *s = rod_scene("render.width=80 render.height=60 render.depth=1");
    assert_int_equal(scene_set(s, "lamp.intensity", "1e9", &why), STATUS_BAD_INPUT); /* the table's own range */
    s->lights[0].intensity = 1e9;
    assert_int_equal(try_to_render(s, &why), STATUS_BAD_INPUT);
    set_all(s, "lamp.intensity=10000 lamp.color=10000,1,1"); /* each is valid, but not both together */
    assert_int_equal(try_to_render(s, &why), STATUS_BAD_INPUT);
    assert_true(why.what[0] && why.remedy[0]);
    set(s, "lamp.color=20,1,1");
    assert_int_equal(try_to_render(s, &why), STATUS_OK);
    scene_destroy(s);
}

/* Contributions that are not numbers are detected; with shadow rays and without. */
static void light_that_is_not_a_number_is_an_error(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=80 render.height=60 render.depth=1 render.shadows=off");
    s->lights[0].intensity = (double)NAN;
    assert_int_equal(try_to_render(s, NULL), STATUS_BAD_INPUT);
    set(s, "render.shadows=opaque");
    assert_int_equal(try_to_render(s, NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

/* Many contributions, each in range, whose sum is not. */
static void a_sum_beyond_the_films_range_is_an_error(void **state)
{
    (void)state;
    char text[4096];
    int length = snprintf(
        text, sizeof text,
        "render: {width: 2, height: 2, depth: 0, shadows: off}\n"
        "camera: {position: [0, 3, -4], target: [0, 0, 0]}\nsolids: {ground: {shape: plane, diffuse: 1}}\nlights:\n");
    for (int i = 0; i < 12; i++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "  lamp%d: {position: [0, 9, 0], color: [10, 10, 10], intensity: 10000}\n", i);
    scene *s = scene_from(text);
    assert_int_equal(try_to_render(s, NULL), STATUS_BAD_INPUT); /* 1.2e6 */
    for (int i = 5; i < 12; i++)
        s->lights[i].intensity = 0.0;
    assert_int_equal(try_to_render(s, NULL), STATUS_OK); /* 5e5 */
    scene_destroy(s);
}

static void an_invalid_scene_is_refused(void **state)
{
    (void)state;
    diagnostic why = {0};
    scene *s = rod_scene("vessel.inner_radius=2");
    assert_int_equal(try_to_render(s, &why), STATUS_BAD_INPUT);
    assert_true(why.what[0] != '\0');
    scene_destroy(s);
}

typedef struct watch {
    int calls;
    double last;
    cancel_token token;
} watch;

static void stop_at_once(void *context, double share)
{
    watch *w = context;
    w->calls++;
    w->last = share;
    cancel_set(&w->token);
}

static void note_share(void *context, double share)
{
    watch *w = context;
    assert_true(share >= w->last && share <= 1.0);
    w->calls++;
    w->last = share;
}

/* Stops a large frame, then renders a small one, which must not be affected. */
static void stop_and_go_on(renderer *r, const scene *large, const scene *small, const render_result *undisturbed)
{
    render_result *part = NULL, *after = NULL;
    watch w = {0};
    const render_options options = {.progress = stop_at_once, .context = &w};
    const uint64_t pixels = (uint64_t)(large->render.width * large->render.height);
    cancel_begin(&w.token);
    assert_int_equal(renderer_render(r, large, &options, &part, NULL), STATUS_INTERRUPTED);
    cancel_end(&w.token);
    assert_non_null(part);
    assert_true(w.calls >= 1 && w.last < 1.0);
    assert_true(!CUVETTE_COUNTERS || (part->counters.camera > 0 && part->counters.camera < pixels));
    render_result_destroy(part);
    assert_int_equal(renderer_render(r, small, NULL, &after, NULL), STATUS_OK);
    assert_true(film_hash(after->img) == film_hash(undisturbed->img));
    assert_memory_equal(&after->counters, &undisturbed->counters, sizeof after->counters);
    render_result_destroy(after);
}

static void stop_some_frames(scene *large, scene *small, int count)
{
    render_result *undisturbed = render(small);
    renderer *r = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    for (int i = 0; i < count; i++) {
        large->render.pool = i % 2;
        stop_and_go_on(r, large, small, undisturbed);
    }
    renderer_destroy(r);
    render_result_destroy(undisturbed);
    scene_destroy(large);
    scene_destroy(small);
}

/* A frame that would take minutes ends on request; the finished part is kept, and the next frame is correct. */
static void an_interrupted_frame_ends_and_does_not_affect_the_next(void **state)
{
    (void)state;
    stop_some_frames(rod_scene("render.width=4000 render.height=3000 render.depth=16 render.threads=3"),
                     rod_scene("render.width=64 render.height=48 render.threads=3"), 2);
}

/* More workers than processors: workers that start late must not continue the work of stopped ones. */
static void stopped_workers_do_not_affect_the_next_frame(void **state)
{
    (void)state;
    stop_some_frames(rod_scene("render.width=1024 render.height=1024 render.depth=30 render.threads=64 "
                               "render.schedule=rows camera.fov_deg=25"),
                     rod_scene("render.width=64 render.height=48 render.threads=64 render.tile=4"), 4);
}

static void progress_callbacks_do_not_change_the_film(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=64 render.height=48");
    render_result *plain = render(s);
    watch w = {0};
    const render_options options = {.progress = note_share, .context = &w};
    render_result *watched = render_at(s, isa_best(), &options);
    assert_true(film_hash(plain->img) == film_hash(watched->img));
    render_result_destroy(plain);
    render_result_destroy(watched);
    scene_destroy(s);
}

typedef struct studio {
    const scene *s;
    uint64_t expected;
    int wrong;
} studio;

static void *work_in(void *argument)
{
    studio *w = argument;
    renderer *r = NULL;
    w->wrong = renderer_create(isa_best(), NULL, &r, NULL) != STATUS_OK;
    for (int i = 0; i < 10 && !w->wrong; i++) {
        render_result *result = NULL;
        w->wrong = renderer_render(r, w->s, NULL, &result, NULL) != STATUS_OK || film_hash(result->img) != w->expected;
        render_result_destroy(result);
    }
    renderer_destroy(r);
    return NULL;
}

static void two_concurrent_renderers_are_independent(void **state)
{
    (void)state;
    scene *scenes[2] = {
        rod_scene("render.width=80 render.height=60 render.threads=2"),
        rod_scene("render.width=60 render.height=80 render.depth=6 vessel.ior=1.7 render.threads=3 render.pool=off")};
    studio studios[2];
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) {
        render_result *alone = render(scenes[i]);
        studios[i] = (studio){scenes[i], film_hash(alone->img), 0};
        render_result_destroy(alone);
    }
    assert_true(studios[0].expected != studios[1].expected);
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, work_in, &studios[i]), 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_int_equal(studios[i].wrong, 0);
        scene_destroy(scenes[i]);
    }
}

/* One renderer, scenes of different depth, size, light and thread counts one after another. */
static void one_renderer_renders_different_scenes_in_sequence(void **state)
{
    (void)state;
    static const char *const settings[] = {
        "render.depth=0 render.threads=5", "render.depth=9", "render.depth=2 render.samples=4 render.threads=2",
        "render.depth=64 render.min_weight=0.001", "render.depth=1 render.width=7 render.height=3"};
    renderer *r = NULL;
    assert_int_equal(renderer_create(isa_best(), NULL, &r, NULL), STATUS_OK);
    for (int i = 0; i < 15; i++) {
        scene *s = rod_scene("render.width=40 render.height=30");
        set_all(s, settings[i * 7 % 5]);
        render_result *alone = render(s), *served = NULL;
        assert_int_equal(renderer_render(r, s, NULL, &served, NULL), STATUS_OK);
        assert_true(film_hash(alone->img) == film_hash(served->img));
        assert_memory_equal(&alone->counters, &served->counters, sizeof served->counters);
        render_result_destroy(alone);
        render_result_destroy(served);
        scene_destroy(s);
    }
    renderer_destroy(r);
}

/* The tracer pool: reuse, counters per frame, lending between threads. */

enum { WORKERS = 4 };

typedef struct stage {
    scene *s;
    plan *p;
    film *img;
    tracer_pool *set;
    tracer_target target;
    schedule tiles;
    atomic_int started; /* workers */
} stage;

static void open_stage(stage *st)
{
    *st = (stage){.s = rod_scene("render.width=64 render.height=48 render.depth=2 render.threads=4 render.tile=8")};
    assert_int_equal(plan_build(st->s, &st->p, NULL), STATUS_OK);
    assert_int_equal(film_create(64, 48, 1, FILM_RGB, &st->img, NULL), STATUS_OK);
    assert_non_null(st->set = tracer_pool_create(ISA_BASE));
    st->target = (tracer_target){.frame_plan = st->p, .img = st->img};
    schedule_start(&st->tiles, &st->s->render);
}

static void close_stage(stage *st)
{
    tracer_pool_destroy(st->set);
    film_destroy(st->img);
    plan_destroy(st->p);
    scene_destroy(st->s);
}

static void the_tracer_returned_last_is_reused_first(void **state)
{
    (void)state;
    stage st;
    open_stage(&st);
    assert_true(tracer_pool_begin(st.set, 3, &st.target));
    tracer *a = tracer_pool_acquire(st.set), *b = tracer_pool_acquire(st.set);
    assert_non_null(a);
    assert_non_null(b);
    assert_ptr_not_equal(a, b);
    tracer_pool_release(st.set, b);
    tracer_pool_release(st.set, a);
    assert_ptr_equal(tracer_pool_acquire(st.set), a);
    assert_ptr_equal(tracer_pool_acquire(st.set), b);
    tracer *c = tracer_pool_acquire(st.set);
    assert_ptr_not_equal(c, a);
    assert_ptr_not_equal(c, b);
    close_stage(&st);
}

/* One pixel. */
static void trace_a_pixel(tracer *t)
{
    const image_tile tile = {32, 24, 33, 25};
    atomic_uint_fast64_t begun = 0;
    tracer_render_tile(t, &tile, &begun);
    tracer_finish(t);
    assert_int_equal(begun, 1);
}

static void counters_are_reset_for_each_frame(void **state)
{
    (void)state;
    need_counters();
    stage st;
    open_stage(&st);
    for (int frame = 0; frame < 3; frame++) {
        ray_counters sum = {0};
        assert_true(tracer_pool_begin(st.set, 2, &st.target));
        assert_false(tracer_pool_collect(st.set, &sum));
        assert_int_equal(sum.camera, 0);
        for (int turn = 0; turn < 2; turn++) {
            tracer *t = tracer_pool_acquire(st.set);
            trace_a_pixel(t);
            assert_int_equal(tracer_counters(t)->camera, turn + 1);
            tracer_pool_release(st.set, t);
        }
        tracer *other = tracer_pool_acquire(st.set), *none = tracer_pool_acquire(st.set);
        trace_a_pixel(none);
        tracer_pool_release(st.set, none);
        tracer_pool_release(st.set, other);
        assert_false(tracer_pool_collect(st.set, &sum));
        assert_int_equal(sum.camera, 3);
    }
    close_stage(&st);
}

static void *work(void *context)
{
    stage *st = context;
    atomic_uint_fast64_t begun = 0;
    image_tile tile;
    const int worker = atomic_fetch_add(&st->started, 1);
    for (uint64_t taken = 0; schedule_next(&st->tiles, worker, taken, &tile); taken++) {
        tracer *t = tracer_pool_acquire(st->set);
        tracer_render_tile(t, &tile, &begun);
        tracer_finish(t);
        tracer_pool_release(st->set, t);
    }
    return NULL;
}

/* ThreadSanitizer reports it if two workers ever hold the same tracer. */
static void concurrent_workers_never_share_a_tracer(void **state)
{
    (void)state;
    need_counters();
    stage st;
    open_stage(&st);
    assert_true(tracer_pool_begin(st.set, WORKERS, &st.target));
    pthread_t threads[WORKERS];
    for (int i = 0; i < WORKERS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, work, &st), 0);
    for (int i = 0; i < WORKERS; i++)
        pthread_join(threads[i], NULL);
    ray_counters sum = {0};
    assert_false(tracer_pool_collect(st.set, &sum));
    assert_int_equal(sum.camera, 64 * 48);
    close_stage(&st);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_beyond_the_films_range_is_an_error),
        cmocka_unit_test(light_that_is_not_a_number_is_an_error),
        cmocka_unit_test(a_sum_beyond_the_films_range_is_an_error),
        cmocka_unit_test(an_invalid_scene_is_refused),
        cmocka_unit_test(an_interrupted_frame_ends_and_does_not_affect_the_next),
        cmocka_unit_test(stopped_workers_do_not_affect_the_next_frame),
        cmocka_unit_test(progress_callbacks_do_not_change_the_film),
        cmocka_unit_test(two_concurrent_renderers_are_independent),
        cmocka_unit_test(one_renderer_renders_different_scenes_in_sequence),
        cmocka_unit_test(the_tracer_returned_last_is_reused_first),
        cmocka_unit_test(counters_are_reset_for_each_frame),
        cmocka_unit_test(concurrent_workers_never_share_a_tracer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
