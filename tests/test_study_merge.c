/* Tests of a study's shards: partition of the cells, merging, duplicate and incomplete rows. */
#include "study_fixture.h"
#include "base/csv.h"

static const char study_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid:\n"
                                 "  - {render.depth: [0, 1, 2]}\n"
                                 "  - {ball.ior: [1.1, 1.2, 1.3]}\n"
                                 "repetitions: 2\n"
                                 "warmups: 0\n"
                                 "keep: {workers: on, image: on}\n";

static size_t run_part(const study *s, study_options options)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    size_t ran = 0;
    if (study_run(s, &options, &ran, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return ran;
}

static size_t run_shard(const fixture *f, const study *s, long shard, long shards)
{
    return run_part(s, (study_options){.results = f->results, .shard = shard, .shards = shards});
}

static size_t merge(const fixture *f, const study *s)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    size_t rows = 0;
    if (study_merge(s, f->results, &rows, NULL, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return rows;
}

static void shards_partition_the_cells(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    size_t ran = 0;
    for (long shard = 0; shard < 4; shard++) {
        size_t part = run_shard(f, s, shard, 4);
        assert_true(part == 4 || part == 6); /* 9 cells over 4 shards: 3, 2, 2, 2 */
        ran += part;
    }
    assert_int_equal(ran, 18);
    assert_false(fixture_has(f, "results/test/rows.csv"));
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.cells_done, 9);
    assert_int_equal(progress.rows, 18);
    for (int cell = 0; cell < 9; cell++) {
        char name[64];
        snprintf(name, sizeof name, "results/test/images/%04d.png", cell);
        assert_true(fixture_has(f, name));
    }
    study_destroy(s);
}

static void merging_keeps_every_row(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    for (long shard = 0; shard < 2; shard++)
        run_shard(f, s, shard, 2);
    char *parts[2] = {fixture_text(f, "results/test/rows.shard-0-of-2.csv"),
                      fixture_text(f, "results/test/rows.shard-1-of-2.csv")};
    assert_int_equal(merge(f, s), 18);
    char *joined = fixture_text(f, "results/test/rows.csv");
    /* Header and lines, unchanged. */
    const char *second = strchr(parts[1], '\n') + 1;
    assert_int_equal(strlen(joined), strlen(parts[0]) + strlen(second));
    assert_memory_equal(joined, parts[0], strlen(parts[0]));
    assert_string_equal(joined + strlen(parts[0]), second);
    char *workers = fixture_text(f, "results/test/workers.csv");
    assert_int_equal(fixture_count(workers, "\n"), 19);
    /* Again: no duplicates, and the study is complete for every process. */
    assert_int_equal(merge(f, s), 18);
    char *again = fixture_text(f, "results/test/rows.csv");
    assert_string_equal(joined, again);
    assert_int_equal(run_shard(f, s, 0, 1), 0);
    assert_int_equal(run_shard(f, s, 2, 3), 0);
    free(parts[0]);
    free(parts[1]);
    free(joined);
    free(again);
    free(workers);
    study_destroy(s);
}

/* A run without shards measures what the shards left. */
static void a_run_without_shards_counts_the_rows_of_shards(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    size_t part = run_shard(f, s, 1, 3);
    assert_int_equal(part, 6);
    assert_int_equal(run_shard(f, s, 0, 1), 12);
    assert_int_equal(merge(f, s), 18);
    assert_int_equal(merge(f, s), 18);
    study_destroy(s);
}

/* Merged rows are twice on disk, and still those of their shard. */
static void merged_repetitions_are_not_measured_again(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    study_options part = {.results = f->results, .shards = 2, .by_repetition = true};
    for (part.shard = 0; part.shard < 2; part.shard++)
        assert_int_equal(run_part(s, part), 9);
    assert_int_equal(merge(f, s), 18);
    for (part.shard = 0; part.shard < 2; part.shard++)
        assert_int_equal(run_part(s, part), 0);
    study_destroy(s);
}

static void incomplete_rows_of_shards_are_dropped(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    run_shard(f, s, 0, 2);
    run_shard(f, s, 1, 2);
    char *part = fixture_text(f, "results/test/rows.shard-1-of-2.csv");
    part[strlen(part) - 5] = 0;
    fixture_write(f, "results/test/rows.shard-1-of-2.csv", part);
    free(part);
    assert_int_equal(merge(f, s), 17);
    assert_true(fixture_has(f, "results/test/rows.shard-1-of-2.torn.csv"));
    /* The worker rows of the incomplete row still exist, but it is measured again, and they must not be duplicated. */
    assert_int_equal(run_shard(f, s, 1, 2), 1);
    assert_int_equal(merge(f, s), 18);
    study_destroy(s);
}

static void contradictory_rows_are_errors(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    run_shard(f, s, 0, 1);
    char *rows = fixture_text(f, "results/test/rows.csv");
    char *digit = rows + strlen(rows) - 2; /* the last digit of the row's check */
    *digit = *digit == '0' ? '1' : '0';
    fixture_write(f, "results/test/rows.shard-0-of-2.csv", rows);
    free(rows);
    diagnostic why = {0};
    size_t count;
    assert_int_equal(study_merge(s, f->results, &count, NULL, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "duplicate row"));
    assert_non_null(strstr(why.file, "rows.shard-0-of-2.csv"));
    assert_int_equal(why.line, 19);
    study_destroy(s);
}

/* One repetition twice in one file counts once, and is a fault; a person must decide before a merge. */
static void duplicate_rows_in_a_file_are_faults(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    run_shard(f, s, 0, 1);
    char *rows = fixture_text(f, "results/test/rows.csv");
    char *last = rows + strlen(rows) - 1;
    while (last[-1] != '\n')
        last--;
    char *twice = calloc(1, strlen(rows) + strlen(last) + 1);
    strcat(strcat(twice, rows), last);
    fixture_write(f, "results/test/rows.csv", twice);
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.faults, 2); /* it is twice there, and not after the row that its check names */
    assert_int_equal(progress.rows, 18);
    assert_int_equal(study_merge(s, f->results, NULL, NULL, NULL), STATUS_BAD_INPUT);
    free(twice);
    free(rows);
    study_destroy(s);
}

