/* Tests of comparisons of a study's cells with its reference image. */
#include "base/csv.h"
#include "image/compare.h"
#include "render/frame/renderer.h"
#include "scene/model/params.h"
#include "study/summary/summary.h"
#include "study_fixture.h"
#include <dirent.h>

/* Depths 0 and 2 with one and two threads, all compared with depth 2. */
static const char depth_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid:\n"
                                 "  - {render.depth: [0, 2]}\n"
                                 "  - {render.threads: [1, 2]}\n"
                                 "reference: {render.depth: 2}\n"
                                 "repetitions: 2\n"
                                 "warmups: 0\n";

static csv *read_table(const fixture *f, const char *name)
{
    char path[400];
    csv *table = NULL;
    fixture_path(f, name, path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_non_null(table);
    return table;
}

/* The row of a cell, which must occur once. */
static size_t row_of(const csv *table, int cell)
{
    size_t found = SIZE_MAX;
    for (size_t i = 0; i < table->row_count; i++)
        if ((int)csv_field_real(table, i, csv_column(table, "cell")) == cell) {
            assert_true(found == SIZE_MAX);
            found = i;
        }
    assert_true(found != SIZE_MAX);
    return found;
}

static const char *text_of(const csv *table, int cell, const char *name)
{
    assert_true(csv_column(table, name) >= 0);
    return csv_field(table, row_of(table, cell), csv_column(table, name));
}

static double real_of(const csv *table, int cell, const char *name)
{
    return csv_field_real(table, row_of(table, cell), csv_column(table, name));
}

static size_t files_in(const fixture *f, const char *name, const char *ending)
{
    char path[400];
    size_t count = 0;
    fixture_path(f, name, path);
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        size_t length = strlen(entry->d_name), tail = strlen(ending);
        count += length > tail && strcmp(entry->d_name + length - tail, ending) == 0;
    }
    closedir(folder);
    return count;
}

/* The image of the fixture's scene at that depth, without a study. */
static image *image_at(const fixture *f, const char *depth)
{
    char path[400];
    scene *s = NULL;
    renderer *r = NULL;
    render_result *frame = NULL;
    image *img = NULL;
    isa level;
    fixture_path(f, "scene.yaml", path);
    assert_int_equal(isa_choose(&level, NULL), STATUS_OK);
    assert_int_equal(scene_read(path, &s, NULL), STATUS_OK);
    assert_int_equal(scene_set(s, "render.depth", depth, NULL), STATUS_OK);
    assert_int_equal(renderer_create(level, NULL, &r, NULL), STATUS_OK);
    assert_int_equal(renderer_render(r, s, &(render_options){0}, &frame, NULL), STATUS_OK);
    assert_int_equal(film_image(frame->img, &img, NULL), STATUS_OK);
    render_result_destroy(frame);
    renderer_destroy(r);
    scene_destroy(s);
    return img;
}

static void an_image_does_not_differ_from_itself(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    csv *table = read_table(f, "results/test/compare.csv");
    assert_int_equal(table->row_count, 4);
    for (int cell = 2; cell < 4; cell++) {
        assert_string_equal(text_of(table, cell, "mse"), "0");
        assert_string_equal(text_of(table, cell, "psnr_db"), "NA");
        assert_string_equal(text_of(table, cell, "ssim"), "1");
        assert_string_equal(text_of(table, cell, "flip"), "0");
        assert_string_equal(text_of(table, cell, "error_rms"), "0");
        assert_string_equal(text_of(table, cell, "differing_fraction"), "0");
        assert_string_equal(text_of(table, cell, "noise_rms"), "NA");
        assert_string_equal(text_of(table, cell, "film_hash"), text_of(table, cell, "reference_film"));
    }
    csv_destroy(table);
    study_destroy(s);
}

/* The measures of two films rendered without a study; the rms by its definition. */
static void differences_equal_those_of_the_films(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    csv *table = read_table(f, "results/test/compare.csv");
    image *shallow = image_at(f, "0"), *deep = image_at(f, "2");
    image_comparison metrics;
    assert_int_equal(image_compare(shallow, deep, &metrics, NULL), STATUS_OK);
    assert_true(metrics.mse > 0 && metrics.flip > 0 && metrics.ssim < 1);
    assert_true(real_of(table, 0, "mse") == metrics.mse);
    assert_true(real_of(table, 0, "psnr_db") == metrics.psnr_db);
    assert_true(real_of(table, 0, "ssim") == metrics.ssim);
    assert_true(real_of(table, 0, "flip") == metrics.flip);
    assert_true(real_of(table, 0, "largest") == metrics.largest);
    assert_true(real_of(table, 0, "differing_fraction") == metrics.differing_fraction);
    double sum = 0;
    for (size_t i = 0; i < 24 * 18 * 3; i++)
        sum +=
            ((double)shallow->pixel[i] - (double)deep->pixel[i]) * ((double)shallow->pixel[i] - (double)deep->pixel[i]);
    assert_true(fabs(real_of(table, 0, "error_rms") - sqrt(sum / (24 * 18 * 3))) < 1e-15);
    image_destroy(shallow);
    image_destroy(deep);
    csv_destroy(table);
    study_destroy(s);
}

