/* Tests of study runs: repetitions, interruption and resumption, kept files, locks and full disks. */
#include "base/cancel.h"
#include "base/csv.h"
#include "base/hash.h"
#include "base/os_process.h"
#include "image/image.h"
#include "measure/clock.h"
#include "rows_fixture.h"
#include "study/run/progress.h"
#include "study_fixture.h"
#include <fcntl.h>
#include <inttypes.h>
#include <jansson.h>
#include <pthread.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>

/* The rows, read back: the numbers of warm-ups and measured repetitions of each cell. */
typedef struct tally {
    size_t rows, warmups[8], counted[8], marked;
} tally;

static tally tally_rows(const fixture *f, const char *name)
{
    tally t = {0};
    char path[400];
    csv *table = NULL;
    fixture_path(f, name, path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_non_null(table);
    assert_int_equal(table->complete_size, table->size);
    bool seen[8][64] = {{false}};
    for (t.rows = 0; t.rows < table->row_count; t.rows++) {
        size_t cell = (size_t)csv_field_real(table, t.rows, csv_column(table, "cell"));
        size_t repetition = (size_t)csv_field_real(table, t.rows, csv_column(table, "repetition"));
        assert_true(cell < 8 && repetition < 64);
        assert_false(seen[cell][repetition]);
        seen[cell][repetition] = true;
        bool warmup = csv_field_real(table, t.rows, csv_column(table, "warmup")) != 0;
        (warmup ? t.warmups : t.counted)[cell]++;
        t.marked += csv_field_real(table, t.rows, csv_column(table, "marked")) != 0;
        assert_true(csv_field_real(table, t.rows, csv_column(table, "order")) == (double)t.rows);
        assert_true(csv_field_real(table, t.rows, csv_column(table, "rays_total")) >= 24 * 18);
        assert_true(csv_field_real(table, t.rows, csv_column(table, "total_internal")) >= 0);
    }
    csv_destroy(table);
    return t;
}

/* Whether the file still starts with the earlier text, byte for byte. */
static void expect_begins(const fixture *f, const char *name, const char *earlier)
{
    char *now = fixture_text(f, name);
    assert_true(strlen(now) >= strlen(earlier));
    assert_memory_equal(now, earlier, strlen(earlier));
    free(now);
}

static void every_cell_has_its_repetitions(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    assert_int_equal(fixture_run(f, s), 6 * 4);
    tally t = tally_rows(f, "results/test/rows.csv");
    assert_int_equal(t.rows, 24);
    assert_int_equal(t.marked, 0);
    for (size_t cell = 0; cell < 6; cell++) {
        assert_int_equal(t.warmups[cell], 1);
        assert_int_equal(t.counted[cell], 3);
    }
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.cells, 6);
    assert_int_equal(progress.cells_done, 6);
    assert_int_equal(progress.rows, 24);
    assert_int_equal(progress.rows_marked, 0);
    /* 1 and 2 threads: 3 cells of 4 frames each. */
    char *workers = fixture_text(f, "results/test/workers.csv");
    assert_int_equal(fixture_count(workers, "\n"), 1 + 12 * 1 + 12 * 2);
    free(workers);
    study_destroy(s);
}

static void a_complete_study_renders_nothing_and_rewrites_nothing(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    fixture_run(f, s);
    char *rows = fixture_text(f, "results/test/rows.csv"), *manifest = fixture_text(f, "results/test/runs.json");
    assert_int_equal(fixture_run(f, s), 0);
    char *rows_now = fixture_text(f, "results/test/rows.csv"),
         *manifest_now = fixture_text(f, "results/test/runs.json");
    assert_string_equal(rows, rows_now);
    assert_string_equal(manifest, manifest_now);
    free(rows);
    free(rows_now);
    free(manifest);
    free(manifest_now);
    study_destroy(s);
}

/* Warm-ups come immediately before the first repetition of their cell, and rounds are complete: no cell gets its second
 * repetition before all have their first. */
