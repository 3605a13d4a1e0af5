/* Tests of comparisons: known ratios are found, equal sides rarely differ, sides that did not alternate are never told
 * apart, rows of unlike environments are never pooled. Times are drawn from a known distribution and written into
 * measured rows. */
#include "random_stream.h"
#include "rows_fixture.h"
#include "study/summary/contrast.h"
#include "study_fixture.h"
#include "whole.h"

enum { PROCESSES = 60 };

static const char study_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid: [{render.depth: [1, 2]}, {render.threads: [1, 2]}]\n"
                                 "repetitions: 60\n"
                                 "processes: 60\n"
                                 "warmups: 0\n";

/* Times of a row: a drift that all cells of a process share, an effect of the process on each cell, noise. */
typedef struct made_times {
    double effect, drift, layout, noise; /* logarithms; effect: of render.depth 2 */
    long processes, repetitions;         /* that stay; 0 repetitions: all */
    uint64_t seed;
    long delay_s; /* of the first row, after midnight */
    bool halves;  /* the first half of the processes has the cells of one thread only, the second the others */
    double shared[PROCESSES], own[PROCESSES][4];
    char wall[40], time[100];
} made_times;

static double normal(uint64_t *seed)
{
    const double u = random_real(seed, 1e-300, 1), v = random_real(seed, 0, 1);
    return sqrt(-2 * log(u)) * cos(2 * acos(-1) * v);
}

static void draw_processes(made_times *m)
{
    double walk = 0;
    for (size_t p = 0; p < PROCESSES; p++) {
        m->shared[p] = walk += m->drift * normal(&m->seed);
        for (size_t cell = 0; cell < 4; cell++)
            m->own[p][cell] = m->layout * normal(&m->seed);
    }
}

static bool replace_times(void *context, const csv *table, char **fields)
{
    made_times *m = context;
    const long process = atol(fields[csv_column(table, "process")]);
    const long cell = atol(fields[csv_column(table, "cell")]);
    if (process >= m->processes || (m->halves && (2 * process < m->processes) != (cell % 2 == 0)))
        return false;
    const double noise = m->noise * normal(&m->seed);
    const double wall_s = 0.1 * exp(m->shared[process] + m->own[process][cell] + noise + (cell >= 2 ? m->effect : 0));
    snprintf(m->wall, sizeof m->wall, "%.17g", wall_s);
    const long at_s = m->delay_s + 60 * process;
    snprintf(m->time, sizeof m->time, "2026-01-31T%02ld:%02ld:%02ld.000Z", at_s / 3600, at_s / 60 % 60, at_s % 60);
    fields[csv_column(table, "wall_s")] = m->wall;
    fields[csv_column(table, "time_utc")] = m->time;
    return true;
}

static void make_times(const fixture *f, const char *results, made_times *m)
{
    char path[500];
    draw_processes(m);
    snprintf(path, sizeof path, "%s/%s/test/rows.csv", f->folder, results);
    rows_edit(path, replace_times, m);
}

/* A study with PROCESSES processes of one repetition each. */
static study *measured(const fixture *f, const char *text)
{
    char path[500];
    study *s = fixture_study(f, text);
    for (long process = 1; process <= study_processes(s); process++) {
        const study_options options = {.results = f->results, .process = process};
        assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    }
    snprintf(path, sizeof path, "%s/test/runs.json", f->results);
    rows_unseal(path);
    return s;
}

static void copy_results(const fixture *f, const char *from, const char *to)
{
    char line[1200];
    snprintf(line, sizeof line, "rm -rf '%s/%s' && cp -r '%s/%s' '%s/%s'", f->folder, to, f->folder, from, f->folder,
             to);
    assert_int_equal(system(line), 0);
}

