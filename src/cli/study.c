/* `cuvette study`: runs, lists, merges and summarises studies. */
#include "cli/study.h"
#include "base/os_process.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "measure/usage.h"
#include "study/rows/row_files.h"
#include "study/run/estimate.h"
#include "study/study.h"
#include "study/summary/summary.h"
#include "study/summary/verify.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The action of a subcommand on each given study. */
typedef status study_action(const study *s, const study_request *request, diagnostic *why);

/* Divides the study among the processes of --processes, with as many repetitions in each as before. */
static status divide(study *s, const study_request *request, diagnostic *why)
{
    const long wanted = (long)request->processes, before = s->processes;
    const long least = (s->repetitions_min + before - 1) / before * wanted;
    const long most = (s->repetitions_max + before - 1) / before * wanted;
    if (most > STUDY_REPETITIONS_MAX)
        return options_wrong("--processes", NULL, why, "use fewer processes", "%ld repetitions are more than %d", most,
                             STUDY_REPETITIONS_MAX);
    s->processes = wanted;
    s->repetitions_min = least;
    s->repetitions_max = most;
    return STATUS_OK;
}

/* Reads all files before acting on the first, so that an error in the last one is reported at once. */
static status read_and_act(const study_request *request, study_action *act, diagnostic *why)
{
    study **studies = calloc(request->file_count + 1, sizeof *studies);
    if (!studies)
        return out_of_memory(why);
    status result = STATUS_OK;
    for (size_t i = 0; i < request->file_count && result == STATUS_OK; i++) {
        result = study_read(request->files[i], &studies[i], why);
        if (request->verb != STUDY_RUN)
            THEN(result, study_follow_runs(studies[i], request->results, why));
        if (request->quick)
            THEN(result, study_make_quick(studies[i], why));
        if (request->processes)
            THEN(result, divide(studies[i], request, why));
    }
    for (size_t i = 0; i < request->file_count && result == STATUS_OK; i++)
        result = act(studies[i], request, why);
    for (size_t i = 0; i < request->file_count; i++)
        study_destroy(studies[i]);
    free(studies);
    return result;
}

static status for_each_study(study_verb verb, study_action *act, int argc, char **argv, diagnostic *why)
{
    study_request request;
    status result = study_request_parse(verb, argc, argv, &request, why);
    isa level = ISA_BASE; /* part of the environment */
    if (result == STATUS_OK && (verb == STUDY_RUN || verb == STUDY_STATUS))
        result = scene_input_isa(&level, why);
    THEN(result, read_and_act(&request, act, why));
    study_request_release(&request);
    return result;
}

/* Prints notes on existing rows that are not used, or should not be. */
static void note_rows(const study *s, const study_request *request, const study_progress *progress)
{
    char text[700], difference[400] = "";
    if (progress->rows_elsewhere && !request->any_environment) {
        study_environment_difference(s, request->results, difference, sizeof difference);
        snprintf(text, sizeof text,
                 "%s: %zu rows are of another environment%s%s; they are kept and not pooled (--any-environment counts "
                 "them)",
                 s->name, progress->rows_elsewhere, difference[0] ? ": here " : "", difference);
        terminal_note(text);
    }
    if (request->shards > 1 && !request->by_repetition && study_cell_count(s) > 1) {
        snprintf(text, sizeof text,
                 "%s: each shard measures its own cells; on several machines, use --by=repetition, or cells differ by "
                 "machine",
                 s->name);
        terminal_note(text);
    }
    if (progress->fault.what[0]) {
        snprintf(text, sizeof text, "%s: %.300s; `cuvette study verify` lists such rows", s->name,
                 progress->fault.what);
        terminal_note(text);
    }
}

static void note_disturbance(void *context, const char *text)
{
    char line[400];
    const char *advice = disturbance_advice(text);
    (void)context;
    snprintf(line, sizeof line, "this machine: %s%s%s", text, advice[0] ? ": " : "", advice);
    terminal_note(line);
}

/* Notes once per command what disturbs measurements on this machine, and what to do about it. */
static void note_machine(void)
{
    static bool noted;
    if (!noted)
        disturbances_report(0, note_disturbance, NULL);
    noted = true;
}

/* Prints notes before anything is measured, unless no row is missing. */
static status print_notes(const study *s, const study_request *request, diagnostic *why)
{
    study_progress progress;
    TRY(study_status(s, request->results, &progress, why));
    if (progress.cells_done == progress.cells)
        return STATUS_OK;
    note_rows(s, request, &progress);
    if (!request->dry_run)
        note_machine();
    study_notes_print_file(s);
    return study_notes_print_cells(s, why);
}

