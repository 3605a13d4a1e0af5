/* Functions of the HTTP server with libmicrohttpd's types; private to its files. See web/http/http_private.h. */
#pragma once

#include "web/http/http_library.h"
#include "web/http/http_private.h"

/* --- http_send.c --- */
/* Queues the reply with the headers common to all replies. */
enum MHD_Result http_reply_send(http_reply *r);

/* --- http_watch.c --- */
void http_watch_notify(void *server, struct MHD_Connection *c, void **place, enum MHD_ConnectionNotificationCode what);

/* --- http_request.c: libmicrohttpd's callbacks --- */
void *http_on_target(void *server, const char *target, struct MHD_Connection *c);
enum MHD_Result http_on_request(void *server, struct MHD_Connection *c, const char *url, const char *method,
                                const char *version, const char *upload, size_t *upload_size, void **request);
void http_on_end(void *server, struct MHD_Connection *c, void **request, enum MHD_RequestTerminationCode why);