static void rounds_are_complete_shuffled_blocks(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    fixture_run(f, s);
    char path[400];
    csv *table = NULL;
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    int cell = csv_column(table, "cell"), warmup = csv_column(table, "warmup");
    char first_order[8] = "", second_order[8] = "";
    for (size_t i = 0; i < 12; i += 2) {
        assert_string_equal(csv_field(table, i, warmup), "1");
        assert_string_equal(csv_field(table, i + 1, warmup), "0");
        assert_string_equal(csv_field(table, i, cell), csv_field(table, i + 1, cell));
        assert_null(strstr(first_order, csv_field(table, i, cell)));
        strcat(first_order, csv_field(table, i, cell));
    }
    for (size_t i = 12; i < 18; i++) {
        assert_null(strstr(second_order, csv_field(table, i, cell)));
        strcat(second_order, csv_field(table, i, cell));
    }
    assert_string_not_equal(first_order, "012345");
    assert_string_not_equal(first_order, second_order);
    csv_destroy(table);
    study_destroy(s);
}

static void without_shuffling_cells_go_in_order(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1, 2]}]\nrepetitions: "
                                "2\nwarmups: 0\norder: {shuffle: off}\n");
    fixture_run(f, s);
    char path[400];
    csv *table = NULL;
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    for (size_t i = 0; i < 6; i++)
        assert_true(csv_field_real(table, i, csv_column(table, "cell")) == (double)(i % 3));
    csv_destroy(table);
    study_destroy(s);
}

/* As the ask of a token, polled before and during each frame: stops the run after a while. */
static bool stop_soon(void *context)
{
    int *left = context;
    return --*left < 0;
}

static void an_interrupted_study_resumes(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    size_t total = 0;
    char *earlier = calloc(1, 1);
    for (int polls = 1; polls < 200; polls += 3) {
        diagnostic why = {0};
        size_t ran = 99;
        int stop_after = polls;
        const study_options options = {.results = f->results};
        status code = fixture_run_until(stop_soon, &stop_after, s, &options, &ran, &why);
        total += ran;
        expect_begins(f, "results/test/rows.csv", earlier);
        free(earlier);
        earlier = fixture_text(f, "results/test/rows.csv");
        assert_int_equal(fixture_count(earlier, "\n"), total + 1);
        if (code == STATUS_OK)
            break;
        assert_int_equal(code, STATUS_INTERRUPTED);
        assert_true(why.what[0]);
    }
    free(earlier);
    tally t = tally_rows(f, "results/test/rows.csv");
    for (size_t cell = 0; cell < 6; cell++) {
        assert_int_equal(t.counted[cell], 3);
        assert_true(t.warmups[cell] >= 1);
    }
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
}

/* Another program removes, replaces or cuts rows.csv after the second row. */
typedef struct meddler {
    char path[500];
    const char *command;
    bool done;
} meddler;

static void meddle(void *context, const study_frame_progress *now)
{
    meddler *m = context;
    char line[1200];
    if (m->done || now->frames_done < 2)
        return;
    m->done = true;
    snprintf(line, sizeof line, "f='%s'; %s", m->path, m->command);
    assert_int_equal(system(line), 0);
}

static void rows_that_vanish_are_noticed_and_kept(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *command, *what;
    } cases[] = {
        {"rm \"$f\"", "the file was removed while the study ran"},
        {"cp \"$f\" \"$f.new\"; mv \"$f.new\" \"$f\"", "the file was replaced by another file while the study ran"},
        {"truncate -s -10 \"$f\"", "the file was truncated while the study ran"},
        {"echo >>\"$f\"", "the file was changed while the study ran"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char line[1300];
        diagnostic why = {0};
        snprintf(line, sizeof line, "rm -rf '%s'", f->results);
        assert_int_equal(system(line), 0);
        study *s = fixture_study(f, "study: test\nscene: scene.yaml\nwarmups: 0\nrepetitions: 400\n"
                                    "set: {render.width: 8, render.height: 6}\n");
        meddler m = {.command = cases[i].command};
        snprintf(m.path, sizeof m.path, "%s/test/rows.csv", f->results);
        const study_options options = {.results = f->results, .progressed = meddle, .context = &m};
        assert_int_equal(study_run(s, &options, NULL, &why), STATUS_FAILURE);
        assert_string_equal(why.what, cases[i].what);
        assert_non_null(strstr(why.remedy, "rows.rescued.csv"));
        /* the two rows and the next one; one was cut */
        snprintf(line, sizeof line, "test \"$(grep -c '^test,' '%s/test/rows.rescued.csv')\" -ge 2", f->results);
        assert_int_equal(system(line), 0);
        study_destroy(s);
    }
}

