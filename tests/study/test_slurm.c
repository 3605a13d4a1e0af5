/* Tests of study/run/slurm.h: what a study asks of a cluster, and the script of its jobs. */
#include "study_fixture.h"

#include "study/run/slurm.h"

static char *array_of(const char *missing)
{
    study_estimate parts[16] = {{.cells = 1}};
    const size_t count = strlen(missing);
    parts[count] = (study_estimate){.cells = 1, .cells_lacking = 1}; /* behind the last one */
    for (size_t i = 0; i < count; i++)
        parts[i] = (study_estimate){.cells = 1, .cells_lacking = missing[i] == 'r', .cells_to_keep = missing[i] == 'f'};
    return slurm_array(parts, count);
}

/* r: rows are missing; f: only files. */
static void missing_parts_are_listed_as_ranges(void **state)
{
    static const char *const cases[][2] = {{"rrrr", "0-3"}, {"....", ""},          {"r...", "0"},      {"...f", "3"},
                                           {"r.r.", "0,2"}, {"rr.frr", "0-1,3-5"}, {".rf.r", "1-2,4"}, {"", ""}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *array = array_of(cases[i][0]);
        assert_string_equal(array, cases[i][1]);
        free(array);
    }
}

static void the_longest_part_that_is_missing_counts(void **state)
{
    (void)state;
    study_estimate parts[] = {{.cells_lacking = 1, .most_s = 5}, {.most_s = 0}, {.cells_to_keep = 1, .most_s = 7}};
    assert_true(slurm_longest_s(parts, 3) == 7);
    assert_true(slurm_longest_s(parts + 1, 1) == 0);
    parts[1].most_s = NAN; /* of a complete part */
    assert_true(slurm_longest_s(parts, 3) == 7);
    parts[1].cells_lacking = 1;
    assert_true(isnan(slurm_longest_s(parts, 3)));
    parts[1] = (study_estimate){.cells_lacking = 1, .most_s = 1, .cut = true}; /* "more than" */
    assert_true(isnan(slurm_longest_s(parts, 3)));
}

static void time_limits_are_whole_minutes(void **state)
{
    static const struct {
        double longest_s, factor;
        const char *limit;
    } cases[] = {{0, 3, "00:10:00"},       {200, 3, "00:10:00"},           {201, 3, "00:11:00"},
                 {1200, 3, "01:00:00"},    {86399, 1, "1-00:00:00"},       {86400, 3, "3-00:00:00"},
                 {90061, 1, "1-01:02:00"}, {INFINITY, 3, "69444-10:40:00"}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char limit[SLURM_TIME];
        slurm_time_limit(cases[i].longest_s, cases[i].factor, limit);
        assert_string_equal(limit, cases[i].limit);
    }
}

static char *fill(const char *text)
{
    static const slurm_word words[] = {
        {"name", "rod"}, {"constraint", NULL}, {"study", "it's a/rod.study"}, {"by", ""}};
    char *out = NULL;
    assert_int_equal(slurm_fill("own.slurm", text, words, 4, &out, NULL), STATUS_OK);
    return out;
}

