/* Included before the files of the laboratory in a WebAssembly module, which has one thread. A wait is satisfied only
 * by work that render_turns.c does at once: loading the scene, serving a grab. Any other wait times out immediately,
 * and sets wasm_waited, so that the request is handled again later (src/wasm/request.c). */
#pragma once

#ifdef __EMSCRIPTEN__
#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <time.h>

extern int wasm_waited;
/* A request that waited is being handled again: work that failed before is not repeated for it. */
extern bool wasm_is_repeated;
bool wasm_work_at_once(void);

static inline int pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *lock, clockid_t clock,
                                         const struct timespec *until)
{
    (void)condition, (void)lock, (void)clock, (void)until;
    if (wasm_work_at_once())
        return 0;
    wasm_waited = 1;
    return ETIMEDOUT;
}

/* Musl has one kind of lock. */
#define PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP 0
static inline int pthread_rwlockattr_setkind_np(pthread_rwlockattr_t *attributes, int kind)
{
    (void)attributes, (void)kind;
    return 0;
}
#endif
