/* Tests of the film, of ray queues, and of the kernels that turn light into film units. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "base/isa.h"
#include "base/random.h"
#include "render/plan/film.h"
#include "render/shade/kernels.h"
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
    queue_destroy(&q);
}

/* The kernels that turn light into film units: the arithmetic of integers, exact at the ends of a
 * contribution's range, with each instruction set and any number of rays. */

static const shade_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(shade_kernels);
static const group_kernels *const grouping[ISA_COUNT] = ISA_ARRAY(group_kernels);
static const int counts[] = {1, 2, 3, 7, 8, 9, 31, 32, 33, 63, 64, 100, ROW};
enum { COUNTS = sizeof counts / sizeof *counts };

/* A radiance and its film units, by hand: 2^44 units are 1, halves round up, and the range ends before 2^18. */
static const struct {
    double radiance;
    int64_t units; /* -1: out of range */
} known[] = {
    {0.0, 0},
    {-0.0, 0},
    {1.0, (int64_t)1 << 44},
    {0x1p-44, 1},
    {0x1p-45, 1},      /* half a unit */
    {0x1.ffffp-46, 0}, /* less than half */
    {3.0 * 0x1p-45, 2},
    {262143.0, (int64_t)262143 << 44},
    {0x1.fffffffffffffp17, ((int64_t)1 << 62) - 512},
    {262144.0, -1},
    {-0x1p-1074, -1},
    {-1.0, -1},
    {1e300, -1},
    {(double)INFINITY, -1},
    {-(double)INFINITY, -1},
    {(double)NAN, -1},
};
enum { KNOWN = sizeof known / sizeof *known };

static void arrived_light_is_exact(void **state)
{
    (void)state;
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int channel = 0; channel < 3; channel++)
            for (int k = 0; k < KNOWN; k++)
                for (int c = 0; c < COUNTS; c++) {
                    static double share[ROW], rgb[3][ROW];
                    static film_light sent;
                    const int count = counts[c], at = (count * 5 + k) % count;
                    for (int i = 0; i < count; i++)
                        share[i] = 1.0, rgb[0][i] = rgb[1][i] = rgb[2][i] = 0.25;
                    rgb[channel][at] = known[k].radiance;
                    kernels[level]->arrived(count, share, rgb[0], rgb[1], rgb[2], &sent);
                    const int64_t *units[3] = {sent.r, sent.g, sent.b}, quarter = (int64_t)1 << 42;
                    assert_int_equal(sent.out_of_range < 0, known[k].units < 0);
                    for (int i = 0; i < count; i++)
                        for (int ch = 0; ch < 3; ch++)
                            assert_int_equal(units[ch][i], i != at              ? quarter
                                                           : known[k].units < 0 ? 0 /* the whole light is left out */
                                                           : ch == channel      ? known[k].units
                                                                                : quarter);
                }
}

/* A share of 0 is a ray that did not leave the scene: whatever its other numbers are, it neither adds nor counts. */
static void rays_without_a_share_add_nothing(void **state)
{
    (void)state;
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int k = 0; k < KNOWN; k++) {
            static double share[ROW], value[ROW];
            static film_light sent;
            for (int i = 0; i < ROW; i++)
                share[i] = i % 3 ? 1.0 : 0.0, value[i] = i % 3 ? 2.0 : known[k].radiance;
            kernels[level]->arrived(ROW, share, value, value, value, &sent);
            assert_int_equal(sent.out_of_range, 0);
            for (int i = 0; i < ROW; i++)
                assert_int_equal(sent.g[i], i % 3 ? (int64_t)1 << 45 : 0);
        }
}

static double unit(uint32_t a, uint32_t b)
{
    return random_unit(random_at(11, a, b, 0, 0).word[0]);
}

