/* Tests of the hand-out of tiles to ranks: each is given once, and a simulated cluster is kept busy to the end. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/random.h"
#include "mpi/messenger.h"

enum { RANKS_MOST = 64 };

static handout *begin(int64_t tiles, int ranks)
{
    handout *h = NULL;
    assert_int_equal(handout_create(tiles, ranks, &h, NULL), STATUS_OK);
    return h;
}

static void tiles_are_given_in_order_and_only_once(void **state)
{
    (void)state;
    handout *h = begin(1000, 3);
    int32_t tiles[HANDOUT_MOST];
    int64_t expected = 0;
    double now_s = 0.0;
    for (int rank = 0; rank < 3; rank++)
        handout_join(h, rank, rank + 1, now_s);
    while (!handout_is_complete(h))
        for (int rank = 0; rank < 3; rank++) {
            const int count = handout_assign(h, rank, tiles);
            assert_int_equal(handout_held(h, rank), count);
            for (int i = 0; i < count; i++) {
                assert_int_equal(tiles[i], expected++);
                assert_true(handout_return(h, rank, tiles[i], now_s += 0.001));
            }
        }
    assert_int_equal(expected, 1000);
    assert_true(handout_is_empty(h));
    assert_true(handout_fraction(h) == 1.0);
    handout_destroy(h);
}

static void a_tile_is_taken_back_only_from_the_rank_that_holds_it(void **state)
{
    (void)state;
    handout *h = begin(10, 2);
    int32_t tiles[HANDOUT_MOST];
    handout_join(h, 0, 1, 0.0);
    handout_join(h, 1, 1, 0.0);
    assert_true(handout_assign(h, 0, tiles) > 0);
    assert_false(handout_return(h, 1, tiles[0], 1.0)); /* another rank's */
    assert_false(handout_return(h, 0, 9, 1.0));        /* not given yet */
    assert_false(handout_return(h, 0, 10, 1.0));       /* no tile */
    assert_false(handout_return(h, 0, -1, 1.0));
    assert_true(handout_return(h, 0, tiles[0], 1.0));
    assert_false(handout_return(h, 0, tiles[0], 1.0)); /* for the second time */
    handout_destroy(h);
}

static void a_rank_that_has_not_joined_gets_nothing(void **state)
{
    (void)state;
    handout *h = begin(4, 2);
    int32_t tiles[HANDOUT_MOST];
    assert_int_equal(handout_assign(h, 1, tiles), 0);
    handout_join(h, 1, 2, 0.0);
    assert_true(handout_assign(h, 1, tiles) > 0);
    handout_destroy(h);
}

/* A cluster whose ranks trace one tile at a time. */
typedef struct cluster {
    int32_t queue[RANKS_MOST][2 * HANDOUT_MOST];
    int count[RANKS_MOST];
    double free_s[RANKS_MOST], latency_s;
    int ranks;
} cluster;

static void fetch(cluster *c, handout *h, int rank, double now_s)
{
    int32_t tiles[HANDOUT_MOST];
    const int given = handout_assign(h, rank, tiles);
    if (c->count[rank] == 0 && given > 0)
        c->free_s[rank] = fmax(c->free_s[rank], now_s + c->latency_s);
    for (int i = 0; i < given; i++)
        c->queue[rank][c->count[rank]++] = tiles[i];
}

/* The time that `tiles` tiles take, each as long as cost says. */
static double run(int64_t tiles, int ranks, double latency_s, double (*cost)(int64_t tile))
{
    static cluster c;
    c = (cluster){.ranks = ranks, .latency_s = latency_s};
    handout *h = begin(tiles, ranks);
    double last_s = 0.0;
    for (int rank = 0; rank < ranks; rank++)
        handout_join(h, rank, 1, 0.0);
    for (int rank = 0; rank < ranks; rank++)
        fetch(&c, h, rank, 0.0);
    while (!handout_is_complete(h)) {
        int next = -1; /* the rank whose tile ends first */
        for (int rank = 0; rank < ranks; rank++)
            if (c.count[rank] > 0 &&
                (next < 0 || c.free_s[rank] + cost(c.queue[rank][0]) < c.free_s[next] + cost(c.queue[next][0])))
                next = rank;
        assert_true(next >= 0);
        const int32_t tile = c.queue[next][0];
        last_s = c.free_s[next] += cost(tile);
        for (int i = 1; i < c.count[next]; i++)
            c.queue[next][i - 1] = c.queue[next][i];
        c.count[next]--;
        assert_true(handout_return(h, next, tile, last_s));
        fetch(&c, h, next, last_s);
    }
    handout_destroy(h);
    return last_s;
}

static double slow(int64_t tile)
{
    return 0.5 + random_unit(random_at(1, (uint32_t)tile, 0, 0, 0).word[0]);
}
static double quick(int64_t tile)
{
    return 0.001 * slow(tile);
}
static double rare(int64_t tile)
{
    return random_at(2, (uint32_t)tile, 0, 0, 0).word[0] % 50 == 0 ? 1.0 : 0.01;
}

static double sum(int64_t tiles, double (*cost)(int64_t tile))
{
    double all_s = 0.0;
    for (int64_t i = 0; i < tiles; i++)
        all_s += cost(i);
    return all_s;
}

/* List scheduling takes at most the mean and one tile more (Graham, "Bounds for certain multiprocessing anomalies",
 * 1966); tiles held in advance may add one more. */
static void slow_tiles_do_not_wait_behind_others_at_the_end(void **state)
{
    (void)state;
    for (int ranks = 1; ranks <= RANKS_MOST; ranks *= 4) {
        assert_true(run(2000, ranks, 1e-4, slow) < sum(2000, slow) / ranks * 1.001 + 1.5 + 1.5);
        assert_true(run(2000, ranks, 1e-4, rare) < sum(2000, rare) / ranks * 1.001 + 1.0 + 1.0);
    }
}

/* With tiles of 1 ms and answers after 1 ms, a rank without tiles in advance would be idle half of the time. */
static void quick_tiles_are_held_in_advance(void **state)
{
    (void)state;
    for (int ranks = 1; ranks <= 16; ranks *= 4)
        assert_true(run(4000, ranks, 1e-3, quick) < 1.1 * sum(4000, quick) / ranks + 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_are_given_in_order_and_only_once),
        cmocka_unit_test(a_tile_is_taken_back_only_from_the_rank_that_holds_it),
        cmocka_unit_test(a_rank_that_has_not_joined_gets_nothing),
        cmocka_unit_test(slow_tiles_do_not_wait_behind_others_at_the_end),
        cmocka_unit_test(quick_tiles_are_held_in_advance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
