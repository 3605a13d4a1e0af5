/* Finds the route or file of a request. */
#include "web/http/http_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void forget_values(http_request *q)
{
    for (int i = 0; i < HTTP_VALUES_MAX; i++) {
        free(q->value[i]);
        q->value[i] = NULL;
    }
}

/* Compares part by part; the parts that match {name} are stored in q->value. */
static bool matches(http_request *q, const char *pattern)
{
    const char *path = q->path;
    int values = 0;
    while (*pattern == '/' && *path == '/') {
        const size_t pattern_length = strcspn(++pattern, "/"), path_length = strcspn(++path, "/");
        if (pattern_length > 2 && pattern[0] == '{' && pattern[pattern_length - 1] == '}') {
            if (path_length == 0 || values == HTTP_VALUES_MAX || !(q->value[values++] = strndup(path, path_length)))
                break;
        } else if (pattern_length != path_length || memcmp(pattern, path, pattern_length) != 0) {
            break;
        }
        pattern += pattern_length;
        path += path_length;
    }
    if (!*pattern && !*path)
        return true;
    forget_values(q);
    return false;
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
    for (size_t i = 0; i < s->route_count; i++)
        if (matches(q, s->routes[i].pattern)) {
            if (is_method(q, s->routes[i].method)) {
                q->route = &s->routes[i];
                return 0;
            }
            forget_values(q);
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
