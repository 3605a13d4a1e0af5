/* Work of the laboratory that takes long: the thread of a task, one at a time, such as a study; and a
 * counting semaphore that limits work with much memory and time that cannot be interrupted: encoding or comparing
 * images, loading models. Ownership: task_thread_create prepares a value, task_thread_destroy releases it when no
 * thread runs; semaphore_create creates, semaphore_destroy releases when no thread holds a place or waits. The
 * semaphore is thread-safe. */
#pragma once

#include "base/cancel.h"
#include "base/status.h"

#include <pthread.h>
#include <stdbool.h>

/* --- the thread of a task; members other than life and the tokens are private --- */

typedef struct task_thread {
    pthread_mutex_t life; /* held while the thread is started or joined */
    pthread_t thread;
    bool started;        /* the thread must be joined */
    cancel_token token;  /* cancels the task; begun by the task's thread */
    cancel_token ending; /* set when the laboratory ends */
} task_thread;

/* At most four events per second: sending disturbs a measurement. */
#define TASK_PUBLISH_PERIOD_S 0.25

void task_thread_create(task_thread *t);
void task_thread_destroy(task_thread *t);

/* The caller of the next three holds life. STATUS_INTERRUPTED when the laboratory ends. */
status task_thread_may_start(const task_thread *t, diagnostic *why);
/* Call it after task_thread_join. STATUS_FAILURE if no thread can be started. */
status task_thread_start(task_thread *t, void *(*run)(void *), void *context, diagnostic *why);
/* Joins the thread; false if there was none. */
bool task_thread_join(task_thread *t);

/* Requests the end of this task and of all later ones. The caller holds life, and joins. */
void task_thread_end(task_thread *t);

/* Whether it is time for another event; *published_s is the time of the last one. */
bool task_publish_is_due(double *published_s);

/* --- the semaphore --- */

typedef struct semaphore semaphore;

semaphore *semaphore_create(int places); /* NULL when out of memory */
void semaphore_destroy(semaphore *s);    /* NULL is allowed */

/* Waits for a free place. STATUS_INTERRUPTED, without a place, if the semaphore is closed meanwhile. */
status semaphore_acquire(semaphore *s, diagnostic *why);
void semaphore_release(semaphore *s);
/* Closes the semaphore permanently: waiting threads return with an error; threads that hold a place continue. */
void semaphore_close(semaphore *s);
