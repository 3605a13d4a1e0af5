/* Calls of squeue and sbatch, and their answers. */
#include "base/cancel.h"
#include "base/os_process.h"
#include "base/text.h"
#include "cli/study.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { NOT_FOUND = 127 /* of env(1) */, FURTHER = 8 /* arguments besides the user's options */ };

static const double answer_limit_s = 300; /* a busy controller answers late */

/* Returns the message that ended a program, otherwise its first error: TEXT of "sbatch: error: TEXT". */
static char *reason_of(char *output)
{
    char *fatal = strstr(output, "fatal: "), *error = strstr(output, "error: ");
    char *text = fatal ? fatal + strlen("fatal: ") : error ? error + strlen("error: ") : output;
    text[strcspn(text, "\n")] = 0;
    return text;
}

/* Runs a program of Slurm, whose name is arguments[1]. *output is allocated. */
static status ask(const char *const *arguments, const char *remedy, char **output, diagnostic *why)
{
    int exit_code = -1;
    cancel_token shield; /* no cancellation: whether a job was submitted must be known */
    cancel_shield(&shield);
    status code = child_run((char *const *)(uintptr_t)arguments, answer_limit_s, output, &exit_code, why);
    cancel_end(&shield);
    if (code == STATUS_OK && exit_code == NOT_FOUND)
        code = diagnose_at(why, arguments[1], STATUS_FAILURE,
                           "submit on a machine with Slurm's commands, or print the script with --dry-run",
                           "the program is not found");
    else if (code == STATUS_OK && exit_code != 0)
        code = diagnose_at(why, arguments[1], STATUS_FAILURE, remedy, "%.300s", reason_of(*output));
    return code;
}

/* --- the queue --- */

status slurm_check_queue(const char *script, diagnostic *why)
{
    static const char *const arguments[] = {"/usr/bin/env", "squeue", "--me", "--noheader", "--format=%i %o", NULL};
    char path[PATH_MAX], *output = NULL, *rest, *line;
    status code = ask(arguments, "nothing is submitted", &output, why);
    rest = code == STATUS_OK && realpath(script, path) ? output : NULL;
    while (code == STATUS_OK && (line = strsep(&rest, "\n"))) {
        char *id = strsep(&line, " ");
        id[strcspn(id, "_")] = 0; /* the number of the array job */
        if (line && strcmp(line, path) == 0)
            code = diagnose_at(why, script, STATUS_BAD_INPUT, "wait for its end, or end it with scancel",
                               "job %.60s of this study is still in the queue", id);
    }
    free(output);
    return code;
}

/* --- sbatch --- */

/* A call of sbatch; ended by NULL. */
typedef struct command_line {
    const char **arguments;
    size_t count;
    char *job_option; /* --array or --dependency */
} command_line;

static void add(command_line *c, const char *argument)
{
    if (argument)
        c->arguments[c->count++] = argument;
}

/* job_option: allocated; the line owns it. argument: the script's argument, or NULL. */
static bool open_line(command_line *c, const slurm_submission *s, char *job_option, const char *argument)
{
    *c = (command_line){.arguments = calloc(s->option_count + FURTHER, sizeof *c->arguments), .job_option = job_option};
    if (!c->arguments || !job_option)
        return false;
    add(c, "/usr/bin/env");
    add(c, "sbatch");
    for (size_t i = 0; i < s->option_count; i++)
        add(c, s->options[i]);
    add(c, "--parsable");
    add(c, job_option);
    add(c, argument ? "--output=merge.log" : NULL);
    add(c, s->script);
    add(c, argument);
    return true;
}

static void close_line(command_line *c)
{
    free(c->arguments);
    free(c->job_option);
}

static bool parts_line(command_line *c, const slurm_submission *s)
{
    return open_line(c, s, text_format("--array=%s", s->array), NULL);
}

static bool merge_line(command_line *c, const slurm_submission *s, const char *parts)
{
    return open_line(c, s, text_format("--dependency=afterany:%s", parts), "merge");
}

/* The job's number: the first line that begins with a digit, after warnings; a cluster's name may follow. */
static bool read_id(char *output, slurm_job *out)
{
    for (char *line; (line = strsep(&output, "\n"));) {
        const size_t digits = strspn(line, "0123456789");
        if (digits && digits < sizeof out->id) {
            snprintf(out->id, sizeof out->id, "%.*s", (int)digits, line);
            return true;
        }
    }
    return false;
}

static status submit(const command_line *c, const char *remedy, slurm_job *out, diagnostic *why)
{
    char *output = NULL;
    status code = ask(c->arguments, remedy, &output, why);
    if (code == STATUS_OK && !read_id(output, out))
        code = diagnose_at(why, "sbatch", STATUS_FAILURE, "look for the job with squeue",
                           "its answer has no job number: %.200s", reason_of(output));
    free(output);
    return code;
}

status slurm_submit_parts(const slurm_submission *s, slurm_job *out, diagnostic *why)
{
    command_line c;
    const status code = parts_line(&c, s) ? submit(&c, "nothing is submitted", out, why) : out_of_memory(why);
    close_line(&c);
    return code;
}

status slurm_submit_merge(const slurm_submission *s, const slurm_job *parts, slurm_job *out, diagnostic *why)
{
    command_line c;
    const status code =
        merge_line(&c, s, parts->id)
            ? submit(&c, "the parts are submitted; merge their rows with `cuvette study merge`", out, why)
            : out_of_memory(why);
    close_line(&c);
    return code;
}

static void print_line(const command_line *c, FILE *out)
{
    for (size_t i = 1; i < c->count; i++)
        fprintf(out, "%s%s", i > 1 ? " " : "", c->arguments[i]);
    fputc('\n', out);
}

status slurm_print_commands(const slurm_submission *s, FILE *out, diagnostic *why)
{
    command_line parts, merge = {.arguments = NULL};
    const bool good = parts_line(&parts, s) && merge_line(&merge, s, "JOB");
    if (good) {
        print_line(&parts, out);
        print_line(&merge, out);
    }
    close_line(&parts);
    close_line(&merge);
    return good ? STATUS_OK : out_of_memory(why);
}
