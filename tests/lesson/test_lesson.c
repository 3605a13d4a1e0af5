/* Lessons: those that belong to the program agree with theory at both ends of every control; a wrong lesson is refused
 * with its place and a remedy. */
#include "base/number.h"
#include "lesson/lesson.h"
#include "scene/model/params.h"
#include "whole.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static void measured_as_theory(const lesson *l, const scene *s)
{
    diagnostic why = {.what = ""};
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    if (lesson_measure(l, s, isa_best(), r, &why) != STATUS_OK)
        fail_msg("%s: %s", l->path, why.what);
    if (!r->passes)
        fail_msg("%s: error %g of the curve; %.17g, theory %.17g", l->path, r->error, r->measured, r->theory);
    assert_true(r->points.count >= (lesson_is_timed(l) ? 3 : 10));
    free(r);
}

static void measured_with(const lesson *l, const char *path, const char *value)
{
    scene *s = scene_clone(l->start);
    diagnostic why = {.what = ""};
    if (scene_set(s, path, value, &why) != STATUS_OK)
        fail_msg("%s: %s=%s: %s", l->path, path, value, why.what);
    /* A hidden rod has no curve: the laboratory says so. */
    if (strstr(path, "visible") == NULL)
        measured_as_theory(l, s);
    scene_destroy(s);
}

static void lessons_agree_with_theory(void **state)
{
    (void)state;
    lesson_list all;
    diagnostic why = {.what = ""};
    assert_int_equal(lesson_list_find("experiments/lessons", &all, &why), STATUS_OK);
    assert_true(all.count >= 8);
    for (size_t i = 0; i < all.count; i += is_whole() ? 1 : 3) {
        lesson *l = NULL;
        if (lesson_read(all.path[i], &l, &why) != STATUS_OK)
            fail_msg("%s:%ld:%ld: %s", why.file, why.line, why.column, why.what);
        measured_as_theory(l, l->start);
        assert_true(l->control_count >= 3);
        const int controls = is_whole() ? l->control_count : 1;
        for (int k = 0; k < controls && !lesson_is_timed(l); k++) {
            const lesson_control *c = &l->control[k];
            char text[NUMBER_TEXT_MAX];
            for (int j = 0; j < c->choice_count; j++)
                measured_with(l, c->parameter, c->choices[j]);
            for (int end = 0; end < 2 && !c->choice_count; end++)
                measured_with(l, c->parameter, number_format(end ? c->to : c->from, text));
        }
        lesson_destroy(l);
    }
    lesson_list_release(&all);
}

static void critical_angle_is_read_within_a_tenth_of_a_degree(void **state)
{
    (void)state;
    lesson *l = NULL;
    lesson_result *r = malloc(sizeof *r);
    diagnostic why = {.what = ""};
    assert_non_null(r);
    assert_int_equal(lesson_read("experiments/lessons/30-critical-angle.lesson", &l, &why), STATUS_OK);
    assert_int_equal(lesson_measure(l, l->start, isa_best(), r, &why), STATUS_OK);
    assert_true(fabs(r->measured - asin(1.0 / 1.333) * 180.0 / M_PI) < 1e-9);
    free(r);
    lesson_destroy(l);
}

/* Measures a lesson of the program after some settings. */
static void measure_with(const char *name, const char *const *settings, lesson_result *r)
{
    char path[128];
    lesson *l = NULL;
    diagnostic why = {.what = ""};
    snprintf(path, sizeof path, "experiments/lessons/%s.lesson", name);
    assert_int_equal(lesson_read(path, &l, &why), STATUS_OK);
    for (; *settings; settings++)
        if (scene_set_assignment(l->start, *settings, &why) != STATUS_OK)
            fail_msg("%s: %s", *settings, why.what);
    if (lesson_measure(l, l->start, isa_best(), r, &why) != STATUS_OK)
        fail_msg("%s: %s", name, why.what);
    lesson_destroy(l);
}

