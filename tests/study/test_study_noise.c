/* Tests of disturbed rows: rule, further repetitions up to the limit, news, waiting, and the numbers in status and
 * summary. A rule that every row breaks, or none, makes them independent of the machine. */
#include "base/cancel.h"
#include "measure/clock.h"
#include "study/rows/row_files.h"
#include "study/rows/row_quantity.h"
#include "study/run/run_state.h"
#include "study/summary/summary.h"
#include "study_fixture.h"
#include <signal.h>
#include <sys/wait.h>

static const char study_format[] = "study: test\nscene: scene.yaml\nwarmups: 0\nrepetitions: %s\ndisturbed: %s\n";
static const char never[] = "{others_fraction: 1}", always[] = "{others_fraction: 0}";

static study *study_with(const fixture *f, const char *repetitions, const char *rule)
{
    char text[400];
    snprintf(text, sizeof text, study_format, repetitions, rule);
    return fixture_study(f, text);
}

typedef struct said {
    size_t count;
    char last[200];
} said;

static void hear(void *context, const char *text)
{
    said *s = context;
    s->count++;
    snprintf(s->last, sizeof s->last, "%s", text);
}

/* Keeps a processing unit busy until it is killed. */
static pid_t start_load(void)
{
    const pid_t pid = fork();
    if (pid == 0)
        for (volatile unsigned i = 0;; i++) {
        }
    assert_true(pid > 0);
    const double began_s = clock_wall_s();
    while (clock_wall_s() - began_s < 0.7)
        usleep(10000);
    return pid;
}

static void end_load(pid_t pid)
{
    assert_int_equal(kill(pid, SIGKILL), 0);
    waitpid(pid, NULL, 0);
}

/* Without a rule in the study, 5 % of the machine are news. */
static void a_twentieth_of_the_machine_is_news(void **state)
{
    (void)state;
    const study s = {.disturbed = {.others_fraction = NAN, .steal_fraction = NAN, .frequency_drop = NAN}};
    for (int more = 0; more < 2; more++) {
        said heard = {.count = 0};
        const study_options options = {.news = hear, .context = &heard};
        run r = {.s = &s, .options = &options};
        machine_noise noise = noise_unknown();
        noise.others_fraction = more ? 0.0502 : 0.0498;
        (void)run_noise_judge(&r, &noise);
        assert_int_equal(heard.count, more);
    }
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

/* The field of a column of the first line of the summary. */
static char *field_of(const char *summary, const char *column)
{
    char *copy = strdup(summary), *rest = copy, *header = strsep(&rest, "\n"), *line = strsep(&rest, "\n"),
         *found = NULL;
    for (char *name, *field; (name = strsep(&header, "\t")) && (field = strsep(&line, "\t"));)
        if (strcmp(name, column) == 0)
            found = strdup(field);
    free(copy);
    if (!found)
        fail_msg("no column %s", column);
    return found;
}

static void expect_field(const char *summary, const char *column, const char *expected)
{
    char *field = field_of(summary, column);
    assert_string_equal(field, expected);
    free(field);
}

static void quiet_rows_suffice(void **state)
{
    const fixture *f = *state;
    study *s = study_with(f, "{undisturbed: 3, max: 9}", never);
    assert_int_equal(s->undisturbed, 3);
    assert_int_equal(fixture_run(f, s), 3);
    char *summary = summary_of(f, s);
    expect_field(summary, "disturbed", "0");
    expect_field(summary, "undisturbed_n", "3");
    char *all = field_of(summary, "wall_s_median");
    expect_field(summary, "undisturbed_wall_s_median", all);
    free(all);
    free(summary);
    study_destroy(s);
}

/* Under a load every row is disturbed: the limit is reached, all rows are kept, and news are reported once. */
static void disturbed_rows_are_kept_and_repeated_up_to_the_limit(void **state)
{
    const fixture *f = *state;
    study *s = study_with(f, "{undisturbed: 3, max: 9}", always);
    const pid_t load = start_load();
    said heard = {0};
    size_t ran = 0;
    const study_options options = {.results = f->results, .news = hear, .context = &heard};
    usleep(600000); /* the window of the first frame begins with the run */
    assert_int_equal(study_run(s, &options, &ran, NULL), STATUS_OK);
    end_load(load);
    if (sysconf(_SC_NPROCESSORS_ONLN) > 64)
        skip(); /* one busy unit is less than 5% of others */
    study_progress progress;
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.rows, ran);
    assert_int_equal(progress.faults, 0);
    assert_true(ran >= 3 && ran <= 9);
    assert_true(ran == 9 || progress.rows - progress.rows_disturbed >= 3);
    assert_true(progress.rows_disturbed > 0);
    char *summary = summary_of(f, s), text[40];
    snprintf(text, sizeof text, "%zu", progress.rows_disturbed);
    expect_field(summary, "disturbed", text);
    snprintf(text, sizeof text, "%zu", ran);
    expect_field(summary, "n", text);
    free(summary);
    study_destroy(s);
}

