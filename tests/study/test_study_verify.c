/* Tests of the checks of rows: every edit, removal, duplication and swap is detected, in every column; rows of unlike
 * environments are never pooled. */
#include "base/csv.h"
#include "base/installed.h"
#include "random_stream.h"
#include "rows_fixture.h"
#include "study/rows/environment.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/summary/summary.h"
#include "study/summary/verify.h"
#include "study_fixture.h"
#include <errno.h>

static const char study_text[] = "study: test\n"
                                 "scene: scene.yaml\n"
                                 "grid: [{render.depth: [0, 1, 2]}, {render.threads: [1, 2]}]\n"
                                 "reference: {render.depth: 3}\n"
                                 "repetitions: 3\n"
                                 "keep: {workers: on}\n";
static const char *const names[] = {"results/test/rows.csv", "results/test/workers.csv", "results/test/compare.csv"};

static study_verdict verify(const fixture *f, const study *s)
{
    study_verdict verdict;
    diagnostic why = {0};
    char message[DIAGNOSTIC_TEXT_MAX];
    FILE *out = fopen("/dev/null", "w");
    if (study_verify(s, f->results, out, &verdict, &why) != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, message, sizeof message));
    fclose(out);
    return verdict;
}

/* --- damage --- */

enum { LINES_MAX = 200, FIELDS_MAX = 200 };
typedef struct lines {
    char *text, *line[LINES_MAX]; /* the header first */
    size_t count;
} lines;

static lines split_lines(const char *text)
{
    lines l = {.text = strdup(text)};
    for (char *rest = l.text, *line; (line = strsep(&rest, "\n")) && *line;) {
        assert_true(l.count < LINES_MAX);
        l.line[l.count++] = line;
    }
    return l;
}

static void write_lines(const fixture *f, const char *name, const lines *l)
{
    size_t size = 1;
    for (size_t i = 0; i < l->count; i++)
        size += strlen(l->line[i]) + 1;
    char *text = calloc(1, size);
    for (size_t i = 0, at = 0; i < l->count; i++)
        at += (size_t)sprintf(text + at, "%s\n", l->line[i]);
    fixture_write(f, name, text);
    free(text);
}

/* One field of a line with another value: a changed digit, NA, nothing, a word, a negative number. */
static char *edited(const char *line, size_t column, uint64_t how)
{
    static const char *const values[] = {"NA", "nan", "-3.5", "abc", "", "0", "1e300"};
    char *copy = strdup(line), *fields[FIELDS_MAX], old[4000];
    const size_t count = csv_split(copy, fields);
    csv_buffer out = {0};
    assert_true(count > column && count < FIELDS_MAX);
    snprintf(old, sizeof old, "%s", fields[column]);
    char value[4000];
    snprintf(value, sizeof value, "%s", how < 7 ? values[how] : old);
    if (how >= 7 && value[0])
        value[how % strlen(value)] = value[how % strlen(value)] == '7' ? '8' : '7';
    if (strcmp(value, old) == 0)
        snprintf(value, sizeof value, "%s", strcmp(old, "1") == 0 ? "2" : "1");
    for (size_t i = 0; i < count; i++)
        csv_text(&out, i == column ? value : fields[i]);
    free(copy);
    return out.text;
}

static size_t column_count(const char *line)
{
    char *copy = strdup(line), *fields[FIELDS_MAX];
    const size_t count = csv_split(copy, fields);
    free(copy);
    return count;
}

typedef enum damage { EDIT, REMOVE, DUPLICATE, SWAP, DAMAGES } damage;

/* Damages the lines at random; describes it in text. */
static void damage_lines(lines *l, damage kind, size_t column, uint64_t random, char *text, size_t size)
{
    const size_t row = 1 + random % (l->count - 1),
                 other = 1 + (row - 1 + 1 + (random >> 20) % (l->count - 2)) % (l->count - 1);
    snprintf(text, size, "damage %d, line %zu and %zu, column %zu", kind, row + 1, other + 1, column);
    if (kind == EDIT) {
        l->line[row] = edited(l->line[row], column, (random >> 40) % 30);
        return;
    }
    if (kind == SWAP) {
        char *line = l->line[row];
        l->line[row] = l->line[other];
        l->line[other] = line;
        return;
    }
    if (kind == REMOVE) {
        memmove(l->line + row, l->line + row + 1, (l->count - row - 1) * sizeof(char *));
        l->count--;
        return;
    }
    char *line = l->line[row];
    memmove(l->line + other + 1, l->line + other, (l->count - other) * sizeof(char *));
    l->line[other] = line;
    l->count++;
}

