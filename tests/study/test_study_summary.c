/* Tests of the summary of a study. */
#include "base/csv.h"
#include "rows_fixture.h"
#include "study/rows/row_files.h"
#include "study/summary/summary.h"
#include "study_fixture.h"
#include <inttypes.h>
#include <locale.h>

/* Medians, their intervals and the columns. */

static const char study_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid: [{render.depth: [0, 1, 2]}]\n"
                                 "repetitions: 8\n";

typedef struct written {
    int cell, repetition, warmup, marked;
    double wall_s;
} written;

static const char run_id[] = "0123456789abcdef";

/* runs.json with one run, of an environment without known facts. */
static void write_run(const fixture *f)
{
    run_environment here = {.key = ""};
    char text[300];
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        strcpy(here.fact[i], "unknown");
    environment_close(&here);
    snprintf(text, sizeof text, "{\"runs\": [{\"id\": \"%s\", \"environment\": {\"key\": \"%s\"}}]}", run_id, here.key);
    fixture_write(f, "results/test/runs.json", text);
}

/* rows.csv with these rows: every column that is not named below is NA. */
static void write_rows(const fixture *f, const study *s, const written *rows, size_t count)
{
    char *header = row_file_header(s, ROWS), path[400];
    header[strcspn(header, "\n")] = 0;
    char *text = malloc(1 << 18);
    size_t size = (size_t)sprintf(text, "%s\n", header);
    for (size_t i = 0; i < count; i++) {
        char *names = strdup(header), *rest = names;
        for (const char *name; (name = strsep(&rest, ","));) {
            char value[64] = "NA";
            if (strcmp(name, "study") == 0)
                strcpy(value, "test");
            else if (strcmp(name, "identity") == 0)
                sprintf(value, "%016" PRIx64, s->identity[rows[i].cell]);
            else if (strcmp(name, "run") == 0)
                strcpy(value, run_id);
            else if (strcmp(name, "cell") == 0)
                sprintf(value, "%d", rows[i].cell);
            else if (strcmp(name, "repetition") == 0)
                sprintf(value, "%d", rows[i].repetition);
            else if (strcmp(name, "warmup") == 0)
                sprintf(value, "%d", rows[i].warmup);
            else if (strcmp(name, "marked") == 0)
                sprintf(value, "%d", rows[i].marked);
            else if (strcmp(name, "film_expected") == 0)
                strcpy(value, "00000000000000aa");
            else if (strcmp(name, "wall_s") == 0)
                sprintf(value, "%d.%d", (int)rows[i].wall_s, (int)(rows[i].wall_s * 10) % 10);
            else if (strcmp(name, "rays_total") == 0 || strcmp(name, "first_hits.ball") == 0)
                sprintf(value, "%d", 1000 + rows[i].cell);
            else if (strcmp(name, "motion_s") == 0)
                sprintf(value, "%d.5", (int)rows[i].wall_s);
            else if (strcmp(name, "motion_steps") == 0)
                sprintf(value, "%d", (int)rows[i].wall_s - 1);
            size += (size_t)sprintf(text + size, "%s%s", value, rest ? "," : "\n");
        }
        free(names);
    }
    fixture_path(f, "results", path);
    mkdir(path, 0777);
    fixture_path(f, "results/test", path);
    mkdir(path, 0777);
    fixture_write(f, "results/test/rows.csv", text);
    fixture_path(f, "results/test/rows.csv", path);
    rows_recheck(path);
    write_run(f);
    free(text);
    free(header);
}

