/* Tests of what a study is going to write: bytes at least and at most, and the lines of `study run --dry-run`. */
#include "study_fixture.h"

#include "study/run/estimate.h"
#include "study/rows/row_files.h"

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

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(rows_have_their_columns),
        CASE(images_have_their_pixels),
        CASE(kept_files_have_a_line),
    };
    return cmocka_run_group_tests_name("study_room", tests, NULL, NULL);
}
