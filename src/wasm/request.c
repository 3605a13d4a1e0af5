/* The functions of web/http/http.h for messages: the page's script sends requests and receives replies. */
#include "wasm/exports.h"
#include "wasm/worker.h"
#include "web/http/http_private.h"
#include "web/lab.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* The browser loads the page from the site's files, so the module embeds no file. */
const http_file page_files[1] = {{.name = ""}};
const size_t page_file_count = 0;

/* The name is libmicrohttpd's, because http_reply has a pointer to this type. */
struct MHD_Response {
    const char *type;
    void *bytes; /* owned */
    size_t size;
};

typedef struct waiting_request {
    http_request q;
    int id;
    bool again; /* the request has waited */
    struct waiting_request *next;
} waiting_request;

static http_server page_server;
static waiting_request *waiting;
int wasm_waited;
bool wasm_is_repeated;

status http_start(const http_settings *settings, http_server **out, diagnostic *why)
{
    (void)why;
    page_server.settings = *settings;
    *out = &page_server;
    return STATUS_OK;
}

/* Nothing to do: a laboratory ends with its worker. */
void http_stop(http_server *server)
{
    (void)server;
}

/* --- replies --- */

static void set(http_reply *r, int code, const char *type, void *bytes, size_t size)
{
    if (r->response)
        free(r->response->bytes);
    else if (!(r->response = malloc(sizeof *r->response))) {
        free(bytes);
        return;
    }
    *r->response = (struct MHD_Response){type, bytes, size};
    r->code = code;
}

void http_reply_bytes(http_reply *r, int code, const char *type, void *bytes, size_t size)
{
    set(r, bytes ? code : 500, type, bytes, bytes ? size : 0);
}

void http_reply_static(http_reply *r, int code, const char *type, const void *bytes, size_t size)
{
    void *copy = malloc(size + 1);
    if (copy)
        memcpy(copy, bytes, size);
    http_reply_bytes(r, code, type, copy, size);
}

static void release(http_request *q)
{
    if (q->reply.response)
        free(q->reply.response->bytes);
    free(q->reply.response);
    q->reply.response = NULL;
    for (; q->reply.header_count > 0; q->reply.header_count--) {
        free(q->reply.header_name[q->reply.header_count - 1]);
        free(q->reply.header_value[q->reply.header_count - 1]);
    }
}

static void destroy(waiting_request *w)
{
    release(&w->q);
    for (int i = 0; i < HTTP_VALUES_MAX; i++)
        free(w->q.value[i]);
    free(w->q.target);
    free(w->q.path);
    free(w->q.body);
    free((char *)(uintptr_t)w->q.method);
    free(w);
}

static void send(const waiting_request *w)
{
    const http_reply *r = &w->q.reply;
    json_t *headers = json_pack("{s:s}", "Content-Type", r->response ? r->response->type : "application/json");
    for (int i = 0; i < r->header_count; i++)
        json_object_set_new(headers, r->header_name[i], json_string(r->header_value[i]));
    char *text = headers ? json_dumps(headers, JSON_COMPACT) : NULL;
    static const char failed[] = "{\"error\":\"no memory for the reply\",\"remedy\":\"try again later\"}";
    if (r->response && r->response->bytes)
        host_reply(w->id, r->code, text ? text : "{}", r->response->bytes, r->response->size);
    else
        host_reply(w->id, 500, "{\"Content-Type\":\"application/json\"}", failed, sizeof failed - 1);
    free(text);
    json_decref(headers);
}

/* --- requests --- */

static int digit(char c)
{
    return isdigit((unsigned char)c) ? c - '0' : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/* Decodes %XX in place. */
static char *decode(char *text, bool plus)
{
    char *to = text;
    for (const char *c = text; *c; c++)
        if (*c == '%' && digit(c[1]) >= 0 && digit(c[2]) >= 0) {
            *to++ = (char)(digit(c[1]) * 16 + digit(c[2]));
            c += 2;
        } else {
            *to++ = plus && *c == '+' ? ' ' : *c;
        }
    *to = 0;
    return text;
}

/* Decodes the path and the query of a target. q->target: name 0 value 0 name 0 value 0 ... 0. */
static bool parse_target(http_request *q, const char *target)
{
    const size_t length = strlen(target);
    q->target = calloc(length + 4, 1);
    q->path = strndup(target, strcspn(target, "?"));
    if (!q->target || !q->path)
        return false;
    decode(q->path, false);
    char *to = q->target;
    for (const char *part = strchr(target, '?'); part && part[1];) {
        const size_t size = strcspn(++part, "&");
        const size_t name = strcspn(part, "=&");
        memcpy(to, part, name);
        to += strlen(decode(to, true)) + 1;
        if (name < size)
            memcpy(to, part + name + 1, size - name - 1);
        to += strlen(decode(to, true)) + 1;
        part += size;
        part = *part ? part : NULL;
    }
    return true;
}

const char *http_query_value(const http_request *q, const char *name)
{
    for (const char *at = q->target; *at; at += strlen(at) + 1) {
        const char *value = at + strlen(at) + 1;
        if (strcmp(at, name) == 0)
            return value;
        at = value;
    }
    return NULL;
}

const char *http_header(const http_request *q, const char *name)
{
    (void)q, (void)name;
    return NULL;
}

/* Handles a request. False: it must wait, and its reply was discarded. */
static bool handle(waiting_request *w)
{
    http_request *q = &w->q;
    wasm_waited = 0;
    wasm_is_repeated = w->again;
    w->again = true;
    q->route->handle(q->route->context, q, &q->reply);
    wasm_is_repeated = false;
    if (!wasm_waited || (q->reply.response && q->reply.code < 400))
        return true;
    release(q);
    return false;
}

static void keep(waiting_request *w)
{
    waiting_request **end = &waiting;
    while (*end)
        end = &(*end)->next;
    w->next = NULL;
    *end = w;
}

static void handle_or_keep(waiting_request *w)
{
    if (handle(w)) {
        send(w);
        destroy(w);
    } else {
        keep(w);
    }
}

void wasm_lab_request(int id, const char *method, const char *target, const char *body, size_t size)
{
    waiting_request *w = calloc(1, sizeof *w);
    if (!w) {
        host_reply(id, 500, "{}", "", 0);
        return;
    }
    *w = (waiting_request){.q.server = &page_server, .id = id};
    w->q.reply.server = &page_server;
    w->q.method = strdup(method);
    w->q.body = malloc(size + 1);
    if (!w->q.method || !w->q.body || !parse_target(&w->q, target)) {
        http_reply_error(&w->q.reply, 500, "out of memory for the request", "try again later");
    } else {
        memcpy(w->q.body, body, size);
        w->q.body[size] = 0;
        w->q.body_size = size;
        if (http_find_route(&w->q) == 0 && w->q.route) {
            handle_or_keep(w);
            return;
        }
    }
    send(w);
    destroy(w);
}

void requests_retry(void)
{
    waiting_request *w = waiting;
    waiting = NULL;
    while (w) {
        waiting_request *next = w->next;
        handle_or_keep(w);
        w = next;
    }
}

/* --- events --- */

status http_publish(http_server *server, const char *event, const json_t *value, diagnostic *why)
{
    (void)server;
    char *text = json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY);
    if (!text)
        return out_of_memory(why);
    host_event(event, text);
    free(text);
    return STATUS_OK;
}

void http_events(void *context, const http_request *request, http_reply *reply)
{
    (void)context, (void)request;
    http_reply_error(reply, 404, "a laboratory in a browser sends events as messages", "listen to the engine's events");
}
