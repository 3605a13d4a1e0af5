/* The reference image A, and the cached differences between it and other images. */
#include "web/live/images.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* A cached result or its error. */
typedef struct measured {
    bool done;
    status code;
    diagnostic why;
} measured;

struct reference_pair {
    const shared_image *a, *b;
    atomic_int references;
    pthread_mutex_t lock; /* guards the fields below; its holder measures, others wait for the result */
    measured numbers, map;
    image_comparison found;
    unsigned char *map_bytes;
    size_t map_size;
};

struct reference_image {
    pthread_mutex_t lock;
    const shared_image *a;
    reference_pair *newest;
};

reference_image *reference_image_create(void)
{
    reference_image *reference = calloc(1, sizeof *reference);
    if (reference)
        pthread_mutex_init(&reference->lock, NULL);
    return reference;
}

void reference_image_destroy(reference_image *reference)
{
    if (!reference)
        return;
    shared_image_release(reference->a);
    reference_pair_release(reference->newest);
    pthread_mutex_destroy(&reference->lock);
    free(reference);
}

void reference_image_set(reference_image *reference, const shared_image *a)
{
    if (a)
        shared_image_retain(a);
    pthread_mutex_lock(&reference->lock);
    const shared_image *before = reference->a;
    reference_pair *pair = reference->newest;
    reference->a = a;
    reference->newest = NULL;
    pthread_mutex_unlock(&reference->lock);
    shared_image_release(before);
    reference_pair_release(pair);
}

const shared_image *reference_image_get(reference_image *reference)
{
    pthread_mutex_lock(&reference->lock);
    const shared_image *a = reference->a;
    if (a)
        shared_image_retain(a);
    pthread_mutex_unlock(&reference->lock);
    return a;
}

json_t *reference_image_json(reference_image *reference)
{
    const shared_image *a = reference_image_get(reference);
    json_t *json = a ? shared_image_json(a) : json_null();
    shared_image_release(a);
    return json;
}

static reference_pair *pair_create(const shared_image *a, const shared_image *b)
{
    reference_pair *pair = calloc(1, sizeof *pair);
    if (!pair)
        return NULL;
    shared_image_retain(a);
    shared_image_retain(b);
    pair->a = a;
    pair->b = b;
    pthread_mutex_init(&pair->lock, NULL);
    atomic_init(&pair->references, 1);
    return pair;
}

void reference_pair_release(reference_pair *pair)
{
    if (!pair || atomic_fetch_sub(&pair->references, 1) > 1)
        return;
    shared_image_release(pair->a);
    shared_image_release(pair->b);
    pthread_mutex_destroy(&pair->lock);
    free(pair->map_bytes);
    free(pair);
}

/* Pairs are identified by the addresses of their images, which stay valid while the pair holds references. */
reference_pair *reference_image_compare(reference_image *reference, const shared_image *b)
{
    reference_pair *old = NULL, *pair = NULL;
    pthread_mutex_lock(&reference->lock);
    if (reference->newest && reference->newest->a == reference->a && reference->newest->b == b) {
        pair = reference->newest;
    } else if (reference->a && (pair = pair_create(reference->a, b))) {
        old = reference->newest;
        reference->newest = pair;
    }
    if (pair)
        atomic_fetch_add(&pair->references, 1);
    pthread_mutex_unlock(&reference->lock);
    reference_pair_release(old);
    return pair;
}

const shared_image *reference_pair_a(const reference_pair *pair)
{
    return pair->a;
}

bool reference_pair_fits(const reference_pair *pair)
{
    return pair->a->width == pair->b->width && pair->a->height == pair->b->height;
}

/* The caller holds the lock. */
static status measure_once(reference_pair *pair, measured *m, status (*measure)(reference_pair *pair, diagnostic *why),
                           diagnostic *why)
{
    if (!m->done) {
        m->code = measure(pair, &m->why);
        m->done = m->code != STATUS_FAILURE; /* out of memory may be temporary, so try again next time */
    }
    if (why)
        *why = m->why;
    return m->code;
}

static status compare(reference_pair *pair, diagnostic *why)
{
    return image_compare(pair->a->linear, pair->b->linear, &pair->found, why);
}

status reference_pair_numbers(reference_pair *pair, image_comparison *out, diagnostic *why)
{
    pthread_mutex_lock(&pair->lock);
    const status code = measure_once(pair, &pair->numbers, compare, why);
    *out = pair->found;
    pthread_mutex_unlock(&pair->lock);
    return code;
}

static status draw_map(reference_pair *pair, diagnostic *why)
{
    image *map = NULL;
    status code = image_compare_map(pair->a->linear, pair->b->linear, &map, why);
    THEN(code, image_encode(map, IMAGE_PNG, 8, true, &pair->map_bytes, &pair->map_size, why));
    image_destroy(map);
    return code;
}

status reference_pair_map(reference_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why)
{
    pthread_mutex_lock(&pair->lock);
    const status code = measure_once(pair, &pair->map, draw_map, why);
    *bytes = pair->map_bytes;
    *size = pair->map_size;
    pthread_mutex_unlock(&pair->lock);
    return code;
}
