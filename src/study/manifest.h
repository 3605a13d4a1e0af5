/* results/<study>/manifest.json: on what machine, with what program and from what files the rows came. Written
 * whole once, when the study first runs; each later run adds itself to the list `runs`, so that every row's
 * time_utc falls into one. It holds no host name, no serial number and no path of this machine. SOURCE_DATE_EPOCH,
 * if set, stands for the time. */
#ifndef CUVETTE_STUDY_MANIFEST_H
#define CUVETTE_STUDY_MANIFEST_H

#include "base/isa.h"
#include "measure/topology.h"
#include "study/study.h"

enum { MANIFEST_BYTES_MAX = 64 << 20 };

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

#endif
