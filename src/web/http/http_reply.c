/* JSON in requests and replies, and the headers of a reply. */
#include "base/json_build.h"
#include "report/json.h"
#include "web/http/http_private.h"

#include <stdlib.h>
#include <string.h>

json_t *http_body_json(const http_request *q, http_reply *r)
{
    json_error_t error;
    bool no_memory;
    json_t *value =
        json_parse(q->body ? q->body : "", q->body_size, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &error, &no_memory);
    if (!value && no_memory) {
        diagnostic why = {.line = 0};
        http_reply_diagnostic(r, out_of_memory(&why), &why);
    } else if (!value) {
        diagnostic why = {.line = error.line > 0 ? error.line : 1, .column = error.column > 0 ? error.column : 1};
        diagnose(&why, STATUS_BAD_INPUT, "send one JSON value", "the request's body is not JSON: %s", error.text);
        http_reply_diagnostic(r, STATUS_BAD_INPUT, &why);
    }
    return value;
}

void http_reply_json(http_reply *r, int code, json_t *value)
{
    char *text = value ? json_text(value, JSON_COMPACT | JSON_ENCODE_ANY) : NULL;
    json_decref(value);
    http_reply_bytes(r, code, "application/json", text, text ? strlen(text) : 0);
}

void http_reply_error(http_reply *r, int code, const char *what, const char *remedy)
{
    http_reply_json(r, code,
                    json_pack("{s:o, s:o}", "error", json_of_text(what), "remedy", json_of_text(remedy ? remedy : "")));
}

void http_reply_diagnostic(http_reply *r, status code, const diagnostic *why)
{
    http_reply_json(r,
                    code == STATUS_BAD_INPUT     ? 400
                    : code == STATUS_INTERRUPTED ? 409
                                                 : 500,
                    json_of_diagnostic(why));
}

static bool printable(const char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            return false;
    return true;
}

void http_reply_header(http_reply *r, const char *name, const char *value)
{
    if (r->header_count == HTTP_HEADERS_MAX || !printable(name) || !printable(value))
        return;
    char *name_copy = strdup(name), *value_copy = strdup(value);
    if (!name_copy || !value_copy) {
        free(name_copy);
        free(value_copy);
        return;
    }
    r->header_name[r->header_count] = name_copy;
    r->header_value[r->header_count++] = value_copy;
}
