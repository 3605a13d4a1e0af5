#include "web/session/pins.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Was it measured, or is it known why not? */
typedef struct measured {
    bool is;
    status code;
    diagnostic why;
} measured;

struct pin_pair {
    const picture *a, *b;
    atomic_int owners;
    pthread_mutex_t lock; /* of what follows: who has it measures, others wait for that */
    measured numbers, map;
    image_comparison found;
    unsigned char *map_bytes;
    size_t map_size;
};

struct pins {
    pthread_mutex_t lock;
    const picture *a;
    pin_pair *newest;
};

pins *pins_create(void)
{
    pins *p = calloc(1, sizeof *p);
    if (p)
        pthread_mutex_init(&p->lock, NULL);
    return p;
}

void pins_destroy(pins *p)
{
    if (!p)
        return;
    picture_release(p->a);
    pin_pair_release(p->newest);
    pthread_mutex_destroy(&p->lock);
    free(p);
}

void pins_set(pins *p, const picture *a)
{
    if (a)
        picture_keep(a);
    pthread_mutex_lock(&p->lock);
    const picture *before = p->a;
    pin_pair *pair = p->newest;
    p->a = a;
    p->newest = NULL;
    pthread_mutex_unlock(&p->lock);
    picture_release(before);
    pin_pair_release(pair);
}

const picture *pins_take(pins *p)
{
    pthread_mutex_lock(&p->lock);
    const picture *a = p->a;
    if (a)
        picture_keep(a);
    pthread_mutex_unlock(&p->lock);
    return a;
}

json_t *pins_tell(pins *p)
{
    const picture *a = pins_take(p);
    json_t *told = a ? picture_json(a) : json_null();
    picture_release(a);
    return told;
}

static pin_pair *pair_create(const picture *a, const picture *b)
{
    pin_pair *pair = calloc(1, sizeof *pair);
    if (!pair)
        return NULL;
    picture_keep(a);
    picture_keep(b);
    pair->a = a;
    pair->b = b;
    pthread_mutex_init(&pair->lock, NULL);
    atomic_init(&pair->owners, 1);
    return pair;
}

void pin_pair_release(pin_pair *pair)
{
    if (!pair || atomic_fetch_sub(&pair->owners, 1) > 1)
        return;
    picture_release(pair->a);
    picture_release(pair->b);
    pthread_mutex_destroy(&pair->lock);
    free(pair->map_bytes);
    free(pair);
}

/* Pairs are told apart by their pictures' addresses, which are theirs as long as the pair has its share of them. */
pin_pair *pins_pair(pins *p, const picture *b)
{
    pin_pair *old = NULL, *pair = NULL;
    pthread_mutex_lock(&p->lock);
    if (p->newest && p->newest->a == p->a && p->newest->b == b) {
        pair = p->newest;
    } else if (p->a && (pair = pair_create(p->a, b))) {
        old = p->newest;
        p->newest = pair;
    }
    if (pair)
        atomic_fetch_add(&pair->owners, 1);
    pthread_mutex_unlock(&p->lock);
    pin_pair_release(old);
    return pair;
}

const picture *pin_pair_a(const pin_pair *pair)
{
    return pair->a;
}

bool pin_pair_fits(const pin_pair *pair)
{
    return pair->a->width == pair->b->width && pair->a->height == pair->b->height;
}

/* With the lock held. */
static status measure_once(pin_pair *pair, measured *m, status (*measure)(pin_pair *pair, diagnostic *why),
                           diagnostic *why)
{
    if (!m->is) {
        m->code = measure(pair, &m->why);
        m->is = m->code != STATUS_FAILURE; /* memory may be there the next time */
    }
    if (why)
        *why = m->why;
    return m->code;
}

static status compare(pin_pair *pair, diagnostic *why)
{
    return image_compare(pair->a->linear, pair->b->linear, &pair->found, why);
}

status pin_pair_numbers(pin_pair *pair, image_comparison *out, diagnostic *why)
{
    pthread_mutex_lock(&pair->lock);
    const status code = measure_once(pair, &pair->numbers, compare, why);
    *out = pair->found;
    pthread_mutex_unlock(&pair->lock);
    return code;
}

static status draw_map(pin_pair *pair, diagnostic *why)
{
    image *map = NULL;
    status code = image_compare_map(pair->a->linear, pair->b->linear, &map, why);
    THEN(code, image_encode(map, IMAGE_PNG, 8, true, &pair->map_bytes, &pair->map_size, why));
    image_destroy(map);
    return code;
}

status pin_pair_map(pin_pair *pair, const unsigned char **bytes, size_t *size, diagnostic *why)
{
    pthread_mutex_lock(&pair->lock);
    const status code = measure_once(pair, &pair->map, draw_map, why);
    *bytes = pair->map_bytes;
    *size = pair->map_size;
    pthread_mutex_unlock(&pair->lock);
    return code;
}
