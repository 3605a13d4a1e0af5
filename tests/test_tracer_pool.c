/* Tests of the tracer pool: reuse, counters per frame, lending between threads. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render/frame/tracers.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

enum { WORKERS = 4 };

typedef struct stage {
    scene *s;
    plan *p;
    film *img;
    tracer_pool *set;
    tracer_target target;
    schedule pieces;
    atomic_int started; /* workers */
} stage;

static void open_stage(stage *st)
{
    *st = (stage){.s = rod_scene("render.width=64 render.height=48 render.depth=2 render.threads=4 render.tile=8")};
    assert_int_equal(plan_build(st->s, &st->p, NULL), STATUS_OK);
    assert_int_equal(film_create(64, 48, 1, FILM_RGB, &st->img, NULL), STATUS_OK);
    assert_non_null(st->set = tracer_pool_create(ISA_BASE));
    st->target = (tracer_target){.frame_plan = st->p, .img = st->img};
    schedule_start(&st->pieces, &st->s->render);
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
    const image_tile piece = {32, 24, 33, 25};
    atomic_uint_fast64_t begun = 0;
    tracer_render_tile(t, &piece, &begun);
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
    image_tile piece;
    const int worker = atomic_fetch_add(&st->started, 1);
    for (uint64_t taken = 0; schedule_next(&st->pieces, worker, taken, &piece); taken++) {
        tracer *t = tracer_pool_acquire(st->set);
        tracer_render_tile(t, &piece, &begun);
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
        cmocka_unit_test(the_tracer_returned_last_is_reused_first),
        cmocka_unit_test(counters_are_reset_for_each_frame),
        cmocka_unit_test(concurrent_workers_never_share_a_tracer),
    };
    return cmocka_run_group_tests_name("tracer_pool", tests, NULL, NULL);
}
