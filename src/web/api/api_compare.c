/* API: compares two images, the pinned reference image A and the newest image B. */
#include "web/api/api.h"

#include "report/json.h"
#include "report/report.h"
#include "web/session/reference_image.h"
#include <stdlib.h>
#include <string.h>

/* The newest image if it is final; with ?wait, the next final one. */
static status take_final(call *c, const shared_image **out)
{
    *out = NULL;
    if (api_query_flag(c, "wait"))
        return api_wait_for_final(c, out);
    const shared_image *newest = render_worker_take(c->l->render_worker);
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
    return api_reply_json(c, json_pack("{s:o}", "pin", reference_image_json(c->l->reference_image)));
}

status api_set_reference(call *c)
{
    const shared_image *newest;
    c->refused = 409;
    TRY(take_final(c, &newest));
    return set_reference(c, newest);
}

status api_clear_reference(call *c)
{
    return set_reference(c, NULL);
}

static status refuse_without_reference(call *c, int code)
{
    return api_refuse(c, code, "no reference image is pinned", "pin one with POST /api/pin");
}

/* The bytes belong to the shared image, so the reply gets a copy. */
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
    const unsigned char *shared = NULL;
    unsigned char *own = NULL;
    size_t size = 0;
    if (!api_take_bits(c, &bits))
        return api_refuse(c, 400, "unsupported bit depth", "use ?bits=8 or ?bits=16");
    const shared_image *a = reference_image_take(c->l->reference_image);
    if (!a)
        return refuse_without_reference(c, 404);
    c->refused = 409;
    status code = semaphore_acquire(c->l->heavy, &c->why);
    if (code == STATUS_OK) {
        code = bits == 16 ? image_encode(a->linear, IMAGE_PNG, 16, true, &own, &size, &c->why)
                          : shared_image_encode(a, IMAGE_PNG, &shared, &size, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        own ? api_send(c, "image/png", own, size) : send_copy(c, shared, size);
    shared_image_release(a);
    return code;
}

/* Gets A and B; the caller releases both. */
static status take_pair(call *c, reference_pair **pair, const shared_image **b)
{
    c->refused = 409;
    const shared_image *a =
        reference_image_take(c->l->reference_image); /* fail early: without A the newest image is not needed */
    shared_image_release(a);
    if (!a)
        return refuse_without_reference(c, 409);
    const status code = take_final(c, b);
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
    TRY(take_pair(c, &pair, &b));
    status code = STATUS_OK;
    const shared_image *a = reference_pair_a(pair);
    const bool fits = reference_pair_fits(pair);
    if (fits && (code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = reference_pair_numbers(pair, &found, &c->why);
        semaphore_release(c->l->heavy);
    }
    if (code == STATUS_OK)
        api_reply_json(c, json_pack("{s:o, s:o, s:o, s:o}", "a", shared_image_json(a), "b", shared_image_json(b),
                                    "changed", changed_params(a->of, b->of), "comparison",
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
    TRY(take_pair(c, &pair, &b));
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
