/* Keeps and renders thumbnails, one render at a time. */
#include "base/cancel.h"
#include "base/text.h"
#include "image/image.h"
#include "job/job.h"
#include "measure/clock.h"
#include "render/plan/film.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"
#include "web/live/images.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* KEPT: more thumbnails than a gallery shows at once. PIXELS: about the pixels of the widest card. WAVELENGTHS: fewer
 * would show a prism's spectrum as grains of colour. */
enum { KEPT = 128, PIXELS = 240 * 180, WAVELENGTHS = 96, SAMPLES = 4 };
static const double limit_s = 16.0; /* of the process's CPU time, so that the limit is the same on a busy machine */

typedef struct kept {
    char *key;
    unsigned char *bytes;
    size_t size;
} kept;

struct thumbnails {
    isa level;
    pthread_mutex_t lock;        /* of the table */
    pthread_mutex_t render_lock; /* one render at a time */
    kept table[KEPT];
    int next; /* the entry that is replaced next */
    cancel_token ended;
    double late_s; /* CPU time at which the current render has taken too long */
};

thumbnails *thumbnails_create(isa level)
{
    thumbnails *t = calloc(1, sizeof *t);
    if (t) {
        t->level = level;
        pthread_mutex_init(&t->lock, NULL);
        pthread_mutex_init(&t->render_lock, NULL);
    }
    return t;
}

void thumbnails_destroy(thumbnails *t)
{
    if (!t)
        return;
    for (int i = 0; i < KEPT; i++) {
        free(t->table[i].key);
        free(t->table[i].bytes);
    }
    pthread_mutex_destroy(&t->lock);
    pthread_mutex_destroy(&t->render_lock);
    free(t);
}

void thumbnails_end(thumbnails *t)
{
    cancel_set(&t->ended);
}

/* The ask of a cancel token: whether the laboratory ends, or the render takes too long. */
static bool is_cancelled(void *context)
{
    const thumbnails *t = context;
    return cancel_is_set(&t->ended) || clock_process_cpu_s() > t->late_s;
}

status thumbnails_find(thumbnails *t, const char *key, unsigned char **bytes, size_t *size, diagnostic *why)
{
    status code = STATUS_OK;
    *bytes = NULL;
    pthread_mutex_lock(&t->lock);
    for (int i = 0; i < KEPT && !*bytes && code == STATUS_OK; i++)
        if (t->table[i].key && strcmp(t->table[i].key, key) == 0) {
            *size = t->table[i].size;
            *bytes = malloc(*size);
            if (*bytes)
                memcpy(*bytes, t->table[i].bytes, *size);
            else
                code = out_of_memory(why);
        }
    pthread_mutex_unlock(&t->lock);
    return code;
}

/* Keeps a copy, unless memory runs out. */
static void keep(thumbnails *t, const char *key, const unsigned char *bytes, size_t size)
{
    kept fresh = {.key = strdup(key), .bytes = malloc(size), .size = size};
    if (!fresh.key || !fresh.bytes) {
        free(fresh.key);
        free(fresh.bytes);
        return;
    }
    memcpy(fresh.bytes, bytes, size);
    pthread_mutex_lock(&t->lock);
    kept before = t->table[t->next];
    t->table[t->next] = fresh;
    t->next = (t->next + 1) % KEPT;
    pthread_mutex_unlock(&t->lock);
    free(before.key);
    free(before.bytes);
}

/* Makes the image small, to be rendered by one thread, so that the laboratory's own image hardly waits. */
static void reduce(scene *s)
{
    render_settings *r = &s->render;
    const double shrink = sqrt((double)PIXELS / ((double)r->width * (double)r->height));
    r->width = (int64_t)fmax(1.0, (double)r->width * shrink);
    r->height = (int64_t)fmax(1.0, (double)r->height * shrink);
    r->threads = 1;
    r->wavelengths = r->wavelengths < WAVELENGTHS ? r->wavelengths : WAVELENGTHS;
}

/* Renders the scene into an image that the caller destroys. */
static status render_image(job *j, scene *s, image **img, diagnostic *why)
{
    job_account account = {.result = NULL};
    status code = job_render(j, s, NULL, &account, why);
    THEN(code, film_image(account.result->img, img, why));
    if (code == STATUS_OK)
        (*img)->tone = camera_tone(s);
    job_account_release(&account);
    return code;
}

/* Renders with the scene's own samples first, then with more if the time is likely to suffice: a slow scene has a
 * coarser image, not none. */
static status render_twice(thumbnails *t, job *j, scene *s, image **img, diagnostic *why)
{
    const int64_t samples = s->render.samples;
    const double start_s = clock_process_cpu_s();
    TRY(render_image(j, s, img, why));
    if (samples >= SAMPLES ||
        (clock_process_cpu_s() - start_s) * (double)(SAMPLES + samples) / (double)samples > limit_s)
        return STATUS_OK;
    image *fine = NULL;
    s->render.samples = SAMPLES;
    const status code = render_image(j, s, &fine, why);
    if (code == STATUS_OK) {
        image_destroy(*img);
        *img = fine;
    }
    return code == STATUS_INTERRUPTED && !cancel_is_set(&t->ended) ? STATUS_OK : code;
}

static status render(thumbnails *t, scene *s, unsigned char **bytes, size_t *size, diagnostic *why)
{
    job *j = NULL;
    image *img = NULL;
    reduce(s);
    t->late_s = clock_process_cpu_s() + limit_s;
    status code = job_create(&(job_settings){.level = &t->level}, &j, why);
    cancel_token token = {.ask = is_cancelled, .context = t};
    cancel_begin(&token);
    THEN(code, job_load(j, s, NULL, why));
    THEN(code, render_twice(t, j, s, &img, why));
    cancel_end(&token);
    THEN(code, image_encode(img, IMAGE_JPEG, 8, false, bytes, size, why));
    image_destroy(img);
    job_destroy(j);
    return code == STATUS_INTERRUPTED && !cancel_is_set(&t->ended)
               ? diagnose(why, STATUS_FAILURE, "open the scene", "the thumbnail takes too long")
               : code;
}

status thumbnails_render(thumbnails *t, const char *key, scene *s, unsigned char **bytes, size_t *size, diagnostic *why)
{
    pthread_mutex_lock(&t->render_lock);
    status code = thumbnails_find(t, key, bytes, size, why); /* another page may have requested it meanwhile */
    if (code == STATUS_OK && !*bytes) {
        code = render(t, s, bytes, size, why);
        if (code == STATUS_OK)
            keep(t, key, *bytes, *size);
    }
    pthread_mutex_unlock(&t->render_lock);
    return code;
}
