/* Tests of cuvette_query_cancel: other threads' rays, fans and beams end soon, and later calls give what they gave
 * before. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "cuvette.h"

enum { FAN_RAYS = 100000, RAYS = 200000 }; /* 10 s and more for the fan, which is then one ray tree after another */

static void fine(cuvette_status code, const cuvette_diagnostic *why)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    if (code != CUVETTE_OK)
        fail_msg("%d: %s", (int)code, cuvette_diagnostic_text(why, text, sizeof text));
}

static cuvette_query *query_of(const char *path)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    fine(cuvette_scene_read(path, &s, &why), &why);
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    cuvette_scene_destroy(s);
    return q;
}

static cuvette_fan_rule rule_of(int rays)
{
    return (cuvette_fan_rule){
        .size = sizeof(cuvette_fan_rule), .from = {-3, 1.5, 0}, .to = {3, 1.5, 0}, .rays = rays, .width = 1.5};
}

/* A call in a thread of its own. */
typedef struct work {
    cuvette_query *of;
    atomic_bool ended;
    cuvette_status code;
    bool has_reason;
} work;

static void finish(work *w, cuvette_status code, const cuvette_diagnostic *why)
{
    w->code = code;
    w->has_reason = code != CUVETTE_OK && *why->what;
    atomic_store(&w->ended, true);
}

static void *follow_fan(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_fan *fan = NULL;
    const cuvette_fan_rule rule = rule_of(FAN_RAYS);
    finish(w, cuvette_query_fan(w->of, &rule, &fan, &why), &why);
    cuvette_fan_destroy(fan);
    return NULL;
}

static cuvette_ray *some_rays(void)
{
    cuvette_ray *rays = calloc(RAYS, sizeof *rays);
    assert_non_null(rays);
    for (int i = 0; i < RAYS; i++)
        rays[i] = (cuvette_ray){.origin = {-3, 1.5, 0}, .direction = {1, 1e-6 * i, 0.2}, .reach = i % 2 ? 100 : 0};
    return rays;
}

/* Again and again, since one call takes only a tenth of a second. */
static void *trace_rays(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_ray *rays = some_rays();
    cuvette_hit *hits = malloc(RAYS * sizeof *hits);
    cuvette_status code = CUVETTE_OK;
    for (int i = 0; i < 1000 && hits && code == CUVETTE_OK; i++)
        code = cuvette_query_nearest(w->of, rays, RAYS, hits, &why);
    finish(w, code, &why);
    free(hits);
    free(rays);
    return NULL;
}

static void *block_rays(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_ray *rays = some_rays();
    unsigned char *blocked = malloc(RAYS);
    cuvette_status code = CUVETTE_OK;
    for (int i = 0; i < 1000 && blocked && code == CUVETTE_OK; i++)
        code = cuvette_query_occluded(w->of, rays, RAYS, blocked, &why);
    finish(w, code, &why);
    free(blocked);
    free(rays);
    return NULL;
}

/* Cancels every 5 ms, since a call that has not begun is not cancelled. */
static void are_cancelled(cuvette_query *q, void *(*const calls[])(void *), size_t count)
{
    work works[4];
    pthread_t threads[4];
    for (size_t i = 0; i < count; i++) {
        works[i] = (work){.of = q};
        assert_int_equal(pthread_create(&threads[i], NULL, calls[i], &works[i]), 0);
    }
    for (size_t i = 0; i < count;) {
        usleep(5000);
        cuvette_query_cancel(q);
        i += atomic_load(&works[i].ended);
    }
    for (size_t i = 0; i < count; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(works[i].code, CUVETTE_CANCELLED);
        assert_true(works[i].has_reason);
    }
}

static uint64_t hash_of_fan(const cuvette_query *q)
{
    cuvette_diagnostic why;
    cuvette_fan *fan;
    const cuvette_fan_rule rule = rule_of(50);
    fine(cuvette_query_fan(q, &rule, &fan, &why), &why);
    size_t count;
    const cuvette_fan_ray *rays = cuvette_fan_rays(fan, &count);
    assert_int_equal(count, 50);
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &rays[i].exit_direction[k], sizeof bits);
            hash = (hash ^ bits) * UINT64_C(0x100000001b3);
        }
    cuvette_fan_destroy(fan);
    return hash;
}

/* The second fan waits for the first, which the query's only probe follows. */
static void test_fans_and_those_that_wait(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml");
    cuvette_query_cancel(NULL);
    cuvette_query_cancel(q); /* nothing is in progress: no effect */
    const uint64_t before = hash_of_fan(q);
    are_cancelled(q, (void *(*const[])(void *)){follow_fan, follow_fan}, 2);
    assert_true(hash_of_fan(q) == before);
    cuvette_query_destroy(q);
}

static void test_the_first_trace_is_cancelled(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml"), *other = query_of("experiments/scenes/rod.yaml");
    are_cancelled(q, (void *(*const[])(void *)){follow_fan}, 1);
    assert_true(hash_of_fan(q) == hash_of_fan(other));
    cuvette_query_destroy(q);
    cuvette_query_destroy(other);
}

static void test_many_rays(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml");
    are_cancelled(q, (void *(*const[])(void *)){trace_rays, block_rays}, 2);
    cuvette_diagnostic why;
    cuvette_hit hit;
    const cuvette_ray ray = {.origin = {-3, 1.5, 0}, .direction = {1, 0, 0}};
    fine(cuvette_query_nearest(q, &ray, 1, &hit, &why), &why);
    assert_true(hit.solid >= 0);
    cuvette_query_destroy(q);
}

typedef struct visits {
    cuvette_query *of;
    int count, cancelled_at;
} visits;

static bool cancel_at(void *context, const cuvette_beam_ray *ray, cuvette_tree *tree)
{
    visits *v = context;
    (void)ray;
    cuvette_tree_destroy(tree);
    if (++v->count == v->cancelled_at)
        cuvette_query_cancel(v->of);
    return true;
}

static void test_beams(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_query *q = query_of("experiments/scenes/lens.yaml");
    visits all = {.of = q}, some = {.of = q, .cancelled_at = 2};
    fine(cuvette_query_each_beam_ray(q, cancel_at, &all, &why), &why);
    assert_true(all.count > 3);
    assert_int_equal(cuvette_query_each_beam_ray(q, cancel_at, &some, &why), CUVETTE_CANCELLED);
    assert_int_equal(some.count, 2);
    cuvette_query_destroy(q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fans_and_those_that_wait),
        cmocka_unit_test(test_the_first_trace_is_cancelled),
        cmocka_unit_test(test_many_rays),
        cmocka_unit_test(test_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