/* The lanes past the last ray repeat it. */
static void fill(group *g, branch_group *b, int count)
{
    for (int i = 0; i < ROW; i++) {
        const uint32_t from = (uint32_t)(i < count ? i : count - 1);
        g->wr[i] = unit(from, 0), g->wg[i] = unit(from, 1), g->wb[i] = unit(from, 2);
        g->cr[i] = unit(from, 3), g->cg[i] = unit(from, 4), g->cb[i] = unit(from, 5);
        b->reflect[i] = from % 4 == 1 ? 0.0 : unit(from, 6);
        b->refract[i] = from % 4 < 2 ? 0.0 : unit(from, 7);
    }
    g->count = count;
    g->padded = (count + 7) / 8 * 8 < ROW ? (count + 7) / 8 * 8 : ROW;
}

/* Within one unit of the product in extended precision. */
static void expect_units(int64_t units, long double radiance)
{
    const long double apart = (long double)units - radiance * (long double)FILM_ONE;
    assert_true(apart <= 1.0L && apart >= -1.0L);
}

static void own_and_cut_light_are_products(void **state)
{
    (void)state;
    static group g;
    static branch_group b;
    static film_light own, cut;
    const vec3 radiance = vec3_make(0.5, 0.0, 0.001);
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int c = 0; c < COUNTS; c++) {
            fill(&g, &b, counts[c]);
            kernels[level]->own_light(&g, radiance, &own);
            kernels[level]->cut_light(&g, &b, radiance, &cut);
            assert_int_equal(own.out_of_range, 0);
            assert_int_equal(cut.out_of_range, 0);
            for (int i = 0; i < counts[c]; i++) {
                const long double both = (long double)b.reflect[i] + (long double)b.refract[i];
                expect_units(own.r[i], (long double)g.wr[i] * (long double)g.cr[i] * 0.5L);
                assert_int_equal(own.g[i], 0);
                expect_units(own.b[i], (long double)g.wb[i] * (long double)g.cb[i] * (long double)radiance.z);
                expect_units(cut.r[i], (long double)g.wr[i] * both * 0.5L);
                assert_int_equal(cut.g[i], 0);
                expect_units(cut.b[i], (long double)g.wb[i] * both * (long double)radiance.z);
            }
        }
}

/* One light out of range is noted wherever it is; a repeat past the last ray is not a light. */
static void light_out_of_range_is_noted(void **state)
{
    (void)state;
    static group g;
    static branch_group b;
    static film_light sent;
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int c = 0; c < COUNTS; c++)
            for (int at = 0; at < ROW; at++) {
                fill(&g, &b, counts[c]);
                g.wg[at] = 1e9;
                b.reflect[at] = g.cg[at] = 1.0;
                kernels[level]->own_light(&g, vec3_make(1.0, 1.0, 1.0), &sent);
                assert_int_equal(sent.out_of_range < 0, at < counts[c]);
                kernels[level]->cut_light(&g, &b, vec3_make(1.0, 1.0, 1.0), &sent);
                assert_int_equal(sent.out_of_range < 0, at < counts[c]);
            }
}

/* Shares are n values of a sum; by hand: 1, 2 and 6 add up to 9, their variance is 7, and that of the sum 3 x 7. */
static void the_sum_and_variance_of_shares(void **state)
{
    (void)state;
    film *f = NULL;
    double variance[3];
    assert_int_equal(film_create(1, 1, 3, FILM_RGB, &f, NULL), STATUS_OK);
    static const int values[] = {1, 2, 6};
    for (int k = 0; k < 3; k++)
        f->sum[3 * k] = (int64_t)values[k] << 44;
    assert_true(film_merge_replicates(f, variance));
    assert_true(film_value(f, 0, 0, 0) == 9.0 && film_value(f, 0, 0, 1) == 0.0);
    assert_true(fabs(variance[0] - 21.0) < 1e-12 && variance[1] == 0.0);
    film_destroy(f);
    for (int layers = 2; layers <= FILM_REPLICATES_MAX; layers++) { /* each in range, the sum is not */
        assert_int_equal(film_create(1, 1, layers, FILM_RGB, &f, NULL), STATUS_OK);
        for (int k = 0; k < layers; k++)
            f->sum[3 * k + 1] = INT64_MAX / layers + 1;
        assert_false(film_merge_replicates(f, NULL));
        film_destroy(f);
    }
}

