/* Tests of what a run would measure and keep, how long it would take, and how much it would write. */
#include "base/cancel.h"
#include "measure/clock.h"
#include "study/rows/row_files.h"
#include "study/run/estimate.h"
#include "study_fixture.h"

static study_estimate estimate_part(const fixture *f, const study *s, long shard, long shards)
{
    diagnostic why = {0};
    study_estimate e;
    const study_options options = {.results = f->results, .shard = shard, .shards = shards};
    if (study_estimate_run(s, &options, &e, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    return e;
}

static study_estimate estimate(const fixture *f, const study *s)
{
    return estimate_part(f, s, 0, 1);
}

static void a_new_study_is_tried_and_nothing_is_written(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid:\n  - {render.depth: [0, 1, 2]}\n"
                                "  - {ball.ior: [1.3, 1.5]}\nrepetitions: 4\nwarmups: 2\n"
                                "reference: {render.depth: 9}\nkeep: {image: on, pixel_rays: on}\n");
    const study_estimate e = estimate(f, s);
    assert_true(e.cells == 6 && e.cells_lacking == 6 && e.rows_least == 24 && e.rows_most == 24);
    assert_true(e.warmups == 12 && e.cells_to_keep == 6 && e.files == 18 && e.comparisons == 6);
    assert_true(e.from_rows == 0 && e.from_trials == 6 && e.from_others == 0 && !e.cut);
    assert_true(e.least_s > 0 && e.least_s == e.most_s);
    assert_false(fixture_has(f, "results"));
    const study_estimate half = estimate_part(f, s, 1, 4); /* 6 cells over 4 parts: 2, 2, 1, 1 */
    assert_true(half.cells == 2 && half.rows_most == 8 && half.warmups == 4 && half.files == 6);
    assert_int_equal(fixture_run(f, s), 36);
    const study_estimate none = estimate(f, s);
    assert_true(none.cells == 6 && none.cells_lacking == 0 && none.rows_most == 0 && none.warmups == 0);
    assert_true(none.cells_to_keep == 0 && none.files == 0 && none.comparisons == 0 && none.most_s == 0);
    assert_true(none.from_rows == 0 && none.from_trials == 0);
    study_destroy(s);
}

/* The estimate of a cell with rows is their mean times the missing frames. */
static void existing_rows_are_the_basis(void **state)
{
    const fixture *f = *state;
    const char *grid = "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1, 2]}]\nwarmups: 1\n";
    char text[400];
    snprintf(text, sizeof text, "%srepetitions: 2\n", grid);
    study *s = fixture_study(f, text);
    row_files *files = NULL;
    assert_int_equal(fixture_run(f, s), 9);
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    double sum_s = 0;
    for (size_t i = 0; i < files->row_count; i++)
        sum_s += files->rows[i].warmup ? 0 : row_field_real(&files->rows[i], "wall_s");
    row_files_destroy(files);
    study_destroy(s);

    snprintf(text, sizeof text, "%srepetitions: 5\n", grid);
    s = fixture_study(f, text);
    study_estimate e = estimate(f, s);
    assert_true(e.cells_lacking == 3 && e.rows_least == 9 && e.warmups == 3 && e.files == 0);
    assert_true(e.from_rows == 3 && e.from_trials == 0);
    const double expected_s = sum_s / 2 * 4; /* a warm-up and three repetitions of each cell */
    assert_true(fabs(e.most_s - expected_s) < 1e-9 * expected_s);
    study_destroy(s);

    /* A narrow interval may end a cell after any further row; two rows of equal time would end it before one. */
    snprintf(text, sizeof text, "%srepetitions: {min: 3, max: 50, relative_width: 0.0000001}\n", grid);
    s = fixture_study(f, text);
    e = estimate(f, s);
    assert_true(e.cells_lacking == 3 && e.rows_least == 3 && e.rows_most == 144);
    assert_true(fabs(e.least_s - sum_s / 2 * 2) < 1e-9 && fabs(e.most_s - sum_s / 2 * 49) < 1e-9 * e.most_s);
    study_destroy(s);
}

static void estimate_parts(const fixture *f, const study *s, study_options options, bool tries, study_estimate *out)
{
    diagnostic why = {0};
    options.results = f->results;
    if (study_estimate_parts(s, &options, tries, out, &why) != STATUS_OK)
        fail_msg("%s", why.what);
}

/* As the parts themselves would say it, each with its own trials. */
static void parts_lack_what_their_shards_lack(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid:\n  - {render.depth: [0, 1, 2]}\n"
                                "  - {ball.ior: [1.3, 1.5]}\nrepetitions: 4\nwarmups: 1\n");
    study_estimate parts[4];
    estimate_parts(f, s, (study_options){.shards = 4}, true, parts);
    for (long i = 0; i < 4; i++) { /* 6 cells over 4 parts: 2, 2, 1, 1 */
        assert_true(parts[i].cells == (i < 2 ? 2 : 1) && parts[i].cells_lacking == parts[i].cells);
        assert_true(parts[i].rows_most == 4 * parts[i].cells && parts[i].most_s > 0 && !parts[i].cut);
    }
    size_t ran = 0;
    assert_int_equal(study_run(s, &(study_options){.results = f->results, .shard = 2, .shards = 4}, &ran, NULL),
                     STATUS_OK);
    estimate_parts(f, s, (study_options){.shards = 4}, false, parts);
    for (long i = 0; i < 4; i++)
        assert_true(i == 2 ? parts[i].cells_lacking == 0 && parts[i].most_s == 0 : isnan(parts[i].most_s));
    estimate_parts(f, s, (study_options){.shards = 4, .environment = "another"}, false, parts);
    assert_int_equal(parts[2].cells_lacking, 1);
    study_destroy(s);
}

