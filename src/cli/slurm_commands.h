/* Calls Slurm's programs squeue and sbatch, found in PATH. Ownership: everything is borrowed. STATUS_FAILURE if one is
 * missing or fails; the reason is then its fatal message, or its first error. */
#pragma once

#include "base/status.h"

#include <stdio.h>

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