static contrast *compared(const study *s, const char *a, const char *b, const fixture *f)
{
    char message[DIAGNOSTIC_TEXT_MAX];
    diagnostic why = {0};
    study_side sides[2];
    contrast *c = NULL;
    assert_int_equal(side_read(s, a, f->results, &sides[0], NULL), STATUS_OK);
    assert_int_equal(side_read(s, b, f->results, &sides[1], NULL), STATUS_OK);
    if (contrast_make(s, &sides[0], &sides[1], &(contrast_options){.column = NULL}, &c, NULL, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    side_release(&sides[0]);
    side_release(&sides[1]);
    return c;
}

/* A drift of 5% between processes does not hide a difference of 3%, because both sides have it. */
static void a_known_ratio_is_found(void **state)
{
    const fixture *f = *state;
    study *s = measured(f, study_text);
    made_times m = {.effect = log(1.03), .drift = 0.05, .layout = 0.004, .noise = 0.004, .processes = 12, .seed = 1};
    make_times(f, "results", &m);
    contrast *c = compared(s, "render.depth=1", "render.depth=2", f);
    assert_int_equal(c->count, 2);
    for (size_t i = 0; i < 2; i++) {
        const contrast_line *l = &c->lines[i];
        assert_int_equal(l->a.cell, i);
        assert_int_equal(l->b.cell, 2 + i);
        assert_int_equal(l->a.count, 12);
        assert_int_equal(l->b.processes, 12);
        assert_true(l->alternate && l->verdict == CONTRAST_SLOWER && l->reason == CONTRAST_CLEAR);
        assert_true(l->ratio.low < 1.03 && 1.03 < l->ratio.high);
        assert_true(l->ratio.high - l->ratio.low < 0.02);
        assert_true(l->pairs_needed >= 3 && l->pairs_needed <= 20);
    }
    assert_true(c->all.ratio.high - c->all.ratio.low < c->lines[0].ratio.high - c->lines[0].ratio.low);
    assert_int_equal(c->all.verdict, CONTRAST_SLOWER);
    contrast_destroy(c);
    c = compared(s, "cell=2", "cell=0", f);
    assert_int_equal(c->count, 1);
    assert_int_equal(c->lines[0].verdict, CONTRAST_FASTER);
    contrast_destroy(c);
    study_destroy(s);
}

/* A grid that grew between two runs, or shards by cell: no process has all cells. */
static void all_cells_count_though_no_process_has_them(void **state)
{
    const fixture *f = *state;
    study *s = measured(f, study_text);
    made_times m = {
        .effect = log(4.7), .drift = 0.05, .layout = 0.004, .noise = 0.004, .processes = 12, .halves = true, .seed = 1};
    make_times(f, "results", &m);
    contrast *c = compared(s, "render.depth=1", "render.depth=2", f);
    assert_int_equal(c->count, 2);
    assert_true(c->lines[0].a.processes == 6 && c->lines[1].a.processes == 6);
    assert_true(c->all.a.processes == 12 && c->all.b.processes == 12 && c->all.a.count == 12);
    assert_true(c->all.reason == CONTRAST_CLEAR && c->all.verdict == CONTRAST_SLOWER && c->all.alternate);
    assert_true(c->all.ratio.low < 4.7 && 4.7 < c->all.ratio.high && c->all.ratio.low > 4.6);
    contrast_destroy(c);
    study_destroy(s);
}

/* Runs, environments and columns that say nothing are refused: nothing was compared. */
static void unknown_sides_are_refused(void **state)
{
    const fixture *f = *state;
    static const char *const sides[][3] = {{"run=1", "run=2", "is of the run '1'"},
                                           {"environment=nope", "environment=nope", "of the environment 'nope'"}};
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 2]}]\nwarmups: 0\n");
    assert_int_equal(fixture_run(f, s), 12);
    study_side a, b;
    contrast *c;
    diagnostic why;
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(side_read(s, sides[i][0], f->results, &a, NULL), STATUS_OK);
        assert_int_equal(side_read(s, sides[i][1], f->results, &b, NULL), STATUS_OK);
        assert_int_equal(contrast_make(s, &a, &b, &(contrast_options){.column = NULL}, &c, NULL, &why),
                         STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, sides[i][2]));
        assert_non_null(strstr(why.remedy, "give one of these: "));
        side_release(&a);
        side_release(&b);
    }
    assert_int_equal(side_read(s, "cell=0", f->results, &a, NULL), STATUS_OK);
    assert_int_equal(side_read(s, "cell=1", f->results, &b, NULL), STATUS_OK);
    assert_int_equal(contrast_make(s, &a, &b, &(contrast_options){.column = "isa"}, &c, NULL, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "the column 'isa' has no positive number");
    side_release(&a);
    side_release(&b);
    study_destroy(s);
}

