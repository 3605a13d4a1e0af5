/* Declarations shared by the files of the HTTP server; private to them. See web/http/http.h. Functions that need
 * libmicrohttpd's types are in http_library.h: the build for browsers (src/wasm) lacks that library. */
#pragma once

#include "web/http/http.h"

#include <pthread.h>
#include <stdbool.h>

enum {
    HTTP_TOKEN_DIGITS = 32,
    HTTP_EVENT_CLIENTS_MAX = 512,
    HTTP_EVENTS_WAITING = 16,
    HTTP_HEADERS_MAX = 8,
    HTTP_HEARTBEAT_MS = 5000
};

/* Token bucket of a rate limit; refills at its rate and holds one second's worth. */
typedef struct http_bucket {
    double left, filled_s;
} http_bucket;

/* A connection's slot in the watchdog. */
typedef struct http_slot {
    int socket;        /* -1: the slot is free */
    double deadline_s; /* 0: none */
    bool known;        /* the connection has sent a request with the token */
    double started_s;
} http_slot;

typedef struct http_event_client http_event_client;

struct http_server {
    http_settings settings;
    struct MHD_Daemon *daemon;
    int port;
    char token[HTTP_TOKEN_DIGITS + 1], address[96], cookie[24];
    char *content_policy; /* the header Content-Security-Policy */

    pthread_mutex_t bucket_lock;
    http_bucket known, unknown; /* requests with the token and without */

    pthread_mutex_t watch_lock;
    pthread_cond_t watch_wake;
    pthread_t watch;
    bool watching, watch_ends;
    http_slot *slots; /* settings.connections slots */

    pthread_mutex_t event_lock;
    bool events_end;
    int event_client_count;
    http_event_client *event_client[HTTP_EVENT_CLIENTS_MAX];
};

struct http_reply {
    http_server *server;
    struct MHD_Connection *connection;
    struct MHD_Response *response; /* NULL: none yet */
    int code;
    int header_count;
    char *header_name[HTTP_HEADERS_MAX], *header_value[HTTP_HEADERS_MAX];
};

struct http_request {
    http_server *server;
    struct MHD_Connection *connection;
    char *target; /* as received: path and query */
    char *path;   /* decoded */
    const char *method;
    const http_route *route;
    const http_file *file;
    char *value[HTTP_VALUES_MAX]; /* values of the pattern's {name} parts, in order */
    char *body;
    size_t body_size, body_room, received;
    bool head_read;
    bool length_unclear; /* nobody knows where the body ends: it is not read */
    http_reply reply;    /* if set before the body arrives, the body is discarded */
};

/* --- http_guard.c: checks a request. Returns 0, or the HTTP code with the reply set. --- */

int http_guard(http_request *q, const char *version);

/* --- http_shared.c: sets q->route or q->file. Returns 0, or the HTTP code with the reply set. --- */
int http_find_route(http_request *q);

/* --- http_send.c --- */
void http_reply_release(http_reply *r);
void http_reply_set(http_reply *r, int code, const char *type,
                    struct MHD_Response *response); /* owns response; NULL: out of memory */

/* --- http_watch.c: closes connections that exceed timeout_s --- */
status http_watch_start(http_server *s, diagnostic *why);
/* Reports that the server's threads cannot be started. */
status http_no_threads(diagnostic *why);
void http_watch_stop(http_server *s);
/* Marks a connection that has sent the token: new connections do not displace it. */
void http_watch_known(http_server *s, struct MHD_Connection *c);
/* Sets the time limit of the connection's current action; 0: none. */
void http_watch_deadline(http_server *s, struct MHD_Connection *c, double in_s);

/* --- http_events.c --- */
void http_events_end(http_server *s);
