/* The parts of `cuvette study`: its command lines, its subcommands, the notes before a run, and tables for a terminal.
 * Ownership: study_request_release frees a request, also after a parsing error; strings are borrowed from argv;
 * everything else is borrowed. Diagnostics name the command line, or a position in the study file. */
#pragma once

#include "base/status.h"
#include "study/run/estimate.h"
#include "study/study.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* --- command lines --- */

typedef enum study_verb {
    STUDY_RUN,
    STUDY_LIST,
    STUDY_STATUS,
    STUDY_MERGE,
    STUDY_SUMMARY,
    STUDY_VERIFY,
    STUDY_VERB_COUNT
} study_verb;

typedef struct study_request {
    study_verb verb;
    const char **files; /* study files; for STUDY_LIST the folder */
    size_t file_count;
    const char *results;
    const char *environment;    /* summary: a key, "main", or NULL for all */
    const char *columns;        /* summary: columns of --interval, or NULL */
    const char *against;        /* run: the program to alternate with, or NULL */
    double wait_quiet_s;        /* run; 0: do not wait */
    int64_t process, processes; /* run: see study_options; processes 0: as in the study file */
    long shard, shards;
    bool by_repetition, any_environment, quick, quiet, progress, dry_run, instructions;
} study_request;

status study_request_parse(study_verb verb, int argc, char **argv, study_request *out, diagnostic *why);
void study_request_release(study_request *request);

/* --- subcommands with a file of their own --- */

/* `study new`: writes a study file. */
status study_new(int argc, char **argv, diagnostic *why);

/* `study list`: the studies of a folder, and the scenes of its folder scenes. */
status study_list(int argc, char **argv, diagnostic *why);
/* `study submit`: the missing parts of a study as an array job of a cluster. */
status study_submit(int argc, char **argv, diagnostic *why);
/* `study exclude`: excludes a row from summaries. */
status study_exclude(int argc, char **argv, diagnostic *why);
/* `study compare`: the ratio of two sides of a study, with a verdict. */
status study_compare(int argc, char **argv, diagnostic *why);
/* `study films`: whether two results folders have the same films and ray counts. */
status study_films_command(int argc, char **argv, diagnostic *why);
/* `study power`: false claims and missed differences of smaller studies, drawn from measured rows. */
status study_power(int argc, char **argv, diagnostic *why);
/* `cuvette study plot`, which has options of its own (study_plot.c). */
status command_study_plot(int argc, char **argv, diagnostic *why);

/* --- `study run` (study_run.c) --- */

/* STATUS_FAILURE if the files of the run cannot fit on the disk; prints a note if they may not. */
status study_check_room(const study *s, const study_request *request, const study_estimate *e, diagnostic *why);

/* `study run --dry-run`: prints what a run would measure and keep, and about how long it would take. */
status study_dry_run(const study *s, const study_request *request, diagnostic *why);

/* Runs a study that divides its repetitions among fresh processes, one after the other. With --against=PROGRAM the same
 * process of the other program precedes or follows each one, at random; its rows go to the folder DIR-against, if DIR
 * is the results folder. Two builds that alternate in this way can be compared. */
status study_run_processes(const study *s, const study_request *request, diagnostic *why);

/* `study run --instructions`: the study runs under valgrind, which counts the instructions of each frame
 * (measure/usage.h). Call study_instructions_end whatever study_instructions_begin returned; until then the
 * request borrows from the counted_run. */
typedef struct counted_run {
    char folder[200];   /* folder of the counts; "": none */
    char results[4096]; /* DIR-instructions */
} counted_run;

/* Does nothing without --instructions. Otherwise sends the rows to a separate folder, and sets the environment of this
 * process and its children: where counts are written, and an instruction set that valgrind supports. */
status study_instructions_begin(study_request *request, counted_run *out, diagnostic *why);
void study_instructions_end(const counted_run *run);

/* --- notes on a study before it runs, one line each on standard error --- */

/* Notes of the linter, hints, and parameters without effect (lint/lint.h) in all or some cells; and notes of the study
 * file. */

/* Prints the notes on the study file, with their positions. */
void study_notes_print_file(const study *s);

/* Prints the notes on the scenes of the cells, each once with the number of its cells. Overlaps, gaps, the camera and
 * the depth limit need traced rays: up to twelve cells are examined, for at most a second; slimes are not simulated. */
status study_notes_print_cells(const study *s, diagnostic *why);

/* --- tables with aligned columns, for a terminal or a reader --- */

/* text[row * columns + column]; numbers are right-aligned. */
status aligned_table_print(FILE *out, char *const *text, size_t rows, size_t columns, diagnostic *why);

/* Prints the summary of a study for a terminal, with aligned columns: cell, axes, n, median and 95% interval of the
 * wall time, median CPU time, rays and marked rows, excluded and disturbed ones if there are some; with a reference
 * also flip and error_rms. tsv is the output of study_summary and is modified. */
status study_table_print(FILE *out, char *tsv, diagnostic *why);

/* --- Slurm (slurm_commands.c) ---
 *
 * Calls Slurm's programs squeue and sbatch, found in PATH. Ownership: everything is borrowed. STATUS_FAILURE if one is
 * missing or fails; the reason is then its fatal message, or its first error. */

/* A script to submit. */
typedef struct slurm_submission {
    const char *script;         /* its path */
    const char *array;          /* the missing parts, for --array */
    const char *const *options; /* further options of sbatch */
    size_t option_count;
} slurm_submission;

typedef struct slurm_job {
    char id[32];
} slurm_job;

/* STATUS_BAD_INPUT if a job with this script is still in the queue. */
status slurm_check_queue(const char *script, diagnostic *why);

/* Submits the array job of the parts, and the job after it that merges their rows. */
status slurm_submit_parts(const slurm_submission *s, slurm_job *out, diagnostic *why);
status slurm_submit_merge(const slurm_submission *s, const slurm_job *parts, slurm_job *out, diagnostic *why);

/* Prints the commands of both. */
status slurm_print_commands(const slurm_submission *s, FILE *out, diagnostic *why);
