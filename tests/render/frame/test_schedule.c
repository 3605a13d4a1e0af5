/* Tests of the schedule: every pixel goes to exactly one worker. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render/plan/schedule.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static render_settings settings_of(schedule_rule rule, int width, int height, int tile, int workers)
{
    return (render_settings){.width = width, .height = height, .schedule = rule, .tile = tile, .threads = workers};
}

/* Marks a rect, which must be inside the image and not marked yet. */
static void mark(unsigned char *seen, int width, int height, const image_tile *s)
{
    assert_true(s->x0 >= 0 && s->x0 < s->x1 && s->x1 <= width);
    assert_true(s->y0 >= 0 && s->y0 < s->y1 && s->y1 <= height);
    for (int y = s->y0; y < s->y1; y++)
        for (int x = s->x0; x < s->x1; x++)
            assert_int_equal(seen[y * width + x]++, 0);
}

static void every_pixel_goes_to_exactly_one_worker(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {7, 5}, {64, 48}, {37, 91}, {100, 1}, {1, 100}};
    static const int tiles[] = {1, 3, 8, 64, 65536}, workers[] = {1, 2, 3, 7, 64, 1024};
    for (size_t i = 0; i < COUNT(sizes); i++)
        for (size_t k = 0; k < COUNT(tiles); k++)
            for (size_t n = 0; n < COUNT(workers); n++)
                for (int rule = SCHEDULE_COLUMNS; rule <= SCHEDULE_DYNAMIC; rule++) {
                    const int width = sizes[i][0], height = sizes[i][1];
                    render_settings settings = settings_of((schedule_rule)rule, width, height, tiles[k], workers[n]);
                    settings.tiles_per_worker = 4 * (int64_t)(k % 2);
                    unsigned char *seen = calloc((size_t)(width * height), 1);
                    schedule s;
                    image_tile rect;
                    assert_non_null(seen);
                    schedule_start(&s, &settings);
                    for (int w = 0; w < workers[n]; w++)
                        for (uint64_t taken = 0; schedule_next(&s, w, taken, &rect); taken++)
                            mark(seen, width, height, &rect);
                    for (int p = 0; p < width * height; p++)
                        assert_int_equal(seen[p], 1);
                    free(seen);
                }
}

/* As in the report: ceil(width / threads) columns each, the last block gets the rest. */
static void columns_and_rows_are_one_block_per_worker(void **state)
{
    (void)state;
    const render_settings columns = settings_of(SCHEDULE_COLUMNS, 800, 600, 32, 7),
                          rows = settings_of(SCHEDULE_ROWS, 800, 600, 32, 7);
    schedule s;
    image_tile rect;
    for (int w = 0; w < 7; w++) {
        schedule_start(&s, &columns);
        assert_true(schedule_next(&s, w, 0, &rect));
        assert_int_equal(rect.x0, 115 * w);
        assert_int_equal(rect.x1, w < 6 ? 115 * (w + 1) : 800);
        assert_true(rect.y0 == 0 && rect.y1 == 600);
        assert_false(schedule_next(&s, w, 1, &rect));
        schedule_start(&s, &rows);
        assert_true(schedule_next(&s, w, 0, &rect));
        assert_int_equal(rect.y0, 86 * w);
        assert_int_equal(rect.y1, w < 6 ? 86 * (w + 1) : 600);
        assert_true(rect.x0 == 0 && rect.x1 == 800);
        assert_false(schedule_next(&s, w, 1, &rect));
    }
}

static void workers_without_pixels_get_no_tile(void **state)
{
    (void)state;
    const render_settings settings = settings_of(SCHEDULE_COLUMNS, 10, 10, 8, 1024);
    schedule s;
    image_tile rect;
    schedule_start(&s, &settings);
    for (int w = 0; w < 1024; w++)
        assert_true(schedule_next(&s, w, 0, &rect) == (w < 10));
}

/* Tiles are assigned in turn, in reading order. */
static void static_tiles_are_assigned_round_robin(void **state)
{
    (void)state;
    const render_settings settings = settings_of(SCHEDULE_TILES, 100, 50, 32, 3);
    schedule s;
    image_tile rect;
    schedule_start(&s, &settings);
    assert_true(schedule_next(&s, 1, 0, &rect)); /* tile 1 of 4 across */
    assert_true(rect.x0 == 32 && rect.x1 == 64 && rect.y0 == 0 && rect.y1 == 32);
    assert_true(schedule_next(&s, 1, 1, &rect)); /* tile 4 */
    assert_true(rect.x0 == 0 && rect.x1 == 32 && rect.y0 == 32 && rect.y1 == 50);
    assert_true(schedule_next(&s, 1, 2, &rect)); /* tile 7 */
    assert_true(rect.x0 == 96 && rect.x1 == 100 && rect.y0 == 32 && rect.y1 == 50);
    assert_false(schedule_next(&s, 1, 3, &rect));
}

