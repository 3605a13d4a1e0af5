/* Reference-counted images: see web/live/images.h. */
#include "report/json.h"
#include "web/live/render_worker_private.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

typedef struct counted_image {
    shared_image shown; /* first, so that a shared_image pointer can be cast to its owner */
    atomic_int references;
    pthread_mutex_t lock;
    struct encoded {
        unsigned char *bytes;
        size_t size;
    } png, jpeg;
} counted_image;

static counted_image *counted(const shared_image *img)
{
    return (counted_image *)(uintptr_t)img;
}

void shared_image_drop(const shared_image *img)
{
    image_destroy((image *)(uintptr_t)img->linear);
    scene_destroy((scene *)(uintptr_t)img->rendered);
    json_decref((json_t *)(uintptr_t)img->numbers);
}

const shared_image *shared_image_create(const shared_image *shown)
{
    counted_image *owner = malloc(sizeof *owner);
    if (!owner)
        return NULL;
    *owner = (counted_image){.shown = *shown, .references = 1, .lock = PTHREAD_MUTEX_INITIALIZER};
    return &owner->shown;
}

void shared_image_retain(const shared_image *img)
{
    atomic_fetch_add(&counted(img)->references, 1);
}

void shared_image_release(const shared_image *img)
{
    if (!img || atomic_fetch_sub(&counted(img)->references, 1) > 1)
        return;
    shared_image_drop(img);
    pthread_mutex_destroy(&counted(img)->lock);
    free(counted(img)->png.bytes);
    free(counted(img)->jpeg.bytes);
    free(counted(img));
}

status shared_image_encode(const shared_image *img, image_format format, const unsigned char **bytes, size_t *size,
                           diagnostic *why)
{
    counted_image *owner = counted(img);
    struct encoded *cached = format == IMAGE_PNG ? &owner->png : &owner->jpeg;
    status code = STATUS_OK;
    pthread_mutex_lock(&owner->lock);
    if (!cached->bytes)
        code = image_encode(img->linear, format, 8, true, &cached->bytes, &cached->size, why);
    *bytes = cached->bytes;
    *size = cached->size;
    pthread_mutex_unlock(&owner->lock);
    return code;
}

json_t *shared_image_json(const shared_image *img)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)img->film_hash);
    json_t *o = json_pack("{s:I,s:I,s:i,s:i,s:b,s:i,s:i,s:i,s:i}", "serial", (json_int_t)img->serial, "generation",
                          (json_int_t)img->generation, "pass", img->pass, "passes", img->passes, "final",
                          (int)img->final, "width", img->width, "height", img->height, "full_width", img->full_width,
                          "full_height", img->full_height);
    if (!o)
        return NULL;
    /* a copy, because jansson's reference counts are atomic only in some builds */
    json_t *numbers = json_deep_copy(img->numbers);
    int bad = !numbers || json_object_update(o, numbers);
    json_decref(numbers);
    bad |= json_object_set_new(o, "film_hash", img->final ? json_string(hash) : json_null());
    return json_if(o, !bad);
}
