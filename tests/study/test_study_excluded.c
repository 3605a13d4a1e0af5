/* Tests of study/rows/row_files.h: rows that a person excludes from summaries. */
#include "study_fixture.h"

#include "study/rows/row_files.h"
#include "study/summary/summary.h"

static const char text[] =
    "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 3\nwarmups: 1\n";

static status add(const fixture *f, const study *s, const char *row, const char *reason, diagnostic *why)
{
    return excluded_add(s, f->results, row, reason, why);
}

/* The field of the summary's line of a cell; valid until the next call. */
static const char *summary_field(const fixture *f, const study *s, size_t cell, const char *name)
{
    static char value[64];
    char *tsv = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&tsv, &size);
    assert_int_equal(study_summary(s, f->results, out, NULL), STATUS_OK);
    fclose(out);
    char *rest = tsv, *header = strsep(&rest, "\n"), *line = NULL;
    for (size_t i = 0; i <= cell; i++)
        line = strsep(&rest, "\n");
    assert_non_null(line);
    for (char *column; (column = strsep(&header, "\t"));) {
        const char *field = strsep(&line, "\t");
        if (strcmp(column, name) == 0)
            snprintf(value, sizeof value, "%s", field);
    }
    free(tsv);
    return value;
}

/* The row of a cell and repetition. */
static const row_ref *row_of(const row_files *files, size_t cell, long repetition)
{
    for (size_t i = 0; i < files->row_count; i++)
        if (files->rows[i].cell == cell && files->rows[i].repetition == repetition)
            return &files->rows[i];
    fail_msg("no row %zu:%ld", cell, repetition);
    return NULL;
}

static void a_row_is_left_out_and_stays(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    assert_int_equal(fixture_run(f, s), 8);
    char *before = fixture_text(f, "results/test/rows.csv");
    row_files *files = NULL;
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    const double first_s = row_field_real(row_of(files, 0, 1), "wall_s"),
                 last_s = row_field_real(row_of(files, 0, 3), "wall_s");
    row_files_destroy(files);
    assert_string_equal(summary_field(f, s, 0, "n"), "3");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "0");

    assert_int_equal(add(f, s, "0:2", "the fan of the machine failed", NULL), STATUS_OK);
    assert_string_equal(summary_field(f, s, 0, "n"), "2");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "1");
    assert_string_equal(summary_field(f, s, 1, "n"), "3");
    assert_string_equal(summary_field(f, s, 1, "excluded"), "0");
    assert_true(fabs(atof(summary_field(f, s, 0, "wall_s_max")) - fmax(first_s, last_s)) < 1e-12);
    assert_int_equal(add(f, s, "1:1", "a comma, and \"quotes\"", NULL), STATUS_OK);
    assert_string_equal(summary_field(f, s, 1, "excluded"), "1");
    char *after = fixture_text(f, "results/test/rows.csv"), *list = fixture_text(f, "results/test/excluded.csv");
    assert_string_equal(before, after);
    assert_non_null(strstr(list, "checksum,identity,run,process,cell,repetition,reason,time_utc\n"));
    assert_non_null(strstr(list, ",0,2,\"the fan of the machine failed\",2"));
    assert_non_null(strstr(list, ",1,1,\"a comma, and \"\"quotes\"\"\",2"));
    assert_int_equal(fixture_run(f, s), 0); /* an excluded row is not measured again */
    free(before);
    free(after);
    free(list);
    study_destroy(s);
}

static void the_check_names_a_row(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    row_files *files = NULL;
    char checksum[64];
    fixture_run(f, s);
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    snprintf(checksum, sizeof checksum, "%s", row_field(row_of(files, 1, 2), "checksum"));
    row_files_destroy(files);
    assert_int_equal(strlen(checksum), 16);
    assert_int_equal(add(f, s, checksum, "reason", NULL), STATUS_OK);
    diagnostic why = {0};
    assert_int_equal(add(f, s, "1:2", "again", &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "this row is excluded already");
    study_destroy(s);
}

/* The cell of an excluded row has another number when an axis grows at its beginning; the row stays excluded. */
static void rows_stay_excluded_when_the_grid_changes(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    fixture_run(f, s);
    assert_int_equal(add(f, s, "0:1", "reason", NULL), STATUS_OK);
    study_destroy(s);
    s = fixture_study(
        f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [2, 1, 0]}]\nrepetitions: 3\nwarmups: 1\n");
    fixture_run(f, s);
    assert_string_equal(summary_field(f, s, 0, "excluded"), "0");
    assert_string_equal(summary_field(f, s, 1, "excluded"), "0");
    assert_string_equal(summary_field(f, s, 2, "excluded"), "1");
    assert_string_equal(summary_field(f, s, 2, "n"), "2");
    study_destroy(s);
}

/* A list that a person wrote names a row as rows.csv does, whatever the grid is now. */
static void a_written_list_names_rows_of_the_file(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    fixture_run(f, s);
    study_destroy(s);
    fixture_write(f, "results/test/excluded.csv", "cell,repetition,reason\n1,2,depth 1\n");
    s = fixture_study(f,
                      "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 0]}]\nrepetitions: 3\nwarmups: 1\n");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "1");
    assert_string_equal(summary_field(f, s, 1, "excluded"), "0");
    study_destroy(s);
}

