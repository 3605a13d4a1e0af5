/* Tests of the film and of ray queues: fixed-point sums, the hash, images, batches. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "render/plan/film.h"
#include "render/tracer/queue.h"

static film *made(int width, int height)
{
    film *f = NULL;
    assert_int_equal(film_create(width, height, 1, FILM_RGB, &f, NULL), STATUS_OK);
    return f;
}

static void a_new_film_is_black(void **state)
{
    (void)state;
    film *f = made(5, 3);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 5; x++)
            for (int c = 0; c < 3; c++)
                assert_true(film_value(f, x, y, c) == 0.0);
    film_destroy(f);
    film_destroy(NULL);
}

/* One unit is 2^-44; rows from the top, channels interleaved. */
static void sums_are_fixed_point(void **state)
{
    (void)state;
    film *f = made(5, 3);
    f->sum[(2 * 5 + 4) * 3 + 1] = 1;
    f->sum[0] = (int64_t)1 << 44;
    f->sum[3] = ((int64_t)1 << 62) + 3;
    assert_true(film_value(f, 4, 2, 1) == 0x1p-44);
    assert_true(film_value(f, 0, 0, 0) == 1.0);
    assert_true(fabs(film_value(f, 1, 0, 0) - 262144.0) < 1e-9);
    film_destroy(f);
}

/* The hash depends on every bit of every sum, on the size, and on the order. */
static void different_films_have_different_hashes(void **state)
{
    (void)state;
    film *f = made(6, 4), *same = made(6, 4), *other = made(4, 6);
    const uint64_t blank = film_hash(f);
    assert_true(blank == film_hash(same));
    assert_true(blank != film_hash(other));
    for (int i = 0; i < 6 * 4 * 3; i++)
        for (int bit = 0; bit < 64; bit += 7) {
            f->sum[i] = (int64_t)((uint64_t)1 << bit);
            assert_true(film_hash(f) != blank);
            f->sum[i] = 0;
        }
    f->sum[0] = 1, f->sum[1] = 2;
    same->sum[0] = 2, same->sum[1] = 1;
    assert_true(film_hash(f) != film_hash(same));
    film_destroy(f);
    film_destroy(same);
    film_destroy(other);
}

static void a_film_becomes_an_image(void **state)
{
    (void)state;
    film *f = made(2, 2);
    image *img = NULL;
    for (int i = 0; i < 12; i++)
        f->sum[i] = (int64_t)i << 42; /* quarters */
    assert_int_equal(film_image(f, &img, NULL), STATUS_OK);
    for (int i = 0; i < 12; i++)
        assert_true(img->pixel[i] == 0.25f * (float)i);
    image_destroy(img);
    film_destroy(f);
}

/* queue_pop removes the end of the queue, at most a batch, and leaves whole vectors in it. */
static void a_queue_is_last_in_first_out(void **state)
{
    (void)state;
    ray_queue q;
    assert_true(queue_create(&q, 3 * BATCH + LANES_MAX));
    for (int count = 1; count <= 3 * BATCH + LANES_MAX; count++) {
        for (int i = 0; i < count; i++)
            q.ox[i] = i, q.inside[i] = (uint64_t)i, q.sample_key[i] = i, q.wb[i] = -i;
        q.count = count;
        int first, left = count;
        while (left > 0) {
            const ray_batch b = queue_pop(&q, &first);
            assert_true(b.count > 0 && b.count <= BATCH && first + b.count == left && first == q.count);
            assert_int_equal(first % LANES_MAX, 0);
            assert_true(left <= BATCH ? first == 0 : b.count > BATCH - LANES_MAX);
            for (int i = 0; i < b.count; i++)
                assert_true(b.ox[i] == first + i && b.inside[i] == (uint64_t)(first + i));
            left = first;
        }
    }
    queue_move(&q, 3, 200);
    assert_true(q.ox[3] == 200.0 && q.inside[3] == 200 && q.sample_key[3] == 200 && q.wb[3] == -200.0);
    queue_destroy(&q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_film_is_black),
        cmocka_unit_test(sums_are_fixed_point),
        cmocka_unit_test(different_films_have_different_hashes),
        cmocka_unit_test(a_film_becomes_an_image),
        cmocka_unit_test(a_queue_is_last_in_first_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
