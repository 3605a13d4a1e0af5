/* Tests of a study's list of runs: the provenance and the environments of rows, without names of hosts and paths. */
#include "study/rows/facts.h"
#include "study/rows/runs.h"
#include "study_fixture.h"
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <pthread.h>
#include <stdatomic.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/syscall.h>

static json_t *list_of(const fixture *f)
{
    char path[400];
    fixture_path(f, "results/test/runs.json", path);
    json_t *list = json_load_file(path, 0, NULL);
    assert_non_null(list);
    return list;
}

static const char *text_at(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    if (!text)
        fail_msg("no text under %s", key);
    return text;
}

static const char first_text[] = "study: test\nscene: scene.yaml\nrepetitions: 1\nwarmups: 0\n";
static const char second_text[] = "study: test\nscene: scene.yaml\nrepetitions: 2\nwarmups: 0\n";

static void runs_record_the_provenance_of_rows(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, first_text);
    fixture_run(f, s);
    json_t *list = list_of(f);
    const json_t *about = json_object_get(list, "study"), *machine = json_object_get(list, "machine");
    assert_string_equal(text_at(about, "name"), "test");
    assert_string_equal(text_at(about, "file"), "test.study");
    assert_string_equal(text_at(about, "text"), first_text);
    assert_string_equal(text_at(about, "scene_file"), "scene.yaml");
    assert_string_equal(text_at(about, "scene_text"), fixture_scene);
    assert_non_null(strstr(text_at(machine, "hwloc_xml"), "<topology"));
    assert_true(text_at(machine, "topology")[0]);
    assert_true(json_integer_value(json_object_get(machine, "processing_units")) >= 1);
    assert_true(json_real_value(json_object_get(json_object_get(machine, "clocks"), "wall_tick_s")) > 0);
    const json_t *runs = json_object_get(list, "runs");
    assert_int_equal(json_array_size(runs), 1);
    const json_t *run = json_array_get(runs, 0);
    static const char *const keys[] = {"id",    "started_utc", "ended_utc", "version",    "compiler",
                                       "flags", "config",      "kernel",    "study_text", "binding"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        assert_true(text_at(run, keys[i])[0]);
    const json_t *environment = json_object_get(run, "environment");
    static const char *const facts[] = {"key",      "machine", "cpu_model", "microcode", "smt",
                                        "governor", "limits",  "isa",       "build"};
    for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++)
        assert_true(text_at(environment, facts[i])[0]);
    const json_t *sealed = json_object_get(json_object_get(run, "rows"), "rows");
    assert_int_equal(json_integer_value(json_object_get(sealed, "count")), 1);
    assert_int_equal(strlen(text_at(sealed, "checksum")), 16);
    static const char *const libraries[] = {"libpng", "libjpeg-turbo", "hwloc", "libyaml", "jansson", "OpenEXR"};
    for (size_t i = 0; i < sizeof libraries / sizeof libraries[0]; i++)
        assert_true(strchr(text_at(json_object_get(run, "libraries"), libraries[i]), '.') != NULL);
    assert_true(json_is_array(json_object_get(run, "disturbances")));
    json_decref(list);
    study_destroy(s);
}

static void each_run_is_added(void **state)
{
    const fixture *f = *state;
    assert_int_equal(setenv("SOURCE_DATE_EPOCH", "1000000000", 1), 0);
    study *s = fixture_study(f, first_text);
    fixture_run(f, s);
    study_destroy(s);
    json_t *before = list_of(f);
    assert_int_equal(setenv("SOURCE_DATE_EPOCH", "1000000001", 1), 0);
    s = fixture_study(f, second_text);
    assert_int_equal(fixture_run(f, s), 1);
    assert_int_equal(fixture_run(f, s), 0);
    unsetenv("SOURCE_DATE_EPOCH");
    json_t *after = list_of(f);
    assert_int_equal(json_array_size(json_object_get(after, "runs")), 2);
    assert_true(json_equal(json_object_get(before, "study"), json_object_get(after, "study")));
    assert_true(json_equal(json_array_get(json_object_get(before, "runs"), 0),
                           json_array_get(json_object_get(after, "runs"), 0)));
    assert_string_equal(text_at(json_array_get(json_object_get(after, "runs"), 0), "started_utc"),
                        "2001-09-09T01:46:40.000Z");
    assert_string_equal(text_at(json_array_get(json_object_get(after, "runs"), 1), "started_utc"),
                        "2001-09-09T01:46:41.000Z");
    json_decref(before);
    json_decref(after);
    study_destroy(s);
}