/* With a wall of the same index the glass of water is one cylinder: f = n R / (2 (n - 1)), Hecht, table 6.1. */
static void the_focal_length_of_a_cylinder_is_measured_over_its_index(void **state)
{
    (void)state;
    static const char *const water[] = {"liquid.ior=1.333", "vessel.ior=1.333", NULL};
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    measure_with("35-lens", water, r);
    assert_true(fabs(r->measured - 1.333 / (2.0 * 0.333)) < 1e-9);
    assert_true(r->points.count == 25 && r->points.at[0].x == 1.1 && r->points.at[24].x == 1.6);
    for (int i = 1; i < r->points.count; i++)
        assert_true(r->points.at[i].measured < r->points.at[i - 1].measured);
    free(r);
}

/* Up to the time step, of a 28th of the period. */
static void four_times_the_stiffness_halves_the_period(void **state)
{
    (void)state;
    static const char *const none[] = {NULL};
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    measure_with("95-slime", none, r);
    assert_true(r->points.at[0].x == 5.0 && r->points.at[24].x == 20.0);
    assert_true(fabs(r->points.at[24].measured / r->points.at[0].measured - 0.5) < 0.005);
    free(r);
}

/* Angles in degrees, switches as 1 and 0, precedence. */
static void formulas_have_values(void **state)
{
    (void)state;
    static const struct {
        const char *formula;
        double value;
    } known[] = {
        {"1 + 2 * 3 ^ 2 - 4 / -2", 21.0},
        {"-2 ^ 2", -4.0},
        {"sin(30) + atan(1)", 45.5},
        {"(1 < 2) + (2 > 3)", 1.0},
        {"vessel.visible", 1.0},
        {"2 ^ 3 ^ 2", 512.0},
        {"sqrt(liquid.ior ^ 2) + theory", 7.333},
        {"exp(log(pi)) / pi", 1.0},
    };
    lesson *l = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(lesson_read("experiments/lessons/30-critical-angle.lesson", &l, &why), STATUS_OK);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double value = NAN;
        if (lesson_formula(l, l->start, 6.0, known[i].formula, &value, &why) != STATUS_OK)
            fail_msg("%s: %s", known[i].formula, why.what);
        if (!(fabs(value - known[i].value) < 1e-12))
            fail_msg("%s = %.17g", known[i].formula, value);
    }
    lesson_destroy(l);
}

/* Which choice is right follows the scene: behind a film of a smaller index the thinnest film is bright. */
static void the_right_choice_follows_the_scene(void **state)
{
    (void)state;
    static const char *const none[] = {NULL}, *const dense[] = {"soap.ior=1.8", NULL};
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    measure_with("78-soap", none, r);
    assert_int_equal(r->right, 1);
    measure_with("78-soap", dense, r);
    assert_int_equal(r->right, 0);
    free(r);
}

/* Times are not compared: the machine may be busy. */
static void frames_are_timed_with_each_number_of_threads(void **state)
{
    (void)state;
    static const double threads[] = {1.0, 2.0, 3.0, 4.0, 8.0};
    static const char *const small[] = {"render.width=64", "render.height=48", "render.threads=2", NULL};
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    measure_with("97-threads", small, r);
    assert_int_equal(r->points.count, 5);
    const double units = r->points.at[4].theory;
    for (int i = 0; i < 5; i++) {
        const realism_point *p = &r->points.at[i];
        assert_true(p->x == threads[i] && p->measured > 0.0 && isfinite(p->measured));
        assert_true(p->theory == fmin(threads[i], units));
    }
    assert_true(units >= 1.0 && r->theory == fmin(2.0, units) && r->measured == r->points.at[1].measured &&
                isinf(r->tolerance) && r->passes);
    free(r);
}

