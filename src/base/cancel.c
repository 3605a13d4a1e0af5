/* The stack of tokens of each thread. */
#include "base/cancel.h"

#include <errno.h>
#include <time.h>

static _Thread_local cancel_token *current;
static _Thread_local char self; /* its address identifies the thread */

void cancel_begin(cancel_token *t)
{
    t->thread = &self;
    t->outer = current;
    current = t;
}

void cancel_end(cancel_token *t)
{
    current = t->outer;
}

void cancel_set(cancel_token *t)
{
    atomic_store_explicit(&t->asked, true, memory_order_relaxed);
}

bool cancel_is_set(const cancel_token *t)
{
    return atomic_load_explicit(&t->asked, memory_order_relaxed);
}

void cancel_clear(cancel_token *t)
{
    atomic_store_explicit(&t->asked, false, memory_order_relaxed);
}

void cancel_shield(cancel_token *t)
{
    *t = (cancel_token){.shields = true};
    cancel_begin(t);
}

static bool asked_from(cancel_token *first)
{
    for (cancel_token *t = first; t && !t->shields; t = t->outer) {
        if (cancel_is_set(t))
            return true;
        if (t->ask && t->thread == &self && t->ask(t->context)) {
            cancel_set(t);
            return true;
        }
    }
    return false;
}

bool cancel_asked(void)
{
    return asked_from(current);
}

bool cancel_hurries(void)
{
    cancel_token *t = current;
    while (t && !t->shields)
        t = t->outer;
    return t && asked_from(t->outer);
}

status cancel_check(diagnostic *why)
{
    return cancel_asked() ? diagnose(why, STATUS_INTERRUPTED, "", "interrupted") : STATUS_OK;
}

status cancelled_or_out_of_memory(diagnostic *why)
{
    const status cancelled = cancel_check(why);
    return cancelled == STATUS_OK ? out_of_memory(why) : cancelled;
}

cancel_token *cancel_current(void)
{
    return current;
}

void cancel_follow(cancel_token *t)
{
    current = t;
}

void cancel_join(pthread_t thread)
{
    enum { ASK_NS = 10000000 };
    struct timespec until;
    do {
        cancel_asked();
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += ASK_NS;
        if (until.tv_nsec >= 1000000000)
            until.tv_nsec -= 1000000000, until.tv_sec++;
    } while (pthread_timedjoin_np(thread, NULL, &until) == ETIMEDOUT);
}