/* A thousand random edits of every column, removals, duplications and swaps, in files with rows of two runs. */
static void all_damage_is_detected(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    study_destroy(s);
    char more[sizeof study_text];
    memcpy(more, study_text, sizeof more);
    *(strstr(more, "repetitions: 3") + strlen("repetitions: ")) = '4';
    s = fixture_study(f, more);
    fixture_run(f, s);
    assert_int_equal(verify(f, s).faults, 0);
    char *whole[3];
    for (size_t i = 0; i < 3; i++)
        whole[i] = fixture_text(f, names[i]);
    uint64_t seed = 18;
    for (size_t trial = 0, column = 0; trial < 1000; trial++) {
        const size_t file = trial % 3;
        const damage kind = trial % 4 == 0 ? (damage)(trial / 4 % DAMAGES) : EDIT;
        lines l = split_lines(whole[file]);
        char *text = l.text, what[200];
        column = (column + 1) % column_count(l.line[0]);
        char *before[LINES_MAX];
        memcpy(before, l.line, sizeof before);
        damage_lines(&l, kind, column, random_bits(&seed), what, sizeof what);
        write_lines(f, names[file], &l);
        if (verify(f, s).faults == 0)
            fail_msg("%s: %s is not noticed", names[file], what);
        if (kind == EDIT)
            for (size_t i = 0; i < l.count; i++)
                if (l.line[i] != before[i])
                    free(l.line[i]);
        free(text);
        fixture_write(f, names[file], whole[file]);
    }
    assert_int_equal(verify(f, s).faults, 0);
    for (size_t i = 0; i < 3; i++)
        free(whole[i]);
    study_destroy(s);
}

/* An edited row is not used, the others are; every command that reads says so. */
static void edited_rows_are_left_out(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    char *text = fixture_text(f, names[0]);
    lines l = split_lines(text);
    char *edit = edited(l.line[3], 11, 1);
    l.line[3] = edit;
    write_lines(f, names[0], &l);
    study_progress progress;
    diagnostic verdict = {.what = ""}, merged = {.what = ""};
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.faults, 1);
    assert_int_equal(progress.rows, 23);
    assert_int_equal(progress.fault.line, 4);
    FILE *out = fopen("/dev/null", "w");
    assert_int_equal(study_summary_of(s, f->results, &(summary_options){.environment = NULL}, out, &verdict, NULL),
                     STATUS_OK);
    fclose(out);
    assert_int_equal(verdict.line, 4);
    assert_int_equal(study_merge(s, f->results, NULL, &merged, NULL), STATUS_OK);
    assert_int_equal(merged.line, 4);
    free(edit);
    free(l.text);
    free(text);
    study_destroy(s);
}

static bool change_rays_of_first(void *context, const csv *table, char **fields)
{
    static char few[] = "7";
    size_t *row = context;
    if ((*row)++ == 0)
        fields[csv_column(table, "rays_total")] = few;
    return true;
}

/* Of three rows the first has other rays: it differs from the majority, not the two from it. */
static void the_majority_is_right(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 3\nwarmups: 0\n");
    fixture_run(f, s);
    char path[400];
    size_t row = 0;
    fixture_path(f, names[0], path);
    rows_edit(path, change_rays_of_first, &row);
    fixture_path(f, "results/test/runs.json", path);
    rows_unseal(path);
    row_files *files;
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    assert_int_equal(files->fault_count, 1);
    assert_int_equal(files->issues[0].fault, ROW_DIFFERS);
    assert_int_equal(files->issues[0].line, 2);
    assert_int_equal(files->row_count, 2);
    row_files_destroy(files);
    study_destroy(s);
}

/* A kill leaves an incomplete line; that is no fault. */
static void torn_lines_are_no_fault(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    char *text = fixture_text(f, names[0]), *longer = calloc(1, strlen(text) + 10);
    sprintf(longer, "%stest,12", text);
    fixture_write(f, names[0], longer);
    assert_int_equal(verify(f, s).faults, 0);
    free(longer);
    free(text);
    study_destroy(s);
}

