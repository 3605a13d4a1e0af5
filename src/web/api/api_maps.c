/* API: maps of the rays, the time and the cut light of each pixel of the final image, with the numbers of their
 * scales. */
#include "base/cancel.h"
#include "base/json_build.h"
#include "web/api/api.h"

#include "image/heatmap.h"
#include "report/json.h"
#include "web/session/pixel_maps.h"
#include "web/session/studies.h"
#include <stdlib.h>
#include <string.h>

static const char *const names[PIXEL_MAPS] = {[PIXEL_RAYS] = "rays", [PIXEL_TIME] = "time", [PIXEL_CUT] = "cut"};
static const char *const units[PIXEL_MAPS] = {[PIXEL_RAYS] = "rays", [PIXEL_TIME] = "ns", [PIXEL_CUT] = ""};

typedef struct map_question {
    lab *l;
    const shared_image *of;
} map_question;

/* As the ask of a token. */
static bool is_late(void *context)
{
    const map_question *q = context;
    return studies_ending(q->l->studies) || studies_runs(q->l->studies, NULL) ||
           scene_document_generation(q->l->scene_document) != q->of->generation;
}

static status take_maps(call *c, pixel_map_set *set, int which, unsigned char **png, size_t *size)
{
    const shared_image *final = NULL;
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and the frame of the maps would disturb it",
                          "wait until it ends, or stop it");
    TRY(api_wait_for_final(c, &final));
    map_question q = {c->l, final};
    status code = semaphore_acquire(c->l->heavy, &c->why);
    if (code == STATUS_OK) {
        cancel_token token = {.ask = is_late, .context = &q};
        cancel_begin(&token);
        code = pixel_maps_of(c->l->pixel_maps, final, set, which, png, size, &c->why);
        cancel_end(&token);
        semaphore_release(c->l->heavy);
    }
    shared_image_release(final);
    return code;
}

/* The scale's colours at equal distances, for a legend. */
static json_t *colors_json(void)
{
    enum { COLORS = 17 };
    json_t *list = json_array();
    for (int i = 0; i < COLORS; i++) {
        unsigned char rgb[3];
        char text[8];
        heatmap_color(i / (COLORS - 1.0), rgb);
        snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
        json_add(&list, json_string(text));
    }
    return list;
}

static json_t *map_json(const pixel_map *map, const char *unit)
{
    return json_pack("{s:s, s:o, s:b, s:o, s:o}", "unit", unit, "end", json_of_real(map->scale.end), "cut",
                     map->scale.cut, "total", json_of_real(map->total), "largest", json_of_real(map->largest));
}

status api_maps(call *c)
{
    pixel_map_set set;
    TRY(take_maps(c, &set, 0, NULL, NULL));
    json_t *json = json_pack("{s:I, s:i, s:i, s:{s:i, s:i, s:i}, s:o, s:i, s:o}", "serial", (json_int_t)set.serial,
                             "width", set.width, "height", set.height, "picture", "width", set.picture_width, "height",
                             set.picture_height, "left", set.left, "wall_s", json_of_real(set.wall_s), "threads",
                             set.threads, "colors", colors_json());
    for (int i = 0; json && i < PIXEL_MAPS; i++)
        json_add_as(&json, names[i], map_json(&set.map[i], units[i]));
    return api_reply_json(c, json);
}

static status send_map(call *c, int which)
{
    pixel_map_set set;
    unsigned char *png = NULL;
    size_t size = 0;
    TRY(take_maps(c, &set, which, &png, &size));
    return api_send(c, "image/png", png, size);
}

status api_map_of_rays(call *c)
{
    return send_map(c, PIXEL_RAYS);
}

status api_map_of_time(call *c)
{
    return send_map(c, PIXEL_TIME);
}

status api_map_of_cut(call *c)
{
    return send_map(c, PIXEL_CUT);
}