/* --- gathering and sending out --- */

/* Every `gap`th ray is missing: 1 leaves the single one in the middle, ROW none. */
static int some_of(int count, int gap, int *list)
{
    int chosen = 0;
    for (int i = 0; i < count; i++)
        if (gap == 1 ? i == count / 2 : i % gap != gap - 1)
            list[chosen++] = i;
    return chosen;
}

static void number_queue(ray_queue *q)
{
    for (int i = 0; i < q->capacity; i++) {
        double *reals[] = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, q->wr, q->wg, q->wb};
        for (int f = 0; f < 9; f++)
            reals[f][i] = 1000.0 * f + i;
        q->start[i] = 9000 + i, q->sample_key[i] = 10000 + i, q->inside[i] = 11000 + (uint64_t)i;
    }
}

static void gathered_rays_are_those_of_the_list(void **state)
{
    (void)state;
    static group g;
    static hit_batch hits;
    static const double ior[] = {1.0, 1.33, 1.5};
    const int first = 5;
    ray_queue q;
    assert_true(queue_create(&q, first + BATCH));
    number_queue(&q);
    for (int i = 0; i < ROW; i++) {
        hits.t[i] = 0.5 + i, hits.before[i] = i % 3, hits.after[i] = (i + 1) % 3;
        hits.inside_before[i] = 3 * (uint64_t)i, hits.inside_after[i] = 5 * (uint64_t)i;
    }
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int count = 1; count <= BATCH; count++)
            for (int gap = 1; gap <= ROW; gap = gap < 8 ? gap + 1 : gap * 17) {
                int list[ROW];
                const int chosen = some_of(count, gap, list);
                if (chosen == 0)
                    continue;
                const bool ascending = count % 4 != 0; /* else two change places */
                if (!ascending && chosen > 3) {
                    const int second = list[1];
                    list[1] = list[chosen - 2], list[chosen - 2] = second;
                }
                grouping[level]->gather(&q, first, &hits, ior, list, chosen, ascending, &g);
                assert_true(g.count == chosen && g.padded >= chosen && g.padded < chosen + LANES_MAX);
                for (int k = 0; k < g.padded; k++) {
                    const int i = list[k < chosen ? k : chosen - 1], at = first + i;
                    const double *rows[] = {g.ox, g.oy, g.oz, g.dx, g.dy, g.dz, g.wr, g.wg, g.wb};
                    for (int f = 0; f < 9; f++)
                        assert_true(rows[f][k] == 1000.0 * f + at);
                    assert_true(g.start[k] == 9000 + at && g.sample_key[k] == 10000 + at && g.t[k] == 0.5 + i);
                    assert_true(g.inside_before[k] == 3 * (uint64_t)i && g.inside_after[k] == 5 * (uint64_t)i);
                    assert_true(g.n_from[k] == ior[i % 3] && g.n_to[k] == ior[(i + 1) % 3]);
                }
            }
    queue_destroy(&q);
}

/* Shadow rays of the listed lanes. */
static void append_to_lamp(const group_kernels *kernel, const group *g, const int *list, int chosen, ray_queue *q)
{
    static lit_group lit;
    for (int i = 0; i < ROW; i++) {
        lit.lx[i] = 2000 + i, lit.ly[i] = 2200 + i, lit.lz[i] = 2400 + i;
        lit.r[i] = 2600 + i, lit.g[i] = 2800 + i, lit.b[i] = 3000 + i, lit.contributes[i] = 0;
    }
    for (int k = 0; k < chosen; k++)
        lit.contributes[list[k]] = -1;
    q->count = 0;
    const new_rays n = {lit.lx, lit.ly, lit.lz,           lit.r,         lit.g,
                        lit.b,  NULL,   g->inside_before, g->sample_key, lit.contributes};
    int kept[ROW];
    assert_int_equal(kernel->append(g, &n, kept, q), chosen);
    assert_int_equal(q->count, chosen);
    for (int k = 0; k < chosen; k++) {
        const int i = list[k];
        assert_true(q->ox[k] == i && q->oy[k] == 200 + i && q->oz[k] == 400 + i && q->dx[k] == 2000 + i);
        assert_true(q->dy[k] == 2200 + i && q->dz[k] == 2400 + i && q->start[k] == 600 + i);
        assert_true(q->sample_key[k] == 1400 + i && q->inside[k] == g->inside_before[i]);
        assert_true(q->wr[k] == 2600 + i && q->wg[k] == 2800 + i && q->wb[k] == 3000 + i);
    }
}

