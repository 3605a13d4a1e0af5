/* Cancellation of long work: one token for everything that a call does, however deep. Whoever begins the work (a
 * command, a job, an engine's call) sets the token of its thread; every loop that may run for longer than 50 ms asks
 * cancel_asked, stops, and returns STATUS_INTERRUPTED. So no function below needs a parameter for it. A thread team
 * passes its caller's token on to its members; other threads begin without one.
 *
 * Once requested, cancellation stays so until the token ends: a function without a status may return early with
 * an incomplete result if its caller then asks before using it. Ownership: a token is its owner's, usually on the
 * stack, and must outlive the work; begin and end are paired on one thread, and nest: work below two tokens ends with
 * either. */
#pragma once

#include "base/status.h"
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/* Zeros but for ask and context; the other fields are private. */
typedef struct cancel_token {
    /* Whether the work should end: called only on the thread that began the token, often (cheap), possibly again after
     * true. NULL: only cancel_set ends it. */
    bool (*ask)(void *context);
    void *context;
    atomic_bool asked;
    bool shields; /* against the tokens outside */
    const void *thread;
    struct cancel_token *outer;
} cancel_token;

void cancel_begin(cancel_token *t);
void cancel_end(cancel_token *t);

/* From any thread, and from signal handlers. */
void cancel_set(cancel_token *t);

/* Begins a token that no one sets: for writing partial results after a cancellation. */
void cancel_shield(cancel_token *t);

/* Whether the work of this thread should end. About 2 ns without a token, 5 with one. */
bool cancel_asked(void);

/* The same for item i of a loop over items of a few nanoseconds: asks at one in 4096. */
static inline bool cancel_asked_at(size_t i)
{
    return (i & 0xfff) == 0 && cancel_asked();
}

/* Under a shield: whether the work outside should end, so that what is written should be written soon. */
bool cancel_hurries(void);

/* The flag of the innermost token, for a loop of a lower layer that takes one; a caller asks too, for the others. */
const atomic_bool *cancel_flag(void);

/* STATUS_INTERRUPTED with the reason "interrupted" if it should end, else STATUS_OK. */
status cancel_check(diagnostic *why);

/* For a step that returned nothing: it was cancelled, or out of memory. */
status cancelled_or_out_of_memory(diagnostic *why);

/* For thread teams: this thread's token, NULL for none; the members' (never calls ask). */
cancel_token *cancel_current(void);
void cancel_follow(cancel_token *t);
