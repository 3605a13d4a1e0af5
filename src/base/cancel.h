/* Cancellation of long work, through one token. The caller of work that may have to end early (a command, a time limit,
 * the engine) begins a token on its thread, and sets it or supplies the function `ask`. Every loop that may run for
 * longer than 50 ms calls cancel_asked, and if it returns true, stops and returns STATUS_INTERRUPTED. So no function in
 * between needs a parameter for it, and progress callbacks return nothing: to cancel, they set a token. Threads that
 * work for a caller follow its tokens: those of a thread team, of the worker pool, and those joined by cancel_join.
 * Other threads begin without a token.
 *
 * A cancellation holds until the token ends: a function without a status may return early with an incomplete result if
 * its caller then asks before using it. Ownership: the caller owns the token, usually on the stack; it must outlive the
 * work. Begin and end are paired on one thread and nest: work under two tokens ends if either is set. */
#pragma once

#include "base/status.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/* The caller sets ask and context, and all other fields to zero; they are private. */
typedef struct cancel_token {
    /* Whether the work should end. Called often, so it must be cheap; only on the thread that began the token; not
     * again after it returned true. NULL: only cancel_set ends the work. */
    bool (*ask)(void *context);
    void *context;
    atomic_bool asked;
    bool shields; /* hides the outer tokens */
    const void *thread;
    struct cancel_token *outer;
} cancel_token;

void cancel_begin(cancel_token *t);
void cancel_end(cancel_token *t);

/* Requests the cancellation: from any thread, from signal handlers, and also before the token begins. */
void cancel_set(cancel_token *t);
/* Whether the token was set or its ask returned true; for any thread. */
bool cancel_is_set(const cancel_token *t);
/* Resets a token before other work begins under it. */
void cancel_clear(cancel_token *t);

/* Begins a token that hides the outer ones, so that partial results can be written after a cancellation. */
void cancel_shield(cancel_token *t);

/* Whether the work of this thread should end. About 2 ns without a token, 5 with one. */
bool cancel_asked(void);

/* The same for item i of a loop over items of a few nanoseconds: asks at one in 4096. */
static inline bool cancel_asked_at(size_t i)
{
    return (i & 0xfff) == 0 && cancel_asked();
}

/* Under a shield: whether an outer token is set, so that partial results should be written quickly. */
bool cancel_hurries(void);

/* STATUS_INTERRUPTED with the reason "interrupted" if the work should end, else STATUS_OK. */
status cancel_check(diagnostic *why);

/* The error of a step that returned NULL: cancelled, or out of memory. */
status cancelled_or_out_of_memory(diagnostic *why);

/* For threads that work for this one: they follow the token that cancel_current returned on this thread (or NULL), and
 * never call its ask. */
cancel_token *cancel_current(void);
void cancel_follow(cancel_token *t);
/* pthread_join of a thread that follows this one's token. Calls ask while it waits, as only this thread may. */
void cancel_join(pthread_t thread);
