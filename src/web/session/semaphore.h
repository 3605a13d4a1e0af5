/* A counting semaphore that limits work with much memory and time that cannot be interrupted: encoding or comparing
 * images, loading models. Thread-safe. Ownership: semaphore_create creates, semaphore_destroy releases when no
 * thread holds it or waits. */
#pragma once

#include "base/status.h"

typedef struct semaphore semaphore;

semaphore *semaphore_create(int places); /* NULL when out of memory */
void semaphore_destroy(semaphore *g);    /* NULL is allowed */

/* Waits for a free place. STATUS_INTERRUPTED, without a place, if the semaphore is closed meanwhile. */
status semaphore_acquire(semaphore *g, diagnostic *why);
void semaphore_release(semaphore *g);
/* Closes it permanently: waiting threads return with an error; threads inside continue. */
void semaphore_close(semaphore *g);