static void words_of_the_script_are_replaced(void **state)
{
    static const char *const cases[][2] = {
        {"#SBATCH --job-name=@name@\n", "#SBATCH --job-name=rod\n"},
        {"a\n#SBATCH --constraint=@constraint@\nb\n", "a\nb\n"},
        {"@name@ @constraint@", ""},
        {"study=@study@\n", "study='it'\\''s a/rod.study'\n"},
        {"@name@@name@", "rodrod"},
        {"by=@by@", "by=''"},
        {"--mail-user=me@here.org # @ signs @\n\nlast", "--mail-user=me@here.org # @ signs @\n\nlast"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *filled = fill(cases[i][0]);
        assert_string_equal(filled, cases[i][1]);
        free(filled);
    }
}

static void unknown_words_are_located(void **state)
{
    static const slurm_word words[] = {{"name", "rod"}, {"time", "1"}};
    char *out = NULL;
    diagnostic why = {0};
    (void)state;
    assert_int_equal(slurm_fill("own.slurm", "one\n@name@ @nmae@\n", words, 2, &out, &why), STATUS_BAD_INPUT);
    assert_null(out);
    assert_string_equal(why.file, "own.slurm");
    assert_true(why.line == 2 && why.column == 8);
    assert_string_equal(why.what, "unknown word @nmae@");
    assert_string_equal(why.remedy, "use one of name, time");
}

static void the_largest_cell_determines_the_needs(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *grid;
        long threads, memory_gib;
    } cases[] = {{"grid: [{render.depth: [1, 2]}]\n", 1, 1},
                 {"grid: [{render.threads: [1, 8, 2]}]\n", 8, 1},
                 {"set: {render.width: 8000}\ngrid: [{render.height: [100, 4000]}]\n", 1, 3}}; /* 2.4 GiB */
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[300];
        slurm_needs needs;
        snprintf(text, sizeof text, "study: test\nscene: scene.yaml\n%srepetitions: 1\n", cases[i].grid);
        study *s = fixture_study(f, text);
        assert_int_equal(slurm_needs_of(s, &needs, NULL), STATUS_OK);
        assert_int_equal(needs.threads, cases[i].threads);
        assert_int_equal(needs.memory_gib, cases[i].memory_gib);
        study_destroy(s);
    }
}

/* The rows of nodes of the type count, those of others do not; of unlike nodes of the type, those with most rows. */
static void the_environment_is_that_of_the_node_type(void **state)
{
    const fixture *f = *state;
    char key[ENVIRONMENT_KEY], again[ENVIRONMENT_KEY], unlike[300];
    size_t others;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\ngrid: [{render.depth: [0, 1, 2]}]\n"
                                "repetitions: 2\nwarmups: 0\n");
    fixture_run(f, s); /* of this machine */
    assert_int_equal(slurm_environment(s, f->results, "thin", key, unlike, sizeof unlike, &others, NULL), STATUS_OK);
    assert_string_equal(key, "none");
    assert_int_equal(others, 6);
    setenv("CUVETTE_NODE_TYPE", "thin", 1);
    setenv("CUVETTE_ISA", isa_name(ISA_BASE), 1);
    const study_options part = {.results = f->results, .shard = 0, .shards = 2}; /* two of three cells */
    assert_int_equal(study_run(s, &part, NULL, NULL), STATUS_OK);
    assert_int_equal(slurm_environment(s, f->results, "thin", key, unlike, sizeof unlike, &others, NULL), STATUS_OK);
    assert_int_equal(strlen(key), 8);
    assert_int_equal(others, 6);
    assert_string_equal(unlike, "");
    if (isa_best() > ISA_BASE) {
        unsetenv("CUVETTE_ISA");
        const study_options rest = {.results = f->results, .shard = 1, .shards = 2};
        assert_int_equal(study_run(s, &rest, NULL, NULL), STATUS_OK);
        assert_int_equal(slurm_environment(s, f->results, "thin", again, unlike, sizeof unlike, &others, NULL),
                         STATUS_OK);
        assert_string_equal(again, key);
        assert_non_null(strstr(unlike, "isa "));
    }
    unsetenv("CUVETTE_NODE_TYPE");
    unsetenv("CUVETTE_ISA");
    assert_int_equal(slurm_environment(s, f->results, "fat", key, unlike, sizeof unlike, &others, NULL), STATUS_OK);
    assert_string_equal(key, "none");
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_parts_are_listed_as_ranges), cmocka_unit_test(the_longest_part_that_is_missing_counts),
        cmocka_unit_test(time_limits_are_whole_minutes),      cmocka_unit_test(words_of_the_script_are_replaced),
        cmocka_unit_test(unknown_words_are_located),          CASE(the_largest_cell_determines_the_needs),
        CASE(the_environment_is_that_of_the_node_type),
    };
    return cmocka_run_group_tests_name("slurm", tests, NULL, NULL);
}