/* Two folders, measured in turn or one after the other. */
static void only_sides_that_alternate_are_told_apart(void **state)
{
    const fixture *f = *state;
    char side[400];
    study *s = measured(f, study_text);
    made_times m = {.noise = 0.01, .processes = 8, .seed = 2};
    copy_results(f, "results", "other");
    make_times(f, "results", &m);
    copy_results(f, "other", "in-turn");
    copy_results(f, "other", "later");
    for (int later = 0; later < 2; later++) {
        made_times slower = {.noise = 0.01, .processes = 8, .seed = 3, .delay_s = later ? 3600 : 30};
        draw_processes(&slower);
        for (size_t p = 0; p < PROCESSES; p++)
            for (size_t cell = 0; cell < 4; cell++)
                slower.own[p][cell] = log(1.2);
        snprintf(side, sizeof side, "%s/%s/test/rows.csv", f->folder, later ? "later" : "in-turn");
        rows_edit(side, replace_times, &slower);
        snprintf(side, sizeof side, "%s/%s", f->folder, later ? "later" : "in-turn");
        contrast *c = compared(s, f->results, side, f);
        for (size_t i = 0; i < c->count; i++) {
            assert_true(c->lines[i].ratio.low > 1.1 && c->lines[i].ratio.high < 1.3);
            assert_int_equal(c->lines[i].alternate, !later);
            assert_int_equal(c->lines[i].verdict, later ? CONTRAST_CANNOT_TELL : CONTRAST_SLOWER);
            assert_int_equal(c->lines[i].reason, later ? CONTRAST_NO_TURNS : CONTRAST_CLEAR);
        }
        assert_int_equal(c->all.verdict, later ? CONTRAST_CANNOT_TELL : CONTRAST_SLOWER);
        contrast_destroy(c);
    }
    study_destroy(s);
}

static void few_processes_tell_nothing(void **state)
{
    const fixture *f = *state;
    static const char text[] = "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 2]}]\n"
                               "repetitions: 24\nprocesses: 2\n";
    study *s = measured(f, text);
    contrast *c = compared(s, "cell=0", "cell=1", f);
    assert_int_equal(c->lines[0].a.count, 24);
    assert_int_equal(c->lines[0].a.processes, 2);
    assert_true(isfinite(c->lines[0].ratio.value) && isnan(c->lines[0].ratio.low));
    assert_int_equal(c->lines[0].reason, CONTRAST_FEW);
    assert_int_equal(c->lines[0].verdict, CONTRAST_CANNOT_TELL);
    contrast_destroy(c);
    study_destroy(s);
}

/* A slower machine's rows lie in the same folder: they are left out, or compared as a side of their own. */
static void environments_are_never_pooled(void **state)
{
    const fixture *f = *state;
    char key[2][ENVIRONMENT_KEY], side[2][40];
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 2]}]\nrepetitions: 6\n");
    for (int i = 2; i >= 0; i--) {
        static const char *const machines[] = {"one", "two", "three"};
        setenv("CUVETTE_MACHINE", machines[i], 1);
        fixture_run(f, s);
        if (i == 2)
            continue;
        study_progress progress;
        assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
        snprintf(key[i], sizeof key[i], "%.8s", progress.environment);
        snprintf(side[i], sizeof side[i], "cell=0,environment=%s", key[i]);
    }
    contrast *c = compared(s, "cell=0", "cell=1", f);
    assert_string_equal(c->environment[0], c->environment[1]);
    assert_int_equal(c->left_out[0], 24);
    assert_int_equal(c->lines[0].a.count, 6);
    contrast_destroy(c);
    c = compared(s, side[0], side[1], f);
    assert_string_equal(c->environment[0], key[0]);
    assert_string_equal(c->environment[1], key[1]);
    assert_int_equal(c->lines[0].a.count, 6);
    assert_int_equal(c->lines[0].b.count, 6);
    assert_int_equal(c->lines[0].verdict, CONTRAST_CANNOT_TELL);
    contrast_destroy(c);
    unsetenv("CUVETTE_MACHINE");
    study_destroy(s);
}

static void invalid_sides_are_refused(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *a, *b, *what, *remedy;
    } cases[] = {
        {"render.depth=7", "render.depth=1", "no cell has render.depth=7", "choose from: 1, 2"},
        {"render.width=7", "render.width=9", "no parameter 'render.width'", "parameters: render.depth, render.threads"},
        {"render.depth=1", "render.threads=1", "only one side has a value of", "both sides"},
        {"cell=4", "cell=0", "no cell '4'", "summary"},
        {"cell=x", "cell=0", "no cell 'x'", "summary"},
        {"render.depth=1,", "render.depth=2,", "an empty item", "PATH=VALUE"},
    };
    study *s = fixture_study(f, study_text);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        study_side a = {.text = NULL}, b = {.text = NULL};
        size_t(*pairs)[2] = NULL, count;
        diagnostic why = {0};
        status code = side_read(s, cases[i].a, "results", &a, &why);
        THEN(code, side_read(s, cases[i].b, "results", &b, &why));
        THEN(code, side_cells(s, &a, &b, &pairs, &count, &why));
        assert_int_equal(code, STATUS_BAD_INPUT);
        if (!strstr(why.what, cases[i].what) || !strstr(why.remedy, cases[i].remedy))
            fail_msg("%s: %s; %s", cases[i].a, why.what, why.remedy);
        free(pairs);
        side_release(&a);
        side_release(&b);
    }
    study_side side;
    assert_int_equal(side_read(s, "some,run=12ab,environment=00ff00ff,render.depth=2.0", "results", &side, NULL),
                     STATUS_OK);
    assert_string_equal(side.results, "some");
    assert_string_equal(side.run, "12ab");
    assert_string_equal(side.environment, "00ff00ff");
    assert_int_equal(side.point[0], 1);
    assert_true(side.point[1] == STUDY_SIDE_ANY);
    side_release(&side);
    study_destroy(s);
}