static status count_rows(const study *s, const study_request *request, size_t *rows, diagnostic *why)
{
    study_progress progress;
    TRY(study_status(s, request->results, &progress, why));
    *rows = progress.rows;
    return STATUS_OK;
}

static void print_news(void *context, const char *text)
{
    (void)context;
    terminal_note(text);
}

/* Checks the disk space before the first of several processes; each process checks again for its part. */
static status check_room(const study *s, const study_request *request, const study_options *options, diagnostic *why)
{
    study_options all = *options;
    study_estimate e;
    if (all.shards > 1)
        return STATUS_OK;
    all.shards = 1;
    TRY(study_estimate_parts(s, &all, false, &e, why));
    return study_check_room(s, request, &e, why);
}

/* Measures the missing rows: in fresh processes if the study has several, or with --against. *rows: number of new
 * rows. */
static status measure(const study *s, const study_request *request, size_t *rows, diagnostic *why)
{
    const bool shows = !request->quiet || request->progress;
    FILE *terminal = shows && terminal_is_smart(STDERR_FILENO) ? stderr : NULL;
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .by_repetition = request->by_repetition,
                                   .any_environment = request->any_environment,
                                   .process = (long)request->process,
                                   .progress = terminal,
                                   .progress_columns = terminal ? terminal_columns(STDERR_FILENO) : 0,
                                   .wait_quiet_s = request->wait_quiet_s,
                                   .news = request->quiet || request->process ? NULL : print_news};
    if (request->process || (s->processes == 1 && !request->against && !request->instructions))
        return study_run(s, &options, rows, why);
    size_t before = 0, after = 0, further = 0;
    TRY(check_room(s, request, &options, why));
    TRY(count_rows(s, request, &before, why));
    status result = study_run_processes(s, request, why);
    const status counted = count_rows(s, request, &after, result == STATUS_OK ? why : NULL);
    result = result == STATUS_OK ? counted : result;
    if (!request->instructions) /* then the kept files; this process cannot count instructions */
        THEN(result, study_run(s, &options, &further, why));
    *rows = after - before + further;
    return result;
}

static status report_interrupted(const study *s, size_t rows, diagnostic *why)
{
    diagnose(why, STATUS_INTERRUPTED,
             study_keeps_files(s) ? "run it again to resume; images are written at the end" : "run it again to resume",
             "interrupted; its %zu new rows are kept", rows);
    diagnostic_locate(why, s->path, 0, 0);
    return STATUS_INTERRUPTED;
}

/* Runs one of several processes; the process that started it prints for all. */
static status run_part(const study *s, const study_request *request, diagnostic *why)
{
    size_t rows = 0;
    if (request->process > study_processes(s))
        return options_wrong("--process", NULL, why, "use a number from 1 to this number of processes",
                             "%s has %ld processes", s->path, study_processes(s));
    /* Otherwise this process would keep the row files locked, which the next run needs. Its rows are kept. */
    os_die_with_parent();
    const status result = measure(s, request, &rows, why);
    if (result == STATUS_INTERRUPTED)
        *why = (diagnostic){.what = ""};
    return result;
}

static status run_one(const study *s, const study_request *request, diagnostic *why)
{
    size_t rows = 0;
    if (request->process)
        return run_part(s, request, why);
    status result = request->quiet ? STATUS_OK : print_notes(s, request, why);
    if (result == STATUS_OK && request->dry_run)
        return study_dry_run(s, request, why);
    THEN(result, measure(s, request, &rows, why));
    if (result == STATUS_INTERRUPTED)
        return report_interrupted(s, rows, why);
    if (result != STATUS_OK || request->quiet)
        return result;
    if (rows)
        printf("%s: %zu rows, including warm-ups, written to %s/%s%s\n", s->name, rows, request->results, s->name,
               study_keeps_files(s) ? "; images/index.tsv there lists the images" : "");
    else
        printf("%s: complete, nothing to do\n", s->name);
    return terminal_flush(why); /* the next study may take an hour */
}

/* Runs the study; with --instructions, under valgrind. */
static status run_counted(const study *s, const study_request *given, diagnostic *why)
{
    study_request request = *given;
    counted_run counted;
    status code = study_instructions_begin(&request, &counted, why);
    THEN(code, run_one(s, &request, why));
    study_instructions_end(&counted);
    return code;
}

/* The first fault of the rows becomes the error of the command, after its output. */
static status judge(const diagnostic *verdict, diagnostic *why)
{
    if (!verdict->what[0])
        return STATUS_OK;
    const status flushed = terminal_flush(why);
    if (flushed != STATUS_OK)
        return flushed;
    *why = *verdict;
    return STATUS_FAILURE;
}

