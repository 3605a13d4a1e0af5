/* Tests of the realism and motion metrics that a study keeps. */
#include "study_fixture.h"

#include "base/csv.h"
#include "realism/realism.h"
#include "scene/model/params.h"
#include "softbody/trials.h"

static const char vessel_text[] = "study: test\n"
                                  "scene: vessel.yaml\n"
                                  "grid:\n"
                                  "  - {liquid.ior: [1.2, 1.33]}\n"
                                  "repetitions: 1\n"
                                  "warmups: 0\n"
                                  "keep: {metrics: on, curves: on}\n";

static const char vessel_scene[] =
    "render: {width: 24, height: 18, depth: 2}\n"
    "camera: {position: [0, 2.75, -6], target: [0, 1.5, 0]}\n"
    "solids:\n"
    "  vessel: {shape: cup, transparency: 1, ior: 1.5, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1, priority: "
    "2}\n"
    "  liquid: {shape: cylinder, transparency: 1, ior: 1.33, position: [0, 0.05, 0], radius: 0.95, height: 1.95, "
    "priority: 1}\n"
    "  rod: {shape: box, diffuse: 1, position: [0.2, 2.1, 0], size: [0.25, 3, 0.25], priority: 3}\n";

static size_t lines_of(const char *text)
{
    return fixture_count(text, "\n");
}

/* One line per metric, preceded by the cell's values, with the same names for every cell; keeping it does not change a
 * frame. */
static void metrics_and_curves_are_written_next_to_the_images(void **state)
{
    const fixture *f = *state;
    fixture_write(f, "vessel.yaml", vessel_scene);
    study *s = fixture_study(f, vessel_text);
    assert_int_equal(fixture_run(f, s), 2);
    char *first = fixture_text(f, "results/test/images/0000-metrics.tsv"),
         *second = fixture_text(f, "results/test/images/0001-metrics.tsv");
    char *curves = fixture_text(f, "results/test/images/0001-curves.tsv"),
         *index = fixture_text(f, "results/test/images/index.tsv");
    assert_ptr_equal(
        strstr(first, "study\tcell\tliquid.ior\tmetric\tunit\tmeasured\ttheory\terror\ttolerance\tpasses\twhat\n"),
        first);
    assert_ptr_equal(strstr(curves, "study\tcell\tliquid.ior\tcurve\tx\tmeasured\ttheory\n"), curves);
    realism_report report;
    assert_int_equal(realism_measure(s->base, isa_best(), &report, NULL), STATUS_OK);
    assert_int_equal(lines_of(first), report.count + 1);
    assert_int_equal(lines_of(second), report.count + 1);
    assert_int_equal(fixture_count(first, "test\t0\t1.2\t"), report.count);
    assert_int_equal(fixture_count(second, "test\t1\t1.33\t"), report.count);
    assert_int_equal(fixture_count(second, "\tedges.round_magnification\t"), 1);
    assert_true(fixture_count(curves, "test\t1\t1.33\tfresnel-s\t") > 10);
    assert_int_equal(fixture_count(index, "-metrics.tsv\t"), 2);
    assert_int_equal(fixture_run(f, s), 0);
    free(first), free(second), free(curves), free(index);
    study_destroy(s);
}

/* The scene of the fixture has no vessel, which is reported before anything is measured. */
static void realism_metrics_without_a_vessel_are_refused(void **state)
{
    const fixture *f = *state;
    char path[400], message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study *s = NULL;
    fixture_write(f, "bad.study", "study: bad\nscene: scene.yaml\nkeep: {metrics: on}\n");
    fixture_path(f, "bad.study", path);
    assert_int_equal(study_read(path, &s, &why), STATUS_BAD_INPUT);
    diagnostic_text(&why, message, sizeof message);
    assert_non_null(strstr(message, "bad.study:3:17: metrics of cell 0 cannot be saved: "));
    assert_non_null(strstr(message, "vessel"));
    assert_false(fixture_has(f, "results"));
}

static const char slime_scene[] = "render: {width: 24, height: 18, depth: 2}\n"
                                  "camera: {position: [0, 1, -5], target: [0, 1, 0]}\n"
                                  "meshes:\n"
                                  "  toy: {generate: slime, level: 0}\n"
                                  "  other: {generate: slime, level: 0, integrator: implicit}\n"
                                  "  ball: {generate: icosphere}\n"
                                  "solids:\n"
                                  "  body: {shape: mesh, mesh: toy, diffuse: 1}\n";

/* One line per value of each slime, and none for other meshes; values other than times are those of the trials with the
 * cell's settings. */
static void motion_metrics_are_written_next_to_the_images(void **state)
{
    const fixture *f = *state;
    fixture_write(f, "slime.yaml", slime_scene);
    study *s = fixture_study(
        f, "study: test\nscene: slime.yaml\ngrid:\n  - {toy.integrator: [euler, verlet]}\nrepetitions: 1\nwarmups: 0\n"
           "keep: {motion: on}\n");
    assert_int_equal(fixture_run(f, s), 2);
    char *first = fixture_text(f, "results/test/images/0000-motion.tsv"),
         *second = fixture_text(f, "results/test/images/0001-motion.tsv");
    char *index = fixture_text(f, "results/test/images/index.tsv");
    assert_ptr_equal(strstr(first, "study\tcell\ttoy.integrator\tslime\tname\tunit\tmeasured\ttheory\terror\twhat\n"),
                     first);
    assert_int_equal(lines_of(first), 2 * SOFTBODY_TRIAL_COUNT + 1);
    assert_int_equal(fixture_count(first, "test\t0\teuler\ttoy\t"), SOFTBODY_TRIAL_COUNT);
    assert_int_equal(fixture_count(second, "test\t1\tverlet\ttoy\t"), SOFTBODY_TRIAL_COUNT);
    assert_int_equal(fixture_count(second, "test\t1\tverlet\tother\t"), SOFTBODY_TRIAL_COUNT);
    assert_int_equal(fixture_count(second, "\tother\tstable_dt.spring_s\ts\tNA\tNA\tNA\t"), 1);
    double depth, theory;
    assert_int_equal(
        sscanf(strstr(first, "\ttoy\tfall.depth\t"), "\ttoy\tfall.depth\tscene units\t%lf\t%lf\t", &depth, &theory), 2);
    assert_true(fabs(theory - 4.905) < 1e-12 && fabs(depth - 4.909905) < 1e-12);
    assert_int_equal(sscanf(strstr(second, "\ttoy\tfall.depth\t"), "\ttoy\tfall.depth\tscene units\t%lf\t", &depth), 1);
    assert_true(fabs(depth - 4.905) < 1e-12);
    assert_int_equal(fixture_count(index, "-motion.tsv\t"), 2);
    assert_int_equal(fixture_run(f, s), 0);
    free(first), free(second), free(index);
    study_destroy(s);
}

static void motion_metrics_without_a_slime_are_refused(void **state)
{
    const fixture *f = *state;
    char path[400], message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study *s = NULL;
    fixture_write(f, "bad.study", "study: bad\nscene: scene.yaml\nkeep: {motion: on}\n");
    fixture_path(f, "bad.study", path);
    assert_int_equal(study_read(path, &s, &why), STATUS_BAD_INPUT);
    diagnostic_text(&why, message, sizeof message);
    assert_non_null(strstr(message, "bad.study:3:16: the motion of cell 0 cannot be saved: "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(metrics_and_curves_are_written_next_to_the_images, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(realism_metrics_without_a_vessel_are_refused, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(motion_metrics_are_written_next_to_the_images, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(motion_metrics_without_a_slime_are_refused, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
