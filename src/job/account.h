/* The account of a job: results of one frame, or of several frames of one scene rendered one after another, with the
 * film, counts, times, and the resources that the process used. All output about a frame is read from an account,
 * through the list in job/quantities.h. Ownership: an account owns its result and its lists of times, and borrows the
 * scene; job_account_release releases them. Unknown numbers are NaN or -1. */
#pragma once

#include "base/isa.h"
#include "lint/lint.h"
#include "measure/machine_noise.h"
#include "measure/usage.h"
#include "render/frame/renderer.h"

typedef struct job_account {
    const scene *of; /* the rendered scene */
    isa level;
    render_result *result;    /* the last complete frame; a partial one if none is complete */
    bool complete;            /* all requested frames are finished */
    size_t count;             /* number of finished frames */
    double *wall_s, *cpu_s;   /* a time for each finished frame, in order */
    usage spent;              /* over all frames, if the job measures it */
    machine_noise noise;      /* over all frames, at least over the last NOISE_WINDOW_S, if the job measures it */
    hardware_counts hardware; /* over all frames, including pool threads, if the job measures it */
    int64_t ended_ms;         /* end of the last frame, milliseconds since 1970 UTC */
    uint64_t film_hash;       /* 0: not computed yet; use job_account_hash */
} job_account;

/* Allocates the lists for the times of `frames` frames. *out can be released even if this fails. */
status job_account_begin(const scene *s, isa level, size_t frames, job_account *out, diagnostic *why);
void job_account_release(job_account *a);

/* The film's hash. */
uint64_t job_account_hash(const job_account *a);

/* Medians over the finished frames; if no frame is finished, the times of the interrupted one. NaN when out of
 * memory. */
double job_account_wall_s(const job_account *a);
double job_account_cpu_s(const job_account *a);

/* Reports the notes on the account's frame, what its image lacks with the remedy; none if no frame is
 * complete. */
void frame_notes(const job_account *a, const note_sink *taker);
