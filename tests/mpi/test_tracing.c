/* Tests of the queues between a rank's messenger and its tracing threads: tiles and tiles pass in order, and a rank
 * that lacks memory for a tile gives the frame up and says why. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "mpi/tracing.h"
#include "render/frame/renderer.h"
#include <string.h>

static tile_queues *begin(void)
{
    const render_settings settings = {.width = 64, .height = 48, .threads = 1};
    const render_settings tiled = tiles_settings(&settings, 16);
    tile_queues *t = NULL;
    schedule tiles;
    schedule_start(&tiles, &tiled);
    assert_int_equal(tile_queues_create(&tiles, 1, &t, NULL), STATUS_OK);
    return t;
}

static void tiles_come_out_as_spans_in_order(void **state)
{
    (void)state;
    tile_queues *t = begin();
    const tracing *messenger = tile_queues_tracing(t);
    const tile_source *source = tile_queues_source(t);
    image_tile at;
    messenger->assign(messenger->of, (const int32_t[]){0, 5, 11}, 3);
    messenger->end(messenger->of);
    assert_true(source->next(source->context, 0, &at));
    assert_true(at.x0 == 0 && at.y0 == 0 && at.x1 == 16 && at.y1 == 16);
    assert_true(source->next(source->context, 0, &at));
    assert_true(at.x0 == 16 && at.y0 == 16);
    assert_true(source->next(source->context, 0, &at));
    assert_true(at.x0 == 48 && at.y0 == 32 && at.x1 == 64 && at.y1 == 48);
    assert_false(source->next(source->context, 0, &at));
    tile_queues_destroy(t);
}

static void a_tile_arrives_with_its_sums_and_variances(void **state)
{
    (void)state;
    tile_queues *t = begin();
    const tracing *messenger = tile_queues_tracing(t);
    const tile_source *source = tile_queues_source(t);
    int64_t sums[6] = {1, 2, 3, 4, 5, 6};
    const double variance[6] = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5};
    const film traced = {.sum = sums};
    assert_null(messenger->pop(messenger->of));
    source->done(source->context, &(image_tile){.x0 = 32, .x1 = 34, .y0 = 16, .y1 = 17}, &traced, variance);
    tile_message *tile = messenger->pop(messenger->of);
    assert_non_null(tile);
    assert_int_equal(tile->head.value, 6);
    assert_int_equal(tile->bytes, sizeof tile->head + sizeof sums + sizeof variance);
    assert_memory_equal(tile->values, sums, sizeof sums);
    assert_memory_equal(tile->values + 6, variance, sizeof variance);
    assert_null(messenger->pop(messenger->of));
    assert_false(messenger->is_done(messenger->of)); /* the renderer may go on */
    tile_queues_close(t);
    assert_true(messenger->is_done(messenger->of));
    free(tile);
    tile_queues_destroy(t);
}

/* More bytes than any machine has: malloc itself refuses. */
static void a_tile_without_memory_gives_the_frame_up(void **state)
{
    (void)state;
    tile_queues *t = begin();
    const tracing *messenger = tile_queues_tracing(t);
    const tile_source *source = tile_queues_source(t);
    const film nothing = {0};
    diagnostic why = {0};
    image_tile at;
    messenger->assign(messenger->of, (const int32_t[]){0, 1}, 2);
    assert_int_equal(tile_queues_status(t, STATUS_OK, &why), STATUS_OK);
    source->done(source->context, &(image_tile){.x1 = 1 << 30, .y1 = 1 << 28}, &nothing, NULL);
    assert_true(cancel_is_set(tile_queues_token(t)));
    assert_false(source->next(source->context, 0, &at)); /* though tiles wait */
    assert_null(messenger->pop(messenger->of));
    assert_int_equal(tile_queues_status(t, STATUS_OK, &why), STATUS_FAILURE);
    assert_non_null(strstr(why.what, "memory"));
    tile_queues_destroy(t);
}

static void a_frame_that_is_given_up_hands_out_no_tiles(void **state)
{
    (void)state;
    tile_queues *t = begin();
    const tracing *messenger = tile_queues_tracing(t);
    const tile_source *source = tile_queues_source(t);
    diagnostic why = {0};
    image_tile at;
    messenger->assign(messenger->of, (const int32_t[]){0, 1}, 2);
    messenger->stop(messenger->of);
    assert_true(cancel_is_set(tile_queues_token(t)));
    assert_false(source->next(source->context, 0, &at));
    assert_int_equal(tile_queues_status(t, STATUS_INTERRUPTED, &why), STATUS_INTERRUPTED);
    tile_queues_destroy(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_come_out_as_spans_in_order),
        cmocka_unit_test(a_tile_arrives_with_its_sums_and_variances),
        cmocka_unit_test(a_tile_without_memory_gives_the_frame_up),
        cmocka_unit_test(a_frame_that_is_given_up_hands_out_no_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
