/* Tests of the worker pool: every worker runs once, persistent and new threads, the watcher. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#include "base/worker_pool.h"

enum { WORKERS_MAX = 300 };

typedef struct job {
    atomic_int runs[WORKERS_MAX];
    pthread_t thread[WORKERS_MAX]; /* the thread that ran the task */
    atomic_int total;
    int watched;
    atomic_bool go_on; /* set by the watcher */
} job;

static void note(void *context, int worker)
{
    job *j = context;
    j->thread[worker] = pthread_self();
    atomic_fetch_add(&j->runs[worker], 1);
    atomic_fetch_add(&j->total, 1);
}

static void expect_each_once(job *j, int count)
{
    for (int i = 0; i < WORKERS_MAX; i++)
        assert_int_equal(atomic_load(&j->runs[i]), i < count);
    for (int i = 0; i < count; i++)
        assert_false(pthread_equal(j->thread[i], pthread_self()));
}

static void run_once(worker_pool *p, int count, bool keep, job *j)
{
    memset(j, 0, sizeof *j);
    assert_int_equal(worker_pool_run(p, count, keep, note, NULL, 0.0, j, NULL), STATUS_OK);
    expect_each_once(j, count);
}

static void every_worker_runs_once(void **state)
{
    (void)state;
    static const int counts[] = {1, 2, 3, 7, 64, 300, 5, 1};
    static job j;
    for (int keep = 0; keep <= 1; keep++) {
        worker_pool *p = worker_pool_create(1 << 16);
        assert_non_null(p);
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++)
            run_once(p, counts[k], keep, &j);
        worker_pool_destroy(p);
    }
}

static void persistent_threads_are_reused(void **state)
{
    (void)state;
    static job first, second;
    worker_pool *p = worker_pool_create(1 << 16);
    assert_non_null(p);
    assert_int_equal(worker_pool_reserve(p, 20, NULL), STATUS_OK);
    run_once(p, 20, true, &first);
    run_once(p, 12, true, &second);
    for (int i = 0; i < 12; i++)
        assert_true(pthread_equal(first.thread[i], second.thread[i]));
    for (int i = 0; i < 20; i++)
        for (int k = 0; k < i; k++)
            assert_false(pthread_equal(first.thread[i], first.thread[k]));
    worker_pool_destroy(p);
}

static void a_pool_runs_many_tasks_in_sequence(void **state)
{
    (void)state;
    static job j;
    worker_pool *p = worker_pool_create(1 << 16);
    assert_non_null(p);
    for (int i = 0; i < 3000; i++)
        assert_int_equal(worker_pool_run(p, 1 + i % 9, true, note, NULL, 0.0, &j, NULL), STATUS_OK);
    int expected = 0;
    for (int i = 0; i < 3000; i++)
        expected += 1 + i % 9;
    assert_int_equal(atomic_load(&j.total), expected);
    worker_pool_destroy(p);
}

static void persistent_and_new_threads_may_alternate(void **state)
{
    (void)state;
    static job j;
    worker_pool *p = worker_pool_create(1 << 16);
    assert_non_null(p);
    for (int i = 0; i < 40; i++)
        run_once(p, 1 + 3 * i % 11, i % 3 != 0, &j);
    worker_pool_destroy(p);
}

static void wait_for_the_watcher(void *context, int worker)
{
    job *j = context;
    const struct timespec little = {0, 1000000};
    while (!atomic_load(&j->go_on))
        nanosleep(&little, NULL);
    note(context, worker);
}

static void watch(void *context)
{
    job *j = context;
    if (++j->watched == 2)
        atomic_store(&j->go_on, true);
}

/* The workers wait until the watcher has been called twice: it is called while they run, on the calling thread. */
static void the_progress_callback_runs_while_workers_run(void **state)
{
    (void)state;
    static job j;
    for (int keep = 0; keep <= 1; keep++) {
        worker_pool *p = worker_pool_create(1 << 16);
        assert_non_null(p);
        memset(&j, 0, sizeof j);
        assert_int_equal(worker_pool_run(p, 3, keep, wait_for_the_watcher, watch, 0.1, &j, NULL), STATUS_OK);
        expect_each_once(&j, 3);
        assert_true(j.watched >= 2);
        worker_pool_destroy(p);
    }
}

static void an_idle_pool_can_be_destroyed(void **state)
{
    (void)state;
    worker_pool_destroy(NULL);
    worker_pool *p = worker_pool_create(1 << 16);
    worker_pool_destroy(p);
    p = worker_pool_create(1 << 16);
    assert_int_equal(worker_pool_reserve(p, 50, NULL), STATUS_OK);
    assert_int_equal(worker_pool_reserve(p, 10, NULL), STATUS_OK); /* never shrinks */
    worker_pool_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_worker_runs_once),
        cmocka_unit_test(persistent_threads_are_reused),
        cmocka_unit_test(a_pool_runs_many_tasks_in_sequence),
        cmocka_unit_test(persistent_and_new_threads_may_alternate),
        cmocka_unit_test(the_progress_callback_runs_while_workers_run),
        cmocka_unit_test(an_idle_pool_can_be_destroyed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
