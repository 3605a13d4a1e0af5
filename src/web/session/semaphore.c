/* A counting semaphore that can be closed, on a mutex and a condition variable. */
#include "web/session/semaphore.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

struct semaphore {
    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t changed;
    int free_places;
    bool closed;
};

semaphore *semaphore_create(int places)
{
    semaphore *g = calloc(1, sizeof *g);
    if (!g)
        return NULL;
    pthread_mutex_init(&g->lock, NULL);
    pthread_cond_init(&g->changed, NULL);
    g->free_places = places;
    return g;
}

void semaphore_destroy(semaphore *g)
{
    if (!g)
        return;
    pthread_cond_destroy(&g->changed);
    pthread_mutex_destroy(&g->lock);
    free(g);
}

status semaphore_acquire(semaphore *g, diagnostic *why)
{
    pthread_mutex_lock(&g->lock);
    while (!g->closed && g->free_places == 0)
        pthread_cond_wait(&g->changed, &g->lock);
    const bool in = !g->closed;
    g->free_places -= in;
    pthread_mutex_unlock(&g->lock);
    return in ? STATUS_OK
              : diagnose(why, STATUS_INTERRUPTED, "start the laboratory again", "the laboratory is shutting down");
}

void semaphore_release(semaphore *g)
{
    pthread_mutex_lock(&g->lock);
    g->free_places++;
    pthread_cond_signal(&g->changed);
    pthread_mutex_unlock(&g->lock);
}

void semaphore_close(semaphore *g)
{
    pthread_mutex_lock(&g->lock);
    g->closed = true;
    pthread_cond_broadcast(&g->changed);
    pthread_mutex_unlock(&g->lock);
}
