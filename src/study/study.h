/* A study: a scene, fixed parameters, a grid over any parameters, repetitions, and files to keep. Rows are never
 * changed. results/<study>/ has rows.csv (one row per repetition, appended and flushed immediately), runs.json, images/
 * (one per cell); with a reference also compare.csv (one row per cell) and references/. Ownership: study_destroy
 * releases a study. Errors in the study file are reported with its path, line and column. */
#pragma once

#include "base/status.h"
#include "lint/lint.h"
#include "measure/machine_noise.h"
#include "scene/model/open.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum {
    STUDY_CELLS_MAX = 65536,
    STUDY_AXES_MAX = 16,
    STUDY_REPETITIONS_MAX = 100000,
    STUDY_WARMUPS_MAX = 1000,
    STUDY_PROCESSES_MAX = 1000
};

/* One point of an axis sets one or more parameters together. Values are as scene_get writes them. */
typedef struct study_point {
    char **paths, **values;
    size_t count;
    size_t film; /* index of the first point of the axis with the same film: the points differ only in performance
                    parameters */
    long line, column;
} study_point;
/* All points of an axis set the same paths, in the same order. */
typedef struct study_axis {
    char *name;
    study_point *points;
    size_t count;
} study_axis;

/* A note on a line and column of a valid study file. */
typedef struct study_note {
    long line, column;
    scene_note note;
} study_note;

typedef struct study {
    char *path, *name, *title;
    char *scene_path;  /* resolved against the study file's folder */
    study_point fixed; /* applied to all cells */
    study_axis *axes;
    size_t axis_count;
    study_point reference; /* applied to a cell's scene, these parameters give its reference image; count 0: no
                              comparison */
    long repetitions_min, repetitions_max; /* without warm-ups */
    double relative_width; /* stop after min repetitions as soon as the 95% interval of the mean wall time is narrower
                              than this fraction of it; 0: always max */
    long undisturbed;      /* measure up to repetitions_max until that many rows are not disturbed; 0: no such rule */
    noise_rule disturbed;  /* the rule by which a row is disturbed */
    long processes;        /* fresh processes that divide the repetitions; 1: only the process of the program */
    long warmups;          /* unmeasured frames of a cell before its first measured one, in every process */
    bool quick;            /* the study is in its quick form (study_make_quick) */
    bool shuffle;
    uint64_t seed;
    bool keep_image, keep_pfm, keep_workers, keep_pixel_rays, keep_pixel_time, keep_pixel_cut, keep_timeline,
        keep_metrics, keep_curves, keep_motion; /* once per cell */
    char *text, *scene_text;                    /* the texts of both files */
    scene *base;                                /* the scene with the fixed parameters applied */
    uint64_t *identity; /* of each cell: what determines its film and its measurement (study/plan/identity.h) */
    study_note *notes;  /* in the order of the file */
    size_t note_count;
} study;

/* Whether the study keeps files of its cells in addition to rows (plan/keep.c). */
bool study_keeps_files(const study *s);

/* --- reading: plan/read.c --- */

status study_read(const char *path, study **out, diagnostic *why);
/* Access checks for callers that read a study on behalf of others. Each is called before the files that it is about are
 * opened; any result other than STATUS_OK is the study's error. */
typedef struct study_guard {
    status (*may_open)(void *context, const char *path, diagnostic *why); /* the scene's file */
    status (*may_load)(void *context, const scene *setting,
                       diagnostic *why); /* the files of the scene of a cell, or of its reference */
    void *context;
    const char *root; /* files, including rows, are read only below this folder (base/file.h); NULL or "": anywhere */
} study_guard;
status study_read_guarded(const char *path, const study_guard *guard, study **out, diagnostic *why);
/* Reads a study from memory; name is used in diagnostics, and scene paths are relative to its folder. */
status study_read_text(const char *name, const char *text, size_t size, study **out, diagnostic *why);
status study_read_text_guarded(const char *name, const char *text, size_t size, const study_guard *guard, study **out,
                               diagnostic *why);
void study_destroy(study *s);

/* The quick form of a study, for a look at all results within seconds: every frame is divided to at most QUICK_PIXELS
 * pixels (study/plan/grid.h), and every cell is measured once, without warm-up, in one process. Its times mean nothing;
 * its films and counts are exact. Its runs have `quick` in runs.json, and a results folder of a study has either quick
 * runs or others. */
status study_make_quick(study *s, diagnostic *why);
/* Makes the study quick if its runs in the results folder are quick (rows/runs.c). */
status study_follow_runs(study *s, const char *results, diagnostic *why);

/* --- folder and cells: plan/grid.c --- */

/* results/<name>, the folder of the study's rows; fresh memory, or NULL. */
char *study_folder(const study *s, const char *results);