/* The rule is no part of a cell's identity: the rows stay. */
static void another_rule_keeps_the_rows(void **state)
{
    const fixture *f = *state;
    study *s = study_with(f, "3", never);
    assert_int_equal(fixture_run(f, s), 3);
    study_destroy(s);
    s = study_with(f, "3", "{steal_fraction: 0.5, frequency_drop: 0.9}");
    assert_true(isnan(s->disturbed.others_fraction) && s->disturbed.steal_fraction == 0.5);
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
    s = study_with(f, "3", "{others_fraction: 0, steal_fraction: 0, frequency_drop: 0}"); /* the present rule judges */
    row_files *files;
    study_progress progress;
    size_t above = 0;
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    for (size_t i = 0; i < files->row_count; i++)
        above += row_field_real(&files->rows[i], "others_fraction") > 0 ||
                 row_field_real(&files->rows[i], "steal_fraction") > 0 ||
                 row_field_real(&files->rows[i], "frequency_drop") > 0;
    row_files_destroy(files);
    assert_int_equal(study_status(s, f->results, &progress, NULL), STATUS_OK);
    assert_int_equal(progress.rows_disturbed, above);
    study_destroy(s);
    s = fixture_study(f, "study: test\nscene: scene.yaml\nwarmups: 0\nrepetitions: 3\n");
    assert_true(s->disturbed.others_fraction == 0.05 && isnan(s->disturbed.steal_fraction));
    assert_int_equal(fixture_run(f, s), 0);
    study_destroy(s);
}

static bool stop_after_a_while(void *context)
{
    return clock_wall_s() > *(const double *)context;
}

static void waiting_ends_with_the_time_or_a_stop_request(void **state)
{
    const fixture *f = *state;
    study *s = study_with(f, "1", always);
    const pid_t load = start_load();
    double until_s = clock_wall_s() + 0.5;
    size_t ran = 0;
    study_options options = {.results = f->results, .wait_quiet_s = 60};
    cancel_token token = {.ask = stop_after_a_while, .context = &until_s};
    cancel_begin(&token);
    const status stopped = study_run(s, &options, &ran, NULL);
    cancel_end(&token);
    const double began_s = clock_wall_s();
    options = (study_options){.results = f->results, .wait_quiet_s = 0.3};
    const status waited = study_run(s, &options, &ran, NULL);
    const double took_s = clock_wall_s() - began_s;
    end_load(load);
    if (stopped == STATUS_OK)
        skip(); /* the machine does not report other processes */
    assert_int_equal(stopped, STATUS_INTERRUPTED);
    assert_int_equal(waited, STATUS_OK);
    assert_int_equal(ran, 1);
    assert_true(took_s >= 0.3);
    study_destroy(s);
}