/* The text of a lesson in which one line is replaced. */
static const char *const lines[] = {
    "lesson: trial",
    "title: Trial",
    "question: Why?",
    "scene: /SCENE",
    "set: {liquid.ior: 1.3}",
    "controls: [{parameter: liquid.ior, label: Index, from: 1, to: 2}, "
    "{parameter: render.depth, label: Depth, from: 1, to: 4}, "
    "{parameter: render.beyond, label: Beyond, choices: [black, sky]}]",
    "prediction: {ask: Which angle?, within: 1}",
    "measure: {curve: mirror, tolerance: 1e-9, reading: Angle, metric: critical.liquid}",
    "answer: Because.",
    "beams: {ray: {position: [0, 1, 0], direction: [1, 0, 0]}}",
    "values: {n: liquid.ior, top: liquid.position.y + liquid.height}",
    "show: {view: front, at: 0, window: [-1, 1, 0, 2], marks: [normals]}",
    "hand: {tool: ruler, ask: How far?, truth: 2 * n, within: 1, place: [0, 1, 0], to: [1, 1, 0]}",
};
enum { LINES = sizeof lines / sizeof *lines };

static status read_with(int line, const char *instead, lesson **out, diagnostic *why)
{
    char path[] = "/tmp/cuvette-lesson-XXXXXX", *here = realpath("experiments/scenes/rod.yaml", NULL);
    const int file = mkstemp(path);
    assert_true(file >= 0 && here);
    FILE *f = fdopen(file, "w");
    for (int i = 0; i < LINES; i++)
        if (i == line)
            fprintf(f, "%s\n", instead);
        else if (i == 3)
            fprintf(f, "scene: %s\n", here);
        else
            fprintf(f, "%s\n", lines[i]);
    fclose(f);
    lesson_result *r = malloc(sizeof *r);
    assert_non_null(r);
    status code = lesson_read(path, out, why);
    if (code == STATUS_OK && (code = lesson_check(*out, isa_best(), r, why)) != STATUS_OK) {
        lesson_destroy(*out);
        *out = NULL;
    }
    free(r);
    unlink(path);
    free(here);
    return code;
}