/* Each of two parts of the repetitions measures two of every cell; the rows of one show the time of the other. */
static void parts_of_the_repetitions(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1, 2]}]\n"
                                "repetitions: 4\nwarmups: 0\n");
    study_estimate parts[2];
    study_options half = {.results = f->results, .shard = 1, .shards = 2, .by_repetition = true};
    size_t ran = 0;
    assert_int_equal(study_run(s, &half, &ran, NULL), STATUS_OK);
    assert_int_equal(ran, 6);
    estimate_parts(f, s, half, false, parts);
    assert_true(parts[0].cells_lacking == 3 && parts[0].rows_most == 6 && parts[0].most_s > 0);
    assert_true(parts[1].cells_lacking == 0 && parts[1].most_s == 0);
    study_destroy(s);
}

/* Trial frames have a hundredth of the pixels; the estimate is for all of them. */
static void trial_frames_predict_the_time_of_large_ones(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nset: {render.width: 1600, render.height: 1200}\n"
                                "grid: [{render.depth: [2, 6]}]\nrepetitions: 2\nwarmups: 0\n");
    const study_estimate e = estimate(f, s);
    assert_true(e.from_trials == 2 && e.cells_lacking == 2 && e.rows_most == 4);
    assert_true(isfinite(e.most_s) && e.most_s > 0);
    study_destroy(s);
}

static void a_cell_that_takes_too_long_is_unknown(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.paths: [1048575, 1048576]}]\n"
                                "set: {render.integrator: path, render.width: 800, render.height: 600}\n");
    const study_estimate e = estimate(f, s);
    assert_true(e.cut && isnan(e.least_s) && isnan(e.most_s) && e.from_trials == 0 && e.from_others == 0);
    assert_int_equal(e.rows_most, 12);
    study_destroy(s);
}

static void a_stop_request_ends_the_trials(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\n");
    study_estimate e;
    const study_options options = {.results = f->results};
    cancel_token token = {.ask = NULL};
    cancel_set(&token);
    cancel_begin(&token);
    assert_int_equal(study_estimate_run(s, &options, &e, NULL), STATUS_INTERRUPTED);
    cancel_end(&token);
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

/* What a study is going to write: bytes at least and at most, and the lines of `study run --dry-run`. */

/* What nothing of the study exists of, without trial frames. */
static disk_room needed_by(const fixture *f, const char *more)
{
    char text[400];
    snprintf(text, sizeof text, "study: test\nscene: scene.yaml\nset: {render.width: 400, render.height: 300}\n%s",
             more);
    study *s = fixture_study(f, text);
    study_estimate e;
    diagnostic why = {0};
    const study_options options = {.results = f->results, .shards = 1};
    if (study_estimate_parts(s, &options, false, &e, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    study_destroy(s);
    return e.needed;
}

/* A value has at least a digit and a comma, and at most the 17 digits of a number, its sign, point and exponent. */
static void rows_have_their_columns(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\n");
    char *header = row_file_header(s, ROWS);
    const double columns = 1.0 + (double)fixture_count(header, ",");
    free(header);
    study_destroy(s);
    const disk_room two = needed_by(f, "repetitions: 2\nwarmups: 0\n"),
                    five = needed_by(f, "repetitions: 5\nwarmups: 0\n");
    assert_true(five.least_bytes - two.least_bytes == 3 * columns * 2);
    assert_true(five.most_bytes - two.most_bytes >= 3 * columns * 2 &&
                five.most_bytes - two.most_bytes <= 3 * columns * 24);
}

/* An image of noise cannot be compressed; a reference has three numbers of four bytes a pixel. */
static void images_have_their_pixels(void **state)
{
    const fixture *f = *state;
    const double pixels = 400 * 300, without = needed_by(f, "repetitions: 2\n").most_bytes;
    const double image = needed_by(f, "repetitions: 2\nkeep: {image: on}\n").most_bytes - without;
    const double compared = needed_by(f, "repetitions: 2\nreference: {render.depth: 9}\n").most_bytes - without;
    assert_true(image >= 3 * pixels && image <= 8 * pixels);
    assert_true(compared >= 12 * pixels && compared <= 32 * pixels);
}

static void kept_files_have_a_line(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nkeep: {image: on}\n");
    const study_estimate e = {.cells = 4, .cells_to_keep = 4, .files = 4, .free_bytes = NAN, .least_s = 2, .most_s = 2};
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    study_estimate_write(out, s, "results", &e);
    fclose(out);
    assert_non_null(strstr(text, "test: 4 files to keep in results/test/images: CELL.png\ntest: "));
    for (const char *line = text; *line; line = strchr(line, '\n') + 1)
        assert_int_equal(strncmp(line, "test: ", 6), 0);
    free(text);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(a_new_study_is_tried_and_nothing_is_written),
        CASE(parts_lack_what_their_shards_lack),
        CASE(parts_of_the_repetitions),
        CASE(existing_rows_are_the_basis),
        CASE(trial_frames_predict_the_time_of_large_ones),
        CASE(a_cell_that_takes_too_long_is_unknown),
        CASE(a_stop_request_ends_the_trials),
        CASE(rows_have_their_columns),
        CASE(images_have_their_pixels),
        CASE(kept_files_have_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
