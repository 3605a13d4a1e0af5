/* JSON values stored next to rows: runs.json (study/runs.h) and the films of references (study/reference.h). */
#pragma once

#include "base/status.h"
#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

/* A hash is 16 hex digits; reading it gives false and 0 if it is missing. */
json_t *facts_hash(uint64_t value);
bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out);
/* Reads a file below root (base/file.h), NULL with STATUS_OK if it is not JSON; writes a whole file. flags: jansson's.
 * */
status facts_read(const char *path, const char *root, json_t **out, diagnostic *why);
status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why);
