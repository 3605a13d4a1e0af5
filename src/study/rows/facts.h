/* Facts in JSON that are stored next to rows: what runs.json records about the study, the machine and a run
 * (study/rows/runs.h), and the files of such values. No host name, serial number or path of this machine. The caller
 * owns them; NULL or a null value if memory runs out. */
#pragma once

#include "base/status.h"
#include "measure/topology.h"
#include "study/rows/environment.h"
#include "study/study.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* A hash is 16 hex digits; reading it returns false and 0 if it is missing. */
json_t *facts_hash(uint64_t value);
bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out);
/* facts_read: *out is NULL with STATUS_OK if the file below root (base/file.h) is not JSON. facts_write replaces the
 * file; flags: jansson's. */
status facts_read(const char *path, const char *root, json_t **out, diagnostic *why);
status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why);

json_t *run_study_facts(const study *s);
json_t *run_machine_facts(const topology *machine);
json_t *run_facts(const study *s, const topology *machine, const run_environment *environment, const char *id,
                  long shard, long shards);
/* The current time as text, or the time in SOURCE_DATE_EPOCH (reproducible-builds.org/specs/source-date-epoch). */
json_t *run_time(void);

/* The commit checked out in folder, 40 hex digits, which the caller frees; *dirty: tracked files differ from it. NULL
 * without git. */
char *provenance_git_commit(const char *folder, bool *dirty);
/* Removes from hwloc's XML everything that distinguishes machines of the same kind: host name, serial numbers,
 * addresses, control groups. Changes xml in place; NULL is allowed. */
void provenance_anonymize(char *xml);
