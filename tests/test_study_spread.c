/* Tests of study/summary/summary.h: any column by cell, quotients row by row. The rows are those of a run, whose counts of rays
 * are the same in every repetition. */
#include "study_fixture.h"
#include "base/csv.h"
#include "study/summary/summary.h"

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
static const char *field(const char *text, int line, int column)
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
            assert_int_equal(atoi(field(text, line, 0)), cell);
            assert_string_equal(field(text, line, 3), quotient ? "rays_total/rays_camera" : "rays_total");
            assert_string_equal(field(text, line, 4), "6"); /* without the warm-up */
            for (int column = 5; column < 10; column++)
                assert_true(fabs(atof(field(text, line, column)) - expected) <= 1e-6 * expected);
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
        cmocka_unit_test_setup_teardown(each_cell_has_a_line_for_each_column, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
