/* Tests of `study upgrade`: rows of an old version in the present form have the same summary, pass every check, and the
 * study resumes with them. */
#include "study_fixture.h"
#include "study/row_files.h"
#include "study/summary.h"
#include "study/upgrade.h"
#include "study/verify.h"

static const char old_study[] = "tests/old-rows/old-rows.study", old_results[] = "tests/old-rows/results";

static study *read_old(void)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study *s = NULL;
    if (study_read(old_study, &s, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return s;
}

/* The summary, without the last column of each line: the environment has other facts. */
static char *summary_of(const study *s, const char *results)
{
    char *text = NULL, *write;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(study_summary(s, results, out, NULL), STATUS_OK);
    fclose(out);
    write = text;
    for (char *line = text, *end; (end = strchr(line, '\n')); line = end + 1) {
        const char *tab = memrchr(line, '\t', (size_t)(end - line));
        memmove(write, line, (size_t)(tab - line));
        write += tab - line;
        *write++ = '\n';
    }
    *write = 0;
    return text;
}

static void old_rows_get_the_present_form(void **state)
{
    const fixture *f = *state;
    study *s = read_old();
    size_t rows = 0;
    study_verdict verdict;
    row_files *old = NULL, *new = NULL;
    assert_int_equal(study_upgrade(s, old_results, f->results, &rows, NULL), STATUS_OK);
    FILE *out = fopen("/dev/null", "w");
    assert_int_equal(study_verify(s, f->results, out, &verdict, NULL), STATUS_OK);
    fclose(out);
    assert_int_equal(verdict.faults, 0);
    assert_int_equal(verdict.rows, rows);
    char *before = summary_of(s, old_results), *after = summary_of(s, f->results);
    assert_string_equal(after, before);
    for (row_kind kind = ROWS; kind <= WORKER_ROWS; kind++) {
        assert_int_equal(row_files_read(s, old_results, kind, &old, NULL), STATUS_OK);
        assert_int_equal(row_files_read(s, f->results, kind, &new, NULL), STATUS_OK);
        assert_true(old->row_count > 0);
        assert_int_equal(new->row_count, old->row_count);
        for (size_t i = 0; i < old->row_count; i++) {
            assert_true(new->rows[i].run >= 0);
            assert_int_equal(new->rows[i].cell, old->rows[i].cell);
            assert_string_equal(row_field(&new->rows[i], "wall_s"), row_field(&old->rows[i], "wall_s"));
        }
        row_files_destroy(old);
        row_files_destroy(new);
    }
    free(before);
    free(after);
    study_destroy(s);
}

/* Nothing is overwritten, and rows of this version need no upgrade. */
static void existing_and_present_rows_are_refused(void **state)
{
    const fixture *f = *state;
    study *s = read_old();
    size_t rows = 0;
    char other[400];
    diagnostic why = {0};
    snprintf(other, sizeof other, "%s-2", f->results);
    assert_int_equal(study_upgrade(s, old_results, f->results, &rows, NULL), STATUS_OK);
    assert_int_equal(study_upgrade(s, old_results, f->results, &rows, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "--to"));
    assert_int_equal(study_upgrade(s, f->results, other, &rows, &why), STATUS_BAD_INPUT);
    assert_int_equal(rows, 0);
    assert_int_equal(study_upgrade(s, other, f->results, &rows, &why), STATUS_BAD_INPUT);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(old_rows_get_the_present_form, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(existing_and_present_rows_are_refused, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("study_upgrade", tests, NULL, NULL);
}
