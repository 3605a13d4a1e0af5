/* Tests of the order of a study's cells, and of its shards. */
#include "base/csv.h"
#include "study/plan/grid.h"
#include "study_fixture.h"

/* A study's shards: partition of the cells, merging, duplicate and incomplete rows. */

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
    char *digit = rows + strlen(rows) - 2; /* the last digit of the row's checksum */
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
    assert_int_equal(progress.faults, 2); /* it is twice there, and not after the row that its checksum names */
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

/* The shuffled order of cells: it depends on seed and stream only, and is uniformly distributed. */

enum { COUNT = 50 };

static void every_cell_occurs_once(void **state)
{
    (void)state;
    for (uint64_t stream = 0; stream < 100; stream++) {
        size_t order[COUNT];
        bool seen[COUNT] = {false};
        order_shuffle(7, stream, order, COUNT);
        for (size_t i = 0; i < COUNT; i++) {
            assert_true(order[i] < COUNT && !seen[order[i]]);
            seen[order[i]] = true;
        }
    }
}

static void orders_depend_on_seed_and_stream(void **state)
{
    (void)state;
    size_t a[COUNT], b[COUNT];
    order_shuffle(1, 0, a, COUNT);
    order_shuffle(1, 0, b, COUNT);
    assert_memory_equal(a, b, sizeof a);
    static const uint64_t other[][2] = {
        {1, 1}, {2, 0}, {UINT64_C(1) << 32 | 1, 0}, {1, UINT64_C(1) << 32}, {1, ORDER_STREAM_SHARDS}};
    for (size_t i = 0; i < sizeof other / sizeof other[0]; i++) {
        order_shuffle(other[i][0], other[i][1], b, COUNT);
        assert_memory_not_equal(a, b, sizeof a);
    }
}

/* The order of a published study must never change: expected values recorded once. */
static void the_orders_of_published_studies_do_not_change(void **state)
{
    (void)state;
    static const size_t known[9] = {7, 4, 5, 0, 6, 8, 2, 1, 3};
    size_t order[9];
    order_shuffle(1, 0, order, 9);
    assert_memory_equal(order, known, sizeof known);
}

/* 4! orders, 24000 draws: chi squared with 23 degrees of freedom exceeds 49.7 for one in 1000 seeds. */
static void orders_are_uniformly_distributed(void **state)
{
    (void)state;
    unsigned count[256] = {0};
    for (uint64_t stream = 0; stream < 24000; stream++) {
        size_t order[4];
        order_shuffle(12345, stream, order, 4);
        count[order[0] << 6 | order[1] << 4 | order[2] << 2 | order[3]]++;
    }
    double chi_squared = 0;
    size_t kinds = 0;
    for (size_t i = 0; i < 256; i++)
        if (count[i]) {
            double off = (double)count[i] - 1000;
            chi_squared += off * off / 1000;
            kinds++;
        }
    assert_int_equal(kinds, 24);
    assert_true(chi_squared < 49.7);
}

static void orders_of_no_and_one_cell(void **state)
{
    (void)state;
    size_t order[1] = {99};
    order_shuffle(1, 0, order, 0);
    assert_int_equal(order[0], 99);
    order_shuffle(1, 0, order, 1);
    assert_int_equal(order[0], 0);
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
        cmocka_unit_test(every_cell_occurs_once),
        cmocka_unit_test(orders_depend_on_seed_and_stream),
        cmocka_unit_test(the_orders_of_published_studies_do_not_change),
        cmocka_unit_test(orders_are_uniformly_distributed),
        cmocka_unit_test(orders_of_no_and_one_cell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
