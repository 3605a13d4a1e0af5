#include "cli/study_request.h"
#include "cli/options.h"
#include "base/number.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_SHARD = 0x100, SHARDS_MAX = 10000 };

static const struct argp_option run_options[] = {
    {"results", 'r', "DIR", 0, "put results/STUDY/ into DIR instead of results", 0},
    {"shard", KEY_SHARD, "I/N", 0,
     "do part I of N, counted from 0: the parts may run at one time, on one or many machines", 0},
    {"quiet", 'q', NULL, 0, "say nothing but errors", 0},
    {0},
};

static const struct argp_option results_options[] = {
    {"results", 'r', "DIR", 0, "where the results are; 'results' if not said", 0},
    {0},
};

static const struct argp_option no_options[] = {{0}};

static error_t wrong_shard(const char *value, diagnostic *why)
{
    char where[512];
    snprintf(where, sizeof where, "--shard %s", value);
    diagnose(why, STATUS_BAD_INPUT, "give I/N with 0 <= I < N, as 0/2 and 1/2", "'%.64s' names no part", value);
    diagnostic_locate(why, where, 0, 0);
    return EINVAL;
}

static error_t take_shard(const char *value, study_request *request, diagnostic *why)
{
    char part[24];
    int64_t shard, shards;
    const char *slash = strchr(value, '/');
    if (!slash || (size_t)(slash - value) >= sizeof part)
        return wrong_shard(value, why);
    snprintf(part, sizeof part, "%.*s", (int)(slash - value), value);
    if (!number_parse_int(part, &shard) || !number_parse_int(slash + 1, &shards))
        return wrong_shard(value, why);
    if (shards < 1 || shards > SHARDS_MAX || shard < 0 || shard >= shards)
        return wrong_shard(value, why);
    request->shard = (long)shard;
    request->shards = (long)shards;
    return 0;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    study_request *request = input->request;
    switch (key) {
    case 'r': request->results = value; return 0;
    case 'q': request->quiet = true; return 0;
    case KEY_SHARD: return take_shard(value, request, input->why);
    case ARGP_KEY_ARG: request->files[request->file_count++] = value; return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parsers[STUDY_VERB_COUNT] = {
    [STUDY_RUN] =
        {.options = run_options,
         .parser = take_option,
         .args_doc = "FILE...",
         .doc = "Measure what is missing of each study, row by row.\vA study that is stopped, or killed, goes on where "
                "it was when it is run again. Rows are never rewritten."},
    [STUDY_LIST] = {.options = no_options,
                    .parser = take_option,
                    .args_doc = "[DIR]",
                    .doc = "List the study files of a folder; 'experiments' if none is named."},
    [STUDY_STATUS] =
        {.options = results_options,
         .parser = take_option,
         .args_doc = "FILE...",
         .doc = "Say how many cells of each study are done, and how many rows are marked because their film differs."},
    [STUDY_MERGE] = {.options = results_options,
                     .parser = take_option,
                     .args_doc = "FILE...",
                     .doc = "Join the rows of a study's shards into its rows.csv."},
    [STUDY_SUMMARY] =
        {.options = results_options,
         .parser = take_option,
         .args_doc = "FILE",
         .doc = "Print one line a cell: medians, 95% intervals, counts.\vOn a terminal the columns that one looks at "
                "first; into a file or pipe all of them, separated by tabs."},
};

static status check_files(const study_request *request, const char *program, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL;
    bool lists = request->verb == STUDY_LIST;
    if (request->file_count == 0 && !lists)
        what = "no study is named", remedy = "name a study file, as experiments/depth.study";
    else if (request->file_count > 1 && lists)
        what = "more than one folder is named", remedy = "name one";
    else if (request->file_count > 1 && request->verb == STUDY_SUMMARY)
        what = "more than one study is named", remedy = "name one: each has columns of its own";
    else if (!request->results[0])
        what = "--results is empty", remedy = "name a folder";
    if (!what)
        return STATUS_OK;
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
    options_locate(why, program);
    return STATUS_BAD_INPUT;
}

status study_request_parse(study_verb verb, int argc, char **argv, study_request *out, diagnostic *why)
{
    *out = (study_request){
        .verb = verb, .results = "results", .shards = 1, .files = calloc((size_t)argc + 1, sizeof(char *))};
    if (!out->files)
        return out_of_memory(why);
    status result = options_parse(&parsers[verb], 0, argc, argv, out, why);
    return result == STATUS_OK ? check_files(out, argv[0], why) : result;
}

void study_request_release(study_request *request)
{
    free(request->files);
    *request = (study_request){0};
}