static char *summary_of(const fixture *f, const study *s)
{
    char *text = NULL, message[DIAGNOSTIC_TEXT_MAX];
    size_t size;
    diagnostic why = {0};
    FILE *out = open_memstream(&text, &size);
    if (study_summary(s, f->results, out, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    fclose(out);
    return text;
}

/* The field of a line (0: header) in a named column; static storage. */
static const char *field(const char *text, int line, const char *name)
{
    static char value[256];
    int column = -1, at = 0;
    char *copy = strdup(text), *lines = copy;
    char *header = strsep(&lines, "\n");
    for (const char *word; (word = strsep(&header, "\t")); at++)
        if (strcmp(word, name) == 0)
            column = at;
    if (column < 0)
        fail_msg("no column %s", name);
    char *expected = NULL;
    for (int i = 0; i < line; i++)
        expected = strsep(&lines, "\n");
    const char *word = NULL;
    for (at = 0; at <= column; at++)
        word = strsep(&expected, "\t");
    snprintf(value, sizeof value, "%s", word ? word : "(none)");
    free(copy);
    return value;
}

static void a_summary_has_medians_and_their_intervals(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    /* Cell 0: a warm-up and a marked outlier, six measured rows 1 to 6. Cell 2: three rows. Cell 1: none. */
    static const written rows[] = {
        {0, 0, 1, 0, 99}, {0, 1, 0, 0, 6}, {0, 2, 0, 0, 1}, {0, 3, 0, 1, 50}, {0, 4, 0, 0, 2}, {2, 0, 0, 0, 1},
        {0, 5, 0, 0, 5},  {0, 6, 0, 0, 3}, {2, 1, 0, 0, 2}, {0, 7, 0, 0, 4},  {2, 2, 0, 0, 3},
    };
    write_rows(f, s, rows, sizeof rows / sizeof rows[0]);
    char *text = summary_of(f, s);
    assert_int_equal(fixture_count(text, "\n"), 4);
    assert_string_equal(field(text, 1, "cell"), "0");
    assert_string_equal(field(text, 1, "render.depth"), "0");
    assert_string_equal(field(text, 1, "n"), "6");
    assert_string_equal(field(text, 1, "wall_s_median"), "3.5");
    assert_string_equal(field(text, 1, "wall_s_mean"), "3.5");
    assert_string_equal(field(text, 1, "wall_s_min"), "1");
    assert_string_equal(field(text, 1, "wall_s_max"), "6");
    /* Six values: the 95% interval of the median is from the smallest to the largest (1 - 2/64 = 96.9%). */
    assert_string_equal(field(text, 1, "wall_s_low"), "1");
    assert_string_equal(field(text, 1, "wall_s_high"), "6");
    assert_string_equal(field(text, 1, "cpu_s_median"), "NA");
    assert_string_equal(field(text, 1, "marked"), "1");
    assert_string_equal(field(text, 1, "film_hash"), "00000000000000aa");
    assert_string_equal(field(text, 1, "rays_total"), "1000");
    assert_string_equal(field(text, 1, "first_hits.ball"), "1000");
    assert_string_equal(field(text, 1, "first_hits.ground"), "NA");
    /* The same of other columns: 1.5 to 6.5; and of quotients, formed row by row: 6.5/5 to 2.5/1, without 1.5/0. */
    assert_string_equal(field(text, 1, "motion_s_median"), "4");
    assert_string_equal(field(text, 1, "motion_s_low"), "1.5");
    assert_string_equal(field(text, 1, "motion_s_max"), "6.5");
    assert_string_equal(field(text, 1, "motion_s/motion_steps_median"), "1.5"); /* 4.5/3 */
    assert_string_equal(field(text, 1, "motion_s/motion_steps_low"), "NA");     /* of five values */
    assert_string_equal(field(text, 1, "motion_s/motion_steps_min"), "1.3");
    assert_string_equal(field(text, 1, "motion_s/motion_steps_max"), "2.5");
    assert_string_equal(field(text, 1, "query_boxes_median"), "NA");
    assert_string_equal(field(text, 1, "query_boxes/query_rays_max"), "NA");
    /* A cell without rows has a line. */
    assert_string_equal(field(text, 2, "render.depth"), "1");
    assert_string_equal(field(text, 2, "n"), "0");
    assert_string_equal(field(text, 2, "wall_s_median"), "NA");
    assert_string_equal(field(text, 2, "film_hash"), "NA");
    assert_string_equal(field(text, 2, "marked"), "0");
    /* Three values have no such interval: even from the smallest to the largest it is only 1 - 2/8 = 75%. */
    assert_string_equal(field(text, 3, "n"), "3");
    assert_string_equal(field(text, 3, "wall_s_median"), "2");
    assert_string_equal(field(text, 3, "wall_s_low"), "NA");
    assert_string_equal(field(text, 3, "wall_s_high"), "NA");
    free(text);
    study_destroy(s);
}

static void columns_are_in_the_expected_order(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    static const written row = {0, 0, 0, 0, 1};
    diagnostic why;
    assert_int_equal(study_summary(s, f->results, stderr, &why), STATUS_FAILURE);
    assert_memory_equal(why.what, "no rows in ", 11);
    write_rows(f, s, &row, 1);
    char *text = summary_of(f, s);
#define SIX(name) name "_median\t" name "_low\t" name "_high\t" name "_mean\t" name "_min\t" name "_max\t"
    static const char header[] = "cell\trender.depth\tn\t" SIX("wall_s") SIX(
        "cpu_s") "rays_total\trays_camera\trays_reflect\trays_refract\trays_shadow\tcut_depth_throughput\ttotal_"
                 "internal\t"
                 "film_hash\tmarked\texcluded\tbusy_s_mean\tbusy_s_max\twaiting_s_mean\tothers_fraction\tworker_cpu_s_"
                 "sum\t"
                 "peak_rss_bytes\tnoise_rms\ttriangles\tinstances\taccel_bytes\tdrawn\tdrawn_bytes\tmotion_steps\tcut_"
                 "fraction\t"
                 "first_hits.ground\tfirst_hits.ball\t" SIX("build_s") SIX("imbalance") SIX("visibility_s_sum") SIX(
                     "motion_s") SIX("query_rays") SIX("query_boxes") SIX("query_triangles") SIX("rays_total/cpu_s")
                     SIX("visibility_s_sum/wall_s") SIX("visibility_s_sum/rays_total") SIX("motion_s/motion_steps")
                         SIX("query_boxes/query_rays") SIX(
                             "query_triangles/query_rays") "disturbed\tundisturbed_n\tundisturbed_wall_s_"
                                                           "median\tundisturbed_wall_s_low\tundisturbed_wall_s_high\t"
                                                           "environment\n";
    assert_memory_equal(text, header, sizeof header - 1);
    size_t columns = fixture_count(header, "\t");
    assert_int_equal(fixture_count(text, "\t"), 4 * columns);
    free(text);
    study_destroy(s);
}

/* The summary of a real run, in a locale with a decimal comma if the system has one. */
static void decimal_points_do_not_depend_on_the_locale(void **state)
{
    const fixture *f = *state;
    setlocale(LC_ALL, "de_DE.UTF-8");
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nset: {ball.ior: 1.25}\ngrid: [{render.min_weight: "
                                "[0.5, 0.25]}]\nrepetitions: 2\n");
    fixture_run(f, s);
    char *text = summary_of(f, s), *rows = fixture_text(f, "results/test/rows.csv"),
         *manifest = fixture_text(f, "results/test/runs.json");
    assert_null(strchr(text, ','));
    assert_string_equal(field(text, 2, "render.min_weight"), "0.25");
    size_t commas = 0;
    for (const char *c = rows; *c != '\n'; c++)
        commas += *c == ',';
    assert_int_equal(fixture_count(rows, ","), commas * fixture_count(rows, "\n"));
    assert_non_null(strstr(manifest, "\"wall_tick_s\": "));
    free(text);
    free(rows);
    free(manifest);
    study_destroy(s);
    setlocale(LC_ALL, "C");
}

/* Spread: any column by cell, quotients row by row. The rows are those of a run, whose counts of rays
 * are the same in every repetition. */

static char *spread(const fixture *f, const study *s, const char *columns, status expected)
{
    char *text = NULL;
    size_t size = 0;
    diagnostic why = {.line = 0};
    FILE *out = open_memstream(&text, &size);
    const status code = study_spread(s, f->results, columns, &(summary_options){0}, out, NULL, &why);
    assert_int_equal(fclose(out), 0);
    if (code != expected)
        fail_msg("%s: %s", columns, why.what);
    return text;
}

/* A field of a line of the text, both from 0. */
static const char *column_of(const char *text, int line, int column)
{
    static char copy[200];
    for (; line > 0; line--)
        text += strcspn(text, "\n") + 1;
    for (; column > 0; column--)
        text += strcspn(text, "\t\n") + 1;
    snprintf(copy, sizeof copy, "%.*s", (int)strcspn(text, "\t\n"), text);
    return copy;
}

static void each_cell_has_a_line_for_each_column(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid:\n  - {render.depth: [0, 1]}\nrepetitions: 6\n"
                                "warmups: 1\n");
    assert_int_equal(fixture_run(f, s), 14);
    char *text = spread(f, s, "rays_total,rays_total/rays_camera", STATUS_OK);
    assert_int_equal(fixture_count(text, "\n"), 1 + 2 * 2);
    char path[400];
    csv *table = NULL;
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    for (int cell = 0; cell < 2; cell++) {
        double rays = 0.0, camera = 0.0;
        for (size_t row = 0; row < table->row_count; row++)
            if (csv_field_real(table, row, csv_column(table, "cell")) == cell) {
                rays = csv_field_real(table, row, csv_column(table, "rays_total"));
                camera = csv_field_real(table, row, csv_column(table, "rays_camera"));
            }
        for (int quotient = 0; quotient < 2; quotient++) {
            const int line = 1 + 2 * cell + quotient;
            const double expected = quotient ? rays / camera : rays;
            assert_int_equal(atoi(column_of(text, line, 0)), cell);
            assert_string_equal(column_of(text, line, 3), quotient ? "rays_total/rays_camera" : "rays_total");
            assert_string_equal(column_of(text, line, 4), "6"); /* without the warm-up */
            for (int column = 5; column < 10; column++)
                assert_true(fabs(atof(column_of(text, line, column)) - expected) <= 1e-6 * expected);
        }
    }
    csv_destroy(table);
    free(text);
    free(spread(f, s, "rays_total,nothing", STATUS_BAD_INPUT));
    free(spread(f, s, "rays_total/nothing", STATUS_BAD_INPUT));
    free(spread(f, s, "rays_total,,cpu_s", STATUS_BAD_INPUT));
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_summary_has_medians_and_their_intervals, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(columns_are_in_the_expected_order, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(decimal_points_do_not_depend_on_the_locale, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(each_cell_has_a_line_for_each_column, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
