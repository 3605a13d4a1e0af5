/* A small HTTP server for one person at one machine: the lab's page, its requests and its streams of events. It listens
 * on 127.0.0.1 alone and serves nobody who does not know its token.
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
 * What each request goes through, and what it is told where it fails; the first that fails answers, as {"error": ..,
 * "remedy": ..}:
 *   400  HTTP/1.0 or 1.1 with one Host; a path of printable characters without "." or ".." as a part, "//", "\", %00,
 *        %2f or %5c, however they are written; libmicrohttpd ends the line at a NUL that is not
 *   421  Host is 127.0.0.1, localhost or [::1] with this port: other names are another site's that was led here (DNS
 *        rebinding)
 *   403  Origin, where there is one, is that same host
 *   401  the token, as "Authorization: Bearer TOKEN" or in the cookie cuvette_PORT; or, for GET, as ?token=TOKEN, which
 *        answers 303 with that cookie (HttpOnly, SameSite=Strict) and the same address without the token
 *   429  requests_per_s, with a second's worth saved up; those who know the token are not held up by those who do not
 *   404  a route or file of that path;  405  of that method (Allow says which); HEAD goes where GET goes
 *   415  Content-Type: application/json for every method but GET and HEAD, which a foreign page cannot send unasked
 *   413  body_max
 * A request has timeout_s to come in whole, a reply as long to be taken; slower ones are cut off. Each reply forbids
 * that a browser keeps it, frames it, guesses its type or loads anything from elsewhere for it (Content-Security-Policy
 * and its kin); libmicrohttpd's own answers to what is not HTTP are bare.
 *
 * Threads: one for each connection, so that a handler may take its time and blocks nobody; handlers of one server run
 * beside each other. Memory: connections * (body_max + 64 KiB) and what the handlers reply with; an event is kept once
 * for all clients. Ownership: http_start gives, http_stop releases; settings, routes and files are borrowed in between
 * (settings itself only by http_start). What is given to a reply is the reply's. Errors: STATUS_BAD_INPUT for a port
 * that cannot be had, STATUS_FAILURE for memory, threads and sockets. Nothing is printed, no signal is taken. */
#pragma once

#include "base/status.h"
#include <jansson.h>
#include <stddef.h>

typedef struct http_server http_server;
typedef struct http_request http_request;
typedef struct http_reply http_reply;

/* Fills the reply; one that stays empty is a 500. Request and reply are the handler's until it returns. */
typedef void http_handler(void *context, const http_request *request, http_reply *reply);

enum { HTTP_VALUES_MAX = 4 };
typedef struct http_route {
    const char *method; /* "GET", "PUT", .. */
    /* "/api/params/{name}": a part in braces stands for any one part; at most HTTP_VALUES_MAX of them */
    const char *pattern;
    http_handler *handle;
    void *context;
} http_route;

/* Served for GET at "/" and its name; index.html at "/" as well. A route of the same path goes first. */
typedef struct http_file {
    const char *name, *type;
    const unsigned char *bytes;
    size_t size;
} http_file;

/* Zero stands for what is in brackets. */
typedef struct http_settings {
    int port; /* 1..65535 [any that is free] */
    const http_route *routes;
    size_t route_count;
    const http_file *files;
    size_t file_count;
    size_t body_max;       /* bytes of a request's body [1 MiB] */
    int connections;       /* at one time, 1..1024 [64]; others wait to be accepted */
    int event_clients;     /* of those, for streams of events [32, or half of connections]; others get 503 */
    int timeout_s;         /* [10] */
    double requests_per_s; /* [2000] */
} http_settings;

status http_start(const http_settings *settings, http_server **out, diagnostic *why);
/* Ends all streams, waits for handlers that run, then releases. No http_publish at the same time or after. NULL is
 * allowed. */
void http_stop(http_server *server);

int http_port(const http_server *server);
const char *http_token(const http_server *server); /* 128 random bits as 32 hexadecimal digits */
const char *
http_address(const http_server *server); /* "http://127.0.0.1:PORT/?token=TOKEN": lets in whoever reads it */

/* --- a request --- */

const char *http_path_value(const http_request *request,
                            const char *name); /* what {name} stood for; NULL: not in the pattern */
const char *http_query_value(const http_request *request, const char *name); /* decoded; NULL: none; "" for ?name */
const char *http_header(const http_request *request, const char *name);      /* the first of that name; NULL: none */
/* The body as JSON (a new reference); NULL where it is none: the reply is then 400 with line and column. */
json_t *http_body_json(const http_request *request, http_reply *reply);

/* --- a reply; the last one set counts --- */

void http_reply_bytes(http_reply *reply, int code, const char *type, void *bytes,
                      size_t size); /* from malloc, taken; NULL is a 500 */
void http_reply_static(http_reply *reply, int code, const char *type, const void *bytes,
                       size_t size);                              /* outlives the server */
void http_reply_json(http_reply *reply, int code, json_t *value); /* takes the reference; NULL is a 500 */
/* {"error": what, "remedy": remedy}; bytes of what that are not UTF-8 become '?'. */
void http_reply_error(http_reply *reply, int code, const char *what, const char *remedy);
/* 400 for STATUS_BAD_INPUT, 409 for STATUS_INTERRUPTED, otherwise 500; with file, line and column where the diagnostic
 * has them. */
void http_reply_diagnostic(http_reply *reply, status code, const diagnostic *why);
/* Adds a header (copied), at most 8; not those that every reply has. Without effect where name or value have control
 * characters. */
void http_reply_header(http_reply *reply, const char *name, const char *value);

/* --- events --- */

/* The handler of a stream (text/event-stream) of all that is published from now on; 503 where event_clients have
 * theirs. To miss nothing, a page opens the stream first and then asks for the state. A comment every 5 s keeps it
 * alive, and a client that has left is noticed at once. */
void http_events(void *context, const http_request *request, http_reply *reply);

/* Sends an event to all streams, from any thread; never waits for a client. Where an event of that name still waits for
 * a client, this one takes its place, so that a slow client gets the last state; of more than 16 names that wait for
 * one client the oldest is dropped. event: 1..63 letters, digits, '-', '_', '.'; STATUS_BAD_INPUT for others. value is
 * borrowed. */
status http_publish(http_server *server, const char *event, const json_t *value, diagnostic *why);
/* Streams that are open now. */
int http_event_clients(http_server *server);
