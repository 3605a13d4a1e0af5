/* The command lines of the subcommands of `cuvette study`. */
#include "base/number.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/study.h"
#include "study/study.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHARDS_MAX = 10000 };

static status parse_shard(const command_option *o, void *context, const char *value, diagnostic *why)
{
    study_request *request = context;
    char part[24];
    int64_t shard, shards;
    const char *slash = strchr(value, '/');
    const bool fits = slash && (size_t)(slash - value) < sizeof part;
    (void)o;
    snprintf(part, sizeof part, "%.*s", fits ? (int)(slash - value) : 0, value);
    if (!fits || !number_parse_int(part, &shard) || !number_parse_int(slash + 1, &shards) || shards < 1 ||
        shards > SHARDS_MAX || shard < 0 || shard >= shards)
        return options_wrong("--shard", value, why, "give I/N with 0 <= I < N, such as 0/2", "invalid shard '%.64s'",
                             value);
    request->shard = (long)shard;
    request->shards = (long)shards;
    return STATUS_OK;
}

static status parse_by(const command_option *o, void *context, const char *value, diagnostic *why)
{
    study_request *request = context;
    (void)o;
    request->by_repetition = strcmp(value, "repetition") == 0;
    if (!request->by_repetition && strcmp(value, "cell") != 0)
        return options_wrong("--by", value, why, "give cell or repetition", "unknown division '%.64s'", value);
    return STATUS_OK;
}

static status parse_wait(const command_option *o, void *context, const char *value, diagnostic *why)
{
    study_request *request = context;
    (void)o;
    request->wait_quiet_s = 60;
    if (value && (!number_parse_real(value, &request->wait_quiet_s) || !(request->wait_quiet_s > 0) ||
                  request->wait_quiet_s > 86400))
        return options_wrong("--wait-quiet", value, why, "give seconds, up to a day, such as 60",
                             "invalid time '%.64s'", value);
    return STATUS_OK;
}

static void store_file(void *request, const char *file)
{
    study_request *r = request;
    r->files[r->file_count++] = file;
}

static const command_option run_options[] = {
    {"results", 'r', "DIR", "write to DIR/STUDY/ instead of results/STUDY/",
     OPTION_FILLS(option_text, study_request, results)},
    {"shard", 0, "I/N", "run part I of N, counted from 0; parts can run concurrently, on one or several machines",
     .store = parse_shard},
    {"by", 0, "WHAT",
     "what --shard divides: cell (default), or repetition, so that each part measures every cell and cells do not "
     "differ by machine",
     .store = parse_by},
    {"any-environment", 0, NULL, "count the rows of every environment, not only those of this machine and build",
     OPTION_FILLS(option_flag, study_request, any_environment)},
    {"processes", 0, "P", "divide the repetitions among P fresh processes, with as many in each as the study file sets",
     OPTION_FILLS(option_integer, study_request, processes), .lowest = 1, .highest = STUDY_PROCESSES_MAX},
    {"process", 0, "K", "measure only the part of process K of the study's processes, counted from 1",
     OPTION_FILLS(option_integer, study_request, process), .lowest = 1, .highest = 2 * STUDY_PROCESSES_MAX},
    {"against", 0, "PROGRAM",
     "alternate with PROGRAM, another build of cuvette, a fresh process each; its rows are written to DIR-against",
     OPTION_FILLS(option_text, study_request, against)},
    {"instructions", 0, NULL,
     "count the instructions of each frame by valgrind, for which the machine need not be quiet; rows go to "
     "results-instructions, or DIR-instructions",
     OPTION_FILLS(option_flag, study_request, instructions)},
    {"wait-quiet", 0, "SECONDS",
     "before each repetition, wait until other processes, steal and frequency do not disturb; at most 60 s by default",
     .store = parse_wait, .optional = true},
    {"quick", 0, NULL,
     "preview: frames of at most 80 x 60 pixels, each measured once; its times mean nothing, and its rows need "
     "another results folder",
     OPTION_FILLS(option_flag, study_request, quick)},
    {"dry-run", 'n', NULL, "print what would be measured and kept, and about how long it takes; write nothing",
     OPTION_FILLS(option_flag, study_request, dry_run)},
    {"quiet", 'q', NULL, "print errors only", OPTION_FILLS(option_flag, study_request, quiet)},
    {"progress", 0, NULL, "show the progress on a terminal, even with --quiet",
     OPTION_FILLS(option_flag, study_request, progress)},
    OPTION_MEMORY,
    {0},
};

