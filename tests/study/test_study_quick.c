/* The quick form of a study: its frames, its repetitions, folders that have rows of one form; and the comparison of
 * films of two folders. */
#include "study_fixture.h"

#include "scene/model/scene.h"
#include "study/study.h"
#include "study/summary/verify.h"

static const char sizes[] = "study: sizes\n"
                            "scene: scene.yaml\n"
                            "set: {render.threads: 1}\n"
                            "grid:\n"
                            "  - name: size\n"
                            "    points:\n"
                            "      - {render.width: 80, render.height: 60}\n"
                            "      - {render.width: 800, render.height: 600}\n"
                            "      - {render.width: 200, render.height: 150}\n"
                            "      - {render.width: 160, render.height: 60}\n"
                            "      - {render.width: 121, render.height: 3}\n"
                            "      - {render.width: 9602, render.height: 1}\n"
                            "repetitions: {min: 6, max: 20, relative_width: 0.02}\n"
                            "processes: 3\n"
                            "warmups: 2\n";

static void frames_are_divided(void **state)
{
    static const int64_t expected[][2] = {{80, 60}, {80, 60}, {66, 50}, {80, 30}, {121, 3}, {3200, 1}};
    study *s = fixture_study(*state, sizes);
    const uint64_t whole = s->identity[1], small = s->identity[0];
    assert_int_equal(study_make_quick(s, NULL), STATUS_OK);
    for (size_t cell = 0; cell < study_cell_count(s); cell++) {
        scene *setting = NULL;
        assert_int_equal(study_cell_scene(s, cell, &setting, NULL), STATUS_OK);
        assert_int_equal(setting->render.width, expected[cell][0]);
        assert_int_equal(setting->render.height, expected[cell][1]);
        scene_destroy(setting);
    }
    assert_true(s->identity[0] == small);
    assert_true(s->identity[1] != whole);
    assert_true(s->identity[1] != s->identity[0]);
    study_destroy(s);
}

static void each_cell_is_measured_once(void **state)
{
    study *s = fixture_study(*state, sizes);
    assert_int_equal(study_make_quick(s, NULL), STATUS_OK);
    assert_int_equal(study_processes(s), 1);
    assert_int_equal(fixture_run(*state, s), 6);
    assert_int_equal(fixture_run(*state, s), 0);
    study_destroy(s);
}

static const char short_study[] = "study: test\n"
                                  "scene: scene.yaml\n"
                                  "set: {render.width: 160, render.height: 120}\n"
                                  "grid: [{render.depth: [0, 1]}]\n"
                                  "reference: {render.depth: 2}\n"
                                  "repetitions: 2\n"
                                  "warmups: 0\n";

static status run_in(const fixture *f, const study *s, diagnostic *why)
{
    const study_options options = {.results = f->results};
    return study_run(s, &options, NULL, why);
}

static void rows_of_both_forms_are_not_mixed(void **state)
{
    const fixture *f = *state;
    study *whole = fixture_study(f, short_study), *quick = fixture_study(f, short_study);
    diagnostic why = {0};
    assert_int_equal(study_make_quick(quick, NULL), STATUS_OK);
    assert_int_equal(fixture_run(f, quick), 2);
    assert_int_equal(run_in(f, whole, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "quick run"));
    assert_non_null(strstr(why.remedy, "--quick"));
    fixture other = *f;
    snprintf(other.results, sizeof other.results, "%.250s/whole", f->folder);
    assert_int_equal(fixture_run(&other, whole), 4);
    assert_int_equal(run_in(&other, quick, &why), STATUS_BAD_INPUT);
    study_destroy(quick);
    study_destroy(whole);
}

static void readers_follow_the_rows(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, short_study), *quick = fixture_study(f, short_study);
    study_progress progress;
    assert_int_equal(study_follow_runs(s, f->results, NULL), STATUS_OK);
    assert_false(s->quick);
    assert_int_equal(study_make_quick(quick, NULL), STATUS_OK);
    fixture_run(f, quick);
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.cells_done, 0);
    assert_int_equal(study_follow_runs(s, f->results, NULL), STATUS_OK);
    assert_true(s->quick);
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.cells_done, 2);
    study_destroy(quick);
    study_destroy(s);
}

static study_films films_of(const study *s, const char *results, const char *against)
{
    study_films films;
    assert_int_equal(study_films_compare(s, results, against, &films, NULL), STATUS_OK);
    return films;
}

static void films_are_compared_cell_by_cell(void **state)
{
    const fixture *f = *state;
    fixture other = *f;
    snprintf(other.results, sizeof other.results, "%.250s/other", f->folder);
    study *s = fixture_study(f, short_study);
    fixture_run(f, s);
    study_films films = films_of(s, f->results, other.results);
    assert_int_equal(films.compared, 0);
    study_films_release(&films);
    fixture_run(&other, s);
    films = films_of(s, f->results, other.results);
    assert_int_equal(films.compared, 2);
    assert_int_equal(films.same, 2);
    assert_int_equal(films.distinct, 2);
    assert_int_equal(films.different_count, 0);
    assert_false(films.other_processor);
    study_films_release(&films);
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(frames_are_divided),      CASE(each_cell_is_measured_once),      CASE(rows_of_both_forms_are_not_mixed),
        CASE(readers_follow_the_rows), CASE(films_are_compared_cell_by_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
