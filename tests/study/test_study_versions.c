/* Tests of rows that outlive versions: identities of cells leave out defaults, columns are identified by name, and rows
 * without a required column are refused. */
#include "base/csv.h"
#include "base/hash.h"
#include "rows_fixture.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/plan/identity.h"
#include "study/rows/row_files.h"
#include "study/summary/summary.h"
#include "study_fixture.h"
#include <dirent.h>

static const char study_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid: [{render.depth: [0, 2]}]\n"
                                 "reference: {render.depth: 2}\n"
                                 "repetitions: 2\n"
                                 "warmups: 0\n"
                                 "keep: {workers: on}\n";
static const char longer_text[] = "study: test\n"
                                  "scene: scene.yaml\n"
                                  "grid: [{render.depth: [0, 2]}]\n"
                                  "reference: {render.depth: 2}\n"
                                  "repetitions: 4\n"
                                  "warmups: 0\n"
                                  "keep: {workers: on}\n";
static const char rows_name[] = "results/test/rows.csv", workers_name[] = "results/test/workers.csv",
                  compare_name[] = "results/test/compare.csv";

static char *summary_of(const study *s, const char *results)
{
    char *text = NULL, message[DIAGNOSTIC_TEXT_MAX];
    size_t size;
    diagnostic why = {0};
    FILE *out = open_memstream(&text, &size);
    if (study_summary(s, results, out, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    fclose(out);
    return text;
}

static study *read_study(const char *path)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study *s = NULL;
    if (study_read(path, &s, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return s;
}

/* --- existing rows --- */

static void rows_of_the_reference_run_are_read(void **state)
{
    (void)state;
    size_t read = 0;
    DIR *folder = opendir("results/reference");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[400];
        snprintf(path, sizeof path, "results/reference/%.100s/runs.json", entry->d_name);
        if (access(path, F_OK) != 0) /* no study's: rows of a script, or figures */
            continue;
        snprintf(path, sizeof path, "experiments/%.100s.study", entry->d_name);
        if (access(path, F_OK) != 0)
            snprintf(path, sizeof path, "experiments/full/%.100s.study", entry->d_name);
        study *s = read_study(path);
        char *text = summary_of(s, "results/reference");
        assert_int_equal(fixture_count(text, "\n"), study_cell_count(s) + 1);
        free(text);
        study_destroy(s);
        read++;
    }
    closedir(folder);
    assert_true(read >= 34);
}

/* --- content of an identity --- */

static bool is_path_of(const scene *s, const char *name, param_place *at)
{
    return strchr(name, '.') && !strchr(name, ' ') && param_place_find(s, name, at, NULL) == STATUS_OK;
}

/* A parameter added by a later version is at its default in every older scene. */
static void default_values_are_not_part_of_an_identity(void **state)
{
    (void)state;
    static const char *const scenes[] = {"experiments/scenes/shapes.yaml", "experiments/scenes/models.yaml",
                                         "experiments/scenes/slime.yaml"};
    size_t paths = 0, shapes = 0, solids = 0;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        scene *s = NULL;
        meaning m = {0};
        assert_int_equal(scene_read(scenes[k], &s, NULL), STATUS_OK);
        assert_int_equal(meaning_of_scene(&m, s, false, NULL), STATUS_OK);
        for (size_t i = 0; i < m.count; i++) {
            param_place at;
            const char *name = m.items[i].name, *value = m.items[i].value;
            shapes += strncmp(name, "shape of ", 9) == 0 && strspn(value, "0123456789") == 0;
            if (!is_path_of(s, name, &at))
                continue;
            char *usual = param_default_text(at.row);
            if (strcmp(usual, value) == 0)
                fail_msg("%s is at its default, and counts", name);
            free(usual);
            paths++;
        }
        solids += s->solid_count;
        meaning_free(&m);
        scene_destroy(s);
    }
    assert_true(paths > 40);
    assert_int_equal(shapes, solids);
}

static bool has_sampling(const fixture *f, const char *assignments)
{
    char text[300];
    snprintf(text, sizeof text, "study: x\nscene: scene.yaml\nset: {%s}\n", assignments);
    study *s = fixture_study(f, text);
    meaning m = {0};
    bool found = false;
    assert_int_equal(meaning_of_scene(&m, s->base, false, NULL), STATUS_OK);
    for (size_t i = 0; i < m.count; i++)
        found |= strcmp(m.items[i].name, "render.sampler") == 0 || strcmp(m.items[i].name, "render.filter") == 0 ||
                 strcmp(m.items[i].name, "render.light_sampling") == 0;
    meaning_free(&m);
    study_destroy(s);
    return found;
}

/* Defaults of random paths that have changed: older rows of other integrators keep their cells, and those of paths have
 * the cells of their own sampling. */
static void changed_defaults_of_paths_concern_only_paths(void **state)
{
    const fixture *f = *state;
    assert_false(has_sampling(f, "render.integrator: whitted"));
    assert_false(has_sampling(f, "render.integrator: whitted, render.sampler: philox"));
    assert_true(has_sampling(f, "render.integrator: path"));
    assert_true(has_sampling(f, "render.integrator: path, render.sampler: philox"));
    assert_false(has_sampling(f, "render.integrator: path, render.sampler: philox, render.filter: centre, "
                                 "render.light_sampling: all"));
}

/* A hash of the identities of all cells. */
static uint64_t identities_of(const study *s)
{
    uint64_t hash = HASH_START;
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        hash = hash_words(hash, &(const int64_t){(int64_t)s->identity[cell]}, 1);
    return hash;
}

static uint64_t with_beam(const fixture *f, const char *keys, const char *grid)
{
    char text[2000];
    snprintf(text, sizeof text, "%s\nbeams: {laser: {%s}}\n", fixture_scene, keys);
    fixture_write(f, "beams.yaml", text);
    snprintf(text, sizeof text, "study: x\nscene: beams.yaml\ngrid: [%s]\n", grid);
    study *s = fixture_study(f, text);
    const uint64_t hash = identities_of(s);
    study_destroy(s);
    return hash;
}

/* A beam that lights nothing changes no film, so that it is not in an identity; a lamp is, as is one that the
 * grid makes a lamp. */
static void beams_belong_to_an_identity_if_they_are_lamps(void **state)
{
    const fixture *f = *state;
    static const char depth[] = "{render.depth: [0, 2]}", lights[] = "{laser.lights: [off, on]}";
    const uint64_t dark = with_beam(f, "power: 1", depth);
    study *without = fixture_study(f, "study: x\nscene: scene.yaml\ngrid: [{render.depth: [0, 2]}]\n");
    assert_int_equal(identities_of(without), dark);
    study_destroy(without);
    assert_int_equal(with_beam(f, "power: 2, width: 3", depth), dark);
    const uint64_t lamp = with_beam(f, "power: 2, lights: on", depth);
    assert_int_not_equal(lamp, dark);
    assert_int_not_equal(with_beam(f, "power: 3, lights: on", depth), lamp);
    assert_int_equal(with_beam(f, "power: 2, lights: on, rays: 9, color: [1, 0, 0]", depth), lamp);
    assert_int_not_equal(with_beam(f, "power: 2", lights), with_beam(f, "power: 3", lights));
}

/* For a parameter anywhere in the table, with and without an explicit default. */
static void order_and_explicit_defaults_do_not_change_an_identity(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: x\nscene: scene.yaml\n");
    study *other = fixture_study(f, "study: x\nscene: scene.yaml\n"
                                    "set: {ball.visible: on, lamp.intensity: 1, render.samples: 1}\n");
    assert_int_equal(s->identity[0], other->identity[0]);
    meaning message = {0};
    assert_int_equal(meaning_of_scene(&message, s->base, false, NULL), STATUS_OK);
    const uint64_t hash = meaning_hash(&message);
    const meaning_item first = message.items[0];
    message.items[0] = message.items[message.count - 1];
    message.items[message.count - 1] = first;
    assert_int_equal(meaning_hash(&message), hash);
    char *const value = message.items[0].value;
    message.items[0].value = message.items[1].value;
    message.items[1].value = value;
    assert_int_not_equal(meaning_hash(&message), hash);
    meaning_free(&message);
    study_destroy(s);
    study_destroy(other);
}

/* The order of solids decides between equal priorities, and a solid with only defaults is part of it. */
static void objects_are_part_of_an_identity(void **state)
{
    const fixture *f = *state;
    static const char *const scenes[] = {
        "solids:\n  a: {shape: sphere, radius: 2}\n  b: {shape: sphere, radius: 2}\n",
        "solids:\n  b: {shape: sphere, radius: 2}\n  a: {shape: sphere, radius: 2}\n",
        "solids:\n  a: {shape: sphere, radius: 2}\n  b: {shape: cylinder, radius: 2}\n",
        "solids:\n  a: {shape: sphere, radius: 2}\n",
        "lights: {l: {}}\nsolids:\n  a: {shape: sphere, radius: 2}\n",
        "materials: {m: {}}\nsolids:\n  a: {shape: sphere, radius: 2, material: m}\n",
        "camera: {target: [0, 1, 0]}\nsolids:\n  a: {shape: sphere, radius: 2}\n",
        "camera: {yaw_deg: 0}\nsolids:\n  a: {shape: sphere, radius: 2}\n",
    };
    enum { COUNT = sizeof scenes / sizeof *scenes };
    uint64_t hash[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        fixture_write(f, "scene.yaml", scenes[i]);
        study *s = fixture_study(f, "study: x\nscene: scene.yaml\n");
        hash[i] = s->identity[0];
        for (size_t k = 0; k < i; k++)
            if (hash[k] == hash[i] && !(k == 3 && i == 6)) /* a target is what a camera has by default */
                fail_msg("scenes %zu and %zu have one identity", k, i);
        study_destroy(s);
    }
}

/* --- other columns --- */

static size_t split(char *line, char **fields)
{
    size_t count = csv_split(line, fields);
    assert_true(count > 0 && count < 200);
    return count;
}

/* The file's columns in reverse order, `without` removed, `with` prepended. */
static void rearrange(const fixture *f, const char *name, const char *without, const char *with)
{
    char *text = fixture_text(f, name), *rest = text;
    csv_buffer out = {0};
    size_t left_out = SIZE_MAX;
    for (char *line; (line = strsep(&rest, "\n")) && *line;) {
        char *fields[200];
        const bool header = !out.text;
        const size_t count = split(line, fields);
        for (size_t i = 0; header && without && i < count; i++)
            left_out = strcmp(fields[i], without) == 0 ? i : left_out;
        if (with)
            csv_text(&out, header ? with : "a, \"b\"");
        for (size_t i = count; i > 0; i--)
            if (i - 1 != left_out)
                csv_text(&out, fields[i - 1]);
        csv_end(&out);
    }
    assert_true(!without || left_out != SIZE_MAX);
    fixture_write(f, name, out.text);
    csv_buffer_free(&out);
    free(text);
}

/* Makes the checks of a changed file again. */
static void recheck(const fixture *f, const char *name)
{
    char path[400];
    fixture_path(f, name, path);
    rows_recheck(path);
    fixture_path(f, "results/test/runs.json", path);
    rows_unseal(path);
}

static void expect_no_faults(const fixture *f, const study *s)
{
    study_progress progress;
    char text[DIAGNOSTIC_TEXT_MAX];
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    if (progress.faults)
        fail_msg("%s", diagnostic_text(&progress.fault, text, sizeof text));
}

/* Summaries under a permuted header, with one column less and one more; a missing one is unknown. A column that this
 * version does not know is part of the row's checksum, so the checksums are made again. */
static void columns_are_identified_by_name(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    char *before = summary_of(s, f->results);
    rearrange(f, rows_name, NULL, NULL);
    rearrange(f, compare_name, NULL, "of another version");
    recheck(f, compare_name);
    rearrange(f, workers_name, NULL, NULL);
    char *after = summary_of(s, f->results);
    assert_string_equal(after, before);
    expect_no_faults(f, s);
    free(after);
    rearrange(f, rows_name, "motion_steps", "of another version");
    recheck(f, rows_name);
    rearrange(f, compare_name, "ssim", NULL);
    recheck(f, compare_name);
    after = summary_of(s, f->results);
    const size_t columns = fixture_count(before, "\t");
    assert_int_equal(fixture_count(after, "\t"), columns);
    assert_int_equal(fixture_count(after, "\tNA"), fixture_count(before, "\tNA") + 4); /* two columns of two cells */
    free(after);
    free(before);
    study_destroy(s);
}

static csv *table_of(const fixture *f, const char *name)
{
    char path[400], message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    csv *table = NULL;
    fixture_path(f, name, path);
    if (csv_read(path, &table, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    return table;
}

static void expect(const csv *table, size_t row, const char *column, const char *value)
{
    assert_true(csv_column(table, column) >= 0);
    assert_string_equal(csv_field(table, row, csv_column(table, column)), value);
}

/* A study resumes in a file with other columns: none is lost, every row is complete, and old rows keep their values. */
static void a_study_resumes_in_a_file_with_other_columns(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    study_destroy(s);
    rearrange(f, rows_name, "imbalance", "of another version");
    recheck(f, rows_name);
    rearrange(f, workers_name, "waiting_s", NULL);
    recheck(f, workers_name);
    char *before = fixture_text(f, rows_name);
    s = fixture_study(f, longer_text);
    assert_int_equal(fixture_run(f, s), 4);
    csv *rows = table_of(f, rows_name), *workers = table_of(f, workers_name);
    assert_int_equal(rows->row_count, 8);
    assert_int_equal(workers->row_count, 8);
    char *line = before + strcspn(before, "\n") + 1;
    for (size_t i = 0; i < 8; i++) {
        expect(rows, i, "of another version", i < 4 ? "a, \"b\"" : "NA");
        expect(rows, i, "study", "test");
        assert_int_equal(strcmp(csv_field(rows, i, csv_column(rows, "imbalance")), "NA") == 0, i < 4);
        assert_int_equal(strcmp(csv_field(workers, i, csv_column(workers, "waiting_s")), "NA") == 0, i < 4);
        assert_true(csv_field_real(rows, i, csv_column(rows, "rays_camera")) == 24 * 18);
        assert_true(csv_field_real(rows, i, csv_column(rows, "order")) == (double)i);
        if (i < 4) /* old rows are unchanged except for appended columns */
            assert_memory_equal(rows->raw + rows->start[i], line, strcspn(line, "\n"));
        line += i < 4 ? strcspn(line, "\n") + 1 : 0;
    }
    size_t ran;
    study_options options = {.results = f->results};
    assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_OK);
    assert_int_equal(ran, 0);
    expect_no_faults(f, s);
    csv_destroy(rows);
    csv_destroy(workers);
    free(before);
    study_destroy(s);
}

/* Without new rows the file does not change. */
static void a_complete_study_leaves_the_row_file_unchanged(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    rearrange(f, rows_name, "imbalance", NULL);
    recheck(f, rows_name);
    char *before = fixture_text(f, rows_name);
    assert_int_equal(fixture_run(f, s), 0);
    char *after = fixture_text(f, rows_name);
    assert_string_equal(after, before);
    free(before);
    free(after);
    study_destroy(s);
}

/* Shards of different versions, one of them with rows in two files with different columns. */
static void shards_with_other_columns_are_merged(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    for (long shard = 0; shard < 2; shard++) {
        study_options options = {.results = f->results, .shard = shard, .shards = 2};
        assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    }
    rearrange(f, "results/test/rows.shard-1-of-2.csv", "imbalance", "of another version");
    char path[400];
    fixture_path(f, "results/test/rows.shard-1-of-2.csv", path);
    rows_recheck(path);
    size_t rows = 0;
    for (int again = 0; again < 2; again++) {
        assert_int_equal(study_merge(s, f->results, &rows, NULL, NULL), STATUS_OK);
        assert_int_equal(rows, 4);
        csv *joined = table_of(f, rows_name);
        assert_int_equal(joined->row_count, 4);
        for (size_t i = 0; i < 4; i++) {
            const bool other = strcmp(csv_field(joined, i, csv_column(joined, "imbalance")), "NA") == 0;
            expect(joined, i, "of another version", other ? "a, \"b\"" : "NA");
            expect(joined, i, "study", "test");
        }
        csv_destroy(joined);
    }
    study_destroy(s);
}

static diagnostic refusal_of(const fixture *f, const study *s)
{
    diagnostic why = {0};
    study_options options = {.results = f->results};
    size_t ran;
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_BAD_INPUT);
    assert_int_equal(study_run(s, &options, &ran, &why), STATUS_BAD_INPUT);
    assert_int_equal(ran, 0);
    return why;
}

static void missing_required_columns_are_reported(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    char *whole = fixture_text(f, rows_name);
    static const char *const required[] = {"repetition", "identity", "run", "checksum"};
    for (size_t i = 0; i < sizeof required / sizeof *required; i++) {
        rearrange(f, rows_name, required[i], NULL);
        diagnostic why = refusal_of(f, s);
        assert_non_null(strstr(why.what, "lack the column"));
        assert_non_null(strstr(why.what, required[i]));
        assert_non_null(strstr(why.remedy, "run the study again"));
        assert_non_null(strstr(why.file, "rows.csv"));
        assert_int_equal(why.line, 1);
        fixture_write(f, rows_name, whole);
    }
    free(whole);
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_the_reference_run_are_read),
        cmocka_unit_test(default_values_are_not_part_of_an_identity),
        CASE(order_and_explicit_defaults_do_not_change_an_identity),
        CASE(changed_defaults_of_paths_concern_only_paths),
        CASE(beams_belong_to_an_identity_if_they_are_lamps),
        CASE(objects_are_part_of_an_identity),
        CASE(columns_are_identified_by_name),
        CASE(a_study_resumes_in_a_file_with_other_columns),
        CASE(a_complete_study_leaves_the_row_file_unchanged),
        CASE(shards_with_other_columns_are_merged),
        CASE(missing_required_columns_are_reported),
    };
    return cmocka_run_group_tests_name("study_versions", tests, NULL, NULL);
}