/* The order of columns, and columns without a value, do not change the checksum of a row; anything else does. */
static void checks_depend_on_names_and_values_only(void **state)
{
    (void)state;
    char *header[] = {"a", "b", "checksum", "c"}, *other[] = {"c", "checksum", "b", "later", "a"};
    char *row[] = {"1", "NA", "x", "2;3"}, *same[] = {"2;3", "y", "NA", "NA", "1"},
         *swapped[] = {"1", "NA", "y", "NA", "2;3"};
    checksum_columns first, second;
    assert_int_equal(checksum_columns_create(header, 4, &first, NULL), STATUS_OK);
    assert_int_equal(checksum_columns_create(other, 5, &second, NULL), STATUS_OK);
    assert_int_equal(checksum_content(&first, row), checksum_content(&second, same));
    assert_int_not_equal(checksum_content(&first, row), checksum_content(&second, swapped));
    checksum_columns_free(&first);
    checksum_columns_free(&second);
    char text[CHECKSUM_TEXT];
    uint32_t content, chain;
    checksum_text(0x12345678, 0x9abcdef0, text);
    assert_string_equal(text, "123456789abcdef0");
    assert_true(checksum_parse(text, &content, &chain));
    assert_int_equal(content, 0x12345678);
    assert_int_equal(chain, UINT32_C(0x9abcdef0));
    assert_false(checksum_parse("123456789abcdef", &content, &chain));
    assert_false(checksum_parse("123456789abcdefX", &content, &chain));
}

/* --- environments --- */

/* The error with which a file of the system is refused; 0: it is opened. */
static int refusal;

FILE *fopen(const char *restrict path, const char *restrict mode)
{
    if (!refusal || !strstr(path, "/sys/devices/system/cpu/smt/active"))
        return fopen64(path, mode);
    errno = refusal;
    return NULL;
}

static void write_system(const fixture *f, const char *file, const char *text)
{
    char path[400], folder[500];
    fixture_path(f, file, path);
    snprintf(folder, sizeof folder, "mkdir -p \"$(dirname '%s')\"", path);
    assert_int_equal(system(folder), 0);
    fixture_write(f, file, text);
}

static run_environment read_system(const fixture *f, isa level)
{
    char root[400];
    run_environment e;
    fixture_path(f, "root", root);
    assert_int_equal(environment_read(root, level, &e, NULL), STATUS_OK);
    return e;
}

/* Each fact of the system changes the key; the difference names it. */
static void every_fact_is_part_of_the_key(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *file, *before, *after, *name;
    } facts[] = {
        {"root/etc/machine-id", "aaaa\n", "bbbb\n", "machine"},
        {"root/proc/cpuinfo", "model name\t: One\nmicrocode\t: 0x1\n", "model name\t: Two\nmicrocode\t: 0x1\n",
         "cpu_model"},
        {"root/proc/cpuinfo", "model name\t: One\nmicrocode\t: 0x1\n", "model name\t: One\nmicrocode\t: 0x2\n",
         "microcode"},
        {"root/sys/devices/system/cpu/smt/active", "0\n", "1\n", "smt"},
        {"root/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n", "powersave\n", "governor"},
        {"root/sys/fs/cgroup/a/cpu.max", "max 100000\n", "50000 100000\n", "limits"},
        {"root/sys/fs/cgroup/memory.max", "max\n", "1000000\n", "limits"},
    };
    write_system(f, "root/proc/self/cgroup", "0::/a/b\n");
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++)
        write_system(f, facts[i].file, facts[i].before);
    const run_environment usual = read_system(f, ISA_BASE);
    assert_int_equal(strlen(usual.key), 8);
    char text[400];
    assert_false(environment_difference(&usual, &usual, text, sizeof text));
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
        write_system(f, facts[i].file, facts[i].after);
        const run_environment other = read_system(f, ISA_BASE);
        assert_string_not_equal(other.key, usual.key);
        assert_true(environment_difference(&other, &usual, text, sizeof text));
        assert_int_equal(strncmp(text, facts[i].name, strlen(facts[i].name)), 0);
        write_system(f, facts[i].file, facts[i].before);
    }
    assert_string_equal(read_system(f, ISA_BASE).key, usual.key);
    if (isa_best() > ISA_BASE)
        assert_string_not_equal(read_system(f, isa_best()).key, usual.key);
    assert_int_equal(setenv("CUVETTE_MACHINE", "other", 1), 0);
    assert_string_not_equal(read_system(f, ISA_BASE).key, usual.key);
    unsetenv("CUVETTE_MACHINE");
    assert_null(strstr(usual.fact[0], "aaaa")); /* the id is not published */
    assert_string_equal(usual.fact[ENVIRONMENT_FACTS - 1], build_id());
    write_system(f, "root/proc/cpuinfo", "processor\t: 0\nCPU part\t: 0xd0b\n"); /* of an ARM board */
    write_system(f, "root/proc/device-tree/model", "Board 5");
    assert_string_equal(read_system(f, ISA_BASE).fact[1], "Board 5");
}

