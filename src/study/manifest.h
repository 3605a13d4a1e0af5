/* results/<study>/manifest.json: on what machine, with what program and from what files the rows came. Written
 * whole once, when the study first runs; each later run adds itself to the list `runs`, so that every row's
 * time_utc falls into one. It holds no host name, no serial number and no path of this machine. SOURCE_DATE_EPOCH,
 * if set, stands for the time. */
#pragma once

#include "base/isa.h"
#include "measure/topology.h"
#include "study/study.h"
#include <jansson.h>

/* shard of shards, as in study_options. Waits while another shard's process writes it. */
status manifest_write(const study *s, const char *folder, const topology *machine, isa level, long shard, long shards,
                      diagnostic *why);

/* What a manifest says of the meaning of its rows. */
typedef struct manifest_study {
    char *text, *scene_text; /* of study and scene when the first run began */
    uint64_t definition;     /* that the rows of that run carry */
    bool has_files;
    uint64_t files; /* of what the scene's files held; has_files: it is recorded */
} manifest_study;

/* Below root (base/below.h). STATUS_BAD_INPUT when it is damaged or tells less than that. manifest_study_free
 * releases. */
status manifest_read(const char *path, const char *root, manifest_study *out, diagnostic *why);
void manifest_study_free(manifest_study *m);

/* Facts that stand as JSON beside rows. A fingerprint is 16 hex digits: as a value, and under a key, false and 0 where
 * there is none. */
json_t *facts_hash(uint64_t value);
bool facts_get_hash(const json_t *facts, const char *key, uint64_t *out);
/* A file below root (base/below.h), NULL with STATUS_OK for what is no JSON; and the whole of one. flags: jansson's. */
status facts_read(const char *path, const char *root, json_t **out, diagnostic *why);
status facts_write(const json_t *facts, size_t flags, const char *path, diagnostic *why);
