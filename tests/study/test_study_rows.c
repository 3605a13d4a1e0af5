/* Tests of the rows of a study: columns, values, worker rows and times. */
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study_fixture.h"
#include <sched.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const char grid_text[] =
    "study: test\n"
    "scene: scene.yaml\n"
    "grid:\n"
    "  - {render.schedule: [rows, dynamic]}\n"
    "  - name: pair\n"
    "    points: [{ball.ior: 1.5, lamp.position: [0, 9, 0]}, {lamp.position: [1, 9, 0], ball.ior: 1.25}]\n";

/* A row with known numbers. */
static char *write_row(const study *s, const scene *setting, bool workers)
{
    worker_report reports[3] = {
        {.wall_s = 1,
         .cpu_s = 0.5,
         .start_s = 0.125,
         .busy_s = 0.75,
         .waiting_s = 0.25,
         .tiles = 2,
         .camera = 70,
         .reflect = 16,
         .refract = 9,
         .shadow = 5,
         .pu = 1},
        {.wall_s = 1, .cpu_s = 0.25, .start_s = 0.25, .busy_s = 0.25, .waiting_s = 0.75, .tiles = 1, .pu = -1},
        {.wall_s = 1, .cpu_s = 0.125, .start_s = 0.5, .busy_s = 0, .waiting_s = 1, .pu = 0},
    };
    render_result frame = {.wall_s = 1, .cpu_s = 0.875, .worker_count = 3, .workers = reports};
    frame.counters.camera = 100;
    frame.counters.reflect = 20;
    frame.counters.refract = 20;
    frame.counters.shadow = 10;
    frame.counters.by_depth[0] = 100;
    frame.counters.by_depth[2] = 40;
    frame.counters.cut_depth_throughput[0] = (int64_t)(3 * COUNTERS_CUT_ONE);
    frame.counters.first_hits[0] = 60;
    frame.counters.first_hits[1] = 40;
    frame.counters.hits[1] = 80;
    const job_account made = {.of = setting,
                              .level = ISA_BASE,
                              .result = &frame,
                              .complete = true,
                              .ended_ms = INT64_C(1700000000250),
                              .film_hash = 0xabc,
                              .spent = {.wall_s = 1,
                                        .cpu_s = 0.875,
                                        .peak_rss_bytes = 4096,
                                        .voluntary_switches = 1,
                                        .involuntary_switches = 0},
                              .noise = {NAN, 0.125, 2e9, 0.25},
                              .hardware = {-1, -1, 5, 0}};
    study_row row = {.s = s,
                     .cell = 3,
                     .repetition = 2,
                     .order = 17,
                     .film_expected = 0xabd,
                     .disturbed = NOISE_DISTURBED,
                     .account = &made};
    csv_buffer line = {0};
    row_columns_header(&line, s, workers ? worker_each_column : row_each_column);
    (workers ? worker_rows_write : row_write)(&line, &row);
    assert_false(line.failed);
    return line.text;
}

