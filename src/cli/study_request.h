/* The command lines of `cuvette study`, and the table of its summary. Ownership: study_request_release frees a request,
 * also after a parsing error; strings are borrowed from argv. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef enum study_verb {
    STUDY_RUN,
    STUDY_LIST,
    STUDY_STATUS,
    STUDY_MERGE,
    STUDY_SUMMARY,
    STUDY_VERIFY,
    STUDY_VERB_COUNT
} study_verb;

typedef struct study_request {
    study_verb verb;
    const char **files; /* study files; for STUDY_LIST the folder */
    size_t file_count;
    const char *results;
    const char *environment;    /* of the summary: a key, "main", or NULL for all */
    const char *columns;        /* of --interval, or NULL */
    const char *against;        /* of a run: the program to alternate with, or NULL */
    double wait_quiet_s;        /* of a run; 0: do not wait */
    int64_t process, processes; /* of a run: see study_options; processes: 0: those of the study file */
    long shard, shards;
    bool by_repetition, any_environment, quick, quiet, progress, dry_run, instructions;
} study_request;

status study_request_parse(study_verb verb, int argc, char **argv, study_request *out, diagnostic *why);
void study_request_release(study_request *request);

/* Prints the summary of a study for a terminal, with aligned columns: cell, axes, n, median and 95% interval of the
 * wall time, median CPU time, rays and marked rows, excluded and disturbed ones if there are some; with a reference
 * also flip and error_rms. tsv is the output of study_summary and is modified. */
status study_table_print(FILE *out, char *tsv, diagnostic *why);

/* `cuvette study plot`, which has options of its own (study_plot.c). */
status command_study_plot(int argc, char **argv, diagnostic *why);
