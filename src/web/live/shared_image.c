/* Reference-counted images: see web/live/images.h. */
#include "report/json.h"
#include "web/live/render_worker_private.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

typedef struct counted_image {
    shared_image shown; /* first, so that a shared_image pointer can be cast to its owner */
    atomic_int owners;
    pthread_mutex_t lock;
    struct encoded {
        unsigned char *bytes;
        size_t size;
    } png, jpeg;
} counted_image;

static counted_image *counted(const shared_image *p)
{
    return (counted_image *)(uintptr_t)p;
}

void shared_image_drop(const shared_image *p)
{
    image_destroy((image *)(uintptr_t)p->linear);
    scene_destroy((scene *)(uintptr_t)p->of);
    json_decref((json_t *)(uintptr_t)p->numbers);
}

const shared_image *shared_image_create(const shared_image *shown)
{
    counted_image *p = malloc(sizeof *p);
    if (!p)
        return NULL;
    *p = (counted_image){.shown = *shown, .owners = 1, .lock = PTHREAD_MUTEX_INITIALIZER};
    return &p->shown;
}

void shared_image_retain(const shared_image *p)
{
    atomic_fetch_add(&counted(p)->owners, 1);
}

void shared_image_release(const shared_image *p)
{
    if (!p || atomic_fetch_sub(&counted(p)->owners, 1) > 1)
        return;
    shared_image_drop(p);
    pthread_mutex_destroy(&counted(p)->lock);
    free(counted(p)->png.bytes);
    free(counted(p)->jpeg.bytes);
    free(counted(p));
}

status shared_image_encode(const shared_image *p, image_format format, const unsigned char **bytes, size_t *size,
                           diagnostic *why)
{
    counted_image *w = counted(p);
    struct encoded *made = format == IMAGE_PNG ? &w->png : &w->jpeg;
    status code = STATUS_OK;
    pthread_mutex_lock(&w->lock);
    if (!made->bytes)
        code = image_encode(p->linear, format, 8, true, &made->bytes, &made->size, why);
    *bytes = made->bytes;
    *size = made->size;
    pthread_mutex_unlock(&w->lock);
    return code;
}

json_t *shared_image_json(const shared_image *p)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)p->film_hash);
    json_t *o =
        json_pack("{s:I,s:I,s:i,s:i,s:b,s:i,s:i,s:i,s:i}", "serial", (json_int_t)p->serial, "generation",
                  (json_int_t)p->generation, "pass", p->pass, "passes", p->passes, "final", (int)p->final, "width",
                  p->width, "height", p->height, "full_width", p->full_width, "full_height", p->full_height);
    if (!o)
        return NULL;
    json_t *numbers = json_deep_copy(p->numbers); /* jansson's reference counts are not atomic */
    int bad = !numbers || json_object_update(o, numbers);
    json_decref(numbers);
    bad |= json_object_set_new(o, "film_hash", p->final ? json_string(hash) : json_null());
    return json_if(o, !bad);
}