static csv *table_of(const fixture *f, bool workers)
{
    study *s = fixture_study(f, grid_text);
    scene *setting;
    assert_int_equal(study_cell_scene(s, 3, &setting, NULL), STATUS_OK);
    char *text = write_row(s, setting, workers), path[400];
    fixture_write(f, "t.csv", text);
    free(text);
    scene_destroy(setting);
    study_destroy(s);
    csv *table = NULL;
    fixture_path(f, "t.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    assert_non_null(table);
    return table;
}

static void expect(const csv *table, size_t row, const char *column, const char *value)
{
    int at = csv_column(table, column);
    if (at < 0)
        fail_msg("no column %s", column);
    if (strcmp(csv_field(table, row, at), value) != 0)
        fail_msg("%s is %s, not %s", column, csv_field(table, row, at), value);
}

static void rows_record_the_measured_values(void **state)
{
    csv *table = table_of(*state, false);
    const char *const known[][2] = {
        {"study", "test"},
        {"cell", "3"},
        {"repetition", "2"},
        {"warmup", "0"},
        {"order", "17"},
        {"time_utc", "2023-11-14T22:13:20.250Z"},
        {"render.schedule", "dynamic"},
        {"ball.ior", "1.25"},
        {"lamp.position", "1,9,0"},
        {"film_hash", "0000000000000abc"},
        {"film_expected", "0000000000000abd"},
        {"marked", "1"},
        {"wall_s", "1"},
        {"cpu_s", "0.875"},
        {"rays_camera", "100"},
        {"rays_reflect", "20"},
        {"rays_refract", "20"},
        {"rays_shadow", "10"},
        {"rays_total", "150"},
        {"rays_by_depth", "100;0;40"},
        {"cut_depth_throughput", "1"},
        {"first_hits.ground", "60"},
        {"first_hits.ball", "40"},
        {"hits.ground", "0"},
        {"hits.ball", "80"},
        {"workers", "3"},
        {"workers_with_tiles", "2"},
        {"busy_s_mean", "0.3333333333333333"},
        {"busy_s_max", "0.75"},
        {"waiting_s_mean", "0.6666666666666666"},
        {"worker_cpu_s_sum", "0.875"},
        {"imbalance", "1.25"},
        {"peak_rss_bytes", "4096"},
        {"voluntary_switches", "1"},
        {"involuntary_switches", "0"},
        {"others_fraction", "NA"},
        {"steal_fraction", "0.125"},
        {"frequency_hz", "2000000000"},
        {"frequency_drop", "0.25"},
        {"disturbed", "1"},
        {"cycles", "NA"},
        {"branch_misses", "5"},
        {"cache_misses", "0"},
        {"isa", isa_name(ISA_BASE)},
    };
    assert_int_equal(table->row_count, 1);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        expect(table, 0, known[i][0], known[i][1]);
    csv_destroy(table);
}

static void columns_are_in_the_expected_order(void **state)
{
    study *s = fixture_study(*state, grid_text);
    char *header = row_file_header(s, ROWS);
    static const char start[] =
        "study,identity,cell,repetition,warmup,order,time_utc,render.schedule,ball.ior,lamp.position,"
        "film_hash,film_expected,marked,disturbed,wall_s,cpu_s,rays_camera,";
    assert_memory_equal(header, start, sizeof start - 1);
    free(header);
    header = row_file_header(s, WORKER_ROWS);
    assert_string_equal(
        header,
        "study,identity,cell,repetition,warmup,render.schedule,ball.ior,lamp.position,worker,pu,tiles,rays_total,"
        "rays_camera,rays_reflect,rays_refract,rays_shadow,start_s,wall_s,cpu_s,busy_s,visibility_s,waiting_s,"
        "running_s,runnable_s,blocked_s,voluntary_switches,involuntary_switches,schema,run,process,checksum\n");
    free(header);
    study_destroy(s);
}

static void each_worker_has_a_row(void **state)
{
    csv *table = table_of(*state, true);
    assert_int_equal(table->row_count, 3);
    for (size_t i = 0; i < 3; i++)
        expect(table, i, "lamp.position", "1,9,0");
    expect(table, 0, "worker", "0");
    expect(table, 2, "worker", "2");
    expect(table, 0, "rays_total", "100");
    expect(table, 0, "rays_camera", "70");
    expect(table, 0, "rays_reflect", "16");
    expect(table, 0, "rays_refract", "9");
    expect(table, 0, "rays_shadow", "5");
    expect(table, 1, "pu", "NA");
    expect(table, 1, "start_s", "0.25");
    expect(table, 2, "busy_s", "0");
    expect(table, 2, "waiting_s", "1");
    csv_destroy(table);
}

static void times_are_utc(void **state)
{
    (void)state;
    char text[ROW_TIME_MAX];
    assert_string_equal(row_time(0, text), "1970-01-01T00:00:00.000Z");
    assert_string_equal(row_time(INT64_C(951782400007), text), "2000-02-29T00:00:00.007Z");
    assert_string_equal(row_time(-1, text), "1969-12-31T23:59:59.999Z");
    assert_string_equal(row_time(-86400000, text), "1969-12-31T00:00:00.000Z");
}

/* render.threads=auto in studies: a value like any other, whose rows have the number of workers. */

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

/* Coatings by name and by layers, and scales: each value is its own cell, has its text in the rows, and acts. */
static void coatings_and_scales_are_swept(void **state)
{
    static const char *const values[][2] = {
        {"none", "1,1,1"},
        {"none", "1,2,-1"},
        {"ar-550", "1,1,1"},
        {"ar-550", "1,2,-1"},
        {"mgf2 550/4", "1,1,1"},
        {"mgf2 550/4", "1,2,-1"},
        {"10x(tio2 550/4, fused-silica 550/4), 1.4 20", "1,1,1"},
        {"10x(tio2 550/4, fused-silica 550/4), 1.4 20", "1,2,-1"},
    };
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\norder: {shuffle: off}\n"
                                "grid:\n"
                                "  - {ball.coating: [none, ar-550, [mgf2 550/4], [10x(tio2 550/4, fused-silica 550/4), "
                                "1.4 20]]}\n"
                                "  - {ball.scale: [[1, 1, 1], [1, 2, -1]]}\n");
    assert_int_equal(study_cell_count(s), COUNT(values));
    assert_int_equal(fixture_run(f, s), COUNT(values));
    csv *table = NULL;
    char path[400];
    fixture_path(f, "results/test/rows.csv", path);
    assert_int_equal(csv_read(path, &table, NULL), STATUS_OK);
    const int hash = csv_column(table, "film_hash");
    for (size_t i = 0; i < COUNT(values); i++) {
        expect(table, i, "ball.coating", values[i][0]);
        expect(table, i, "ball.scale", values[i][1]);
        for (size_t k = 0; k < i; k++) { /* the design ar-550 is mgf2 550/4 */
            const bool same = (i == 4 || i == 5) && k == i - 2;
            assert_int_equal(strcmp(csv_field(table, i, hash), csv_field(table, k, hash)) == 0, same);
        }
    }
    csv_destroy(table);
    study_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rows_record_the_measured_values, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(columns_are_in_the_expected_order, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(each_worker_has_a_row, fixture_setup, fixture_teardown),
        cmocka_unit_test(times_are_utc),
        cmocka_unit_test_setup_teardown(rows_keep_the_word_and_have_the_number, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(coatings_and_scales_are_swept, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(the_cell_is_the_same_on_any_machine, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