/* Each process measures its part of the repetitions of every cell, after its own warm-up, as a run of its own. */
static void processes_divide_the_repetitions(void **state)
{
    const fixture *f = *state;
    static const char text[] = "study: test\nscene: scene.yaml\ngrid: [{render.depth: [1, 2]}]\nrepetitions: 7\n"
                               "processes: 3\nkeep: {image: on}\n";
    static const size_t parts[] = {3, 2, 2};
    study *s = fixture_study(f, text);
    assert_int_equal(study_processes(s), 3);
    for (long process = 1; process <= 3; process++) {
        size_t ran = 0;
        const study_options options = {.results = f->results, .process = process};
        assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_OK);
        assert_int_equal(ran, 2 * (1 + parts[process - 1]));
        assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_OK);
        assert_int_equal(ran, 0);
        assert_false(fixture_has(f, "results/test/images/0000.png"));
    }
    json_t *list = list_of(f);
    assert_int_equal(json_array_size(json_object_get(list, "runs")), 3);
    json_decref(list);
    assert_int_equal(fixture_run(f, s), 0); /* the last process makes the kept files */
    assert_true(fixture_has(f, "results/test/images/0000.png"));
    study_destroy(s);
}

/* With a rule there are as many processes again, which measure beyond the least number. */
static void processes_divide_further_repetitions(void **state)
{
    const fixture *f = *state;
    static const char text[] = "study: test\nscene: scene.yaml\nwarmups: 0\nprocesses: 2\n"
                               "repetitions: {min: 4, max: 8, relative_width: 1e-9}\n";
    study *s = fixture_study(f, text);
    assert_int_equal(study_processes(s), 4);
    for (long process = 1; process <= 4; process++) {
        size_t ran = 0;
        const study_options options = {.results = f->results, .process = process};
        assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_OK);
        assert_int_equal(ran, 2);
    }
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
}

static void runs_contain_no_host_name_or_path(void **state)
{
    const fixture *f = *state;
    char host[256] = "";
    study *s = fixture_study(f, first_text);
    fixture_run(f, s);
    char *text = fixture_text(f, "results/test/runs.json");
    assert_int_equal(gethostname(host, sizeof host - 1), 0);
    assert_null(strstr(text, f->folder));
    /* A short name may be part of another word. */
    if (strlen(host) > 8)
        assert_null(strstr(text, host));
    static const char *const telling[] = {"HostName", "Serial", "UUID"};
    for (size_t i = 0; i < sizeof telling / sizeof telling[0]; i++)
        assert_null(strstr(text, telling[i]));
    free(text);
    study_destroy(s);
}

static void damaged_lists_are_refused(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, first_text);
    fixture_run(f, s);
    study_destroy(s);
    fixture_write(f, "results/test/runs.json", "{\"study\": 1");
    s = fixture_study(f, second_text);
    diagnostic why = {0};
    size_t ran;
    study_options options = {.results = f->results};
    assert_int_equal(study_run(s, &options, &ran, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.file, "runs.json"));
    study_destroy(s);
}

