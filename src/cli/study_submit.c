/* `cuvette study submit --slurm`: a study as an array job of a cluster. */
#include "base/file.h"
#include "base/os_process.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "study/rows/row_files.h"
#include "study/run/slurm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TASKS = 16, TASKS_MAX = 10000, TEMPLATE_MAX = 1 << 20 };

typedef struct submit_request {
    const char *file, *results, *partition, *constraint, *time, *memory, *node_type, *template;
    const char **options; /* of sbatch */
    size_t option_count;
    int64_t tasks, threads, factor;
    bool slurm, by_repetition, dry_run;
} submit_request;

/* --- the command line --- */

static status parse_by(const command_option *o, void *request, const char *value, diagnostic *why)
{
    static const char *const words[] = {"cell", "repetition"};
    int which = 0;
    (void)o;
    TRY(options_choice("--by", "division", value, words, 2, &which, why));
    ((submit_request *)request)->by_repetition = which == 1;
    return STATUS_OK;
}

static status parse_sbatch(const command_option *o, void *request, const char *value, diagnostic *why)
{
    submit_request *r = request;
    (void)o;
    if (value[0] != '-')
        return options_wrong("--sbatch", value, why, "give an option of sbatch, such as --sbatch=--exclusive",
                             "this is not an option");
    r->options[r->option_count++] = value;
    return STATUS_OK;
}

#define TEXT(name, letter, form, purpose, field)                                      \
    {                                                                                 \
        name, letter, form, purpose, OPTION_FILLS(option_text, submit_request, field) \
    }

