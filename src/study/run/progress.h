/* The progress of a study: the measured repetitions by cell, read from the rows on disk and updated while a study runs;
 * and its display with the estimated time left, as a line on a terminal and by callbacks (study_options). Ownership:
 * progress_index_destroy releases an index; progress_end releases what progress_begin returned (NULL if memory runs
 * out); study and options are borrowed until then. */
#pragma once

#include "study/rows/environment.h"
#include "study/study.h"

/* The film that a build of the program renders for cells that must have the same film (study_cell_film); another build
 * may render another. */
typedef struct progress_index_expected {
    uint64_t build, film_hash;
} progress_index_expected;

typedef struct progress_index_cell {
    size_t rows, counted, marked; /* counted: repetitions of the environment that are not warm-ups; rows: all */
    size_t disturbed,
        undisturbed;      /* counted rows; the other counted rows are not judged, because their noise is unknown */
    long next_repetition; /* one more than the highest existing number */
    /* The film of the first row of each build, stored with the first cell that must have this film
     * (study_cell_film). */
    progress_index_expected *film;
    size_t film_count;
    double *wall_s; /* of the counted rows */
} progress_index_cell;

typedef struct progress_index {
    const study *s;
    char environment[ENVIRONMENT_KEY]; /* key of the environment whose rows count; "": all */
    long shard, shards;                /* as in the filter */
    progress_index_cell *cells;
    size_t cell_count, rows, marked, warmups, disturbed;
    size_t elsewhere;   /* rows of other environments */
    size_t other_cells; /* rows of cells that the study does not have */
    size_t fault_count; /* faults of rows, such as a wrong checksum or a missing row (study/rows/row_files.h) */
    diagnostic fault;   /* the first one */
    char last_environment[ENVIRONMENT_KEY]; /* of the last row of another environment; "" without one */
} progress_index;

/* What the index needs to know of a row. */
typedef struct progress_index_entry {
    size_t cell;
    long repetition;
    bool warmup;
    noise_verdict disturbed;
    uint64_t film_hash, build;
    double wall_s;
    const char *environment;
    bool of_other_shard;
} progress_index_entry;

/* Which rows count. */
typedef struct progress_index_filter {
    const char *environment; /* key of the environment whose rows count; "": all */
    long shard,
        shards; /* shards > 1: only rows of this shard's runs count, and it measures a part of the repetitions */
} progress_index_filter;
status progress_index_read(const study *s, const char *results, const progress_index_filter *filter,
                           progress_index **out, diagnostic *why);
/* The smallest and the largest number of repetitions of a cell, of all or of the shard's part. They differ with
 * relative_width or undisturbed. */
long progress_index_least(const progress_index *index);
long progress_index_most(const progress_index *index);
/* Adds a new row. */
status progress_index_add(progress_index *index, const progress_index_entry *entry, diagnostic *why);
void progress_index_destroy(progress_index *index);

/* The film hash that a cell must have: the hash in the first row that the build wrote for any cell with the same film,
 * or film_hash if there is none. progress_index_build: the present build. */
uint64_t progress_index_film(const progress_index *index, size_t cell, uint64_t build, uint64_t film_hash);
uint64_t progress_index_build(void);

/* Whether the cell has enough repetitions: the maximum; or, with undisturbed, that many undisturbed rows; or, with
 * relative_width, at least the minimum and a sufficiently narrow interval. */
bool progress_index_cell_done(const progress_index *index, size_t cell);

/* The display. Without a terminal and callbacks, every call does nothing. */
typedef struct progress_display progress_display;

progress_display *progress_begin(const study *s, const study_options *options);
/* Call before a cell is measured. Estimates the time left: the sum over the unfinished cells of the missing
 * repetitions, up to repetitions_max, times the mean time of the cell so far (of all cells if it has none). */
void progress_count(progress_display *line, size_t cell, const progress_index *done, const size_t *cells,
                    size_t cell_count);
/* Call when all cells are measured; updates the display immediately. */
void progress_measured(progress_display *line, const progress_index *done, const size_t *cells, size_t cell_count);
/* Call before the kept files of a cell are made; img counts such cells from 1 to images. */
void progress_images(progress_display *line, size_t cell, size_t img, size_t images);
/* Updates the display; fraction_done is the completed fraction of the frame. */
void progress_show(progress_display *line, double fraction_done);
/* Like progress_show, while slimes move before a frame; fraction_done is the completed fraction of the motion. */
void progress_moving(progress_display *line, double fraction_done);
/* Erases the line before other text; the next update shows it again. NULL is allowed. */
void progress_erase_line(const progress_display *line);
void progress_end(progress_display *line);
