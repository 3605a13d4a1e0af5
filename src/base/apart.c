/* A confined thread for one call. */
#include "base/apart.h"

#include "base/cancel.h"
#include "base/memory_budget.h"
#include "base/os_confine.h"
#include <pthread.h>
#include <signal.h>
#include <stddef.h>

enum { STACK_BYTES = 1 << 20 };

typedef struct call {
    void (*work)(void *context);
    void *context;
    cancel_token *token; /* of the caller */
    memory_room room;
} call;

static void *run_confined(void *of)
{
    const call *c = of;
    cancel_follow(c->token);
    memory_budget_assume(c->room);
    if (!os_confine_calls(CONFINE_COMPUTING))
        os_confine_files(NULL, 0);
    c->work(c->context);
    return NULL;
}

void apart_run(void (*work)(void *context), void *context)
{
    call c = {work, context, cancel_current(), memory_budget_look()};
    pthread_t thread;
    pthread_attr_t attributes;
    sigset_t all, before;
    int error = pthread_attr_init(&attributes);
    if (!error) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        error = pthread_create(&thread, &attributes, run_confined, &c);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        pthread_attr_destroy(&attributes);
    }
    if (error)
        work(context);
    else
        cancel_join(thread);
}
