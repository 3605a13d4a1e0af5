/* Cancellation of long work, through one token. Whoever begins work that may have to end early (a command, a time
 * limit, a call of the engine) begins a token on its thread, and sets it or supplies the function `ask`; every loop
 * that may run for longer than 50 ms calls cancel_asked, stops, and returns STATUS_INTERRUPTED. So no function below
 * needs a parameter for it, and functions that report progress return nothing: one that wants no more sets a token.
 * Threads that work for a caller follow its tokens: a thread team, the worker pool, cancel_join; other threads begin
 * without one.
 *
 * Once requested, cancellation stays so until the token ends: a function without a status may return early with an
 * incomplete result if its caller then asks before using it. Ownership: a token is its owner's, usually on the stack,
 * and must outlive the work; begin and end are paired on one thread, and nest: work below two tokens ends with
 * either. */
#pragma once

#include "base/status.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/* Zeros but for ask and context; the other fields are private. */
typedef struct cancel_token {
    /* Whether the work should end: called only on the thread that began the token, often (cheap), not again after true.
     * NULL: only cancel_set ends it. */
    bool (*ask)(void *context);
    void *context;
    atomic_bool asked;
    bool shields; /* against the tokens outside */
    const void *thread;
    struct cancel_token *outer;
} cancel_token;

void cancel_begin(cancel_token *t);
void cancel_end(cancel_token *t);

/* From any thread, and from signal handlers; also before the token begins. */
void cancel_set(cancel_token *t);
/* Whether it was set or its ask returned true; for any thread. */
bool cancel_is_set(const cancel_token *t);
/* Before other work begins under it. */
void cancel_clear(cancel_token *t);

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

/* STATUS_INTERRUPTED with the reason "interrupted" if it should end, else STATUS_OK. */
status cancel_check(diagnostic *why);

/* For a step that returned nothing: it was cancelled, or out of memory. */
status cancelled_or_out_of_memory(diagnostic *why);

/* For threads that work for this one: cancel_current returns this thread's token, or NULL; the other threads follow it,
 * without calls of ask. */
cancel_token *cancel_current(void);
void cancel_follow(cancel_token *t);
/* pthread_join of a thread that follows this one's token. Calls ask while it waits, as only this thread may. */
void cancel_join(pthread_t thread);
