/* Replies of the HTTP server, as libmicrohttpd sends them. */
#include "web/http/http_callbacks.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const on_every_reply[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

static const char no_memory[] = "{\"error\":\"no memory for the reply\",\"remedy\":\"try again later\"}";

void http_reply_set(http_reply *r, int code, const char *type, struct MHD_Response *response)
{
    if (r->response)
        mhd.destroy_response(r->response);
    r->response = response;
    r->code = code;
    if (response && mhd.add_response_header(response, "Content-Type", type) != MHD_YES) {
        mhd.destroy_response(response);
        r->response = NULL;
    }
}

/* Sends the compressed bytes instead; false where they are not compressed. */
static bool reply_gzip(http_reply *r, int code, const char *type, const void *bytes, size_t size)
{
    size_t packed_size;
    void *packed = http_gzip(r, type, bytes, size, &packed_size);
    if (!packed)
        return false;
    struct MHD_Response *response = mhd.create_response_from_buffer(packed_size, packed, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(packed);
    http_reply_set(r, code, type, response);
    http_reply_header(r, "Content-Encoding", "gzip");
    http_reply_header(r, "Vary", "Accept-Encoding");
    return true;
}

void http_reply_static(http_reply *r, int code, const char *type, const void *bytes, size_t size)
{
    if (reply_gzip(r, code, type, bytes, size))
        return;
    http_reply_set(r, code, type, mhd.create_response_from_buffer(size, (void *)(size_t)bytes, MHD_RESPMEM_PERSISTENT));
}

void http_reply_bytes(http_reply *r, int code, const char *type, void *bytes, size_t size)
{
    if (!bytes) {
        http_reply_static(r, 500, "application/json", no_memory, sizeof no_memory - 1);
        return;
    }
    if (reply_gzip(r, code, type, bytes, size)) {
        free(bytes);
        return;
    }
    struct MHD_Response *response = mhd.create_response_from_buffer(size, bytes, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(bytes);
    http_reply_set(r, code, type, response);
}

void http_reply_file(http_reply *r, int code, const char *type, int file, size_t size)
{
    struct MHD_Response *response = mhd.create_response_from_fd(size, file);
    if (!response)
        close(file);
    http_reply_set(r, code, type, response);
}

void http_reply_release(http_reply *r)
{
    if (r->response)
        mhd.destroy_response(r->response);
    r->response = NULL;
    for (; r->header_count > 0; r->header_count--) {
        free(r->header_name[r->header_count - 1]);
        free(r->header_value[r->header_count - 1]);
    }
}

enum MHD_Result http_reply_send(http_reply *r)
{
    if (!r->response)
        http_reply_error(r, 500, r->code ? "no memory for the reply" : "the handler set no reply",
                         r->code ? "try again later" : "report this as a bug, with the request");
    if (!r->response)
        return MHD_NO;
    bool complete = true;
    for (size_t i = 0; i < sizeof on_every_reply / sizeof *on_every_reply; i++)
        complete &= mhd.add_response_header(r->response, on_every_reply[i][0], on_every_reply[i][1]) == MHD_YES;
    for (int i = 0; i < r->header_count; i++)
        complete &= mhd.add_response_header(r->response, r->header_name[i], r->header_value[i]) == MHD_YES;
    /* Send nothing rather than a reply without the security headers. */
    return complete ? mhd.queue_response(r->connection, (unsigned)r->code, r->response) : MHD_NO;
}