/* Closed form: the test has a level of 5%; a binomial variable of 180 exceeds 14 with a probability of 2%, one of 20
 * exceeds 3 with 1.6%. */
static void equal_sides_rarely_differ(void **state)
{
    ONLY_IN_CHECK();
    const fixture *f = *state;
    const size_t trials = is_whole() ? 90 : 10, most = is_whole() ? 14 : 3;
    size_t wrong = 0;
    study *s = measured(f, study_text);
    copy_results(f, "results", "whole");
    for (size_t trial = 0; trial < trials; trial++) {
        made_times m = {
            .drift = 0.03, .layout = 0.01, .noise = 0.01, .processes = 6 + (long)trial % 10, .seed = 1000 + trial};
        copy_results(f, "whole", "results");
        make_times(f, "results", &m);
        contrast *c = compared(s, "render.depth=1", "render.depth=2", f);
        for (size_t i = 0; i < 2; i++)
            wrong += c->lines[i].verdict != CONTRAST_CANNOT_TELL;
        contrast_destroy(c);
    }
    if (wrong > most)
        fail_msg("%zu of %zu comparisons of equal sides had a verdict", wrong, 2 * trials);
    study_destroy(s);
}

/* A pilot of 6 processes predicts the number for 3% at 95% power; a binomial variable of 20 at 0.95 is below 16 with a
 * probability of 0.3%, one of 4 is below 3 with 1.4%. */
static void the_predicted_number_suffices(void **state)
{
    const fixture *f = *state;
    const size_t trials = is_whole() ? 20 : 4, missed_most = is_whole() ? 4 : 1;
    size_t found = 0, tries = 0;
    study *s = measured(f, study_text);
    copy_results(f, "results", "whole");
    for (size_t trial = 0; trial < trials; trial++) {
        made_times pilot = {.drift = 0.05, .layout = 0.01, .noise = 0.01, .processes = 6, .seed = 50 + trial};
        copy_results(f, "whole", "results");
        make_times(f, "results", &pilot);
        contrast *c = compared(s, "cell=0", "cell=2", f);
        const size_t needed = c->lines[0].pairs_needed;
        contrast_destroy(c);
        assert_true(needed >= 3);
        if (needed > PROCESSES)
            continue;
        tries++;
        made_times m = pilot;
        m.effect = log(1.03);
        m.processes = (long)(needed < 6 ? 6 : needed); /* an interval needs 6 repetitions */
        m.seed = 5000 + trial;
        copy_results(f, "whole", "results");
        make_times(f, "results", &m);
        c = compared(s, "cell=0", "cell=2", f);
        found += c->lines[0].verdict == CONTRAST_SLOWER;
        contrast_destroy(c);
    }
    assert_true(tries >= trials - trials / 10);
    if (found + missed_most < tries)
        fail_msg("3%% was found in %zu of %zu tries", found, tries);
    study_destroy(s);
}

static void json_has_every_cell(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 2]}]\nrepetitions: 6\n");
    fixture_run(f, s);
    contrast *c = compared(s, f->results, f->results, f);
    json_t *json = contrast_json(s, c, 1), *cell = json_array_get(json_object_get(json, "cells"), 0);
    assert_int_equal(json_integer_value(json_object_get(json, "count")), 2);
    assert_int_equal(json_array_size(json_object_get(json, "cells")), 1);
    assert_string_equal(json_string_value(json_object_get(cell, "render.depth")), "1");
    assert_string_equal(json_string_value(json_object_get(cell, "verdict")), "cannot tell");
    assert_true(json_is_null(json_object_get(cell, "pairs_needed")));
    assert_true(json_is_true(json_object_get(cell, "same_film")));
    json_decref(json);
    contrast_destroy(c);
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(a_known_ratio_is_found),
        CASE(only_sides_that_alternate_are_told_apart),
        CASE(all_cells_count_though_no_process_has_them),
        CASE(unknown_sides_are_refused),
        CASE(few_processes_tell_nothing),
        CASE(environments_are_never_pooled),
        CASE(invalid_sides_are_refused),
        CASE(equal_sides_rarely_differ),
        CASE(the_predicted_number_suffices),
        CASE(json_has_every_cell),
    };
    return cmocka_run_group_tests_name("contrast", tests, NULL, NULL);
}