static void cells_share_the_reference_of_one_scene(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    assert_int_equal(files_in(f, "results/test/references", ".pfm"), 1);
    assert_int_equal(files_in(f, "results/test/references", ".json"), 1);
    assert_int_equal(files_in(f, "results/test/references", ".png"), 0);
    csv *table = read_table(f, "results/test/compare.csv");
    for (int cell = 1; cell < 4; cell++)
        assert_string_equal(text_of(table, cell, "reference"), text_of(table, 0, "reference"));
    csv_destroy(table);
    study_destroy(s);
    /* The axis changes the ball, so each value has its own reference. */
    s = fixture_study(f, "study: balls\nscene: scene.yaml\ngrid: [{ball.ior: [1.2, 1.4]}, {render.threads: [1, 2]}]\n"
                         "reference: {render.depth: 3}\nrepetitions: 1\nwarmups: 0\nkeep: {image: on}\n");
    fixture_run(f, s);
    assert_int_equal(files_in(f, "results/balls/references", ".pfm"), 2);
    assert_int_equal(files_in(f, "results/balls/references", ".png"), 2);
    study_destroy(s);
}

static void existing_comparisons_are_not_repeated(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    char *complete = fixture_text(f, "results/test/compare.csv");
    assert_int_equal(fixture_run(f, s), 0);
    char *again = fixture_text(f, "results/test/compare.csv");
    assert_string_equal(complete, again);
    free(again);
    /* With the first cell's row and an incomplete one left, the others are made, the rows stay, and no reference is
     * rendered. */
    char reference_path[400], cut[4096];
    struct stat before, after;
    char *line = strchr(strchr(complete, '\n') + 1, '\n') + 1;
    snprintf(cut, sizeof cut, "%.*stest,0123", (int)(line - complete), complete);
    fixture_write(f, "results/test/compare.csv", cut);
    csv *table = read_table(f, "results/test/compare.csv");
    snprintf(reference_path, sizeof reference_path, "%s/test/references/%s.pfm", f->results,
             csv_field(table, 0, csv_column(table, "reference")));
    csv_destroy(table);
    assert_int_equal(stat(reference_path, &before), 0);
    char *rows = fixture_text(f, "results/test/rows.csv");
    assert_int_equal(fixture_run(f, s), 0);
    char *rows_now = fixture_text(f, "results/test/rows.csv");
    again = fixture_text(f, "results/test/compare.csv");
    assert_string_equal(rows, rows_now);
    assert_int_equal(strlen(again), strlen(complete));
    assert_memory_equal(again, complete, (size_t)(line - complete));
    assert_int_equal(stat(reference_path, &after), 0);
    assert_true(before.st_ino == after.st_ino && before.st_mtim.tv_nsec == after.st_mtim.tv_nsec);
    assert_true(fixture_has(f, "results/test/compare.torn.csv"));
    free(rows);
    free(rows_now);
    free(again);
    free(complete);
    study_destroy(s);
}

static void a_damaged_reference_image_is_detected(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    csv *table = read_table(f, "results/test/compare.csv");
    char path[500];
    snprintf(path, sizeof path, "%s/test/references/%s.pfm", f->results, text_of(table, 0, "reference"));
    csv_destroy(table);
    FILE *file = fopen(path, "r+");
    assert_non_null(file);
    fseek(file, -4, SEEK_END);
    fputc(1, file);
    fclose(file);
    char compare[400];
    fixture_path(f, "results/test/compare.csv", compare);
    assert_int_equal(remove(compare), 0);
    diagnostic why = {0};
    study_options options = {.results = f->results};
    assert_int_equal(study_run(s, &options, NULL, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, path);
    assert_int_equal(remove(path), 0);
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
}

static char *summary_of(const fixture *f, const study *s)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(study_summary(s, f->results, out, NULL), STATUS_OK);
    fclose(out);
    return text;
}

