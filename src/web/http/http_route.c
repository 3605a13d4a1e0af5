/* Which route, or file, a request goes to. */
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

/* Part by part; what stands for braces is kept in q->value. */
static bool matches(http_request *q, const char *pattern)
{
    const char *path = q->path;
    int values = 0;
    while (*pattern == '/' && *path == '/') {
        const size_t wanted = strcspn(++pattern, "/"), given = strcspn(++path, "/");
        if (wanted > 2 && pattern[0] == '{' && pattern[wanted - 1] == '}') {
            if (given == 0 || values == HTTP_VALUES_MAX || !(q->value[values++] = strndup(path, given)))
                break;
        } else if (wanted != given || memcmp(pattern, path, wanted) != 0) {
            break;
        }
        pattern += wanted;
        path += given;
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
        http_reply_error(&q->reply, 404, "there is nothing of that name", "see the page at /");
        return 404;
    }
    http_reply_header(&q->reply, "Allow", allow);
    http_reply_error(&q->reply, 405, "that cannot be done with it", "use a method that Allow names");
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
