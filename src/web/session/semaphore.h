/* Lets in a few at a time, for what takes much memory and time and cannot be ended on its way: pictures that are
 * encoded or compared, models that are read. For any number of threads. Ownership: semaphore_create gives,
 * semaphore_destroy releases, when nobody is in it or waits. */
#pragma once

#include "base/status.h"

typedef struct semaphore semaphore;

semaphore *semaphore_create(int places); /* NULL when memory is out */
void semaphore_destroy(semaphore *g);    /* NULL is allowed */

/* Waits for a place. STATUS_INTERRUPTED, and no place, where the gate is closed before there is one. */
status semaphore_acquire(semaphore *g, diagnostic *why);
void semaphore_release(semaphore *g);
/* For good: who waits is sent away, who is in goes on. */
void semaphore_close(semaphore *g);
