/* A study as an array job of Slurm: what `cuvette study submit --slurm` requests, and its script. Pure, except for the
 * functions that read rows. Ownership: the caller frees texts; other values are borrowed. */
#pragma once

#include "study/rows/environment.h"
#include "study/run/estimate.h"

/* The script's template, experiments/cluster/study.slurm. */
extern const char slurm_template[];

/* A word that the template has between @ signs. A line with a word whose value is NULL is left out. */
typedef struct slurm_word {
    const char *name, *value;
} slurm_word;

/* Replaces each word by its value, quoted for the shell if necessary (sbatch interprets quotes in its lines like the
 * shell). STATUS_BAD_INPUT for an unknown word, located in the file. */
status slurm_fill(const char *file, const char *text, const slurm_word *words, size_t count, char **out,
                  diagnostic *why);

/* The parts that lack something, in the format of --array ("0-3,7"); "" if none does, NULL when out of memory. */
char *slurm_array(const study_estimate *parts, size_t count);

/* The time of the longest part, s; NaN if it is unknown, or only a lower bound is known. */
double slurm_longest_s(const study_estimate *parts, size_t count);

/* The time limit of a part, in whole minutes: factor times the longest part, and at least SLURM_LEAST_MIN. */
enum { SLURM_LEAST_MIN = 10, SLURM_TIME = 32 };
void slurm_time_limit(double longest_s, double factor, char text[SLURM_TIME]);

/* What the largest cell needs. threads: at least 1. memory_gib: half a GiB for the program and its scene plus 64 bytes
 * for each pixel, rounded up. */
typedef struct slurm_needs {
    long threads, memory_gib;
} slurm_needs;
status slurm_needs_of(const study *s, slurm_needs *out, diagnostic *why);

/* The key of the environment with most rows, among the environments of nodes of this type and of this build; "none",
 * which is no key, if there are no such rows. unlike: how another such environment differs from it; "" if there is
 * none. others: the rows of other types and builds. */
status slurm_environment(const study *s, const char *results, const char *node_type, char key[ENVIRONMENT_KEY],
                         char *unlike, size_t size, size_t *others, diagnostic *why);