/* As Ctrl-Z and fg do, in the middle of the first frame. The child goes on until it has an effect. */
static void stop_once(void *context, const study_frame_progress *now)
{
    bool *stopped = context;
    if (*stopped || now->stage != STUDY_MEASURING || !(now->share > 0))
        return;
    *stopped = true;
    const pid_t own = getpid(), child = fork();
    for (int i = 0; child == 0 && i < 20; i++) {
        usleep(300000);
        if (kill(own, SIGCONT) != 0)
            break;
    }
    if (child == 0)
        _exit(0);
    kill(own, SIGSTOP);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
}

static void a_stopped_process_is_disturbed(void **state)
{
    const fixture *f = *state;
    study *s = fixture_study(f, "study: test\nscene: scene.yaml\nwarmups: 0\nrepetitions: 1\n"
                                "set: {render.width: 400, render.height: 300, render.integrator: path, "
                                "render.paths: 16, render.threads: 1}\n");
    bool stopped = false;
    const study_options options = {.results = f->results, .progressed = stop_once, .context = &stopped};
    assert_int_equal(study_run(s, &options, NULL, NULL), STATUS_OK);
    row_files *files;
    assert_int_equal(row_files_read(s, f->results, ROWS, &files, NULL), STATUS_OK);
    assert_int_equal(files->row_count, 1);
    const row_ref *row = &files->rows[0];
    assert_true(stopped && row_field_real(row, "stalled_fraction") > 0);
    const double stopped_s = row_field_real(row, "wall_s") * row_field_real(row, "stalled_fraction");
    assert_true(stopped_s > 0.25); /* of the 0.3 s or more */
    if (row_field_real(row, "stalled_fraction") > 0.1)
        assert_string_equal(row_field(row, "disturbed"), "1");
    row_files_destroy(files);
    study_destroy(s);
}

static void invalid_rules_are_refused(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *repetitions, *rule, *what;
    } cases[] = {
        {"3", "0.1", "disturbed is not a map"},
        {"3", "{others: 0.1}", "unknown key 'others'"},
        {"3", "{others_fraction: 1.5}", "others_fraction is not a fraction"},
        {"3", "{steal_fraction: much}", "steal_fraction is not a fraction"},
        {"{undisturbed: 3}", never, "repetitions has no max"},
        {"{undisturbed: 5, max: 4}", never, "max 4 is less than undisturbed 5"},
        {"{undisturbed: 5, max: 8, min: 2}", never, "unknown key 'min'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[400], path[400];
        study *s = NULL;
        diagnostic why = {.what = ""};
        snprintf(text, sizeof text, study_format, cases[i].repetitions, cases[i].rule);
        fixture_write(f, "test.study", text);
        fixture_path(f, "test.study", path);
        assert_int_equal(study_read(path, &s, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, cases[i].what))
            fail_msg("%s: %s", cases[i].what, why.what);
        assert_true(why.line >= 4);
    }
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

/* Medians of fractions stay in 0..1, of what can be 0 at or above 0: which column is which. */
static void every_noise_column_has_its_range(void **state)
{
    (void)state;
    static const char *const fractions[] = {"others_fraction", "steal_fraction", "stalled_fraction", "cut_fraction",
                                            "frequency_drop"};
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions; i++)
        assert_int_equal(row_quantity_range((row_quantity){.name = fractions[i]}), LEVEL_FRACTION);
    assert_int_equal(row_quantity_range((row_quantity){.name = "imbalance"}), LEVEL_NOT_NEGATIVE);
    assert_int_equal(row_quantity_range((row_quantity){.name = "wall_s"}), LEVEL_POSITIVE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(quiet_rows_suffice),
        CASE(disturbed_rows_are_kept_and_repeated_up_to_the_limit),
        CASE(another_rule_keeps_the_rows),
        CASE(waiting_ends_with_the_time_or_a_stop_request),
        CASE(a_stopped_process_is_disturbed),
        CASE(invalid_rules_are_refused),
        cmocka_unit_test(a_twentieth_of_the_machine_is_news),
        cmocka_unit_test(every_noise_column_has_its_range),
    };
    return cmocka_run_group_tests_name("study_noise", tests, NULL, NULL);
}
