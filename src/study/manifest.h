/* Reads manifest.json, which defines the rows of versions without identities of cells: the texts of study and scene at
 * the start of the first run. Newer versions write runs.json (study/runs.h). Also JSON values stored next to rows. */
#pragma once

#include "base/status.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* The meaning of rows as recorded in a manifest. */
typedef struct manifest_study {
    char *text, *scene_text; /* the texts of study and scene at the start of the first run */
    uint64_t definition;     /* the hash in the rows of that run */
    bool has_files;
    uint64_t files; /* hash of the contents of the scene's files; has_files: it is recorded */
} manifest_study;

/* Reads it below root (base/below.h). STATUS_BAD_INPUT if it is damaged or incomplete. manifest_study_free releases. */
status manifest_read(const char *path, const char *root, manifest_study *out, diagnostic *why);
void manifest_study_free(manifest_study *m);

/* Values stored in JSON next to the rows. A hash is 16 hex digits; reading it gives false and 0 if it is missing. */
json_t *facts_hash(uint64_t value);
bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out);
/* Reads a file below root (base/below.h), NULL with STATUS_OK if it is not JSON; writes a whole file. flags: jansson's.
 * */
status facts_read(const char *path, const char *root, json_t **out, diagnostic *why);
status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why);
