/* The part of the HTTP server without libmicrohttpd, which the build for browsers (src/wasm) uses too: the route or
 * file of a request, JSON in requests and replies, and the headers of a reply. */
#include "base/json_build.h"
#include "report/json.h"
#include "web/http/http_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The parts of a path that match {name}, in order. */
typedef struct path_values {
    const char *at[HTTP_VALUES_MAX];
    size_t length[HTTP_VALUES_MAX];
    int count;
} path_values;

/* Compares a path with a pattern, part by part. */
static bool matches(const char *path, const char *pattern, path_values *found)
{
    found->count = 0;
    while (*pattern == '/' && *path == '/') {
        const size_t pattern_length = strcspn(++pattern, "/"), path_length = strcspn(++path, "/");
        if (pattern_length > 2 && pattern[0] == '{' && pattern[pattern_length - 1] == '}') {
            if (path_length == 0 || found->count == HTTP_VALUES_MAX)
                return false;
            found->at[found->count] = path;
            found->length[found->count++] = path_length;
        } else if (pattern_length != path_length || memcmp(pattern, path, pattern_length) != 0) {
            return false;
        }
        pattern += pattern_length;
        path += path_length;
    }
    return !*pattern && !*path;
}

/* Returns 0, or 500 with the reply set: running out of memory must not look like an unknown path. */
static int keep_values(http_request *q, const path_values *found)
{
    for (int i = 0; i < found->count; i++)
        if (!(q->value[i] = strndup(found->at[i], found->length[i]))) {
            http_reply_error(&q->reply, 500, "out of memory for the request", "try again later");
            return 500;
        }
    return 0;
}

static bool is_method(const http_request *q, const char *method)
{
    return strcmp(q->method, method) == 0 || (strcmp(method, "GET") == 0 && strcmp(q->method, "HEAD") == 0);
}

static void add_method(char *allow, size_t size, const char *method)
{
    const size_t length = strlen(allow);
    snprintf(allow + length, size - length, "%s%s%s", length ? ", " : "", method,
             strcmp(method, "GET") == 0 ? ", HEAD" : "");
}

int http_find_route(http_request *q)
{
    const http_settings *s = &q->server->settings;
    char allow[128] = "";
    path_values found;
    for (size_t i = 0; i < s->route_count; i++)
        if (matches(q->path, s->routes[i].pattern, &found)) {
            if (is_method(q, s->routes[i].method)) {
                const int code = keep_values(q, &found);
                q->route = code == 0 ? &s->routes[i] : NULL;
                return code;
            }
            add_method(allow, sizeof allow, s->routes[i].method);
        }
    const char *name = q->path[1] ? q->path + 1 : "index.html";
    for (size_t i = 0; i < s->file_count && !allow[0]; i++)
        if (strcmp(name, s->files[i].name) == 0) {
            if (is_method(q, "GET")) {
                q->file = &s->files[i];
                return 0;
            }
            add_method(allow, sizeof allow, "GET");
        }
    if (!allow[0]) {
        http_reply_error(&q->reply, 404, "no page or route has that path", "open the page at /");
        return 404;
    }
    http_reply_header(&q->reply, "Allow", allow);
    http_reply_error(&q->reply, 405, "the method is not allowed here", "use a method of the header Allow");
    return 405;
}

const char *http_path_value(const http_request *q, const char *name)
{
    int i = 0;
    const size_t length = strlen(name);
    for (const char *brace = q->route ? strchr(q->route->pattern, '{') : NULL; brace && i < HTTP_VALUES_MAX;
         brace = strchr(brace + 1, '{'), i++)
        if (strncmp(brace + 1, name, length) == 0 && brace[1 + length] == '}')
            return q->value[i];
    return NULL;
}

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