static void edited_rows_are_not_used(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    run_shard(f, s, 0, 1);
    char *rows = fixture_text(f, "results/test/rows.csv");
    char *line = strchr(rows, '\n') + 1;
    char *cell = strchr(strchr(line, ',') + 1, ',') + 1;
    *cell = '9'; /* there are cells 0 to 8 */
    fixture_write(f, "results/test/rows.csv", rows);
    free(rows);
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.faults, 1);
    assert_int_equal(progress.fault.line, 2);
    assert_int_equal(progress.rows, 17);
    study_destroy(s);
}

static void merging_without_rows_is_an_error(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    assert_int_equal(merge(f, s), 0);
    assert_false(fixture_has(f, "results/test/rows.csv"));
    study_destroy(s);
}

static void invalid_shards_are_refused(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    static const long wrong[][2] = {{2, 2}, {-1, 2}, {5, 3}};
    for (size_t i = 0; i < 3; i++) {
        size_t ran;
        study_options options = {.results = f->results, .shard = wrong[i][0], .shards = wrong[i][1]};
        assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_BAD_INPUT);
    }
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shards_partition_the_cells, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(merging_keeps_every_row, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_run_without_shards_counts_the_rows_of_shards, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(merged_repetitions_are_not_measured_again, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(incomplete_rows_of_shards_are_dropped, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(contradictory_rows_are_errors, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(duplicate_rows_in_a_file_are_faults, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(edited_rows_are_not_used, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(merging_without_rows_is_an_error, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(invalid_shards_are_refused, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("study_merge", tests, NULL, NULL);
}