/* What a kill during the write leaves: half a row, and the worker rows of a frame whose row was never written. */
static void incomplete_rows_are_measured_again(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    fixture_run(f, s);
    char *rows = fixture_text(f, "results/test/rows.csv"), *workers = fixture_text(f, "results/test/workers.csv");
    rows[strlen(rows) - 20] = 0;
    fixture_write(f, "results/test/rows.csv", rows);
    *(strrchr(rows, '\n') + 1) = 0;
    assert_int_equal(fixture_run(f, s), 2); /* the warm-up of this process and the repetition */
    expect_begins(f, "results/test/rows.csv", rows);
    tally t = tally_rows(f, "results/test/rows.csv");
    for (size_t cell = 0; cell < 6; cell++)
        assert_int_equal(t.counted[cell], 3);
    assert_true(fixture_has(f, "results/test/rows.torn.csv"));
    assert_true(fixture_has(f, "results/test/workers.torn.csv"));
    /* Every row has its worker rows, once. */
    char *now = fixture_text(f, "results/test/workers.csv"), *aside = fixture_text(f, "results/test/workers.torn.csv");
    size_t cut = fixture_count(aside, "\n");
    assert_true(cut == 1 || cut == 2);
    assert_int_equal(fixture_count(now, "\n"), fixture_count(workers, "\n") - cut + 2 * cut);
    free(rows);
    free(workers);
    free(now);
    free(aside);
    study_destroy(s);
}

/* Rows of cells that are not in the grid stay; those that are in it count. */
static void changed_grids_keep_their_rows(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    fixture_run(f, s);
    study_destroy(s);
    static const char *const grids[] = {
        "[{render.depth: [0, 1, 2]}, {render.threads: [1, 3]}]", "[{render.depth: [0, 1, 2]}]",
        "[{render.threads: [2, 1]}, {render.depth: [2, 5, 0]}]", "[{render.depth: [2]}, {render.threads: [1, 2]}]",
        "[{render.depth: [0, 1, 2, 5]}, {render.threads: [1, 2, 3]}]"};
    /* The cells that are measured: threads 3; none, because 1 thread is the default; depth 5; none; depth 5, threads 3.
     */
    static const size_t missing[] = {3, 0, 2, 0, 1};
    char *before = fixture_text(f, "results/test/rows.csv");
    for (size_t i = 0; i < sizeof grids / sizeof *grids; i++) {
        char text[400];
        study_progress progress;
        snprintf(text, sizeof text,
                 "study: test\nscene: scene.yaml\ngrid: %s\nrepetitions: 3\nwarmups: 1\nkeep: {workers: on}\n",
                 grids[i]);
        s = fixture_study(f, text);
        assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
        assert_int_equal(progress.cells_done, progress.cells - missing[i]);
        assert_int_equal(fixture_run(f, s), 4 * missing[i]);
        assert_int_equal(fixture_run(f, s), 0);
        study_destroy(s);
    }
    char *after = fixture_text(f, "results/test/rows.csv");
    assert_memory_equal(before, after, strlen(before));
    s = fixture_study(f, fixture_study_text);
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.rows, 24);
    assert_int_equal(progress.rows_other_cells, 24);
    assert_int_equal(progress.faults, 0);
    study_destroy(s);
    free(before);
    free(after);
}

/* A kept image belongs to its cell, whatever its number in a changed grid. */
static void kept_files_follow_their_cells(void **state)
{
    const fixture *f = *state;
    static const char *const grids[] = {"[0, 1, 2]", "[2, 3, 0]", "[0]", "[0, 1, 2, 3]"};
    static const int depths[][4] = {{0, 1, 2}, {2, 3, 0}, {0}, {0, 1, 2, 3}};
    char *images[4] = {NULL}, path[400], name[64];
    for (size_t i = 0; i < 4; i++) {
        char text[200];
        snprintf(text, sizeof text,
                 "study: test\nscene: scene.yaml\ngrid: [{render.depth: %s}]\nrepetitions: 1\nwarmups: 0\nkeep: "
                 "{image: on}\n",
                 grids[i]);
        study *s = fixture_study(f, text);
        fixture_run(f, s);
        for (size_t cell = 0; cell < study_cell_count(s); cell++) {
            snprintf(name, sizeof name, "results/test/images/%04zu.png", cell);
            fixture_path(f, name, path);
            image *img = NULL;
            assert_int_equal(image_read(path, &img, NULL, NULL), STATUS_OK);
            uint64_t hash = hash_numbers(HASH_START, img->pixel, 24 * 18 * 3, sizeof *img->pixel);
            snprintf(name, sizeof name, "%016" PRIx64, hash);
            char **known = &images[depths[i][cell]];
            if (*known)
                assert_string_equal(*known, name);
            else
                *known = strdup(name);
            image_destroy(img);
        }
        study_destroy(s);
    }
    for (size_t i = 1; i < 4; i++)
        assert_string_not_equal(images[i], images[i - 1]);
    for (size_t i = 0; i < 4; i++)
        free(images[i]);
}

