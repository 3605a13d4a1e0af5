/* Two pictures beside each other: A, which was pinned, and B, the newest. */
#include "web/api/api.h"

#include "report/json.h"
#include "report/report.h"
#include "web/session/pins.h"
#include <stdlib.h>
#include <string.h>

/* The newest picture if it is a final one, or, where it is waited for, the next that is. */
static status take_final(call *c, const picture **out)
{
    *out = NULL;
    if (api_asks_for(c, "wait"))
        return api_wait_for_final(c, out);
    const picture *newest = painter_take(c->l->painter);
    if (newest && newest->final) {
        *out = newest;
        return STATUS_OK;
    }
    picture_release(newest);
    return api_refuse(c, 409, "the picture is not finished yet", "wait until it is final, or ask with ?wait=1");
}

static status set_pin(call *c, const picture *a)
{
    pins_set(c->l->pins, a);
    picture_release(a);
    lab_tell_state(c->l);
    return api_tell(c, json_pack("{s:o}", "pin", pins_tell(c->l->pins)));
}

status api_pin(call *c)
{
    const picture *newest;
    c->refused = 409;
    TRY(take_final(c, &newest));
    return set_pin(c, newest);
}

status api_unpin(call *c)
{
    return set_pin(c, NULL);
}

static status refuse_without_pin(call *c, int code)
{
    return api_refuse(c, code, "no picture is pinned", "pin one with POST /api/pin");
}

/* The bytes belong to what they show. */
static status send_copy(call *c, const unsigned char *bytes, size_t size)
{
    void *copy = malloc(size);
    if (copy)
        memcpy(copy, bytes, size);
    return api_send(c, "image/png", copy, size);
}

status api_pin_picture(call *c)
{
    int bits;
    const unsigned char *shared = NULL;
    unsigned char *own = NULL;
    size_t size = 0;
    if (!api_take_bits(c, &bits))
        return api_refuse(c, 400, "bits is neither 8 nor 16", "ask for ?bits=8 or ?bits=16");
    const picture *a = pins_take(c->l->pins);
    if (!a)
        return refuse_without_pin(c, 404);
    c->refused = 409;
    status code = gate_enter(c->l->heavy, &c->why);
    if (code == STATUS_OK) {
        code = bits == 16 ? image_encode(a->linear, IMAGE_PNG, 16, true, &own, &size, &c->why)
                          : picture_png(a, &shared, &size, &c->why);
        gate_leave(c->l->heavy);
    }
    if (code == STATUS_OK)
        own ? api_send(c, "image/png", own, size) : send_copy(c, shared, size);
    picture_release(a);
    return code;
}

/* A and B, which the caller releases. */
static status take_pair(call *c, pin_pair **pair, const picture **b)
{
    c->refused = 409;
    const picture *a = pins_take(c->l->pins); /* so that nobody waits for B without it */
    picture_release(a);
    if (!a)
        return refuse_without_pin(c, 409);
    const status code = take_final(c, b);
    if (code != STATUS_OK || (*pair = pins_pair(c->l->pins, *b)))
        return code;
    picture_release(*b);
    return refuse_without_pin(c, 409);
}

static json_t *comparison_json(const image_comparison *found)
{
    json_t *o = json_object();
    return json_whole(o, o && report_comparison(o, found));
}

status api_compare(call *c)
{
    pin_pair *pair;
    const picture *b;
    image_comparison found;
    TRY(take_pair(c, &pair, &b));
    status code = STATUS_OK;
    const picture *a = pin_pair_a(pair);
    const bool fits = pin_pair_fits(pair);
    if (fits && (code = gate_enter(c->l->heavy, &c->why)) == STATUS_OK) {
        code = pin_pair_numbers(pair, &found, &c->why);
        gate_leave(c->l->heavy);
    }
    if (code == STATUS_OK)
        api_tell(c,
                 json_pack("{s:o, s:o, s:o, s:o}", "a", picture_json(a), "b", picture_json(b), "changed",
                           changed_params(a->of, b->of), "comparison", fits ? comparison_json(&found) : json_null()));
    picture_release(b);
    pin_pair_release(pair);
    return code;
}

status api_compare_map(call *c)
{
    pin_pair *pair;
    const picture *b;
    const unsigned char *bytes;
    size_t size;
    TRY(take_pair(c, &pair, &b));
    status code = STATUS_OK;
    if ((code = gate_enter(c->l->heavy, &c->why)) == STATUS_OK) {
        code = pin_pair_map(pair, &bytes, &size, &c->why);
        gate_leave(c->l->heavy);
    }
    if (code == STATUS_OK)
        send_copy(c, bytes, size);
    picture_release(b);
    pin_pair_release(pair);
    return code;
}