/* What a system does not have or does not show is unknown; that it cannot be read now is an error. */
static void absent_facts_are_no_error(void **state)
{
    const fixture *f = *state;
    static const int absent[] = {ENOENT, ENOTDIR, EACCES, EPERM, ENODEV, EINVAL, EOPNOTSUPP, ENXIO};
    static const int wrong[] = {EIO, EMFILE, ENFILE, ENOMEM};
    char root[400];
    run_environment e;
    write_system(f, "root/sys/devices/system/cpu/smt/active", "1\n");
    fixture_path(f, "root", root);
    assert_string_equal(read_system(f, ISA_BASE).fact[3], "1");
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++) {
        refusal = absent[i];
        assert_string_equal(read_system(f, ISA_BASE).fact[3], "unknown");
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        refusal = wrong[i];
        assert_int_equal(environment_read(root, ISA_BASE, &e, NULL), STATUS_FAILURE);
    }
    refusal = 0;
}

/* Nodes that are declared alike count as one machine, unless another fact tells them apart. */
static void nodes_of_a_type_are_one_machine(void **state)
{
    const fixture *f = *state;
    char type[ENVIRONMENT_FACT_MAX];
    write_system(f, "root/etc/machine-id", "aaaa\n");
    write_system(f, "root/proc/cpuinfo", "model name\t: One\n");
    const run_environment alone = read_system(f, ISA_BASE);
    assert_int_equal(setenv("CUVETTE_NODE_TYPE", "thin", 1), 0);
    const run_environment first = read_system(f, ISA_BASE);
    write_system(f, "root/etc/machine-id", "bbbb\n");
    assert_string_equal(read_system(f, ISA_BASE).key, first.key);
    assert_string_not_equal(first.key, alone.key);
    environment_of_node_type("thin", type, sizeof type);
    assert_string_equal(first.fact[0], type);
    write_system(f, "root/proc/cpuinfo", "model name\t: Two\n");
    assert_string_not_equal(read_system(f, ISA_BASE).key, first.key);
    write_system(f, "root/proc/cpuinfo", "model name\t: One\n");
    assert_int_equal(setenv("CUVETTE_NODE_TYPE", "fat", 1), 0);
    assert_string_not_equal(read_system(f, ISA_BASE).key, first.key);
    unsetenv("CUVETTE_NODE_TYPE");
}

static size_t count_environments(const fixture *f, const study *s)
{
    row_files *files;
    row_environment_count *all;
    size_t count;
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    assert_int_equal(row_environments_find(files, &all, &count, NULL), STATUS_OK);
    free(all);
    row_files_destroy(files);
    return count;
}

/* Two machines and two instruction sets: each is measured completely, and no line of the summary has rows of two. */
static void unlike_environments_are_never_pooled(void **state)
{
    const fixture *f = *state;
    const char *const machines[] = {"one", "two"}, *const levels[] = {isa_name(ISA_BASE), NULL};
    study *s = fixture_study(f, study_text);
    for (size_t i = 0; i < 4; i++) {
        setenv("CUVETTE_MACHINE", machines[i % 2], 1);
        if (levels[i / 2])
            setenv("CUVETTE_ISA", levels[i / 2], 1);
        else
            unsetenv("CUVETTE_ISA");
        if (isa_best() == ISA_BASE && i > 1)
            continue;
        assert_int_equal(fixture_run(f, s), 24);
        assert_int_equal(fixture_run(f, s), 0);
        assert_int_equal(count_environments(f, s), i + 1);
    }
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(study_summary(s, f->results, out, NULL), STATUS_OK);
    fclose(out);
    const size_t environments = count_environments(f, s);
    assert_int_equal(fixture_count(text, "\n"), 1 + 6 * environments);
    const char *line = strchr(text, '\n') + 1; /* n = 3 repetitions in every line, and never 6 or 12 */
    for (size_t i = 0, n = 0; i < 6 * environments; i++, line = strchr(line, '\n') + 1) {
        assert_int_equal(sscanf(line, "%*u\t%*u\t%*u\t%zu\t", &n), 1);
        assert_int_equal(n, 3);
    }
    free(text);
    unsetenv("CUVETTE_MACHINE");
    /* All of them count if that is wanted. */
    diagnostic why = {0};
    size_t ran;
    study_options options = {.results = f->results, .any_environment = true};
    assert_int_equal(study_run(s, &options, &ran, &why), STATUS_OK);
    assert_int_equal(ran, 0);
    study_destroy(s);
}