static const command_option options[] = {
    {"slurm", 0, NULL, "submit to Slurm, by sbatch", OPTION_FILLS(option_flag, submit_request, slurm)},
    TEXT("partition", 'p', "NAME", "partition of the cluster (default: the cluster's default)", partition),
    TEXT("constraint", 'C', "FEATURES", "features that nodes must have, so that all are of one type", constraint),
    TEXT("node-type", 0, "NAME", "name of the type of node (default: partition and constraint)", node_type),
    {"tasks", 0, "N", "parts of the study, one task of the array each (default: 16, or one per cell)",
     OPTION_FILLS(option_integer, submit_request, tasks), .lowest = 1, .highest = TASKS_MAX},
    {"by", 0, "WHAT", "what the tasks divide: cell (default), or repetition, so that cells do not differ by node",
     .store = parse_by},
    {"threads", 0, "N", "processing units of a task (default: the largest render.threads of a cell)",
     OPTION_FILLS(option_integer, submit_request, threads), .lowest = 1, .highest = 1024},
    TEXT("memory", 0, "SIZE", "memory of a task, such as 4G (default: 512M and 64 bytes per pixel, in whole G)",
         memory),
    TEXT("time", 't', "LIMIT", "time limit of a task, such as 2:00:00 (default: from the estimate)", time),
    {"factor", 0, "F", "time limit as a multiple of the estimate of the longest task (default: 3)",
     OPTION_FILLS(option_integer, submit_request, factor), .lowest = 1, .highest = 1000},
    {"sbatch", 0, "OPTION", "a further option of sbatch, such as --sbatch=--account=optics; can be repeated",
     .store = parse_sbatch},
    TEXT("template", 0, "FILE", "script to fill in (default: experiments/cluster/study.slurm)", template),
    TEXT("results", 'r', "DIR", "folder of the results (default: results)", results),
    {"dry-run", 'n', NULL, "print the commands and the script; write and submit nothing",
     OPTION_FILLS(option_flag, submit_request, dry_run)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "--slurm FILE",
    .arguments_at = offsetof(submit_request, file),
    .argument_limit = 1,
    .excess_remedy = "give one study file",
    .excess = "unexpected argument '%.128s'",
    .about =
        "Submit the missing parts of a study to Slurm as an array job, and a job that then merges and verifies the "
        "rows.\vThe same command again submits what failed, was killed or ran out of time. cuvette-cluster(7) is "
        "a guide.",
};

static status check_request(const submit_request *r, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL;
    if (!r->file)
        what = "no study was given", remedy = "give a study file, such as experiments/depth.study";
    else if (!r->slurm)
        what = "no cluster is named", remedy = "add --slurm";
    else if (!r->results[0])
        what = "--results is empty", remedy = "give a folder";
    else if (r->node_type && !r->node_type[0])
        what = "--node-type is empty", remedy = "give a name, or leave it out";
    return what ? options_wrong("study submit", NULL, why, remedy, "%s", what) : STATUS_OK;
}

/* --- the submission --- */

/* A study that is being submitted. Texts are allocated. */
typedef struct submission {
    const submit_request *request;
    const study *s;
    char *node_type, *array, *logs, *path, *script; /* logs: an absolute folder; path: the path of the script */
    study_estimate *parts;
    size_t part_count, rows_apart; /* rows_apart: rows of other environments, if these nodes have none */
    double longest_s;
    long threads;
    char memory[32], time[SLURM_TIME];
} submission;

static size_t missing_parts(const submission *job)
{
    size_t missing = 0;
    for (size_t i = 0; i < job->part_count; i++)
        missing += job->parts[i].cells_lacking || job->parts[i].cells_to_keep;
    return missing;
}

static char *node_type_of(const submit_request *request)
{
    if (request->node_type)
        return strdup(request->node_type);
    return text_format("%s%s%s", request->partition ? request->partition : "default", request->constraint ? " " : "",
                       request->constraint ? request->constraint : "");
}

static status find_environment(submission *job, char key[ENVIRONMENT_KEY], diagnostic *why)
{
    char unlike[300], text[700];
    size_t others;
    TRY(slurm_environment(job->s, job->request->results, job->node_type, key, unlike, sizeof unlike, &others, why));
    snprintf(
        text, sizeof text,
        "%s: nodes of type '%.100s' are unlike: %s; rows of unlike nodes are not pooled: choose with --constraint, and "
        "keep --threads and --memory",
        job->s->name, job->node_type, unlike);
    if (unlike[0])
        terminal_note(text);
    job->rows_apart = strcmp(key, "none") == 0 ? others : 0;
    return STATUS_OK;
}

/* Finds the parts that lack rows or files, in the environment with most rows among those of nodes of this type. */
static status find_parts(submission *job, diagnostic *why)
{
    const submit_request *request = job->request;
    char key[ENVIRONMENT_KEY];
    const size_t most = request->by_repetition ? (size_t)job->s->repetitions_min : study_cell_count(job->s);
    job->part_count = request->tasks ? (size_t)request->tasks : TASKS < most ? TASKS : most;
    job->node_type = node_type_of(request);
    job->parts = calloc(job->part_count, sizeof *job->parts);
    if (!job->node_type || !job->parts)
        return out_of_memory(why);
    TRY(find_environment(job, key, why));
    const study_options as = {.results = request->results,
                              .shards = (long)job->part_count,
                              .by_repetition = request->by_repetition,
                              .environment = key};
    TRY(study_estimate_parts(job->s, &as, !request->time, job->parts, why));
    job->array = slurm_array(job->parts, job->part_count);
    job->longest_s = slurm_longest_s(job->parts, job->part_count);
    return job->array ? STATUS_OK : out_of_memory(why);
}

static status find_limits(submission *job, diagnostic *why)
{
    const submit_request *request = job->request;
    slurm_needs needs;
    TRY(slurm_needs_of(job->s, &needs, why));
    job->threads = request->threads ? (long)request->threads : needs.threads;
    if (job->threads < needs.threads) {
        char text[200];
        snprintf(text, sizeof text, "%s: cells with up to %ld threads share %ld processing units of a task",
                 job->s->name, needs.threads, job->threads);
        terminal_note(text);
    }
    snprintf(job->memory, sizeof job->memory, "%ldG", needs.memory_gib);
    if (request->time)
        return STATUS_OK;
    if (isnan(job->longest_s))
        return diagnose_at(why, job->s->path, STATUS_BAD_INPUT, "give a time limit with --time",
                           "the time of a part is unknown: a trial frame with few pixels takes more than %g s",
                           STUDY_ESTIMATE_TRIALS_S);
    slurm_time_limit(job->longest_s, (double)request->factor, job->time);
    return STATUS_OK;
}

/* --- the script --- */

static status find_places(submission *job, char here[PATH_MAX], diagnostic *why)
{
    const char *results = job->request->results;
    if (!getcwd(here, PATH_MAX))
        return diagnose(why, STATUS_FAILURE, "change to a folder that exists", "the present folder is unknown");
    job->logs = results[0] == '/' ? text_format("%s/%s/slurm", results, job->s->name)
                                  : text_format("%s/%s/%s/slurm", here, results, job->s->name);
    job->path = text_format("%s/%s/slurm/study.slurm", results, job->s->name);
    return job->logs && job->path ? STATUS_OK : out_of_memory(why);
}

static status write_script(submission *job, diagnostic *why)
{
    const submit_request *request = job->request;
    char here[PATH_MAX], program[PATH_MAX], threads[24], parts[24], name[80];
    TRY(find_places(job, here, why));
    if (!os_program_path(program))
        return diagnose(why, STATUS_FAILURE, "", "the path of this program is unknown");
    snprintf(threads, sizeof threads, "%ld", job->threads);
    snprintf(parts, sizeof parts, "%zu", job->part_count);
    snprintf(name, sizeof name, "cuvette-%s", job->s->name);
    const slurm_word words[] = {
        {"name", name},
        {"partition", request->partition},
        {"constraint", request->constraint},
        {"threads", threads},
        {"memory", request->memory ? request->memory : job->memory},
        {"time", request->time ? request->time : job->time},
        {"logs", job->logs},
        {"program", program},
        {"folder", here},
        {"study", job->s->path},
        {"results", request->results},
        {"parts", parts},
        {"by", request->by_repetition ? "repetition" : "cell"},
        {"node_type", job->node_type},
    };
    char *filled_template = NULL;
    size_t size;
    if (request->template)
        TRY(file_read(request->template, TEMPLATE_MAX, &filled_template, &size, why));
    const status code = slurm_fill(request->template ? request->template : "study.slurm",
                                   filled_template ? filled_template : slurm_template, words,
                                   sizeof words / sizeof *words, &job->script, why);
    free(filled_template);
    return code;
}

/* --- messages --- */

static void note_rows_apart(const submission *job)
{
    char text[500];
    if (!job->rows_apart)
        return;
    snprintf(
        text, sizeof text,
        "%s: %zu rows of other machines or builds do not count for nodes of type '%.100s', which measure all anew; "
        "to complete those rows, use their --partition, --constraint or --node-type, and the same build",
        job->s->name, job->rows_apart, job->node_type);
    terminal_note(text);
}

static void say_parts(const submission *job)
{
    size_t rows = 0;
    note_rows_apart(job);
    for (size_t i = 0; i < job->part_count; i++)
        rows += job->parts[i].rows_most;
    printf("%s: %zu of %zu parts to run, %zu rows to measure\n", job->s->name, missing_parts(job), job->part_count,
           rows);
    if (!job->request->time)
        printf("%s: time limit %s for each: %ld times the estimate of the longest, %.2g s, at least %d minutes\n",
               job->s->name, job->time, (long)job->request->factor, job->longest_s, SLURM_LEAST_MIN);
}

static status say_complete(const submission *job, diagnostic *why)
{
    const char *results = job->request->results, *path = job->s->path;
    printf(
        "%s: complete, nothing to submit; if the job that merges the rows failed: cuvette study merge --results %s %s "
        "&& cuvette study verify --results %s %s\n",
        job->s->name, results, path, results, path);
    return terminal_flush(why);
}

static status say_submitted(const submission *job, const char *array, const char *merge, diagnostic *why)
{
    printf("%s: job %s measures, then job %s merges and verifies the rows; script and logs are in %s/%s/slurm\n"
           "%s: run the same command again when they have ended: it submits the parts that are then missing\n",
           job->s->name, array, merge, job->request->results, job->s->name, job->s->name);
    return terminal_flush(why);
}

/* --- submitting --- */

static slurm_submission submission_of(const submission *job)
{
    return (slurm_submission){job->path, job->array, job->request->options, job->request->option_count};
}

static status submit(const submission *job, diagnostic *why)
{
    slurm_job array, merge;
    const slurm_submission to_send = submission_of(job);
    TRY(file_make_directory(job->logs, why));
    TRY(slurm_check_queue(job->path, why));
    TRY(file_write(job->path, job->script, why));
    TRY(slurm_submit_parts(&to_send, &array, why));
    say_parts(job);
    TRY(slurm_submit_merge(&to_send, &array, &merge, why));
    return say_submitted(job, array.id, merge.id, why);
}

static status show(const submission *job, diagnostic *why)
{
    const slurm_submission to_send = submission_of(job);
    say_parts(job);
    TRY(slurm_print_commands(&to_send, stdout, why));
    printf("\n%s", job->script);
    return terminal_flush(why);
}

static status run(submission *job, diagnostic *why)
{
    TRY(find_parts(job, why));
    if (!missing_parts(job))
        return say_complete(job, why);
    TRY(find_limits(job, why));
    TRY(write_script(job, why));
    return job->request->dry_run ? show(job, why) : submit(job, why);
}

status study_submit(int argc, char **argv, diagnostic *why)
{
    submit_request request = {
        .results = "results", .factor = 3, .options = calloc((size_t)argc + 1, sizeof *request.options)};
    study *s = NULL;
    status code = request.options ? command_form_read(&form, argc, argv, &request, why) : out_of_memory(why);
    THEN(code, check_request(&request, why));
    THEN(code, study_read(request.file, &s, why));
    submission job = {.request = &request, .s = s};
    THEN(code, run(&job, why));
    free(job.script);
    free(job.path);
    free(job.logs);
    free(job.array);
    free(job.parts);
    free(job.node_type);
    study_destroy(s);
    free(request.options);
    return code;
}
