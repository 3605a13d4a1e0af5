/* libmicrohttpd's functions, and the server's functions that need its types; the others are in web/http/http_private.h.
 * The library is loaded when a server starts: it depends on GnuTLS, and loading all dependencies would cost every
 * command 6 ms. Its own header has the types and meanings of its functions. */
#pragma once

#include "base/status.h"
#include "web/http/http_private.h"

#include <microhttpd.h>

#define EACH_MHD_FUNCTION(X)         \
    X(add_response_header)           \
    X(create_response_from_buffer)   \
    X(create_response_from_callback) \
    X(destroy_response)              \
    X(get_connection_info)           \
    X(get_connection_values)         \
    X(lookup_connection_value)       \
    X(lookup_connection_value_n)     \
    X(queue_response)                \
    X(set_connection_option)         \
    X(start_daemon)                  \
    X(stop_daemon)

typedef struct mhd_functions {
#define DECLARE_MHD_FUNCTION(name) __typeof__(MHD_##name) *name;
    EACH_MHD_FUNCTION(DECLARE_MHD_FUNCTION)
#undef DECLARE_MHD_FUNCTION
} mhd_functions;

/* NULL pointers until http_library_load has succeeded. */
extern mhd_functions mhd;

/* Fills mhd, once for the process; any thread may call it. A failure says which package to install. */
status http_library_load(diagnostic *why);

/* --- http_watch.c --- */
void http_watch_notify(void *server, struct MHD_Connection *c, void **place, enum MHD_ConnectionNotificationCode what);

/* --- http_request.c: libmicrohttpd's callbacks --- */
void *http_on_target(void *server, const char *target, struct MHD_Connection *c);
enum MHD_Result http_on_request(void *server, struct MHD_Connection *c, const char *url, const char *method,
                                const char *version, const char *upload, size_t *upload_size, void **request);
void http_on_end(void *server, struct MHD_Connection *c, void **request, enum MHD_RequestTerminationCode why);
