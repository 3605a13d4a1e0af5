/* A study: a scene, fixed parameters, a grid over any parameters, repetitions, and what to keep; run so that raw
 * rows are sacred (design, decision 7). results/<study>/ holds rows.csv (one row a repetition, appended and flushed
 * at once, never rewritten), manifest.json, images/ (one a cell); with a reference compare.csv (one row a cell) and
 * references/. Ownership: study_read gives, study_destroy releases. Errors in the file are located there: file, line,
 * column. */
#pragma once

#include "base/status.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { STUDY_CELLS_MAX = 65536, STUDY_AXES_MAX = 16, STUDY_REPETITIONS_MAX = 100000, STUDY_WARMUPS_MAX = 1000 };

/* One point of an axis sets one or more parameters together. Values are as scene_get writes them. */
typedef struct study_point {
    char **paths, **values;
    size_t count;
    size_t film; /* the axis' first point of which a frame has the same film: they differ in how it is computed */
    long line, column;
} study_point;
/* All points of an axis set the same paths, in the same order. */
typedef struct study_axis {
    char *name;
    study_point *points;
    size_t count;
} study_axis;

typedef struct study {
    char *path, *name, *title;
    char *scene_path;  /* resolved against the study file's folder */
    study_point fixed; /* parameters set for all cells */
    study_axis *axes;
    size_t axis_count;
    study_point reference; /* set on top of a cell's parameters, these give the picture that the cell's is
                              compared with; count 0: nothing is compared */
    long repetitions_min, repetitions_max; /* counted, without warm-ups */
    double relative_width; /* stop after min once the 95% interval of the mean wall time is narrower than
                              this share of it; 0: always max */
    long warmups;          /* frames of a cell before its first measured one, in every process */
    bool shuffle;
    uint64_t seed;
    bool keep_image, keep_pfm, keep_workers, keep_pixel_rays, keep_pixel_time, keep_timeline, keep_metrics, keep_curves,
        keep_motion;         /* of each cell, once */
    char *text, *scene_text; /* both files, as they were read */
    scene *base;             /* the scene with the fixed parameters set */
    /* Of what a row means: name, scene, fixed parameters, grid; rows that mean something else are not
     * mixed in (study/accepted.h).
     * Repetitions, order, title and what is kept may change, and the study goes on. */
    uint64_t definition_hash;
    uint64_t compare_hash; /* of what a row of compare.csv means: the definition, and the reference */
} study;

/* Does it keep files of its cells, beside rows? */
bool study_keeps_files(const study *s);

status study_read(const char *path, study **out, diagnostic *why);
/* Who reads a study for others says what it may read. Both are asked before anything is opened; other than STATUS_OK is
 * the study's error. */
typedef struct study_guard {
    status (*may_open)(void *context, const char *path, diagnostic *why); /* the scene's file */
    status (*may_load)(void *context, const scene *setting,
                       diagnostic *why); /* what is named in the scene of a cell, or of its reference */
    void *context;
    const char *root; /* nothing is read that does not lie below it, whoever names it (base/below.h), rows included;
                         NULL or "": anywhere */
} study_guard;
status study_read_guarded(const char *path, const study_guard *guard, study **out, diagnostic *why);
/* The same from memory; name stands for the file in diagnostics, and its folder is where the scene's path starts. */
status study_read_text(const char *name, const char *text, size_t size, study **out, diagnostic *why);
void study_destroy(study *s);

/* Cells are the grid's points, numbered 0.. with the last axis fastest. */
size_t study_cell_count(const study *s);
/* The axis point of a cell: study.axes[axis].points[study_cell_point(...)]. */
size_t study_cell_point(const study *s, size_t cell, size_t axis);
/* The first cell that must have the same film: its parameters differ only in how a frame is computed
 * (param.performance_only). */
size_t study_cell_film(const study *s, size_t cell);
/* The study's scene with the fixed parameters and the cell's set; pictures are not loaded. */
status study_cell_scene(const study *s, size_t cell, scene **out, diagnostic *why);

typedef enum study_phase {
    STUDY_MEASURING,
    STUDY_MOVING,
    STUDY_IMAGES
} study_phase; /* moving: slimes, before a frame */

/* How far a study is while it runs. */
typedef struct study_moment {
    study_phase stage;
    size_t cell;                    /* whose frame it is */
    double share;                   /* of that frame, or of the motion before it, 0..1 */
    size_t frames_done, frames_all; /* repetitions, without warm-ups, of this process' cells */
    double left_s;                  /* for the frames to come; NaN: not known */
    size_t img, images;             /* which of the kept pictures, from 1; 0 of 0 while rows are measured */
} study_moment;

typedef struct study_options {
    const char *results; /* folder; results/<name>/ is made in it */
    long shard, shards;  /* this process does the cells whose place in the shuffled grid, modulo shards, is shard;
                            0 of 1 (or 0 of 0) for all */
    FILE *progress;      /* a terminal for the progress line with ETA, or NULL */
    bool (*stop)(void *context); /* polled; true ends the run with STATUS_INTERRUPTED, rows kept. May be NULL */
    void (*progressed)(
        void *context,
        const study_moment *now); /* about ten times a second at most, from the thread that runs it. May be NULL */
    void *context;                /* of both */
} study_options;

/* Runs what is missing; a study that is complete costs nothing and says so through *ran = 0 (rows written). */
status study_run(const study *s, const study_options *options, size_t *ran, diagnostic *why);

/* How far it is, over rows.csv and the shards' files. */
typedef struct study_progress {
    size_t cells, cells_done, rows, warmups, rows_marked;
} study_progress; /* warmups: of the rows */
status study_status(const study *s, const char *results, study_progress *out, diagnostic *why);

/* Joins the shards' rows (results/<name>/rows.shard-i-of-N.csv) into rows.csv; no row lost or twice. rows.csv
 * appears whole or not at all; the shards' files stay. */
status study_merge(const study *s, const char *results, size_t *rows, diagnostic *why);
