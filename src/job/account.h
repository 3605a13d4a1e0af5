/* What one frame came to, or several of one scene rendered one after another: the film, the counts, the times, and what
 * they cost the process. All that is written of a frame is read from here, by the list of job/quantities.h. Ownership:
 * an account owns its result and its lists of times, and borrows the scene; job_account_release releases them. Absent
 * numbers are NaN or -1. */
#pragma once

#include "base/isa.h"
#include "measure/usage.h"
#include "render/core/renderer.h"

typedef struct job_account {
    const scene *of;
    isa level;
    render_result *result;    /* of the last whole frame; a partial one if none was finished */
    bool whole;               /* all that were asked for are finished */
    size_t count;             /* finished frames */
    double *wall_s, *cpu_s;   /* of each finished frame, in order */
    usage spent;              /* over all the frames, where the job measures it */
    hardware_counts hardware; /* over all the frames, pool threads included, where the job measures it */
    int64_t ended_ms;         /* since 1970 UTC, when the last frame had ended */
    uint64_t film_hash;       /* 0: not known yet, ask job_account_hash */
} job_account;

/* Room for the times of as many frames. *out can be released also when it fails. */
status job_account_begin(const scene *s, isa level, size_t frames, job_account *out, diagnostic *why);
void job_account_release(job_account *a);

/* The film's fingerprint. */
uint64_t job_account_hash(const job_account *a);

/* Median over the finished frames; of a frame that was broken off, what it took. */
double job_account_wall_s(const job_account *a);
double job_account_cpu_s(const job_account *a);
