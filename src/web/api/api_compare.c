/* API: compares two images, the pinned reference image A and the newest image B; and maps of the rays, the time and the
 * cut light of each pixel of the final image, with the numbers of their scales. */
#include "base/cancel.h"
#include "base/json_build.h"
#include "image/heatmap.h"
#include "report/json.h"
#include "report/report.h"
#include "web/api/api.h"
#include "web/live/images.h"
#include "web/session/studies.h"

#include <stdlib.h>
#include <string.h>

/* The newest image if it is final; with ?wait, the next final one. */
static status wait_for_newest(call *c, const shared_image **out)
{
    *out = NULL;
    if (api_query_flag(c, "wait"))
        return api_wait_for_final(c, out);
    const shared_image *newest = render_worker_newest(c->l->render_worker);
    if (newest && newest->final) {
        *out = newest;
        return STATUS_OK;
    }
    shared_image_release(newest);
    return api_refuse(c, 409, "the image is not finished yet", "wait until it is final, or add ?wait=1");
}

static status set_reference(call *c, const shared_image *a)
{
    reference_image_set(c->l->reference_image, a);
    shared_image_release(a);
    lab_publish_state(c->l);
    return api_reply_json(c, json_pack("{s:o}", "reference", reference_image_json(c->l->reference_image)));
}

status api_set_reference(call *c)
{
    const shared_image *newest;
    c->refused = 409;
    TRY(wait_for_newest(c, &newest));
    return set_reference(c, newest);
}

status api_clear_reference(call *c)
{
    return set_reference(c, NULL);
}

static status refuse_without_reference(call *c, int code)
{
    return api_refuse(c, code, "no reference image is pinned", "pin one with POST /api/reference");
}

/* The bytes belong to a shared image or to a pair, so the reply gets a copy. */
static status send_copy(call *c, const unsigned char *bytes, size_t size)
{
    void *copy = malloc(size);
    if (copy)
        memcpy(copy, bytes, size);
    return api_send(c, "image/png", copy, size);
}

status api_reference_image(call *c)
{
    int bits;
    const unsigned char *cached = NULL;
    unsigned char *encoded = NULL;
    size_t size = 0;
    if (!api_read_bits(c, &bits))
        return api_refuse(c, 400, "unsupported bit depth", "use ?bits=8 or ?bits=16");
    const shared_image *a = reference_image_get(c->l->reference_image);
    if (!a)
        return refuse_without_reference(c, 404);
    c->refused = 409;
    status code = semaphore_acquire(c->l->heavy, &c->why);
    if (code == STATUS_OK) {
        code = bits == 16 ? image_encode(a->linear, IMAGE_PNG, 16, true, &encoded, &size, &c->why)
                          : shared_image_encode(a, IMAGE_PNG, &cached, &size, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        encoded ? api_send(c, "image/png", encoded, size) : send_copy(c, cached, size);
    shared_image_release(a);
    return code;
}

/* Gets A and B; the caller releases both. */
static status get_pair(call *c, reference_pair **pair, const shared_image **b)
{
    c->refused = 409;
    const shared_image *a =
        reference_image_get(c->l->reference_image); /* fail early: without A the newest image is not needed */
    shared_image_release(a);
    if (!a)
        return refuse_without_reference(c, 409);
    const status code = wait_for_newest(c, b);
    if (code != STATUS_OK || (*pair = reference_image_compare(c->l->reference_image, *b)))
        return code;
    shared_image_release(*b);
    return refuse_without_reference(c, 409);
}

static json_t *comparison_json(const image_comparison *found)
{
    json_t *o = json_object();
    return json_if(o, o && report_comparison(o, found));
}

status api_compare(call *c)
{
    reference_pair *pair;
    const shared_image *b;
    image_comparison found;
    TRY(get_pair(c, &pair, &b));
    status code = STATUS_OK;
    const shared_image *a = reference_pair_a(pair);
    const bool fits = reference_pair_fits(pair);
    if (fits && (code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = reference_pair_numbers(pair, &found, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        api_reply_json(c, json_pack("{s:o, s:o, s:o, s:o}", "a", shared_image_json(a), "b", shared_image_json(b),
                                    "changed", changed_params(a->rendered, b->rendered), "comparison",
                                    fits ? comparison_json(&found) : json_null()));
    shared_image_release(b);
    reference_pair_release(pair);
    return code;
}

status api_compare_map(call *c)
{
    reference_pair *pair;
    const shared_image *b;
    const unsigned char *bytes;
    size_t size;
    TRY(get_pair(c, &pair, &b));
    status code = STATUS_OK;
    if ((code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = reference_pair_map(pair, &bytes, &size, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        send_copy(c, bytes, size);
    shared_image_release(b);
    reference_pair_release(pair);
    return code;
}

/* --- maps --- */

static const char *const names[PIXEL_MAPS] = {[PIXEL_RAYS] = "rays", [PIXEL_TIME] = "time", [PIXEL_CUT] = "cut"};
static const char *const units[PIXEL_MAPS] = {[PIXEL_RAYS] = "rays", [PIXEL_TIME] = "ns", [PIXEL_CUT] = ""};

bool api_is_obsolete(void *context)
{
    const final_question *q = context;
    return studies_ending(q->l->studies) || studies_runs(q->l->studies, NULL) ||
           scene_document_generation(q->l->scene_document) != q->final->generation;
}

static status get_maps(call *c, pixel_map_set *set, int which, unsigned char **png, size_t *size)
{
    const shared_image *final = NULL;
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and the frame of the maps would disturb it",
                          "wait until the study ends, or stop it");
    TRY(api_wait_for_final(c, &final));
    final_question q = {c->l, final};
    status code = semaphore_acquire(c->l->heavy, &c->why);
    if (code == STATUS_OK) {
        cancel_token token = {.ask = api_is_obsolete, .context = &q};
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
    TRY(get_maps(c, &set, 0, NULL, NULL));
    json_t *json = json_pack("{s:I, s:i, s:i, s:{s:i, s:i, s:i}, s:o, s:i, s:o}", "serial", (json_int_t)set.serial,
                             "width", set.width, "height", set.height, "image", "width", set.image_width, "height",
                             set.image_height, "left", set.left, "wall_s", json_of_real(set.wall_s), "threads",
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
    TRY(get_maps(c, &set, which, &png, &size));
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
