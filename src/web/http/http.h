/* A small HTTP server for one user on one machine: the laboratory's page, its requests and its event streams. It
 * listens on 127.0.0.1 only and serves only clients that know its token.
 *
 *     static void now(void *context, const http_request *q, http_reply *r)
 *     {
 *         http_reply_json(r, 200, json_pack("{s:i}", "n", 1));
 *     }
 *     const http_route routes[] = {{"GET", "/api/now", now, NULL}, {"GET", "/api/events", http_events, NULL}};
 *     http_settings s = {.routes = routes, .route_count = 2, .files = page_files, .file_count = page_file_count};
 *     status code = http_start(&s, &server, why);          then open http_address(server) in a browser
 *     http_publish(server, "tick", value, why);            from any thread
 *     http_stop(server);
 *
 * The checks of every request, in this order; the first that fails replies {"error": .., "remedy": ..}:
 *   400  HTTP/1.0 or 1.1 with one Host; a path of printable characters without "." or ".." as a part, "//", "\\",
 *        %00, %2f or %5c, however they are encoded; libmicrohttpd ends the line at an unencoded NUL
 *        and a body of one length: one Content-Length in digits (or several equal ones) or one Transfer-Encoding
 *   421  Host is 127.0.0.1, localhost or [::1] with this port: another name means DNS rebinding by another site
 *   403  Origin, if present, is that same host
 *   429  requests_per_s, with a burst of one second; requests without the token have a separate limit
 *   401  the token, as "Authorization: Bearer TOKEN" or in the cookie cuvette_PORT; or, for GET, as ?token=TOKEN:
 *        the reply is 303 with that cookie (HttpOnly, SameSite=Strict) and the same address without the token
 *        (if a page of another site or a local file opened the address: 200 with a page that opens "/")
 *   404  no route or file has the path;  405  the route has another method (Allow lists them); HEAD uses GET's route
 *   415  Content-Type: application/json for every method but GET and HEAD; another site's page cannot send it
 *        without a preflight request, which fails
 *   413  body_max
 * A request must arrive within timeout_s, and a reply must be read within the same time; slower connections are
 * closed. Connections that have sent no request with the token may be a quarter of all; another one displaces the
 * oldest of them. Each reply forbids the browser to cache it, to frame it (but for frame_origins), to guess its type or
 * to load anything from elsewhere for it (Content-Security-Policy and related headers); libmicrohttpd's own replies to
 * malformed HTTP lack these headers.
 *
 * In a frame of another site a browser accepts only cookies with SameSite=None; so with frame_origins a frame gets such
 * a cookie, which is partitioned: the browser sends it only from frames in pages of that site.
 *
 * Texts of 1400 bytes or more are compressed for clients that accept gzip.
 *
 * Threads: one per connection, so a handler may block without blocking others; handlers of one server run
 * concurrently. Memory: connections * (body_max + 64 KiB) and the replies of the handlers; an event is stored once
 * for all clients. Ownership: http_start creates, http_stop releases; routes and files of the settings are borrowed
 * until then, the settings themselves only by http_start. A reply owns the bytes, files and JSON passed to
 * it. Errors: STATUS_BAD_INPUT for a port that cannot be used, STATUS_FAILURE for memory, threads and sockets. Prints
 * nothing and handles no signal. */
#pragma once

#include "base/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct http_server http_server;
typedef struct http_request http_request;
typedef struct http_reply http_reply;

/* Fills the reply; an empty reply becomes a 500. Request and reply are valid until the handler returns. */
typedef void http_handler(void *context, const http_request *request, http_reply *reply);

enum { HTTP_VALUES_MAX = 4, HTTP_FRAME_ORIGINS_MAX = 8 };
typedef struct http_route {
    const char *method; /* "GET", "PUT", .. */
    /* "/api/params/{name}": a part in braces matches any one part; at most HTTP_VALUES_MAX of them */
    const char *pattern;
    http_handler *handle;
    void *context;
} http_route;

