/* Tests of studies through cuvette.h: a run, its rows, a stop that resumes, summaries, comparisons; wrong arguments. */
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

#include "cuvette.h"
#include "engine_fixture.h"

static const char TEXT[] =
    "study: tiny\ntitle: A tiny study\nscene: %s/experiments/scenes/rod.yaml\n"
    "set: {render.width: 16, render.height: 12}\ngrid:\n  - render.depth: [0, 3]\nrepetitions: 6\n";
static char folder[] = "/tmp/cuvette-study-XXXXXX", path[128], results[128];

static int set_up(void **state)
{
    char here[4096];
    if (!mkdtemp(folder) || !getcwd(here, sizeof here))
        return -1;
    snprintf(path, sizeof path, "%s/tiny.study", folder);
    snprintf(results, sizeof results, "%s/results", folder);
    FILE *file = fopen(path, "w");
    if (!file)
        return -1;
    fprintf(file, TEXT, here);
    fclose(file);
    cuvette_study *s = NULL;
    cuvette_diagnostic why;
    fine(cuvette_study_read(path, &s, &why), &why);
    *state = s;
    return 0;
}

static int tear_down(void **state)
{
    char command[256];
    cuvette_study_destroy(*state);
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static void test_cells(void **state)
{
    const cuvette_study *s = *state;
    cuvette_diagnostic why;
    cuvette_scene *setting = NULL;
    int64_t depth = 0;
    assert_string_equal(cuvette_study_name(s), "tiny");
    assert_string_equal(cuvette_study_title(s), "A tiny study");
    assert_int_equal(cuvette_study_cells(s), 2);
    assert_int_equal(cuvette_study_processes(s), 1);
    fine(cuvette_study_scene(s, 1, &setting, &why), &why);
    fine(cuvette_scene_get_int(setting, "render.depth", &depth, &why), &why);
    assert_int_equal(depth, 3);
    cuvette_scene_destroy(setting);
    assert_int_equal(cuvette_study_scene(s, 2, &setting, &why), CUVETTE_BAD_INPUT);
    assert_null(setting);
}

typedef struct pair {
    char path[64], value[64];
    int seen;
} pair;

static bool take_value(void *context, const char *name, const char *value)
{
    pair *p = context;
    snprintf(p->path, sizeof p->path, "%s", name);
    snprintf(p->value, sizeof p->value, "%s", value);
    p->seen++;
    return true;
}

static void test_values(void **state)
{
    cuvette_diagnostic why;
    pair found = {.seen = 0};
    fine(cuvette_study_each_value(*state, 1, take_value, &found, &why), &why);
    assert_int_equal(found.seen, 1);
    assert_string_equal(found.path, "render.depth");
    assert_string_equal(found.value, "3");
    assert_int_equal(cuvette_study_each_value(*state, 7, take_value, &found, &why), CUVETTE_BAD_INPUT);
}

static bool refuse(void *context, double share, double left_s)
{
    (void)left_s;
    ++*(int *)context;
    assert_true(share >= 0 && share <= 1);
    return false;
}

static void test_run(void **state)
{
    const cuvette_study *s = *state;
    cuvette_diagnostic why;
    size_t rows = 99;
    int asked = 0;
    cuvette_run run = {.size = sizeof run, .results = results, .progress = refuse, .context = &asked};
    assert_int_equal(cuvette_study_run(s, &run, &rows, &why), CUVETTE_CANCELLED);
    assert_true(asked == 1 && rows < 12);
    run.progress = NULL;
    fine(cuvette_study_run(s, &run, &rows, &why), &why);
    assert_true(rows >= 12);
    fine(cuvette_study_run(s, &run, &rows, &why), &why);
    assert_int_equal(rows, 0);
    cuvette_study_progress now = {.size = sizeof now};
    fine(cuvette_study_state(s, results, &now, &why), &why);
    assert_true(now.cells == 2 && now.cells_done == 2 && now.rows == 12 && now.faults == 0);
    assert_int_equal(strlen(now.environment), 8);
    run.process = 2;
    assert_int_equal(cuvette_study_run(s, &run, &rows, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "the study has 1 processes, but no process 2"));
    assert_non_null(strstr(why.remedy, "from 1 to this number of processes")); /* not `processes` of the file */
    run.size = 8;
    assert_int_equal(cuvette_study_run(s, &run, &rows, &why), CUVETTE_BAD_INPUT);
}

static void test_what_the_rows_say(void **state)
{
    const cuvette_study *s = *state;
    cuvette_diagnostic why;
    char *text = NULL, *fault = NULL;
    fine(cuvette_study_summary(s, results, "main", &text, &fault, &why), &why);
    assert_true(strncmp(text, "cell\trender.depth\tn\t", 20) == 0 && fault == NULL);
    cuvette_text_destroy(text);
    fine(cuvette_study_compare(s, results, "render.depth=0", "render.depth=3", NULL, &text, &fault, &why), &why);
    assert_non_null(strstr(text, "\"ratio\""));
    cuvette_text_destroy(text);
    assert_int_equal(cuvette_study_compare(s, results, "render.depth=9", "cell=1", NULL, &text, &fault, &why),
                     CUVETTE_BAD_INPUT);
    assert_null(text);
    assert_int_equal(cuvette_study_summary(s, folder, NULL, &text, NULL, &why), CUVETTE_FAILURE);
    assert_null(text);
    cuvette_plot plot = {.size = sizeof plot, .results = results, .log = "z"};
    assert_int_equal(cuvette_study_plot(s, &plot, path, "png", &why), CUVETTE_BAD_INPUT);
    plot.log = NULL;
    assert_int_equal(cuvette_study_plot(s, &plot, path, "jpeg", &why), CUVETTE_BAD_INPUT);
    plot.y = "no_such_column";
    assert_int_equal(cuvette_study_plot(s, &plot, path, "png", &why), CUVETTE_BAD_INPUT);
}

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}

