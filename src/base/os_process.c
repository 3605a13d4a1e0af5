/* Facts about this process and its parent: proc(5), sched_setaffinity(2), prctl(2). */
#include "base/os_process.h"

#include "base/cancel.h"
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

bool os_program_path(char path[PATH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
    const bool known = length > 0 && length < PATH_MAX;
    path[known ? length : 0] = 0;
    return known;
}

/* The mask has room for more units than any machine has: sched_getaffinity fails if it is too small for the machine. */
int os_usable_units(void)
{
    enum { UNITS_MAX = 16384 };
    cpu_set_t set[UNITS_MAX / CPU_SETSIZE];
    return sched_getaffinity(0, sizeof set, set) == 0 ? CPU_COUNT_S(sizeof set, set) : 0;
}

void os_signals_as_errors(void)
{
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

typedef struct large_call {
    int (*task)(void *context);
    void *context;
    int result;
    cancel_token *token; /* of the caller */
} large_call;

static void *call(void *of)
{
    large_call *c = of;
    cancel_follow(c->token);
    c->result = c->task(c->context);
    return NULL;
}

/* glibc sets the size of threads' stacks from the limit at the start of the process. */
int os_call_with_stack(int (*task)(void *context), void *context)
{
    enum { ENOUGH_BYTES = 1 << 20, STACK_BYTES = 8 << 20 };
    large_call c = {task, context, 1, cancel_current()};
    struct rlimit limit;
    pthread_attr_t attributes;
    pthread_t thread;
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= ENOUGH_BYTES || pthread_attr_init(&attributes) != 0)
        return task(context);
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    pthread_setattr_default_np(&attributes);
    const bool started = pthread_create(&thread, &attributes, call, &c) == 0;
    pthread_attr_destroy(&attributes);
    if (!started)
        return task(context);
    cancel_join(thread);
    return c.result;
}

void os_die_with_parent(void)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}