static void wrong_lessons_are_refused(void **state)
{
    (void)state;
    static const struct {
        int line;
        const char *instead, *what;
    } wrong[] = {
        {0, "lesson: a b", "invalid name"},
        {0, "lessen: trial", "unknown key 'lessen'"},
        {1, "title: []", "'title' is not a text"},
        {2, "", "'question' is missing"},
        {3, "scene: nowhere.yaml", "nowhere.yaml"},
        {4, "set: {liquid.iro: 1.3}", "no parameter 'iro'"},
        {4, "set: {liquid.ior: water}", "liquid.ior"},
        {5, "controls: []", "one to five controls"},
        {5, "controls: [{parameter: liquid.ior, label: Index, from: 2, to: 1}]", "range of liquid.ior is empty"},
        {5, "controls: [{parameter: liquid.ior, label: Index, from: 0, to: 1}]", "liquid.ior"},
        {5, "controls: [{parameter: liquid.medium, label: Medium, choices: [water, wine]}]", "wine"},
        {6, "prediction: {ask: Which?, choices: [a, b], right: c}", "none of the choices"},
        {6, "prediction: {ask: Which?, within: near}", "'within' is not a number"},
        {6, "prediction: {ask: Which?, within: 1, axis: z}", "'axis' is neither x nor y"},
        {7, "measure: {over: vessel.ior, tolerance: 1e-9, reading: Power, metric: lens.power}", "none of the controls"},
        {7, "measure: {over: [liquid.ior], tolerance: 1e-9, reading: Power, metric: lens.power}",
         "none of the controls"},
        {7, "measure: {over: render.depth, tolerance: 1e-9, reading: Power, metric: lens.power}", "render.depth"},
        {7, "measure: {over: render.beyond, tolerance: 1e-9, reading: Power, metric: lens.power}", "not a number"},
        {7, "measure: {over: liquid.ior, curve: mirror, tolerance: 1e-9, reading: P, metric: lens.power}",
         "cannot be combined"},
        {7, "measure: {over: liquid.ior, tolerance: 1e-9, reading: Power}", "value to read is missing"},
        {7, "measure: {over: liquid.ior, tolerance: 1e-9, reading: Power, metric: lens.pover}",
         "no metric 'lens.pover'"},
        {7, "measure: {over: liquid.ior, tolerance: 1e-9, reading: Period, metric: spring.period_s}", "nothing moves"},
        {7, "measure: {over: liquid.ior, tolerance: 1, reading: Speed-up, metric: speedup}", "no tolerance"},
        {7, "measure: {curve: miror, tolerance: 1e-9, reading: Angle, at: 1}", "unknown curve 'miror'"},
        {7, "measure: {curve: prism, tolerance: 1e-9, reading: Angle, at: 1}", "no solids 'prism'"},
        {7, "measure: {curve: mirror, tolerance: 1e-30, reading: Angle, at: 30}", "largest error"},
        {7, "measure: {curve: mirror, tolerance: 1e-9, reading: Angle}", "value to read is missing"},
        {7, "measure: {curve: mirror, tolerance: 1e-9, reading: Angle, metric: critical.lid}",
         "no metric 'critical.lid'"},
        {7, "measure: {curve: mirror, theory: n, tolerance: 1e-9, reading: Angle, metric: ray.turn}",
         "requires 'over'"},
        {7, "measure: {over: liquid.ior, theory: n, tolerance: 1e-9, reading: Angle, metric: rai.turn}", "no beam"},
        {9, "beams: {vessel: {position: [0, 1, 0]}}", "already in use"},
        {9, "beams: {ray: {positon: [0, 1, 0]}}", "no parameter 'positon'"},
        {10, "values: {theory: 1}", "invalid name"},
        {10, "values: {n: liquid.iro}", "no parameter 'iro'"},
        {10, "values: {n: m + 1}", "unknown name 'm'"},
        {10, "values: {n: (1 + 2}", "')' is missing"},
        {10, "values: {n: 1 2}", "unexpected '2'"},
        {10, "values: {n: tg(45)}", "unknown function 'tg'"},
        {11, "show: {view: below}", "unknown word for 'view'"},
        {11, "show: {view: top, window: [0, 0, 0, 1]}", "the window is empty"},
        {11, "show: {view: top, marks: [normal]}", "unknown mark"},
        {11, "show: {veiw: top}", "unknown key 'veiw'"},
        {12, "hand: {tool: rule, ask: How far?, truth: n, within: 1, place: [0, 1, 0]}", "unknown word for 'tool'"},
        {12, "hand: {tool: ruler, ask: How far?, truth: n, within: 1, place: [0, 1]}", "invalid 'place'"},
        {12, "hand: {tool: ruler, ask: How far?, truth: k, within: 1, place: [0, 1, 0], to: [1, 1, 0]}",
         "unknown name"},
        {12, "hand: {tool: screen, ask: How far?, truth: n, within: 1, place: [0, 1, 0]}", "'reads' is missing"},
    };
    lesson *l = NULL;
    diagnostic why = {.what = ""};
    if (read_with(-1, "", &l, &why) != STATUS_OK)
        fail_msg("%ld:%ld: %s", why.line, why.column, why.what);
    lesson_destroy(l);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        why = (diagnostic){.what = ""};
        assert_int_equal(read_with(wrong[i].line, wrong[i].instead, &l, &why), STATUS_BAD_INPUT);
        assert_null(l);
        if (!strstr(why.what, wrong[i].what))
            fail_msg("%s: %s", wrong[i].instead, why.what);
        assert_true(why.line == (wrong[i].instead[0] ? wrong[i].line + 1 : 1) && why.column > 0);
        assert_true(why.file[0] && why.remedy[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lessons_agree_with_theory),
        cmocka_unit_test(critical_angle_is_read_within_a_tenth_of_a_degree),
        cmocka_unit_test(the_focal_length_of_a_cylinder_is_measured_over_its_index),
        cmocka_unit_test(four_times_the_stiffness_halves_the_period),
        cmocka_unit_test(formulas_have_values),
        cmocka_unit_test(the_right_choice_follows_the_scene),
        cmocka_unit_test(frames_are_timed_with_each_number_of_threads),
        cmocka_unit_test(wrong_lessons_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
