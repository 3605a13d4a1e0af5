/* The thread of a long task of the laboratory, one at a time: a study, a video. Members other than life and the tokens
 * are private. Ownership: task_thread_create prepares a value; task_thread_destroy releases it, when no thread runs. */
#pragma once

#include "base/cancel.h"
#include <pthread.h>
#include <stdbool.h>

typedef struct task_thread {
    pthread_mutex_t life; /* held while the thread is started or joined */
    pthread_t thread;
    bool started;        /* it must be joined */
    cancel_token token;  /* of the task: its thread begins it */
    cancel_token ending; /* set when the laboratory ends */
} task_thread;

/* At most four events per second: sending disturbs a measurement. */
#define TASK_PUBLISH_PERIOD_S 0.25

void task_thread_create(task_thread *t);
void task_thread_destroy(task_thread *t);

/* The caller of the next three holds life. STATUS_INTERRUPTED when the laboratory ends. */
status task_thread_may_start(const task_thread *t, diagnostic *why);
/* After task_thread_join. STATUS_FAILURE if there is no thread. */
status task_thread_start(task_thread *t, void *(*run)(void *), void *context, diagnostic *why);
/* Whether there was one. */
bool task_thread_join(task_thread *t);

/* Requests the end of this task and of all later ones. The caller holds life, and joins. */
void task_thread_end(task_thread *t);

/* Whether it is time for another event; *published_s is the time of the last one. */
bool task_publish_is_due(double *published_s);
