/* Pictures that are shared: see web/live/painter.h. */
#include "web/live/picture.h"
#include "report/json.h"

#include <stdlib.h>

struct shared_picture {
    picture shown; /* first: a picture's address is this one's */
    atomic_int owners;
    pthread_mutex_t lock;
    unsigned char *png;
    size_t png_size;
};

static shared_picture *whole(const picture *p)
{
    return (shared_picture *)(uintptr_t)p;
}

void picture_drop(const picture *p)
{
    image_destroy((image *)(uintptr_t)p->linear);
    scene_destroy((scene *)(uintptr_t)p->of);
    json_decref((json_t *)(uintptr_t)p->numbers);
}

const picture *picture_create(const picture *shown)
{
    shared_picture *p = malloc(sizeof *p);
    if (!p)
        return NULL;
    *p = (shared_picture){.shown = *shown, .owners = 1, .lock = PTHREAD_MUTEX_INITIALIZER};
    return &p->shown;
}

void picture_keep(const picture *p)
{
    atomic_fetch_add(&whole(p)->owners, 1);
}

void picture_release(const picture *p)
{
    if (!p || atomic_fetch_sub(&whole(p)->owners, 1) > 1)
        return;
    picture_drop(p);
    pthread_mutex_destroy(&whole(p)->lock);
    free(whole(p)->png);
    free(whole(p));
}

status picture_png(const picture *p, const unsigned char **bytes, size_t *size, diagnostic *why)
{
    shared_picture *w = whole(p);
    status code = STATUS_OK;
    pthread_mutex_lock(&w->lock);
    if (!w->png)
        code = image_encode(p->linear, IMAGE_PNG, 8, true, &w->png, &w->png_size, why);
    *bytes = w->png;
    *size = w->png_size;
    pthread_mutex_unlock(&w->lock);
    return code;
}

json_t *picture_json(const picture *p)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)p->film_hash);
    json_t *o =
        json_pack("{s:I,s:I,s:i,s:i,s:b,s:i,s:i,s:i,s:i}", "serial", (json_int_t)p->serial, "generation",
                  (json_int_t)p->generation, "pass", p->pass, "passes", p->passes, "final", (int)p->final, "width",
                  p->width, "height", p->height, "full_width", p->full_width, "full_height", p->full_height);
    if (!o)
        return NULL;
    json_t *numbers = json_deep_copy(p->numbers); /* references are not counted across threads */
    int bad = !numbers || json_object_update(o, numbers);
    json_decref(numbers);
    bad |= json_object_set_new(o, "film_hash", p->final ? json_string(hash) : json_null());
    if (!bad)
        return o;
    json_decref(o);
    return NULL;
}