/* Served for GET at /NAME; index.html also at /. A route with the same path has precedence. */
typedef struct http_file {
    const char *name, *type;
    const unsigned char *bytes;
    size_t size;
} http_file;

/* A zero selects the default in brackets. */
typedef struct http_settings {
    int port; /* 1..65535 [any free port] */
    const http_route *routes;
    size_t route_count;
    const http_file *files;
    size_t file_count;
    size_t body_max;       /* limit of a request's body in bytes [1 MiB] */
    int connections;       /* concurrent connections, 1..1024 [64]; further clients wait to be accepted */
    int event_clients;     /* connections that may be event streams [half of all, at most 32]; more clients get 503 */
    int timeout_s;         /* [10] */
    double requests_per_s; /* [2000] */
    /* Origins whose pages may show this server's page in a frame, each as http_is_origin accepts it [none] */
    const char *const *frame_origins;
    size_t frame_origin_count; /* at most HTTP_FRAME_ORIGINS_MAX */
} http_settings;

/* Whether the text is an origin: http:// or https://, a host in lower case and perhaps a port; no path. */
bool http_is_origin(const char *text);

status http_start(const http_settings *settings, http_server **out, diagnostic *why);
/* Ends all streams, waits for running handlers, then releases the server. No thread may call http_publish during or
 * after the call. NULL is allowed. */
void http_stop(http_server *server);

int http_port(const http_server *server);
const char *http_token(const http_server *server); /* 128 random bits as 32 hexadecimal digits */
const char *
http_address(const http_server *server); /* "http://127.0.0.1:PORT/?token=TOKEN": a secret that grants access */

/* --- a request --- */

const char *http_path_value(const http_request *request,
                            const char *name); /* the value of {name}; NULL: not in the pattern */
const char *http_query_value(const http_request *request, const char *name); /* decoded; NULL: none; "" for ?name */
const char *http_header(const http_request *request, const char *name);      /* the first of that name; NULL: none */
/* The body as JSON (a new reference). NULL sets the reply: 400 with line and column for invalid JSON, 500 when out of
 * memory. */
json_t *http_body_json(const http_request *request, http_reply *reply);

/* --- a reply; the last one set counts --- */

void http_reply_bytes(http_reply *reply, int code, const char *type, void *bytes,
                      size_t size); /* allocated by malloc, owned by the reply; NULL sends 500 */
void http_reply_static(http_reply *reply, int code, const char *type, const void *bytes,
                       size_t size);                              /* bytes must outlive the server */
void http_reply_json(http_reply *reply, int code, json_t *value); /* owns value; NULL sends 500 */
/* {"error": what, "remedy": remedy}; bytes that are not UTF-8 become '?'. */
void http_reply_error(http_reply *reply, int code, const char *what, const char *remedy);
/* 400 for STATUS_BAD_INPUT, 409 for STATUS_INTERRUPTED, otherwise 500; with file, line and column if the diagnostic
 * has them. */
void http_reply_diagnostic(http_reply *reply, status code, const diagnostic *why);
/* Adds a header (copied) to those that every reply has. Ignored after 8 added headers, if name or value contain control
 * characters, or if memory runs out. */
void http_reply_header(http_reply *reply, const char *name, const char *value);

/* --- events --- */

/* The handler of an event stream (text/event-stream) with the events from now on; 503 if event_clients streams are
 * open. To miss nothing, a page opens the stream first and then requests the state. A comment every 5 s keeps the
 * connection alive and detects clients that have left. */
void http_events(void *context, const http_request *request, http_reply *reply);

/* Sends an event to all streams; thread-safe; never waits for a client. An event replaces an unsent event of the
 * same name, so a slow client gets the latest state; if more than 16 names wait for one client, the oldest is
 * dropped. event: 1..63 letters, digits, '-', '_', '.'; STATUS_BAD_INPUT otherwise. value is borrowed. */
status http_publish(http_server *server, const char *event, const json_t *value, diagnostic *why);
/* The number of open streams. */
int http_event_clients(http_server *server);
