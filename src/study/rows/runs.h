/* The runs of a study: results/<study>/runs.json, runs.shard-i-of-N.json of shards. Each call of study_run that
 * measures is a run: it has an id, which its rows carry, the facts of its environment (study/rows/environment.h) and
 * others that are only recorded, and at its end the number and last checksum of its rows in each file, so that missing
 * rows are noticed. Ownership: runs_destroy releases a list; entries point into it. Errors name the file. */
#pragma once

#include "study/rows/facts.h"

enum { RUN_ID = 17 };

typedef struct run_entry {
    const char *id;
    run_environment environment;
    bool key_is_right;   /* the key agrees with the facts; otherwise they were edited */
    const json_t *facts; /* the complete entry */
} run_entry;

typedef struct run_list {
    json_t **files;
    size_t file_count;
    run_entry *entry; /* those of runs.json first, then those of each shard, in the order of their starts */
    size_t count;
} run_list;

/* Reads all lists of the folder, below root (base/file.h); a folder may have none. STATUS_BAD_INPUT if one is
 * damaged. */
status runs_read(const char *folder, const char *root, run_list **out, diagnostic *why);
void runs_destroy(run_list *all);
/* The index of the run of that id, or -1. NULL is allowed. */
long runs_find(const run_list *all, const char *id);

/* What a run records about a row file at its end: the number and the last checksum of its rows there. */
typedef struct run_seal {
    const char *table;
    size_t rows;
    char checksum[RUN_ID];
} run_seal;
/* The seal of a run for "rows", "workers" or "compare"; false if the run has none. */
bool runs_seal(const run_entry *run, const char *table, run_seal *out);

/* A new id. */
void runs_make_id(const run_environment *environment, char id[RUN_ID]);
/* Adds a run to the list of the shard. */
status runs_begin(const study *s, const char *folder, const topology *machine, const run_environment *environment,
                  long shard, long shards, const char *id, diagnostic *why);
/* Records the end and the seals of the run in its entry. */
status runs_end(const char *folder, const char *root, long shard, long shards, const char *id, const run_seal *seals,
                size_t seal_count, diagnostic *why);
/* Adds the runs of all shards to runs.json. */
status runs_merge(const char *folder, const char *root, diagnostic *why);

/* STATUS_BAD_INPUT if the folder has runs of the other form, quick or not (study_make_quick): forms are not mixed. */
status quick_check_runs(const study *s, const char *folder, diagnostic *why);