static void appended_rays_are_those_of_the_list(void **state)
{
    (void)state;
    static group g;
    static branch_group b;
    static uint64_t inside[ROW];
    const int waiting = 3;
    ray_queue q;
    fill(&g, &b, BATCH);
    for (int i = 0; i < ROW; i++) {
        g.points.px[i] = i, g.points.py[i] = 200 + i, g.points.pz[i] = 400 + i, g.points.face[i] = 600 + i;
        b.rx[i] = 800 + i, b.ry[i] = 1000 + i, b.rz[i] = 1200 + i, g.sample_key[i] = 1400 + i;
        inside[i] = 1600 + (uint64_t)i, g.inside_before[i] = 1800 + (uint64_t)i;
    }
    assert_true(queue_create(&q, waiting + BATCH));
    for (int level = ISA_BASE; level <= (int)isa_best(); level++)
        for (int count = 1; count <= BATCH; count++)
            for (int gap = 1; gap <= ROW; gap = gap < 8 ? gap + 1 : gap * 17) {
                int list[ROW], kept[ROW];
                const int chosen = some_of(count, gap, list);
                for (int i = 0; i < ROW; i++)
                    b.reflect[i] = -0.0;
                for (int k = 0; k < chosen; k++)
                    b.reflect[list[k]] = unit((uint32_t)k, 8);
                number_queue(&q);
                q.count = waiting, g.count = count;
                const new_rays n = {b.rx, b.ry, b.rz, g.wr, g.wg, g.wb, b.reflect, inside, g.sample_key, NULL};
                assert_int_equal(grouping[level]->append(&g, &n, kept, &q), chosen);
                assert_int_equal(q.count, waiting + chosen);
                assert_memory_equal(kept, list, (size_t)chosen * sizeof *list);
                assert_true(q.ox[waiting - 1] == waiting - 1 && q.inside[waiting - 1] == 11000 + waiting - 1);
                for (int k = 0; k < chosen; k++) {
                    const int i = list[k], at = waiting + k;
                    assert_true(q.ox[at] == i && q.oy[at] == 200 + i && q.oz[at] == 400 + i && q.dx[at] == 800 + i);
                    assert_true(q.dy[at] == 1000 + i && q.dz[at] == 1200 + i && q.start[at] == 600 + i);
                    assert_true(q.sample_key[at] == 1400 + i && q.inside[at] == 1600 + (uint64_t)i);
                    assert_true(q.wr[at] == g.wr[i] * b.reflect[i] && q.wg[at] == g.wg[i] * b.reflect[i] &&
                                q.wb[at] == g.wb[i] * b.reflect[i]);
                }
                append_to_lamp(grouping[level], &g, list, chosen, &q);
            }
    queue_destroy(&q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sum_and_variance_of_shares),
        cmocka_unit_test(a_new_film_is_black),
        cmocka_unit_test(sums_are_fixed_point),
        cmocka_unit_test(different_films_have_different_hashes),
        cmocka_unit_test(a_film_becomes_an_image),
        cmocka_unit_test(a_queue_is_last_in_first_out),
        cmocka_unit_test(arrived_light_is_exact),
        cmocka_unit_test(rays_without_a_share_add_nothing),
        cmocka_unit_test(own_and_cut_light_are_products),
        cmocka_unit_test(light_out_of_range_is_noted),
        cmocka_unit_test(gathered_rays_are_those_of_the_list),
        cmocka_unit_test(appended_rays_are_those_of_the_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
