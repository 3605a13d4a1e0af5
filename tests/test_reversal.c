#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_scene.h"

/* Light's way is the same there and back (Hecht, 4.5: Fermat's principle and reversibility; 4.10: Stokes's relations), and so is the
 * share of power that goes along it: R and T = n_t cos_t / (n_i cos_i) |t|^2 of an interface are the same from either side.
 * Radiance is another matter: it grows by (n_t / n_i)^2 on the way into a medium, L / n^2 stays (Nicodemus, Applied Optics 2, 1963;
 * Veach 1997, 5.2). The tracer's throughput is one of power: between an eye in a medium a and a sky in a medium b it leaves out the
 * factor (n_a / n_b)^2, which is 1 where both are of one medium. Were the factor in it, there and back would differ by its square. */

/* Curved surfaces are a billiard, where a rounding grows with every bounce (to 1e-7 after sixty), and near grazing with the square of
 * 1/cos. A reflectance next to nothing is a difference of almost equal numbers. */
static const double STEEP = 0.1;
enum { BOUNCES_MAX = 12 };
/* A point that lies beside the other turns the normal, the angles and so the reflectances: relative change of throughput a unit of length. */
static const double SWAY = 100.0;

static bool is_tame(const ray_tree *way)
{
    if (way->count > BOUNCES_MAX + 1)
        return false;
    for (size_t j = 0; j + 1 < way->count; j++) {
        const ray_hit *h = &way->node[j].hit;
        const double sine = h->n_from / h->n_to * sqrt(1.0 - h->cos_i * h->cos_i);
        if (h->cos_i < STEEP || (h->tir ? sine * sine - 1.0 < STEEP * STEEP : h->cos_t < STEEP))
            return false;
        if (way->node[j + 1].kind == RAY_REFLECT && h->R < 1e-4)
            return false;
    }
    return way->node[way->count - 1].end == RAY_END_SKY;
}

/* T of power by Hecht's eqs. 4.61, 4.32 and 4.38, the mean of both polarisations; R under a reflection. */
static double share_of(const ray_hit *h, ray_kind next)
{
    const double a = h->n_from * h->cos_i, b = h->n_to * h->cos_t;
    const double t_s = 2.0 * a / (a + b), t_p = 2.0 * a / (h->n_to * h->cos_i + h->n_from * h->cos_t);
    const double T = h->tir ? 0.0 : 0.5 * b / a * (t_s * t_s + t_p * t_p);
    return next == RAY_REFRACT ? T : 1.0 - T;
}

typedef struct tally { int ways, crossings, other_media, reflected; double farthest, unequal; } tally;

/* One way, and back from 3 units behind its last interface. */
static void there_and_back(stage *g, vec3 origin, vec3 direction, int reflect_at, tally *sum)
{
    const ray_tree *way = stage_way(g, origin, direction, reflect_at);
    const int n = (int)way->count - 1;
    if (n == 0 || !is_tame(way))
        return;
    ray_node there[BOUNCES_MAX + 1];
    memcpy(there, way->node, (size_t)(n + 1) * sizeof *there);
    const ray_node *last = &there[n];
    const vec3 end = vec3_add(last->origin, vec3_scale(last->direction, 3.0));
    const bool reflects = reflect_at >= 0 && reflect_at < n;
    way = stage_way(g, end, vec3_scale(last->direction, -1.0), reflects ? n - 1 - reflect_at : -1);
    assert_true((int)way->count > n);
    double known = 1.0, far = 0.0;
    for (int j = 0; j < n; j++) {
        const ray_hit *h = &there[j].hit, *same = &way->node[n - 1 - j].hit;
        far = fmax(far, apart(h->point, same->point));
        assert_int_equal(h->face_solid, same->face_solid);
        assert_true(there[j + 1].kind == way->node[n - j].kind);
        known *= share_of(h, there[j + 1].kind);
    }
    sum->farthest = fmax(sum->farthest, far);
    for (int c = 0; c < 3; c++) {
        /* the first stretch of either way is not part of the other; absorption between is */
        const double forth = there[n].throughput[c] / there[0].hit.transmittance[c];
        const double back = way->node[n].throughput[c] / way->node[0].hit.transmittance[c];
        sum->unequal = fmax(sum->unequal, fabs(forth / back - 1.0) - SWAY * far);
    }
    double kept = 1.0;
    for (int j = 0; j < n; j++)
        kept *= there[j].hit.transmittance[1];
    assert_true(fabs(there[n].throughput[1] / (kept * known) - 1.0) <= 1e-9);
    assert_true(apart(way->node[n].direction, vec3_scale(there[0].direction, -1.0)) <= 1e-9);
    sum->ways++;
    sum->crossings += n;
    sum->other_media += there[0].n != last->n;
    sum->reflected += reflects;
}

static tally many_ways(uint64_t seed, bool absorbing)
{
    tally sum = {0};
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int trial = 0; trial < 200; trial++) {
        const room m = random_room(&seed, false);
        const double outside = trial % 2 ? 1.0 : 1.2;
        scene_text text = scene_begin(outside, 64);
        add_room(&text, &seed, &m, outside, true, absorbing);
        stage g = stage_of(text.at, "");
        for (int k = 0; k < 20; k++) {
            const vec3 origin = random_point(&seed, k % 4 ? 3.0 : 0.8), target = random_point(&seed, 0.8);
            there_and_back(&g, origin, vec3_sub(target, origin), random_below(&seed, 12) - 4, &sum);
        }
        stage_close(&g);
    }
    return sum;
}

static void a_way_back_meets_the_same_points_with_the_same_throughput(void **state)
{
    (void)state;
    const tally sum = many_ways(1, false);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.ways > 2000 && sum.crossings > 6000 && sum.other_media > 500 && sum.reflected > 500);
}

static void media_that_absorb_take_the_same_both_ways(void **state)
{
    (void)state;
    const tally sum = many_ways(2, true);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.ways > 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_way_back_meets_the_same_points_with_the_same_throughput),
        cmocka_unit_test(media_that_absorb_take_the_same_both_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