static void test_rows(void **state)
{
    const cuvette_study *s = *state;
    cuvette_diagnostic why;
    cuvette_study_progress done = {.size = sizeof done};
    char *text = NULL, *alone = NULL, *fault = NULL, place[192];
    fine(cuvette_study_state(s, results, &done, &why), &why);
    fine(cuvette_study_rows(s, results, NULL, &text, &fault, &why), &why);
    assert_null(fault);
    assert_true(strncmp(text, "study,", 6) == 0 && count_of(text, ",environment,left_out\n") == 1);
    assert_int_equal(count_of(text, "\n"), 1 + done.rows + done.warmups);
    assert_int_equal(count_of(text, ",warm-up\n"), done.warmups);
    assert_int_equal(count_of(text, done.environment), done.rows + done.warmups);
    snprintf(place, sizeof place, "%s/tiny/", results);
    fine(cuvette_study_rows(NULL, place, "main", &alone, NULL, &why), &why);
    assert_string_equal(text, alone);
    cuvette_text_destroy(alone);
    cuvette_text_destroy(text);
    assert_int_equal(cuvette_study_rows(s, results, "00000000", &text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.remedy, done.environment));
    assert_int_equal(cuvette_study_rows(s, folder, NULL, &text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_string_equal(why.what, "there are no rows");
    assert_int_equal(cuvette_study_rows(NULL, NULL, NULL, &text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_null(text);
}

static bool take_column(void *context, const cuvette_column *one)
{
    int *seen = context;
    assert_true(one->name[0] && one->meaning[0]);
    return ++*seen < 5;
}

static void test_columns(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    int seen = 0;
    fine(cuvette_each_column(take_column, &seen, &why), &why);
    assert_int_equal(seen, 5);
}

static void test_wrong_arguments(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_study *s = NULL;
    char *text = NULL;
    const cuvette_run run = {.size = sizeof run};
    assert_int_equal(cuvette_study_read("absent.study", &s, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_study_run(NULL, &run, NULL, &why), CUVETTE_BAD_INPUT);
    assert_string_equal(why.what, "the argument 'study' is NULL");
    assert_int_equal(cuvette_study_summary(NULL, NULL, NULL, &text, NULL, &why), CUVETTE_BAD_INPUT);
    assert_null(cuvette_study_name(NULL));
    assert_int_equal(cuvette_study_cells(NULL), 0);
    cuvette_study_destroy(NULL);
    cuvette_text_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_run),
        cmocka_unit_test(test_what_the_rows_say),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_columns),
        cmocka_unit_test(test_wrong_arguments),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