static status print_excluded(const study *s, const study_request *request, diagnostic *why)
{
    excluded *list = NULL;
    TRY(excluded_read(s, request->results, &list, why));
    const size_t count = excluded_count(list);
    if (count)
        printf("%s: %zu row%s excluded from summaries, by %s/%s/excluded.csv\n", s->name, count,
               count == 1 ? " is" : "s are", request->results, s->name);
    excluded_destroy(list);
    return STATUS_OK;
}

static status print_status(const study *s, const study_request *request, diagnostic *why)
{
    study_progress progress;
    TRY(study_status(s, request->results, &progress, why));
    printf("%s: %zu of %zu cells done, %zu rows and %zu warm-ups in %s/%s, %zu marked\n", s->name, progress.cells_done,
           progress.cells, progress.rows - progress.warmups, progress.warmups, request->results, s->name,
           progress.rows_marked);
    if (progress.rows_disturbed)
        printf("%s: %zu of these rows are disturbed by the study's rule\n", s->name, progress.rows_disturbed);
    if (progress.rows_elsewhere)
        printf("%s: %zu other rows, of other environments than this one (%s), are not counted\n", s->name,
               progress.rows_elsewhere, progress.environment);
    if (progress.rows_other_cells)
        printf("%s: %zu rows of cells that the study does not have are kept and not used\n", s->name,
               progress.rows_other_cells);
    TRY(print_excluded(s, request, why));
    return judge(&progress.fault, why);
}

static status merge_one(const study *s, const study_request *request, diagnostic *why)
{
    size_t rows = 0;
    diagnostic verdict = {.what = ""};
    TRY(study_merge(s, request->results, &rows, &verdict, why));
    printf("%s: %zu rows in %s/%s/rows.csv\n", s->name, rows, request->results, s->name);
    return judge(&verdict, why);
}

/* A terminal gets the most important columns, a pipe or file all of them. */
static status print_summary(const study *s, const study_request *request, diagnostic *why)
{
    const summary_options options = {.environment = request->environment};
    diagnostic verdict = {.what = ""};
    if (request->columns) {
        TRY(study_spread(s, request->results, request->columns, &options, stdout, &verdict, why));
        return judge(&verdict, why);
    }
    char *text = NULL;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    status result = study_summary_of(s, request->results, &options, writer.stream, &verdict, why);
    result = text_writer_end(&writer, result, &text, NULL, why);
    if (result == STATUS_OK && terminal_columns(STDOUT_FILENO))
        result = study_table_print(stdout, text, why);
    else if (result == STATUS_OK)
        fputs(text, stdout);
    free(text);
    return result == STATUS_OK ? judge(&verdict, why) : result;
}

static status verify_one(const study *s, const study_request *request, diagnostic *why)
{
    study_verdict verdict;
    TRY(study_verify(s, request->results, stdout, &verdict, why));
    return judge(&verdict.first, why);
}

static status command_verify(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_VERIFY, verify_one, argc, argv, why);
}

static status command_run(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_RUN, run_counted, argc, argv, why);
}

static status command_status(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_STATUS, print_status, argc, argv, why);
}

static status command_merge(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_MERGE, merge_one, argc, argv, why);
}

static status command_summary(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_SUMMARY, print_summary, argc, argv, why);
}

static const command commands[] = {
    {"new", "write a study file for a scene and the parameters to vary", study_new},
    {"run", "run studies, or resume them: measure the missing rows", command_run},
    {"submit", "submit the missing parts of a study to a Slurm cluster", study_submit},
    {"list", "list the studies and scenes in a folder", study_list},
    {"status", "print the progress of studies", command_status},
    {"merge", "merge the rows of a study that was run in shards", command_merge},
    {"verify", "check every row: damaged, edited, missing, duplicate and marked ones", command_verify},
    {"summary", "print medians and confidence intervals for each cell", command_summary},
    {"exclude", "exclude a row from summaries, with the reason", study_exclude},
    {"compare", "compare two runs, environments, cells or values: ratio, interval, verdict", study_compare},
    {"films", "compare the films and ray counts of two results folders, cell by cell", study_films_command},
    {"power", "estimate how often studies with fewer repetitions would mislead", study_power},
    {"plot", "draw a figure of studies with gnuplot", command_study_plot},
};

status command_study(int argc, char **argv, diagnostic *why)
{
    return command_dispatch(commands, sizeof commands / sizeof commands[0],
                            "A study combines a scene, a grid of parameter values and a number of repetitions. Each "
                            "repetition is one row of results/STUDY/rows.csv.",
                            argc, argv, why);
}