static void identifying_entries_are_removed_from_the_topology(void **state)
{
    (void)state;
    char xml[] =
        "<topology>\n  <info name=\"HostName\" value=\"alpha\"/>\n  <info name=\"OSName\" value=\"Linux\"/>\n"
        "  <info name=\"DMIProductSerial\" value=\"123\"/>\n  <info name=\"LinuxCgroup\" value=\"/user/me\"/>\n"
        "  <object type=\"PU\"/>\n  <info name=\"DMIProductUUID\" value=\"x\"/>\n</topology>";
    provenance_anonymize(xml);
    assert_string_equal(xml,
                        "<topology>\n  <info name=\"OSName\" value=\"Linux\"/>\n  <object type=\"PU\"/>\n</topology>");
    provenance_anonymize(NULL);
}

/* A repository with one commit; silent without git. */
static void the_commit_of_a_repository_is_found(void **state)
{
    const fixture *f = *state;
    char command[2000];
    bool dirty = true;
    assert_null(provenance_git_commit("/", &dirty));
    assert_false(dirty);
    assert_null(provenance_git_commit("/nowhere at all", &dirty));
    snprintf(command, sizeof command,
             "cd '%s' && git init -q . && git add scene.yaml && git -c user.name=x -c user.email=x@example.org commit "
             "-q -m x 2>/dev/null",
             f->folder);
    if (system(command) != 0)
        skip();
    char *commit = provenance_git_commit(f->folder, &dirty);
    assert_non_null(commit);
    assert_int_equal(strlen(commit), 40);
    assert_false(dirty);
    free(commit);
    fixture_write(f, "other", "untracked files do not count");
    free(provenance_git_commit(f->folder, &dirty));
    assert_false(dirty);
    fixture_write(f, "scene.yaml", "title: changed\n");
    free(provenance_git_commit(f->folder, &dirty));
    assert_true(dirty);
}

/* --- lists of several processes --- */

typedef struct merging {
    const fixture *of;
    atomic_bool done;
} merging;

static void *merge(void *context)
{
    merging *m = context;
    char folder[400];
    fixture_path(m->of, "results/test", folder);
    const status code = runs_merge(folder, NULL, NULL);
    atomic_store(&m->done, true);
    return code == STATUS_OK ? m : NULL;
}

/* Whoever changes a list waits for another who does. */
static void lists_are_changed_by_one_at_a_time(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, first_text);
    fixture_run(f, s);
    char folder[400];
    fixture_path(f, "results/test", folder);
    const int other = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    assert_true(other >= 0 && flock(other, LOCK_EX) == 0);
    merging m = {.of = f};
    pthread_t thread;
    void *result = NULL;
    assert_int_equal(pthread_create(&thread, NULL, merge, &m), 0);
    usleep(100000);
    const bool waited = !atomic_load(&m.done);
    close(other);
    assert_int_equal(pthread_join(thread, &result), 0);
    assert_true(waited && result == &m);
    study_destroy(s);
}

/* As of a kernel that has just been started. */
static bool no_random;

ssize_t getrandom(void *buffer, size_t size, unsigned flags)
{
    if (!no_random)
        return syscall(SYS_getrandom, buffer, size, flags);
    errno = EAGAIN;
    return -1;
}

static void ids_differ_by_their_time_too(void **state)
{
    (void)state;
    enum { IDS = 5 };
    const run_environment here = {.key = ""};
    char id[IDS][RUN_ID];
    no_random = true;
    for (size_t i = 0; i < IDS; i++) {
        usleep(1000);
        runs_make_id(&here, id[i]);
    }
    no_random = false;
    for (size_t i = 0; i < IDS; i++)
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(id[i], id[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(runs_record_the_provenance_of_rows, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(processes_divide_the_repetitions, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(processes_divide_further_repetitions, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(each_run_is_added, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(runs_contain_no_host_name_or_path, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(damaged_lists_are_refused, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(lists_are_changed_by_one_at_a_time, fixture_setup, fixture_teardown),
        cmocka_unit_test(ids_differ_by_their_time_too),
        cmocka_unit_test(identifying_entries_are_removed_from_the_topology),
        cmocka_unit_test_setup_teardown(the_commit_of_a_repository_is_found, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("study_runs", tests, NULL, NULL);
}
