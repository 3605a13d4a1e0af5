/* The command lines of `cuvette study`. Ownership: study_request_release releases what parsing filled, also after an
 * error; words are borrowed from argv. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum study_verb {
    STUDY_RUN,
    STUDY_LIST,
    STUDY_STATUS,
    STUDY_MERGE,
    STUDY_SUMMARY,
    STUDY_VERB_COUNT
} study_verb;

typedef struct study_request {
    study_verb verb;
    const char **files; /* study files; for STUDY_LIST the folder */
    size_t file_count;
    const char *results;
    long shard, shards;
    bool quiet;
} study_request;

status study_request_parse(study_verb verb, int argc, char **argv, study_request *out, diagnostic *why);
void study_request_release(study_request *request);

/* Prints the summary of a study for people: the few columns that one looks at first, aligned. They are cell, axes, n,
 * median and 95% interval of the wall time, median of the CPU time, rays and marked rows, from the text that
 * study_summary writes; tsv is cut apart in the course of it. */
status study_table_print(FILE *out, char *tsv, diagnostic *why);
