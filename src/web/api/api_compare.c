/* Two pictures beside each other: A, which was pinned, and B, the newest. */
#include "web/lab_private.h"

#include "report/report.h"
#include "web/session/changed.h"
#include "web/session/pins.h"
#include <stdlib.h>
#include <string.h>

static const double final_wait_s = 120.0;

static bool asks_for(const http_request *request, const char *key)
{
    const char *value = http_query_value(request, key);
    return value && strcmp(value, "0") != 0;
}

static void reply_conflict(http_reply *reply, const diagnostic *why)
{
    http_reply_error(reply, 409, why->what, why->remedy);
}

static void reply_failure(http_reply *reply, status code, const diagnostic *why)
{
    if (code == STATUS_FAILURE)
        http_reply_diagnostic(reply, code, why);
    else
        reply_conflict(reply, why);
}

/* The newest picture if it is a final one, or, where it is waited for, the next that is; NULL with the reply set. */
static const picture *take_final(lab *l, const http_request *request, http_reply *reply)
{
    const picture *newest = NULL;
    diagnostic why = {0};
    if (asks_for(request, "wait")) {
        const status code = painter_take_final(l->painter, final_wait_s, &newest, &why);
        if (code != STATUS_OK)
            reply_failure(reply, code, &why);
        return newest;
    }
    newest = painter_take(l->painter);
    if (newest && newest->final)
        return newest;
    picture_release(newest);
    http_reply_error(reply, 409, "the picture is not finished yet", "wait until it is final, or ask with ?wait=1");
    return NULL;
}

static void reply_pin(lab *l, http_reply *reply)
{
    lab_tell_state(l);
    http_reply_json(reply, 200, json_pack("{s:o}", "pin", pins_tell(l->pins)));
}

static void post_pin(void *context, const http_request *request, http_reply *reply)
{
    lab *l = context;
    const picture *newest = take_final(l, request, reply);
    if (!newest)
        return;
    pins_set(l->pins, newest);
    picture_release(newest);
    reply_pin(l, reply);
}

static void delete_pin(void *context, const http_request *request, http_reply *reply)
{
    lab *l = context;
    (void)request;
    pins_set(l->pins, NULL);
    reply_pin(l, reply);
}

static void reply_no_pin(http_reply *reply, int code)
{
    http_reply_error(reply, code, "no picture is pinned", "pin one with POST /api/pin");
}

/* The bytes belong to what they show. */
static void reply_copy(http_reply *reply, const unsigned char *bytes, size_t size)
{
    void *copy = malloc(size);
    if (copy)
        memcpy(copy, bytes, size);
    http_reply_bytes(reply, 200, "image/png", copy, size);
}

static void get_pin_picture(void *context, const http_request *request, http_reply *reply)
{
    lab *l = context;
    const char *bits = http_query_value(request, "bits");
    if (bits && strcmp(bits, "8") != 0 && strcmp(bits, "16") != 0) {
        http_reply_error(reply, 400, "bits is neither 8 nor 16", "ask for ?bits=8 or ?bits=16");
        return;
    }
    const picture *a = pins_take(l->pins);
    if (!a) {
        reply_no_pin(reply, 404);
        return;
    }
    diagnostic why = {0};
    const unsigned char *shared = NULL;
    unsigned char *own = NULL;
    size_t size = 0;
    const bool fine = bits && strcmp(bits, "16") == 0;
    status code = gate_enter(l->heavy, &why);
    if (code == STATUS_OK) {
        code = fine ? image_encode(a->linear, IMAGE_PNG, 16, true, &own, &size, &why)
                    : picture_png(a, &shared, &size, &why);
        gate_leave(l->heavy);
    }
    if (code != STATUS_OK)
        reply_failure(reply, code, &why);
    else if (fine)
        http_reply_bytes(reply, 200, "image/png", own, size);
    else
        reply_copy(reply, shared, size);
    picture_release(a);
}

/* A and B, which the caller releases; false with the reply set. */
static bool take_pair(lab *l, const http_request *request, http_reply *reply, pin_pair **pair, const picture **b)
{
    const picture *a = pins_take(l->pins); /* so that nobody waits for B without it */
    picture_release(a);
    if (!a) {
        reply_no_pin(reply, 409);
        return false;
    }
    *b = take_final(l, request, reply);
    if (!*b)
        return false;
    *pair = pins_pair(l->pins, *b);
    if (*pair)
        return true;
    picture_release(*b);
    reply_no_pin(reply, 409);
    return false;
}

static json_t *comparison_json(const image_comparison *c)
{
    json_t *o = json_object();
    if (o && report_comparison(o, c))
        return o;
    json_decref(o);
    return NULL;
}

static void get_compare(void *context, const http_request *request, http_reply *reply)
{
    lab *l = context;
    pin_pair *pair;
    const picture *b;
    image_comparison found;
    diagnostic why = {0};
    if (!take_pair(l, request, reply, &pair, &b))
        return;
    const picture *a = pin_pair_a(pair);
    const bool fits = pin_pair_fits(pair);
    status code = fits ? gate_enter(l->heavy, &why) : STATUS_OK;
    if (fits && code == STATUS_OK) {
        code = pin_pair_numbers(pair, &found, &why);
        gate_leave(l->heavy);
    }
    if (code == STATUS_OK)
        http_reply_json(reply, 200,
                        json_pack("{s:o, s:o, s:o, s:o}", "a", picture_json(a), "b", picture_json(b), "changed",
                                  changed_params(a->of, b->of), "comparison",
                                  fits ? comparison_json(&found) : json_null()));
    else
        reply_failure(reply, code, &why);
    picture_release(b);
    pin_pair_release(pair);
}

static void reply_map(lab *l, pin_pair *pair, http_reply *reply)
{
    const unsigned char *bytes;
    size_t size;
    diagnostic why = {0};
    status code = gate_enter(l->heavy, &why);
    if (code == STATUS_OK) {
        code = pin_pair_map(pair, &bytes, &size, &why);
        gate_leave(l->heavy);
    }
    if (code == STATUS_OK)
        reply_copy(reply, bytes, size);
    else
        reply_failure(reply, code, &why);
}

static void get_compare_map(void *context, const http_request *request, http_reply *reply)
{
    pin_pair *pair;
    const picture *b;
    if (!take_pair(context, request, reply, &pair, &b))
        return;
    reply_map(context, pair, reply);
    picture_release(b);
    pin_pair_release(pair);
}

static const http_route routes[] = {
    {"POST", "/api/pin", post_pin, NULL},
    {"DELETE", "/api/pin", delete_pin, NULL},
    {"GET", "/api/pin.png", get_pin_picture, NULL},
    {"GET", "/api/compare", get_compare, NULL},
    {"GET", "/api/compare.png", get_compare_map, NULL},
};
const lab_routes compare_routes = {routes, sizeof routes / sizeof *routes};
