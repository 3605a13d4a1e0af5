/* Finds the route or file of a request. */
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

/* Compares part by part. */
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

/* 0, or 500 with the reply set: a path whose parts find no memory is not an unknown one. */
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