static void without_rows_no_environment_is_the_main_one(void **state)
{
    (void)state;
    const row_files none = {.count = 0};
    char key[ENVIRONMENT_KEY] = "deadbee";
    assert_int_equal(row_environments_main(&none, key, NULL), STATUS_OK);
    assert_string_equal(key, "");
}

/* Warm-ups do not count; of equal environments the last one is shown. */
static void the_environment_with_most_rows_is_the_main_one(void **state)
{
    (void)state;
    row_ref rows[] = {
        {.run = -1, .environment = "aaaaaaaa", .warmup = true},
        {.run = -1, .environment = "aaaaaaaa", .warmup = true},
        {.run = -1, .environment = "aaaaaaaa"},
        {.run = -1, .environment = "bbbbbbbb"},
        {.run = -1, .environment = "bbbbbbbb"},
        {.run = -1, .environment = "aaaaaaaa"},
        {.run = -1, .environment = "aaaaaaaa"},
    };
    const char *const expected[] = {[5] = "bbbbbbbb", [6] = "bbbbbbbb", [7] = "aaaaaaaa"};
    for (size_t count = 5; count <= 7; count++) {
        const row_files files = {.rows = rows, .row_count = count};
        char key[ENVIRONMENT_KEY];
        assert_int_equal(row_environments_main(&files, key, NULL), STATUS_OK);
        assert_string_equal(key, expected[count]);
    }
}

/* An error lists as many environments as 255 characters hold. */
static void many_environments_are_listed_in_part(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\n");
    for (int i = 0; i < 18; i++) { /* of 18 characters each */
        char machine[16];
        snprintf(machine, sizeof machine, "m%d", i);
        setenv("CUVETTE_MACHINE", machine, 1);
        assert_int_equal(fixture_run(f, s), 1);
    }
    unsetenv("CUVETTE_MACHINE");
    diagnostic why = {.what = ""}, verdict = {.what = ""};
    FILE *out = fopen("/dev/null", "w");
    assert_int_equal(row_list_write(s, f->results, NULL, out, &verdict, &why), STATUS_BAD_INPUT);
    fclose(out);
    const char *list = strchr(why.what, '('), *end = strchr(why.what, ')');
    assert_int_equal(strncmp(why.what, "the rows are of 18 environments (", 33), 0);
    assert_true(list && end && end - list == 256 && strcmp(end, "), whose times must not be pooled") == 0);
    study_destroy(s);
}

/* The facts of a run in runs.json cannot be edited without notice. */
static void edited_environments_are_noticed(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, study_text);
    fixture_run(f, s);
    char *text = fixture_text(f, "results/test/runs.json");
    char *build = strstr(text, "\"build\": \"");
    assert_non_null(build);
    build[10] = build[10] == 'a' ? 'b' : 'a';
    fixture_write(f, "results/test/runs.json", text);
    assert_true(verify(f, s).faults > 0);
    free(text);
    study_destroy(s);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(all_damage_is_detected),
        CASE(edited_rows_are_left_out),
        CASE(torn_lines_are_no_fault),
        cmocka_unit_test(checks_depend_on_names_and_values_only),
        CASE(every_fact_is_part_of_the_key),
        CASE(unlike_environments_are_never_pooled),
        CASE(nodes_of_a_type_are_one_machine),
        CASE(edited_environments_are_noticed),
        CASE(the_majority_is_right),
        cmocka_unit_test(without_rows_no_environment_is_the_main_one),
        cmocka_unit_test(the_environment_with_most_rows_is_the_main_one),
        CASE(absent_facts_are_no_error),
        CASE(many_environments_are_listed_in_part),
    };
    return cmocka_run_group_tests_name("study_verify", tests, NULL, NULL);
}
