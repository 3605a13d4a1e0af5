/* The gate: no more are in it than there are places, all come through, and a closed one keeps nobody waiting. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "web/session/gate.h"
#include <pthread.h>
#include <sched.h>

enum { PLACES = 2, VISITORS = 8, VISITS = 500 };

typedef struct hall {
    gate *g;
    atomic_int in, most, visits, refused;
} hall;

static void *visit(void *of)
{
    hall *h = of;
    for (int i = 0; i < VISITS; i++) {
        diagnostic why = {.what = ""};
        if (gate_enter(h->g, &why) != STATUS_OK) {
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
        gate_leave(h->g);
    }
    return NULL;
}

static void no_more_than_there_are_places(void **state)
{
    (void)state;
    pthread_t visitors[VISITORS];
    hall h = {.g = gate_create(PLACES)};
    assert_non_null(h.g);
    for (int i = 0; i < VISITORS; i++)
        assert_int_equal(pthread_create(&visitors[i], NULL, visit, &h), 0);
    for (int i = 0; i < VISITORS; i++)
        pthread_join(visitors[i], NULL);
    assert_int_equal(h.visits, VISITORS * VISITS);
    assert_in_range(h.most, 1, PLACES);
    gate_destroy(h.g);
}

static void a_closed_gate_sends_away_who_waits(void **state)
{
    (void)state;
    pthread_t visitors[VISITORS];
    hall h = {.g = gate_create(1)};
    diagnostic why = {.what = ""};
    assert_int_equal(gate_enter(h.g, &why), STATUS_OK); /* and stays */
    for (int i = 0; i < VISITORS; i++)
        assert_int_equal(pthread_create(&visitors[i], NULL, visit, &h), 0);
    gate_close(h.g);
    for (int i = 0; i < VISITORS; i++)
        pthread_join(visitors[i], NULL);
    assert_int_equal(h.refused, VISITORS * VISITS);
    gate_leave(h.g);
    assert_int_equal(gate_enter(h.g, &why), STATUS_INTERRUPTED);
    gate_destroy(h.g);
}

int main(void)
{
    const struct CMUnitTest cases[] = {
        cmocka_unit_test(no_more_than_there_are_places),
        cmocka_unit_test(a_closed_gate_sends_away_who_waits),
    };
    return cmocka_run_group_tests_name("lab_gate", cases, NULL, NULL);
}