/* Whitted's rays are not random: without any effect of the values, the cells are distinguished by these themselves. */
static void cells_without_a_difference_are_distinct(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(
        f,
        "study: test\nscene: scene.yaml\ngrid: [{render.sampler: [philox, sobol]}, {render.filter: [centre, box]}]\n");
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < i; k++)
            assert_true(s->identity[i] != s->identity[k]);
    const uint64_t first = s->identity[0], last = s->identity[3];
    study_destroy(s);
    s = fixture_study(
        f,
        "study: test\nscene: scene.yaml\ngrid: [{render.sampler: [philox, sobol]}, {render.filter: [centre, box]}]\n");
    assert_true(s->identity[0] == first && s->identity[3] == last);
    study_destroy(s);
}

/* Where cells name files, each has the contents of its own. */
static void cells_are_of_the_contents_of_their_files(void **state)
{
    const fixture *f = *state;
    char text[800];
    fixture_write(f, "a.pfm", "PF\n1 1\n1.0\n000000000000");
    fixture_write(f, "b.pfm", "PF\n1 1\n1.0\n000000000000");
    snprintf(text, sizeof text, "%stextures: {spots: {file: a.pfm}}\n", fixture_scene);
    fixture_write(f, "spots.yaml", text);
    snprintf(text, sizeof text, "study: test\nscene: spots.yaml\ngrid: [{spots.file: [%s/a.pfm, %s/b.pfm]}]\n",
             f->folder, f->folder);
    study *s = fixture_study(f, text);
    const uint64_t first = s->identity[0], second = s->identity[1];
    study_destroy(s);
    fixture_write(f, "b.pfm", "PF\n1 1\n1.0\n0000AAAA1111");
    s = fixture_study(f, text);
    assert_true(s->identity[0] == first && s->identity[1] != second);
    study_destroy(s);
}

/* One missing file of any cell is found, also if later cells have theirs. */
static void missing_files_of_any_cell_are_found(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 1\n"
                                "warmups: 0\nkeep: {image: on}\n");
    char path[400];
    bool lacks;
    fixture_run(f, s);
    assert_int_equal(study_lacks_files(s, f->results, &lacks, NULL), STATUS_OK);
    assert_false(lacks);
    for (int cell = 1; cell >= 0; cell--) {
        fixture_path(f, cell ? "results/test/images/0001.png" : "results/test/images/0000.png", path);
        assert_int_equal(unlink(path), 0);
        assert_int_equal(study_lacks_files(s, f->results, &lacks, NULL), STATUS_OK);
        assert_true(lacks);
        fixture_run(f, s);
    }
    study_destroy(s);
}

/* More repetitions, another order, more kept files: the study resumes. */
static void a_study_resumes_with_more_repetitions_or_kept_images(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(
        f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 2\nwarmups: 0\n");
    assert_int_equal(fixture_run(f, s), 4);
    study_destroy(s);
    s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 3\nwarmups: "
                         "0\norder: {seed: 9}\n");
    assert_int_equal(fixture_run(f, s), 2);
    study_destroy(s);
    s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1]}]\nrepetitions: 3\nwarmups: "
                         "0\nkeep: {image: on}\n");
    assert_int_equal(fixture_run(f, s), 0);
    assert_true(fixture_has(f, "results/test/images/0001.png"));
    study_destroy(s);
}

/* Any interval is narrow enough at twice the mean, and none at a millionth: min and max apply. */
static void repetitions_stop_at_the_relative_width_of_the_interval(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(
        f, "study: narrow\nscene: scene.yaml\nrepetitions: {min: 3, max: 7, relative_width: 0.0000001}\nwarmups: 0\n");
    assert_int_equal(fixture_run(f, s), 7);
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
    s = fixture_study(f, "study: wide\nscene: scene.yaml\nset: {render.width: 400, render.height: 300}\n"
                         "repetitions: {min: 4, max: 60, relative_width: 1}\nwarmups: 1\n");
    size_t ran = fixture_run(f, s);
    assert_true(ran >= 5 && ran < 60);
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
}

