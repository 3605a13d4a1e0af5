/* Tests of the semaphore: never more threads inside than it has places, every thread gets in, and closing it ends all
 * waits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "web/session/tasks.h"
#include <pthread.h>
#include <sched.h>

enum { PLACES = 2, VISITORS = 8, VISITS = 500 };

typedef struct hall {
    semaphore *g;
    atomic_int in, most, visits, refused;
} hall;

static void *visit(void *of)
{
    hall *h = of;
    for (int i = 0; i < VISITS; i++) {
        diagnostic why = {.what = ""};
        if (semaphore_acquire(h->g, &why) != STATUS_OK) {
            atomic_fetch_add(&h->refused, 1);
            continue;
        }
        const int now = atomic_fetch_add(&h->in, 1) + 1;
        int most = atomic_load(&h->most);
        while (now > most && !atomic_compare_exchange_weak(&h->most, &most, now))
            continue;
        sched_yield();
        atomic_fetch_sub(&h->in, 1);
        atomic_fetch_add(&h->visits, 1);
        semaphore_release(h->g);
    }
    return NULL;
}

static void no_more_threads_enter_than_there_are_places(void **state)
{
    (void)state;
    pthread_t visitors[VISITORS];
    hall h = {.g = semaphore_create(PLACES)};
    assert_non_null(h.g);
    for (int i = 0; i < VISITORS; i++)
        assert_int_equal(pthread_create(&visitors[i], NULL, visit, &h), 0);
    for (int i = 0; i < VISITORS; i++)
        pthread_join(visitors[i], NULL);
    assert_int_equal(h.visits, VISITORS * VISITS);
    assert_in_range(h.most, 1, PLACES);
    semaphore_destroy(h.g);
}

static void a_closed_semaphore_ends_every_wait(void **state)
{
    (void)state;
    pthread_t visitors[VISITORS];
    hall h = {.g = semaphore_create(1)};
    diagnostic why = {.what = ""};
    assert_int_equal(semaphore_acquire(h.g, &why), STATUS_OK); /* held until the end */
    for (int i = 0; i < VISITORS; i++)
        assert_int_equal(pthread_create(&visitors[i], NULL, visit, &h), 0);
    semaphore_close(h.g);
    for (int i = 0; i < VISITORS; i++)
        pthread_join(visitors[i], NULL);
    assert_int_equal(h.refused, VISITORS * VISITS);
    semaphore_release(h.g);
    assert_int_equal(semaphore_acquire(h.g, &why), STATUS_INTERRUPTED);
    semaphore_destroy(h.g);
}

int main(void)
{
    const struct CMUnitTest cases[] = {
        cmocka_unit_test(no_more_threads_enter_than_there_are_places),
        cmocka_unit_test(a_closed_semaphore_ends_every_wait),
    };
    return cmocka_run_group_tests_name("lab_gate", cases, NULL, NULL);
}