static const command_option results_options[] = {
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, study_request, results)},
    {0},
};

static const command_option summary_options_list[] = {
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, study_request, results)},
    {"environment", 0, "KEY", "only the rows of the environment KEY; main: the environment with most rows",
     OPTION_FILLS(option_text, study_request, environment)},
    {"interval", 'i', "COLUMN[/COLUMN],...",
     "medians and 95% intervals of these columns of rows.csv, or of quotients of two",
     OPTION_FILLS(option_text, study_request, columns)},
    {0},
};

static const command_form forms[STUDY_VERB_COUNT] = {
    [STUDY_RUN] = {.options = run_options,
                   .store_argument = store_file,
                   .synopsis = "FILE...",
                   .about =
                       "Measure the missing rows of each study.\vAn interrupted or killed study resumes when it is "
                       "run again. Rows are never rewritten."},
    [STUDY_LIST] = {.store_argument = store_file,
                    .synopsis = "[DIR]",
                    .about = "List the study files of a folder and of its folder full, and the scenes of its folder "
                             "scenes (default: experiments, or those that were installed with the program)."},
    [STUDY_STATUS] =
        {.options = results_options,
         .store_argument = store_file,
         .synopsis = "FILE...",
         .about =
             "Print the number of finished cells of each study, and of rows marked because their film hash differs."},
    [STUDY_MERGE] = {.options = results_options,
                     .store_argument = store_file,
                     .synopsis = "FILE...",
                     .about = "Merge the rows of a study's shards into its rows.csv."},
    [STUDY_VERIFY] = {.options = results_options,
                      .store_argument = store_file,
                      .synopsis = "FILE...",
                      .about = "Check every row of each study: damaged, edited, moved, missing, duplicate and marked "
                               "ones. Exit status 1 if there is one.\vNothing is changed."},
    [STUDY_SUMMARY] =
        {.options = summary_options_list,
         .store_argument = store_file,
         .synopsis = "FILE",
         .about =
             "Print one line per cell and environment: medians, 95% confidence intervals, counts.\vA terminal gets "
             "the most important columns; a pipe or a file gets all of them, separated by tabs."},
};

static status check_files(const study_request *request, const char *program, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL;
    bool lists = request->verb == STUDY_LIST;
    if (request->file_count == 0 && !lists)
        what = "no study was given", remedy = "give a study file, such as experiments/depth.study";
    else if (request->file_count > 1 && lists)
        what = "more than one folder is given", remedy = "give one folder";
    else if (request->file_count > 1 && request->verb == STUDY_SUMMARY)
        what = "more than one study was given", remedy = "give one study, since each has its own columns";
    else if (!request->results[0])
        what = "--results is empty", remedy = "give a folder";
    if (!what)
        return STATUS_OK;
    options_locate(why, program);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
}

status study_request_parse(study_verb verb, int argc, char **argv, study_request *out, diagnostic *why)
{
    *out = (study_request){
        .verb = verb, .results = "results", .shards = 1, .files = calloc((size_t)argc + 1, sizeof(char *))};
    if (!out->files)
        return out_of_memory(why);
    TRY(command_form_read(&forms[verb], argc, argv, out, why));
    return check_files(out, argv[0], why);
}

void study_request_release(study_request *request)
{
    free(request->files);
    *request = (study_request){0};
}