/* Keeps one row of rows.csv, with another film hash. */
static void leave_row_of_another_film(const fixture *f, size_t row)
{
    char *rows = fixture_text(f, "results/test/rows.csv"), path[400];
    csv *table = NULL;
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    char *hash = strdup(csv_field(table, row, csv_column(table, "film_hash")));
    rows[table->start[row + 1]] = 0;
    memmove(rows + table->start[0], rows + table->start[row], table->start[row + 1] - table->start[row] + 1);
    csv_destroy(table);
    for (char *at = rows; (at = strstr(at, hash)); at += 16)
        memcpy(at, "0123456789abcdef", 16);
    fixture_write(f, "results/test/rows.csv", rows);
    rows_recheck(path);
    fixture_path(f, "results/test/runs.json", path);
    rows_unseal(path);
    free(rows);
    free(hash);
}

/* A row with another film is marked, not dropped, and counts as a repetition. */
static void rows_with_another_film_are_marked(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 3\nwarmups: 1\n");
    fixture_run(f, s);
    leave_row_of_another_film(f, 0); /* all later ones differ from it */
    assert_int_equal(fixture_run(f, s), 4);
    tally t = tally_rows(f, "results/test/rows.csv");
    assert_int_equal(t.rows, 5);
    assert_int_equal(t.marked, 4);
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.rows_marked, 4);
    study_destroy(s);
}

/* Threads and schedules do not change the film, so the cells of a grid over them check one another. */
static void cells_that_share_a_film_check_one_another(void **state)
{
    const fixture *f = *state;
    study *s =
        fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\norder: {shuffle: off}\ngrid:\n"
                         "  - {render.schedule: [tiles, rows]}\n"
                         "  - {render.depth: [0, 1]}\n"
                         "  - {render.threads: [1, 2]}\n");
    static const size_t films[] = {0, 0, 2, 2, 0, 0, 2, 2};
    for (size_t cell = 0; cell < 8; cell++)
        assert_int_equal(study_cell_film(s, cell), films[cell]);
    assert_int_equal(fixture_run(f, s), 8);
    assert_int_equal(tally_rows(f, "results/test/rows.csv").marked, 0);
    leave_row_of_another_film(f, 1); /* the row of cell 1; cells 0, 4 and 5 then differ from it */
    assert_int_equal(fixture_run(f, s), 7);
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.rows_marked, 3);
    study_destroy(s);
    s = fixture_study(f, "study: pairs\nscene: scene.yaml\ngrid:\n  - name: pair\n    points:\n"
                         "      - {render.threads: 1, ball.ior: 1.5}\n"
                         "      - {render.threads: 2, ball.ior: 1.3}\n"
                         "      - {render.threads: 2, ball.ior: 1.5}\n");
    assert_int_equal(study_cell_film(s, 1), 1);
    assert_int_equal(study_cell_film(s, 2), 0);
    study_destroy(s);
    const char *slimes =
        "study: t\nscene: slime.yaml\ngrid:\n  - {toy.threads: [1, 2]}\n  - {toy.dt_s: [0.001, 0.0005]}\n";
    assert_int_equal(study_read_text("experiments/scenes/t.study", slimes, strlen(slimes), &s, NULL), STATUS_OK);
    for (size_t cell = 0; cell < 4; cell++)
        assert_int_equal(study_cell_film(s, cell), cell % 2);
    study_destroy(s);
}

