/* The command lines of `cuvette study`. Ownership: study_request_release releases what parsing filled, also after an
 * error; words are borrowed from argv. */
#ifndef CUVETTE_CLI_STUDY_REQUEST_H
#define CUVETTE_CLI_STUDY_REQUEST_H

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

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

#endif
