/* Tests of laws that hold in every scene: random scenes under changes that must not affect the image (law_pairs.h).
 * LAWS_SCENES and LAWS_SEED select how many scenes and which; `make laws` tests a million. A scene that breaks a law is
 * printed as a scene file, with as few solids as possible. */
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "law_judge.h"

typedef struct tally {
    long scenes, skipped, broken, checked, tried;
} tally;

static long number_from(const char *name, long fallback)
{
    const char *text = getenv(name);
    return text && *text ? strtol(text, NULL, 10) : fallback;
}

static void print_scene(const char *title, const law_scene *w)
{
    print_message("%s\n", title);
    const scene_text text = law_text(w);
    for (const char *line = text.at; *line;) {
        const size_t length = strcspn(line, "\n");
        print_message("  %.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

static void print_fault(judge *j, const law_pair *p, long seed, long number)
{
    const law_pair small = law_shrink(j, *p);
    print_message("law %s is broken: LAWS_SEED=%ld, scene %ld, off by %g\n", law_names[p->which], seed, number,
                  j->difference);
    print_scene("the scene:", &small.a);
    if (p->which == LAW_SCALE)
        print_message("and the same times 2^%d\n", p->exponent);
    else if (p->which != LAW_REVERSAL)
        print_scene("and changed:", &small.b);
}

/* Scene `number` of a seed, independent of the scenes before it. */
static uint64_t seed_of(long seed, law which, long number)
{
    uint64_t mixed = (uint64_t)seed * 0x9e3779b97f4a7c15u + (uint64_t)which * 0xd1342543de82ef95u + (uint64_t)number;
    return random_bits(&mixed);
}

/* Tests a law over all scenes; the first few that break it are printed. */
static tally try_law(law which, judge *j)
{
    enum { PRINTED_MAX = 3, ASKED_EVERY = 5 };
    const long scenes = number_from("LAWS_SCENES", 10000), seed = number_from("LAWS_SEED", 1);
    tally sum = {.scenes = scenes};
    for (long number = 0; number < scenes; number++) {
        law_pair p;
        verdict result = SKIPPED;
        const long rays = j->rays;
        if (law_pair_make(which, seed_of(seed, which, number), (int)(number % 9972),
                          &p) /* all kinds of settings in turn */)
            result = law_judge(j, &p);
        sum.skipped += result == SKIPPED;
        if (result == BROKEN && sum.broken++ < PRINTED_MAX)
            print_fault(j, &p, seed, number);
        if (result != HELD || number % ASKED_EVERY != 0)
            continue;
        const bool asks = which == LAW_CUT || which == LAW_SAME || which == LAW_FILL;
        sum.checked += asks || which == LAW_REVERSAL;
        sum.tried += asks ? law_was_tried(&p) : which == LAW_REVERSAL && j->rays > rays;
    }
    return sum;
}

/* Tests a law over all scenes; at most this share of them may be skipped. Of the scenes that are tested whether a ray
 * crosses the part that a law changes, at least a quarter do: 500 of 10 000 scenes. */
static void law_holds(law which, double skipped_at_most)
{
    judge j = judge_open();
    const tally sum = try_law(which, &j);
    judge_close(&j);
    print_message("law %s: %ld scenes, %ld broken, %ld skipped", law_names[which], sum.scenes, sum.broken, sum.skipped);
    if (sum.checked > 0)
        print_message("; a ray crossed the altered part in %ld of %ld scenes asked", sum.tried, sum.checked);
    if (j.rays > 0)
        print_message("; %ld rays compared, %ld not", j.rays, j.rays_left_out);
    print_message("\n");
    assert_int_equal(sum.broken, 0);
    assert_true((double)sum.skipped <= skipped_at_most * (double)sum.scenes);
    if (sum.checked > 0)
        assert_true(4 * sum.tried >= sum.checked);
    if (which == LAW_MOTION)
        assert_true((double)sum.skipped / (double)sum.scenes +
                        (double)j.rays_left_out / (double)(j.rays + j.rays_left_out) <=
                    0.2);
}

static void a_solid_that_no_ray_hits_leaves_the_film_bit_identical(void **state)
{
    (void)state;
    law_holds(LAW_UNMET, 0.01);
}

static void order_and_priorities_of_separate_solids_leave_the_film_bit_identical(void **state)
{
    (void)state;
    law_holds(LAW_ORDER, 0.01);
}

static void scaling_by_a_power_of_two_leaves_the_film_bit_identical(void **state)
{
    (void)state;
    law_holds(LAW_SCALE, 0.0);
}

static void translation_rotation_and_mirroring_preserve_radiance(void **state)
{
    (void)state;
    law_holds(LAW_MOTION, 0.2);
}

static void cutting_a_clear_solid_in_two_preserves_the_film(void **state)
{
    (void)state;
    law_holds(LAW_CUT, 0.01);
}

static void a_solid_of_the_surrounding_medium_is_invisible(void **state)
{
    (void)state;
    law_holds(LAW_SAME, 0.01);
}

static void a_reversed_path_has_the_same_throughput(void **state)
{
    (void)state;
    law_holds(LAW_REVERSAL, 0.0);
}

static void filling_a_gap_with_the_surrounding_medium_preserves_the_film(void **state)
{
    (void)state;
    law_holds(LAW_FILL, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_solid_that_no_ray_hits_leaves_the_film_bit_identical),
        cmocka_unit_test(order_and_priorities_of_separate_solids_leave_the_film_bit_identical),
        cmocka_unit_test(scaling_by_a_power_of_two_leaves_the_film_bit_identical),
        cmocka_unit_test(translation_rotation_and_mirroring_preserve_radiance),
        cmocka_unit_test(cutting_a_clear_solid_in_two_preserves_the_film),
        cmocka_unit_test(a_solid_of_the_surrounding_medium_is_invisible),
        cmocka_unit_test(a_reversed_path_has_the_same_throughput),
        cmocka_unit_test(filling_a_gap_with_the_surrounding_medium_preserves_the_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
