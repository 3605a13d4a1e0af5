/* The thread team: a parallel loop over tasks. */
#include "base/thread_team.h"

#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/os_process.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct member {
    thread_team *of;
    int number;
    pthread_t thread;
} member;

struct thread_team {
    int size;
    pid_t process; /* that has the threads: a child of fork has none of them (fork(2)) */
    pthread_mutex_t lock;
    pthread_cond_t begin, end;
    unsigned long run; /* number of the current loop */
    int busy;          /* threads that have not finished it */
    bool quit;
    thread_team_task *task;
    void *context;
    size_t count;
    cancel_token *token; /* of the caller */
    atomic_size_t next;
    member members[]; /* [0] is the caller */
};

static void work(thread_team *t, int number)
{
    for (;;) {
        size_t index = atomic_fetch_add_explicit(&t->next, 1, memory_order_relaxed);
        if (index >= t->count)
            return;
        t->task(t->context, index, number);
    }
}

static void *attend(void *argument)
{
    member *m = argument;
    thread_team *t = m->of;
    unsigned long done = 0;
    float_environment_set();
    pthread_mutex_lock(&t->lock);
    for (;;) {
        while (t->run == done && !t->quit)
            pthread_cond_wait(&t->begin, &t->lock);
        if (t->quit)
            break;
        done = t->run;
        cancel_follow(t->token);
        pthread_mutex_unlock(&t->lock);
        work(t, m->number);
        pthread_mutex_lock(&t->lock);
        if (--t->busy == 0)
            pthread_cond_signal(&t->end);
    }
    pthread_mutex_unlock(&t->lock);
    return NULL;
}

thread_team *thread_team_start(int threads)
{
    thread_team *t = malloc(sizeof *t + (size_t)threads * sizeof t->members[0]);
    if (!t)
        return NULL;
    *t = (thread_team){.size = 1, .process = getpid()};
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->begin, NULL);
    pthread_cond_init(&t->end, NULL);
    for (; t->size < threads; t->size++) {
        member *m = &t->members[t->size];
        m->of = t;
        m->number = t->size;
        if (pthread_create(&m->thread, NULL, attend, m))
            break;
    }
    return t;
}

/* In a child of fork the caller is alone. */
static void forget_threads_of_parent(thread_team *t)
{
    if (t->process == getpid())
        return;
    t->size = 1;
    t->process = getpid();
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->begin, NULL);
    pthread_cond_init(&t->end, NULL);
}

void thread_team_stop(thread_team *t)
{
    if (!t)
        return;
    forget_threads_of_parent(t);
    pthread_mutex_lock(&t->lock);
    t->quit = true;
    pthread_cond_broadcast(&t->begin);
    pthread_mutex_unlock(&t->lock);
    for (int i = 1; i < t->size; i++)
        pthread_join(t->members[i].thread, NULL);
    pthread_cond_destroy(&t->begin);
    pthread_cond_destroy(&t->end);
    pthread_mutex_destroy(&t->lock);
    free(t);
}

int thread_team_size(const thread_team *t)
{
    return t->size;
}

void thread_team_run(thread_team *t, thread_team_task *task, void *context, size_t count)
{
    forget_threads_of_parent(t);
    pthread_mutex_lock(&t->lock);
    t->task = task;
    t->context = context;
    t->count = count;
    t->token = cancel_current();
    atomic_store_explicit(&t->next, 0, memory_order_relaxed);
    t->busy = t->size - 1;
    t->run++;
    pthread_cond_broadcast(&t->begin);
    pthread_mutex_unlock(&t->lock);
    work(t, 0);
    pthread_mutex_lock(&t->lock);
    while (t->busy > 0)
        pthread_cond_wait(&t->end, &t->lock);
    pthread_mutex_unlock(&t->lock);
}

int thread_team_units(void)
{
    int count = os_usable_units();
    if (count < 1)
        count = (int)sysconf(_SC_NPROCESSORS_ONLN);
    return count > 1 ? count : 1;
}
