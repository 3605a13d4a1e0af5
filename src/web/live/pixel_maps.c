/* Renders a final image once more, with maps, and keeps the maps of the newest image. */
#include "image/image.h"
#include "job/job.h"
#include "scene/model/scene.h"
#include "web/live/images.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct pixel_maps {
    isa level;
    pthread_mutex_t lock;
    pixel_map_set set; /* serial 0: none */
    unsigned char *png[PIXEL_MAPS];
    size_t size[PIXEL_MAPS];
};

pixel_maps *pixel_maps_create(isa level)
{
    pixel_maps *m = calloc(1, sizeof *m);
    if (m) {
        m->level = level;
        pthread_mutex_init(&m->lock, NULL);
    }
    return m;
}

static void clear(pixel_maps *m)
{
    for (int i = 0; i < PIXEL_MAPS; i++) {
        free(m->png[i]);
        m->png[i] = NULL;
    }
    m->set = (pixel_map_set){.serial = 0};
}

void pixel_maps_destroy(pixel_maps *m)
{
    if (!m)
        return;
    clear(m);
    pthread_mutex_destroy(&m->lock);
    free(m);
}

static status draw(pixel_maps *m, const render_result *result, int which, diagnostic *why)
{
    pixel_map_set *set = &m->set;
    const double *const all[PIXEL_MAPS] = {result->pixel_rays, result->pixel_ns, result->pixel_cut};
    static const char *const titles[PIXEL_MAPS] = {"rays per pixel", "ns per pixel, measured once",
                                                   "fraction of cut light per pixel"};
    const double *values = all[which];
    const size_t count = (size_t)set->width * (size_t)set->height;
    pixel_map *map = &set->map[which];
    image *map_image = NULL;
    status code = heatmap_scale_of(values, count, &map->scale, why);
    THEN(code, heatmap_create(values, set->width, set->height, titles[which], &map_image, why));
    THEN(code, image_encode(map_image, IMAGE_PNG, 8, true, &m->png[which], &m->size[which], why));
    if (code == STATUS_OK) {
        set->image_width = map_image->width;
        set->image_height = map_image->height;
        set->left = (map_image->width - set->width) / 2;
    }
    for (size_t i = 0; i < count && code == STATUS_OK; i++) {
        map->total += values[i];
        map->largest = values[i] > map->largest ? values[i] : map->largest;
    }
    image_destroy(map_image);
    return code;
}

static status draw_all(pixel_maps *m, const shared_image *img, const job_account *a, diagnostic *why)
{
    if (job_account_hash(a) != img->film_hash)
        return diagnose(why, STATUS_FAILURE, "report this as a bug, with the scene",
                        "the film of the maps differs from the film of the image");
    m->set = (pixel_map_set){.wall_s = job_account_wall_s(a),
                             .threads = a->result->worker_count,
                             .width = a->result->img->width,
                             .height = a->result->img->height};
    status code = STATUS_OK;
    for (int i = 0; i < PIXEL_MAPS; i++)
        THEN(code, draw(m, a->result, i, why));
    m->set.serial = img->serial;
    return code;
}

static status render(pixel_maps *m, const shared_image *img, diagnostic *why)
{
    static const render_options maps = {.pixel_rays = true, .pixel_time = true, .pixel_cut = true};
    job *j = NULL;
    job_account account = {.result = NULL};
    clear(m);
    status code = job_create(&(job_settings){.level = &m->level, .time_s = PIXEL_MAPS_LIMIT_S}, &j, why);
    THEN(code, job_render(j, img->rendered, &maps, &account, why));
    THEN(code, draw_all(m, img, &account, why));
    if (code != STATUS_OK)
        clear(m);
    job_account_release(&account);
    job_destroy(j);
    return code == STATUS_INTERRUPTED
               ? diagnose(why, code, "try again", "the maps are not finished: the scene changed, or a study began")
               : code;
}

static status copy(const pixel_maps *m, int which, unsigned char **png, size_t *size, diagnostic *why)
{
    if (!(*png = malloc(m->size[which])))
        return out_of_memory(why);
    memcpy(*png, m->png[which], m->size[which]);
    *size = m->size[which];
    return STATUS_OK;
}

status pixel_maps_of(pixel_maps *m, const shared_image *img, pixel_map_set *out, int which, unsigned char **png,
                     size_t *size, diagnostic *why)
{
    status code = STATUS_OK;
    pthread_mutex_lock(&m->lock);
    if (m->set.serial != img->serial)
        code = render(m, img, why);
    *out = m->set;
    if (code == STATUS_OK && png)
        code = copy(m, which, png, size, why);
    pthread_mutex_unlock(&m->lock);
    return code;
}
