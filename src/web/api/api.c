/* Helpers of the API's handlers: replies, values of a request's body and query, and the current image. */
#include "web/api/api.h"
#include "base/number.h"
#include "report/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

status api_reply_json(call *c, json_t *json)
{
    c->json = json;
    return STATUS_OK;
}

status api_send(call *c, const char *type, void *bytes, size_t size)
{
    http_reply_bytes(c->reply, 200, type, bytes, size);
    c->sent = true;
    return STATUS_OK;
}

status api_refuse(call *c, int code, const char *what, const char *remedy)
{
    c->refused = code;
    return diagnose(&c->why, STATUS_BAD_INPUT, remedy, "%s", what);
}

status api_changed(call *c, status code, uint64_t generation)
{
    return code == STATUS_OK ? api_reply_json(c, json_pack("{s:I}", "generation", (json_int_t)generation)) : code;
}

/* --- bodies --- */

/* Reads value if the JSON has the expected type. */
typedef bool reader(const json_t *json, void *value);

static bool read_value(call *c, const char *key, bool needed, const char *remedy, reader *read, void *value)
{
    const json_t *json = json_object_get(c->body, key);
    const bool missing = !json || json_is_null(json);
    if (missing ? !needed : read(json, value))
        return true;
    diagnose(&c->why, STATUS_BAD_INPUT, remedy, missing ? "'%s' is missing" : "the value of '%s' is not valid", key);
    return false;
}

static bool read_number(const json_t *json, void *value)
{
    if (!json_is_number(json) || !isfinite(json_number_value(json)))
        return false;
    *(double *)value = json_number_value(json);
    return true;
}

static bool read_vector(const json_t *json, void *value)
{
    bool good = json_array_size(json) == 3;
    for (size_t i = 0; i < 3 && good; i++)
        good = read_number(json_array_get(json, i), (double *)value + i);
    return good;
}

static bool read_text(const json_t *json, void *value)
{
    if (!json_is_string(json) || strlen(json_string_value(json)) != json_string_length(json))
        return false;
    *(const char **)value = json_string_value(json);
    return true;
}

static bool read_short(const json_t *json, void *value)
{
    enum { GESTURE_MAX = 64 };
    return json_string_length(json) <= GESTURE_MAX && read_text(json, value);
}

static bool read_flag(const json_t *json, void *value)
{
    *(bool *)value = json_is_true(json);
    return json_is_boolean(json);
}

bool api_read_number(call *c, const char *key, bool needed, double *value)
{
    return read_value(c, key, needed, "give a number", read_number, value);
}

bool api_read_vector(call *c, const char *key, bool needed, double value[3])
{
    return read_value(c, key, needed, "give a list of three numbers", read_vector, value);
}

bool api_read_text(call *c, const char *key, bool needed, const char **value)
{
    return read_value(c, key, needed, "give a string", read_text, value);
}

bool api_read_flag(call *c, const char *key, bool *value)
{
    return read_value(c, key, false, "give true or false", read_flag, value);
}

bool api_read_gesture(call *c, const char **gesture)
{
    *gesture = NULL;
    return api_read_text(c, "gesture", false, gesture) &&
           read_value(c, "gesture", false, "give a string of at most 64 characters", read_short, gesture);
}

/* --- queries and the current document --- */

bool api_query_flag(const call *c, const char *key)
{
    const char *value = http_query_value(c->request, key);
    return value && strcmp(value, "0") != 0;
}

bool api_query_numbers(call *c, const char *key, int count, double *out, const char *remedy)
{
    const char *text = http_query_value(c->request, key);
    char word[64];
    int found = 0;
    for (const char *at = text; at && found < count; found++) {
        const size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        if (length >= sizeof word || !number_parse_real(word, &out[found]))
            break;
        at = at[length] ? at + length + 1 : NULL;
        if (!at && found + 1 == count)
            return true;
    }
    diagnose(&c->why, STATUS_BAD_INPUT, remedy, text ? "%s is not %d number%s: '%.80s'" : "%s is missing", key, count,
             count == 1 ? "" : "s", text);
    return false;
}

bool api_read_bits(const call *c, int *bits)
{
    const char *bits_text = http_query_value(c->request, "bits");
    *bits = bits_text ? atoi(bits_text) : 8;
    return !bits_text || strcmp(bits_text, "8") == 0 || strcmp(bits_text, "16") == 0;
}

status api_wait_for_final(call *c, const shared_image **out)
{
    const double most_s = 120.0;
    return render_worker_wait_for_final(c->l->render_worker, most_s, out, &c->why);
}

char *api_document_file(const call *c)
{
    json_t *json = json_object();
    const bool known = json && scene_document_json(c->l->scene_document, json);
    const char *file = json_string_value(json_object_get(json, "file"));
    char *copy = known ? strdup(file ? file : "") : NULL;
    json_decref(json);
    return copy;
}