/* Cells are the grid's points, numbered 0.. with the last axis fastest. */
size_t study_cell_count(const study *s);
/* The axis point of a cell: study.axes[axis].points[study_cell_point(...)]. */
size_t study_cell_point(const study *s, size_t cell, size_t axis);
/* The first cell that must have the same film: the parameters differ only in performance (param.performance_only). */
size_t study_cell_film(const study *s, size_t cell);
/* The study's scene with the fixed parameters and those of the cell applied; image files are not loaded. */
status study_cell_scene(const study *s, size_t cell, scene **out, diagnostic *why);

/* --- running: run/run.c --- */

typedef enum study_phase {
    STUDY_MEASURING,
    STUDY_MOVING, /* slimes move before a frame */
    STUDY_IMAGES
} study_phase;

/* The progress of a running study, down to the current frame; study_progress describes a study on disk. */
typedef struct study_frame_progress {
    study_phase stage;
    size_t cell;                    /* the cell of the current frame */
    double share;                   /* the completed fraction of that frame, or of the motion before it, 0..1 */
    size_t frames_done, frames_all; /* repetitions of this process' cells, without warm-ups */
    double left_s;                  /* estimated time of the remaining frames; NaN: unknown */
    size_t img, images; /* while files are kept: number of the current cell, from 1, of all such cells; else 0 */
} study_frame_progress;

typedef struct study_options {
    const char *results; /* results folder; results/<name>/ is created in it */
    long shard, shards;  /* this process measures the cells whose position in the shuffled grid, modulo shards, is
                            shard; 0 of 1 (or 0 of 0) for all */
    bool by_repetition;  /* instead, this process measures all cells, and every shards-th repetition of each */
    long process; /* from 1: this is one of study_processes, and measures only its part of the repetitions; 0: this
                             process measures all */
    bool any_environment;    /* rows of every environment count, not only those of the present one */
    const char *environment; /* for an estimate: key of the environment whose rows count; NULL: the present one */
    FILE *progress;          /* a terminal for the progress line with ETA, or NULL */
    int progress_columns;    /* its width, which the line does not exceed; 0: unknown */
    /* Called at most about ten times per second, by the thread that runs the study. May be NULL. */
    void (*progressed)(void *context, const study_frame_progress *now);
    /* News for the user: what disturbs the measurement, each kind at most once per minute, and a possible lack of disk
     * space. The progress line is erased before. May be NULL. */
    void (*news)(void *context, const char *text);
    double wait_quiet_s; /* before each frame, wait at most this long until nothing disturbs; 0: do not wait */
    void *context;       /* passed to all callbacks */
} study_options;

/* The number of processes among which the study divides its repetitions (plan/grid.c): its processes for the least
 * number of repetitions, and as many again for further ones. Each measures, cell by cell, until its part exists; fresh
 * processes differ in memory layout and placement, which repetitions within one do not show (Kalibera and Jones, ISMM
 * 2013). */
long study_processes(const study *s);

/* Measures what is missing; *ran: the number of written rows, 0 for a complete study. When cancelled, it returns
 * STATUS_INTERRUPTED after it has written the rows and images of what is complete. */
status study_run(const study *s, const study_options *options, size_t *ran, diagnostic *why);

/* *lacks: whether a kept file or a comparison with a reference is missing for a cell; missing rows do not count
 * (run/run_keep.c). */
status study_lacks_files(const study *s, const char *results, bool *lacks, diagnostic *why);

/* --- what is on disk: run/progress.c, rows/merge.c --- */

/* The progress of a study on disk, over rows.csv and the files of shards. Cells, rows and warm-up rows are those of the
 * present environment (study/rows/environment.h). */
typedef struct study_progress {
    size_t cells, cells_done, rows, warmups, rows_marked;
    size_t rows_disturbed;   /* by the rule of the study; warm-ups do not count */
    size_t rows_elsewhere;   /* rows of other environments */
    size_t rows_other_cells; /* rows of cells that the study does not have (any more) */
    size_t faults;           /* faults of rows, such as a mark, a wrong checksum or a missing row */
    diagnostic fault;        /* the first of them */
    char environment[16];    /* key of the present environment */
} study_progress;
status study_status(const study *s, const char *results, study_progress *out, diagnostic *why);

/* Merges the shards' rows (results/<name>/rows.shard-i-of-N.csv) into rows.csv, and their runs; no line is lost or
 * duplicated. rows.csv is written atomically; the files of shards stay. STATUS_BAD_INPUT, with no row added to
 * rows.csv, for a line that is not a row and for two rows of one repetition. verdict becomes the first of the other
 * faults of the rows. */
status study_merge(const study *s, const char *results, size_t *rows, diagnostic *verdict, diagnostic *why);