/* Comparisons with another reference stay, and are not those of the study. */
static void a_changed_reference_repeats_comparisons_but_no_measurements(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    char *before = summary_of(f, s);
    study_destroy(s);
    char text[sizeof depth_text];
    strcpy(text, depth_text);
    *(strstr(text, "reference: {render.depth: 2}") + strlen("reference: {render.depth: ")) = '3';
    s = fixture_study(f, text);
    assert_int_equal(fixture_run(f, s), 0);
    csv *table = read_table(f, "results/test/compare.csv");
    assert_int_equal(table->row_count, 8);
    csv_destroy(table);
    assert_int_equal(files_in(f, "results/test/references", ".pfm"), 2);
    char *after = summary_of(f, s);
    assert_string_not_equal(after, before);
    free(after);
    study_destroy(s);
    s = fixture_study(f, depth_text);
    assert_int_equal(fixture_run(f, s), 0);
    after = summary_of(f, s);
    assert_string_equal(after, before);
    free(before);
    free(after);
    study_destroy(s);
}

static void shards_compare_their_cells(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    for (long shard = 0; shard < 3; shard++) {
        study_options options = {.results = f->results, .shard = shard, .shards = 3};
        assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    }
    assert_false(fixture_has(f, "results/test/compare.csv"));
    assert_int_equal(study_merge(s, f->results, NULL, NULL, NULL), STATUS_OK);
    csv *table = read_table(f, "results/test/compare.csv");
    assert_int_equal(table->row_count, 4);
    for (int cell = 0; cell < 4; cell++)
        row_of(table, cell);
    csv_destroy(table);
    study_destroy(s);
}

static void a_summary_has_time_and_error_on_one_line(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, depth_text);
    fixture_run(f, s);
    csv *table = read_table(f, "results/test/compare.csv");
    char *text = summary_of(f, s), values[400], compare[400];
    assert_int_equal(fixture_count(text, "\treference\tmse\tpsnr_db\tssim\tflip\tlargest\tdiffering_fraction\terror_"
                                         "rms\treference_noise_rms\tdisturbed\t"),
                     1);
    char *lines = text, *line = NULL;
    for (int i = 0; i < 2; i++)
        line = strsep(&lines, "\n");
    snprintf(values, sizeof values, "\t%s\t%s\t", text_of(table, 0, "reference"), text_of(table, 0, "mse"));
    assert_non_null(strstr(line, values));
    snprintf(values, sizeof values, "\t%s\tNA\t", text_of(table, 0, "error_rms"));
    assert_non_null(strstr(line, values)); /* then disturbed rows and the environment */
    free(text);
    csv_destroy(table);
    /* Without comparisons the columns exist and are empty. */
    fixture_path(f, "results/test/compare.csv", compare);
    assert_int_equal(remove(compare), 0);
    fixture_lacks_comparisons(f, s, 4);
    study_destroy(s);
}

/* Four times as many independent paths halve the standard error, and so the error against a reference of many paths. */
static void the_error_of_random_paths_decreases_with_their_number(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\n"
                                "set: {render.integrator: path, render.depth: 6, render.sampler: philox}\n"
                                "grid: [{render.paths: [64, 256]}]\n"
                                "reference: {render.paths: 4096, render.seed: 2}\nrepetitions: 1\nwarmups: 0\n");
    fixture_run(f, s);
    csv *table = read_table(f, "results/test/compare.csv"), *rows = read_table(f, "results/test/rows.csv");
    for (int cell = 0; cell < 2; cell++) {
        double noise = real_of(table, cell, "noise_rms"), of_reference = real_of(table, cell, "reference_noise_rms");
        assert_true(real_of(rows, cell, "noise_rms") == noise);
        double expected = sqrt(noise * noise + of_reference * of_reference);
        assert_true(noise > of_reference && of_reference > 0);
        assert_true(fabs(real_of(table, cell, "error_rms") / expected - 1) < 0.25);
    }
    assert_true(fabs(real_of(table, 0, "noise_rms") / real_of(table, 1, "noise_rms") - 2) < 0.4);
    csv_destroy(table);
    csv_destroy(rows);
    study_destroy(s);
}

static void a_study_without_reference_compares_nothing(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\n");
    fixture_run(f, s);
    assert_false(fixture_has(f, "results/test/compare.csv"));
    assert_false(fixture_has(f, "results/test/references"));
    char *text = summary_of(f, s);
    assert_null(strstr(text, "\tmse"));
    free(text);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_image_does_not_differ_from_itself, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(differences_equal_those_of_the_films, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(cells_share_the_reference_of_one_scene, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(existing_comparisons_are_not_repeated, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_damaged_reference_image_is_detected, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_changed_reference_repeats_comparisons_but_no_measurements, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(shards_compare_their_cells, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_summary_has_time_and_error_on_one_line, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(the_error_of_random_paths_decreases_with_their_number, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(a_study_without_reference_compares_nothing, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("compare of studies", tests, NULL, NULL);
}
