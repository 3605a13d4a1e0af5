/* Tests of render.threads=auto in studies: a value like any other, whose rows have the number of workers. */
#include "study_fixture.h"

#include "study/rows/row_files.h"
#include <sched.h>

static const char text[] = "study: test\nscene: scene.yaml\nset: {render.pool: off}\n"
                           "grid: [{render.threads: [1, auto]}]\nrepetitions: 2\nwarmups: 0\n";

static void rows_keep_the_word_and_have_the_number(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, text);
    row_files *files = NULL;
    cpu_set_t units;
    assert_int_equal(sched_getaffinity(0, sizeof units, &units), 0);
    assert_int_equal(study_cell_film(s, 1), 0); /* performance only */
    assert_int_equal(fixture_run(f, s), 4);
    assert_int_equal(fixture_run(f, s), 0); /* the rows are those of the cells */
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    assert_int_equal(files->row_count, 4);
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        assert_string_equal(row_field(ref, "render.threads"), ref->cell ? "auto" : "1");
        assert_true(row_field_real(ref, "workers") == (ref->cell ? CPU_COUNT(&units) : 1));
        assert_string_equal(row_field(ref, "marked"), "0");
    }
    row_files_destroy(files);
    study_destroy(s);
}

/* On one processing unit, auto and 1 start as many workers and stay two cells with names of their own. */
static void the_cell_is_the_same_on_any_machine(void **state)
{
    const fixture *f = *state;
    study *here = fixture_study(f, text), *there = NULL;
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    size_t unit = 0;
    while (!CPU_ISSET(unit, &all))
        unit++;
    CPU_ZERO(&one);
    CPU_SET(unit, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    there = fixture_study(f, text);
    assert_int_equal(study_cell_count(there), study_cell_count(here));
    assert_memory_equal(there->identity, here->identity, study_cell_count(here) * sizeof *here->identity);
    assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
    study_destroy(there);
    study_destroy(here);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rows_keep_the_word_and_have_the_number, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(the_cell_is_the_same_on_any_machine, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
