/* Files that a study keeps for each cell in addition to its rows: images, ray and time maps, timeline, realism metrics
 * and curves, motion, in results/<study>/images/. They are rendered in a separate frame after the rows, so that they do
 * not disturb measurements; the film must equal that of the rows. Files are written atomically.
 *
 * Metrics and curves (realism/realism.h) and motion (softbody/trials.h) are tables, one line per metric, point of a
 * curve or value. Each line starts with study, cell and the axis values, so that the tables of all cells can be
 * concatenated. Tab separated, NA for undefined values; results/README.md lists the columns. */
#pragma once

#include "base/budget.h"
#include "job/account.h"
#include "study/study.h"

/* Checks that the tables kept by the study can be measured in every cell. *key: the key of `keep` that failed. */
status keep_check_tables(const study *s, const char **key, diagnostic *why);

/* Whether a file that the study keeps is missing for the cell. */
bool keep_missing(const study *s, const char *folder, size_t cell);
/* The number of kept files that are missing for the cell. */
size_t keep_missing_count(const study *s, const char *folder, size_t cell);
/* Adds to *to the disk space that the missing files may need; setting: the scene of the cell. */
status keep_room(const study *s, const char *folder, size_t cell, const scene *setting, disk_room *to, diagnostic *why);
/* The ending of the study's kept file i, counted from 0: ".png" of images/0003.png; NULL after the last. */
const char *keep_ending(const study *s, size_t i);

/* Names the kept files by the numbers that their cells have now (study/plan/keep_numbers.c); create: also makes the
 * folder if it is missing. *changed: files may have been renamed. */
status keep_renumber(const study *s, const char *folder, bool create, bool *changed, diagnostic *why);

/* The path of a cell's image in the study's folder; fresh memory, or NULL. */
char *keep_image_path(const char *folder, size_t cell);

/* The options of the frame for the kept files; progress and context stay NULL. */
render_options keep_options(const study *s);

/* A cell, and its frame rendered with keep_options. Borrowed. */
typedef struct kept_cell {
    size_t cell;
    const job_account *account;
} kept_cell;

/* Writes the cell's files. */
status keep_write(const study *s, const char *folder, const kept_cell *c, diagnostic *why);

/* Writes images/index.tsv: file, cell and axis values of every existing kept file, of all shards. Without renew, only
 * if it is missing. Does nothing for a study that keeps nothing. */
status keep_index(const study *s, const char *folder, bool renew, diagnostic *why);
