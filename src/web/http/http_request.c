/* libmicrohttpd's callbacks of a request: its target, its headers, its body, its reply, its end. */
#include "web/http/http_library.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* A body above the limit is still read up to this multiple of the limit, so that the client gets the 413 instead of a
 * broken connection. */
enum { PATIENCE = 8 };

/* The only callback that gets the raw target: libmicrohttpd decodes it later and cuts it at the first NUL. */
void *http_on_target(void *server, const char *target, struct MHD_Connection *c)
{
    http_request *q = calloc(1, sizeof *q);
    if (!q)
        return NULL;
    q->server = q->reply.server = server;
    q->connection = q->reply.connection = c;
    q->target = strdup(target);
    http_watch_deadline(server, c, q->server->settings.timeout_s);
    return q;
}

void http_on_end(void *server, struct MHD_Connection *c, void **request, enum MHD_RequestTerminationCode why)
{
    (void)why;
    http_request *q = *request;
    *request = NULL;
    if (!q)
        return;
    http_reply_release(&q->reply);
    for (int i = 0; i < HTTP_VALUES_MAX; i++)
        free(q->value[i]);
    free(q->target);
    free(q->path);
    free(q->body);
    free(q);
    http_watch_deadline(server, c, ((http_server *)server)->settings.timeout_s);
}

/* --- the reply --- */

static const char *const on_every_reply[][2] = {
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

/* Queues the reply with the headers common to all replies. */
static enum MHD_Result send_reply(http_reply *r)
{
    if (!r->response)
        http_reply_error(r, 500, r->code ? "no memory for the reply" : "the handler set no reply",
                         r->code ? "try again later" : "report this as a bug, with the request");
    if (!r->response)
        return MHD_NO;
    bool complete =
        mhd.add_response_header(r->response, "Content-Security-Policy", r->server->content_policy) == MHD_YES;
    for (size_t i = 0; i < sizeof on_every_reply / sizeof *on_every_reply; i++)
        complete &= mhd.add_response_header(r->response, on_every_reply[i][0], on_every_reply[i][1]) == MHD_YES;
    for (int i = 0; i < r->header_count; i++)
        complete &= mhd.add_response_header(r->response, r->header_name[i], r->header_value[i]) == MHD_YES;
    /* Send nothing rather than a reply without the security headers. */
    return complete ? mhd.queue_response(r->connection, (unsigned)r->code, r->response) : MHD_NO;
}

/* --- the request --- */

static bool changes(const http_request *q)
{
    return strcmp(q->method, "GET") != 0 && strcmp(q->method, "HEAD") != 0;
}

static bool is_json(const char *type)
{
    static const char json[] = "application/json";
    const size_t length = sizeof json - 1;
    return type && strncasecmp(type, json, length) == 0 && (!type[length] || strchr("; \t", type[length]));
}

static void too_large(http_request *q)
{
    if (!q->reply.response)
        http_reply_error(&q->reply, 413, "the request's body is too large", "send a smaller body");
}

/* Runs before the body, so that the body of a refused request is not stored. */
static enum MHD_Result read_head(http_request *q, const char *method, const char *version)
{
    q->head_read = true;
    q->method = method;
    if (!q->target)
        return MHD_NO;
    if (http_guard(q, version) == 0 && http_find_route(q) == 0 && changes(q) &&
        !is_json(http_header(q, "Content-Type")))
        http_reply_error(&q->reply, 415, "the content type is not JSON",
                         "send JSON, with Content-Type: application/json");
    const char *length = http_header(q, "Content-Length");
    const unsigned long long size = length ? strtoull(length, NULL, 10) : 0;
    if (size > q->server->settings.body_max)
        too_large(q);
    if (q->length_unclear || size / PATIENCE > q->server->settings.body_max)
        return send_reply(&q->reply);
    return MHD_YES;
}

static enum MHD_Result read_body(http_request *q, const char *bytes, size_t size)
{
    const size_t limit = q->server->settings.body_max;
    q->received += size;
    if (q->received / PATIENCE > limit)
        return MHD_NO;
    if (q->received > limit)
        too_large(q);
    if (q->reply.response)
        return MHD_YES;
    if (q->body_size + size + 1 > q->body_room) {
        size_t room = q->body_room ? 2 * q->body_room : 4096;
        room = room < q->body_size + size + 1 ? q->body_size + size + 1 : room;
        room = room > limit + 1 ? limit + 1 : room;
        char *body = realloc(q->body, room);
        if (!body)
            return MHD_NO;
        q->body = body;
        q->body_room = room;
    }
    memcpy(q->body + q->body_size, bytes, size);
    q->body_size += size;
    q->body[q->body_size] = 0;
    return MHD_YES;
}

/* False if the request was refused without memory for the reply. */
static bool can_answer(const http_request *q)
{
    return q->reply.response || q->file || q->route;
}

static void answer(http_request *q)
{
    if (q->file)
        http_reply_static(&q->reply, 200, q->file->type, q->file->bytes, q->file->size);
    else
        q->route->handle(q->route->context, q, &q->reply);
}

enum MHD_Result http_on_request(void *server, struct MHD_Connection *c, const char *url, const char *method,
                                const char *version, const char *upload, size_t *upload_size, void **request)
{
    (void)url;
    http_request *q = *request;
    const http_server *s = server;
    if (!q)
        return MHD_NO;
    if (!q->head_read)
        return read_head(q, method, version);
    if (*upload_size) {
        const size_t size = *upload_size;
        *upload_size = 0;
        return read_body(q, upload, size);
    }
    if (!can_answer(q))
        return MHD_NO;
    if (!q->reply.response) {
        http_watch_deadline(q->server, c, 0);
        answer(q);
        http_watch_deadline(q->server, c, s->settings.timeout_s);
        /* libmicrohttpd counts the handler's time as idle time of the client; setting the timeout restarts it. */
        mhd.set_connection_option(c, MHD_CONNECTION_OPTION_TIMEOUT, 0u);
        if (!q->route || q->route->handle != http_events)
            mhd.set_connection_option(c, MHD_CONNECTION_OPTION_TIMEOUT, (unsigned)s->settings.timeout_s);
    }
    return send_reply(&q->reply);
}

const char *http_query_value(const http_request *q, const char *name)
{
    const char *value = NULL;
    size_t size;
    if (mhd.lookup_connection_value_n(q->connection, MHD_GET_ARGUMENT_KIND, name, strlen(name), &value, &size) !=
        MHD_YES)
        return NULL;
    return value ? value : "";
}

const char *http_header(const http_request *q, const char *name)
{
    return mhd.lookup_connection_value(q->connection, MHD_HEADER_KIND, name);
}