static int64_t tiles_of(int width, int height, int tile, int workers, int least)
{
    render_settings settings = settings_of(SCHEDULE_DYNAMIC, width, height, tile, workers);
    schedule s;
    settings.tiles_per_worker = least;
    schedule_start(&s, &settings);
    assert_int_equal(s.tile_count, (int64_t)((width + s.tile - 1) / s.tile) * ((height + s.tile - 1) / s.tile));
    return s.tile_count;
}

/* Tiles of 32, 16 and 8 pixels cut 800 x 600 into 475, 1900 and 7500 tiles. */
static void tiles_are_halved_for_many_workers(void **state)
{
    (void)state;
    assert_int_equal(tiles_of(800, 600, 32, 2, 4), 475);
    assert_int_equal(tiles_of(800, 600, 32, 118, 4), 475);
    assert_int_equal(tiles_of(800, 600, 32, 119, 4), 1900);
    assert_int_equal(tiles_of(800, 600, 32, 475, 4), 1900);
    assert_int_equal(tiles_of(800, 600, 32, 1024, 4), 7500);
    assert_int_equal(tiles_of(800, 600, 32, 1024, 1), 1900);
    assert_int_equal(tiles_of(800, 600, 32, 1024, 0), 475); /* 0: as render.tile says */
    assert_int_equal(tiles_of(800, 600, 65536, 1, 1), 1);
    assert_int_equal(tiles_of(800, 600, 65536, 1, 2), 4); /* 512 pixels */
    assert_int_equal(tiles_of(7, 5, 32, 1024, 4), 35);    /* no more tiles than pixels */
}

/* However late a worker starts, its first tile is waiting for it. */
static void every_worker_has_a_tile_reserved(void **state)
{
    (void)state;
    render_settings settings = settings_of(SCHEDULE_DYNAMIC, 800, 600, 32, 1024);
    settings.tiles_per_worker = 4;
    schedule s;
    image_tile rect;
    schedule_start(&s, &settings);
    uint64_t taken = 0;
    while (schedule_next(&s, 0, taken, &rect))
        taken++;
    assert_int_equal(taken, 7500 - 1023);
    for (int w = 1; w < 1024; w++) {
        assert_true(schedule_next(&s, w, 0, &rect));
        assert_true(rect.x0 == w % 100 * 8 && rect.y0 == w / 100 * 8);
        assert_false(schedule_next(&s, w, 1, &rect));
    }
}

enum { WIDTH = 301, HEIGHT = 203, ASKERS = 8 };

typedef struct asker {
    schedule *tiles;
    int worker;
    unsigned char *seen;
} asker;

/* With a correct schedule each pixel is marked by one thread only; otherwise ThreadSanitizer reports it. */
static void *ask(void *argument)
{
    const asker *a = argument;
    image_tile rect;
    for (uint64_t taken = 0; schedule_next(a->tiles, a->worker, taken, &rect); taken++)
        for (int y = rect.y0; y < rect.y1; y++)
            for (int x = rect.x0; x < rect.x1; x++)
                a->seen[y * WIDTH + x]++;
    return NULL;
}

static void concurrent_threads_share_all_tiles(void **state)
{
    (void)state;
    const render_settings settings = settings_of(SCHEDULE_DYNAMIC, WIDTH, HEIGHT, 2, ASKERS);
    static unsigned char seen[WIDTH * HEIGHT];
    schedule s;
    asker askers[ASKERS];
    pthread_t threads[ASKERS];
    schedule_start(&s, &settings);
    for (int i = 0; i < ASKERS; i++) {
        askers[i] = (asker){&s, i, seen};
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &askers[i]), 0);
    }
    for (int i = 0; i < ASKERS; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        assert_int_equal(seen[p], 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_goes_to_exactly_one_worker),
        cmocka_unit_test(columns_and_rows_are_one_block_per_worker),
        cmocka_unit_test(workers_without_pixels_get_no_tile),
        cmocka_unit_test(static_tiles_are_assigned_round_robin),
        cmocka_unit_test(tiles_are_halved_for_many_workers),
        cmocka_unit_test(every_worker_has_a_tile_reserved),
        cmocka_unit_test(concurrent_threads_share_all_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
