/* Tests that rays and their reversals have the same points, throughput and absorption, in random scenes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_scene.h"
#include "reversal_fixture.h"

typedef struct tally {
    int paths, crossings, other_media, reflected;
    double farthest, unequal;
} tally;

static void take(tally *sum, reversal r)
{
    if (!r.used)
        return;
    assert_true(r.same_surfaces && r.from_closed_form <= 1e-9 && r.direction <= 1e-9);
    sum->farthest = fmax(sum->farthest, r.farthest);
    sum->unequal = fmax(sum->unequal, r.unequal);
    sum->paths++;
    sum->crossings += r.crossings;
    sum->other_media += r.other_media;
    sum->reflected += r.reflected;
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
            take(&sum, there_and_back(&g, origin, vec3_sub(target, origin), random_below(&seed, 12) - 4));
        }
        stage_close(&g);
    }
    return sum;
}

static void a_reversed_path_has_the_same_points_and_throughput(void **state)
{
    (void)state;
    const tally sum = many_ways(1, false);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.paths > 2000 && sum.crossings > 6000 && sum.other_media > 500 && sum.reflected > 500);
}

static void absorption_is_equal_in_both_directions(void **state)
{
    (void)state;
    const tally sum = many_ways(2, true);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.paths > 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reversed_path_has_the_same_points_and_throughput),
        cmocka_unit_test(absorption_is_equal_in_both_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
