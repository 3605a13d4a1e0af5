/* What a study keeps of each cell beside its rows: pictures, ray and time maps, timeline, realism metrics and curves,
 * motion, in results/<study>/images/. They come from a frame of their own after the rows, so that looking disturbs
 * nothing that is measured; its film must be that of the rows. Every file appears whole or not at all. */
#pragma once

#include "job/account.h"
#include "study/study.h"

/* Does the cell lack a file that the study keeps? */
bool keep_missing(const study *s, const char *folder, size_t cell);

/* The frame's options for what is kept; progress and context are left NULL. */
render_options keep_options(const study *s);

/* A cell, and its frame rendered with those options. Borrowed. */
typedef struct kept_cell {
    size_t cell;
    const job_account *made;
} kept_cell;

/* Writes the cell's files. */
status keep_write(const study *s, const char *folder, const kept_cell *c, diagnostic *why);

/* Writes images/index.tsv: file, cell and axis values of every kept file that is there, all shards' together. Unless
 * renew, only when it is missing. Nothing for a study that keeps nothing. */
status keep_index(const study *s, const char *folder, bool renew, diagnostic *why);