/* A cell's number in rows.csv is that of the grid at the time; the same number may now be another row's. */
static void a_number_names_the_row_of_the_file(void **state)
{
    static const char changed[] =
        "study: test\nscene: scene.yaml\ngrid: [{render.depth: [2, 1, 0]}]\nrepetitions: 3\nwarmups: 1\n";
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    fixture_run(f, s);
    study_destroy(s);
    s = fixture_study(f, changed);
    diagnostic why = {0};
    assert_int_equal(add(f, s, "2:1", "the present number", &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "there is no such row");
    assert_int_equal(add(f, s, "0:1", "the number in the file", NULL), STATUS_OK);
    fixture_run(f, s); /* depth 2, cell 0 in the file too */
    assert_string_equal(summary_field(f, s, 0, "excluded"), "0");
    assert_string_equal(summary_field(f, s, 2, "excluded"), "1");
    why = (diagnostic){0};
    assert_int_equal(add(f, s, "0:2", "depth 0 or depth 2", &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "more than one row has this number"));
    assert_non_null(strstr(why.remedy, "checksum"));
    study_destroy(s);
    s = fixture_study(f,
                      "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 0]}]\nrepetitions: 3\nwarmups: 1\n");
    why = (diagnostic){0};
    assert_int_equal(add(f, s, "0:3", "depth 0 in the file, depth 1 now", &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "more than one row has this number"));
    study_destroy(s);
}

/* Rows of shards are merged into another file; the row stays excluded. */
static void rows_stay_excluded_after_a_merge(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    for (long shard = 0; shard < 2; shard++) {
        const study_options options = {.results = f->results, .shard = shard, .shards = 2};
        assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    }
    assert_int_equal(add(f, s, "0:2", "reason", NULL), STATUS_OK);
    assert_int_equal(add(f, s, "1:3", "reason", NULL), STATUS_OK);
    size_t rows = 0;
    diagnostic verdict = {.what = ""};
    assert_int_equal(study_merge(s, f->results, &rows, &verdict, NULL), STATUS_OK);
    assert_string_equal(summary_field(f, s, 0, "excluded"), "1");
    assert_string_equal(summary_field(f, s, 1, "excluded"), "1");
    assert_string_equal(summary_field(f, s, 1, "n"), "2");
    study_destroy(s);
}

static void other_references_are_refused(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *row, *reason, *what;
    } cases[] = {
        {"2:1", "reason", "there is no such row"},
        {"0:4", "reason", "there is no such row"},
        {"0", "reason", "there is no such row"},
        {"", "reason", "there is no such row"},
        {"NA", "reason", "there is no such row"},
        {"00:1", "reason", "there is no such row"},
        {"0:0", "reason", "this row is a warm-up, which summaries never use"},
        {"0:1", "", "this is not a reason"},
        {"0:1", "  ", "this is not a reason"},
        {"0:1", "two\nlines", "this is not a reason"},
    };
    study *s = fixture_study(f, text);
    fixture_run(f, s);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        diagnostic why = {0};
        assert_int_equal(add(f, s, cases[i].row, cases[i].reason, &why), STATUS_BAD_INPUT);
        assert_string_equal(why.what, cases[i].what);
        assert_false(fixture_has(f, "results/test/excluded.csv"));
    }
    study_destroy(s);
}

static void a_damaged_list_is_reported(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    fixture_run(f, s);
    assert_int_equal(add(f, s, "0:1", "reason", NULL), STATUS_OK);
    fixture_write(f, "results/test/excluded.csv",
                  "checksum,identity,run,process,cell,repetition,reason,time_utc\n"
                  "NA,NA,NA,NA,0,1,reason,NA\nNA,NA,NA,NA,0,two,reason,NA\n");
    diagnostic why = {0};
    assert_int_equal(study_summary(s, f->results, stderr, &why), STATUS_BAD_INPUT);
    assert_int_equal(why.line, 3);
    fixture_write(f, "results/test/excluded.csv", "checksum,reason\nNA,reason\n");
    assert_int_equal(study_summary(s, f->results, stderr, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "cell"));
    /* Without what tells runs apart, cell and repetition decide; a last line that lacks fields is no line. */
    fixture_write(f, "results/test/excluded.csv", "cell,repetition,reason\n0,1,reason\n0,2");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "1");
    /* People, editors and spreadsheets end lines as they please; the next exclusion keeps theirs. */
    fixture_write(f, "results/test/excluded.csv",
                  "\xEF\xBB\xBF"
                  "cell,repetition,reason\r\n0,1,reason\r\n0,2,own");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "2");
    assert_int_equal(add(f, s, "0:3", "third", NULL), STATUS_OK);
    assert_string_equal(summary_field(f, s, 0, "excluded"), "3");
    fixture_write(f, "results/test/excluded.csv", "");
    assert_string_equal(summary_field(f, s, 0, "excluded"), "0");
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(a_row_is_left_out_and_stays),
        CASE(the_check_names_a_row),
        CASE(rows_stay_excluded_when_the_grid_changes),
        CASE(a_written_list_names_rows_of_the_file),
        CASE(a_number_names_the_row_of_the_file),
        CASE(rows_stay_excluded_after_a_merge),
        CASE(other_references_are_refused),
        CASE(a_damaged_list_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