static void images_and_maps_are_kept(void **state)
{
    const fixture *f = *state;
    study *s =
        fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 2]}]\nrepetitions: 1\nwarmups: 0\n"
                         "keep: {image: on, pfm: on, pixel_rays: on, pixel_time: on, timeline: on}\n");
    assert_int_equal(fixture_run(f, s), 2);
    static const char *const endings[] = {".png",    ".pfm",    "-rays.png",     "-rays.pfm",
                                          "-ns.png", "-ns.pfm", "-timeline.json"};
    char name[64], path[400];
    for (size_t cell = 0; cell < 2; cell++)
        for (size_t i = 0; i < 7; i++) {
            snprintf(name, sizeof name, "results/test/images/%04zu%s", cell, endings[i]);
            assert_true(fixture_has(f, name));
        }
    /* The map of rays adds up to the rays of the row. */
    image *rays;
    fixture_path(f, "results/test/images/0001-rays.pfm", path);
    assert_int_equal(image_read(path, &rays, NULL, NULL), STATUS_OK);
    double sum = 0;
    for (int i = 0; i < rays->width * rays->height; i++)
        sum += (double)rays->pixel[3 * i];
    image_destroy(rays);
    csv *table = NULL;
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    size_t row = csv_field_real(table, 0, csv_column(table, "cell")) == 1 ? 0 : 1;
    assert_true(sum == csv_field_real(table, row, csv_column(table, "rays_total")));
    csv_destroy(table);
    char *timeline = fixture_text(f, "results/test/images/0000-timeline.json");
    assert_true(fixture_count(timeline, "\"ph\"") >= 3 * 3);
    assert_true(fixture_count(timeline, "\"thread_name\"") >= 1);
    json_t *whole = json_loads(timeline, 0, NULL);
    assert_true(json_array_size(json_object_get(whole, "traceEvents")) == fixture_count(timeline, "\"ph\""));
    json_decref(whole);
    free(timeline);
    /* A missing file is made again, without a row. */
    fixture_path(f, "results/test/images/0001.png", path);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(fixture_run(f, s), 0);
    assert_true(fixture_has(f, "results/test/images/0001.png"));
    study_destroy(s);
}

static void a_second_process_is_refused(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    char path[400];
    fixture_path(f, "results", path);
    assert_int_equal(mkdir(path, 0777), 0);
    fixture_path(f, "results/test", path);
    assert_int_equal(mkdir(path, 0777), 0);
    fixture_path(f, "results/test/rows.csv", path);
    int other = open(path, O_RDWR | O_CREAT, 0666);
    assert_int_equal(flock(other, LOCK_EX), 0);
    diagnostic why = {0};
    size_t ran;
    study_options options = {.results = f->results};
    assert_int_equal(study_run(s, &options, &ran, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "another process"));
    close(other);
    assert_int_equal(fixture_run(f, s), 24);
    study_destroy(s);
}

static void a_full_disk_leaves_only_complete_rows(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 40\nwarmups: 0\n");
    struct rlimit before, small;
    diagnostic why = {0};
    size_t ran = 0;
    study_options options = {.results = f->results};
    int stop_after = 12;
    assert_int_equal(fixture_run_until(stop_soon, &stop_after, s, &options, NULL, NULL), STATUS_INTERRUPTED);
    char *earlier = fixture_text(f, "results/test/rows.csv"), *manifest = fixture_text(f, "results/test/runs.json");
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = (strlen(earlier) > strlen(manifest) + 2000 ? strlen(earlier) : strlen(manifest) + 2000) + 1234;
    os_signals_as_errors();
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    status code = study_run(s, &options, &ran, &why);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(code, STATUS_FAILURE);
    assert_true(ran >= 1);
    assert_non_null(strstr(why.what, "File too large"));
    expect_begins(f, "results/test/rows.csv", earlier);
    tally_rows(f, "results/test/rows.csv"); /* no incomplete row */
    fixture_run(f, s);
    assert_int_equal(tally_rows(f, "results/test/rows.csv").counted[0], 40);
    free(earlier);
    free(manifest);
    study_destroy(s);
}

static void unwritable_result_folders_are_reported(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, fixture_study_text);
    char path[400];
    diagnostic why = {0};
    size_t ran;
    fixture_path(f, "scene.yaml/results", path);
    study_options options = {.results = path};
    assert_int_not_equal(study_run(s, &options, &ran, &why), STATUS_OK);
    assert_true(why.what[0]);
    options.results = "/proc/cuvette";
    assert_int_not_equal(study_run(s, &options, &ran, &why), STATUS_OK);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_cell_has_its_repetitions, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_complete_study_renders_nothing_and_rewrites_nothing, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(rounds_are_complete_shuffled_blocks, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(without_shuffling_cells_go_in_order, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(an_interrupted_study_resumes, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(rows_that_vanish_are_noticed_and_kept, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(cells_without_a_difference_are_distinct, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(cells_are_of_the_contents_of_their_files, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(missing_files_of_any_cell_are_found, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(incomplete_rows_are_measured_again, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(changed_grids_keep_their_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(kept_files_follow_their_cells, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_study_resumes_with_more_repetitions_or_kept_images, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(repetitions_stop_at_the_relative_width_of_the_interval, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(rows_with_another_film_are_marked, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(cells_that_share_a_film_check_one_another, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(images_and_maps_are_kept, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_second_process_is_refused, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(a_full_disk_leaves_only_complete_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(unwritable_result_folders_are_reported, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
