/* The contents of replies, as libmicrohttpd sends them: bytes, compressed if that makes them smaller, and files. */
#include "web/http/http_library.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <zlib.h>

/* --- compression (RFC 9110, 8.4.1.3), for pages that reach the laboratory over a slow link, such as ssh --- */

/* Smaller replies gain nothing: they fit into one packet. Level 4: a scene's JSON takes a millisecond and shrinks to a
 * ninth; level 9 would take three times as long for 8 % less. */
enum { SIZE_MIN = 1400, LEVEL = 4, GZIP_WINDOW = 15 + 16 };

/* Whether the client's list of codings has gzip, with a weight other than 0. */
static bool accepts_gzip(struct MHD_Connection *c)
{
    const char *list = mhd.lookup_connection_value(c, MHD_HEADER_KIND, "Accept-Encoding");
    const char *found = list ? strcasestr(list, "gzip") : NULL;
    if (!found)
        return false;
    const char *weight = found + strlen("gzip");
    weight += strspn(weight, " \t");
    if (*weight != ';')
        return true;
    const char *q = strstr(weight, "q=");
    return !q || strtod(q + 2, NULL) > 0.0;
}

static bool is_text(const char *type)
{
    return strncmp(type, "text/", 5) == 0 || strncmp(type, "application/json", 16) == 0 ||
           strncmp(type, "application/yaml", 16) == 0 || strncmp(type, "image/svg+xml", 13) == 0;
}

static void *deflate_all(const void *bytes, size_t size, size_t *packed_size)
{
    z_stream z = {.next_in = (z_const Bytef *)(uintptr_t)bytes, .avail_in = (uInt)size};
    if (size > UINT32_MAX / 2 || deflateInit2(&z, LEVEL, Z_DEFLATED, GZIP_WINDOW, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return NULL;
    const uLong room = deflateBound(&z, (uLong)size);
    void *packed = malloc(room);
    z.next_out = packed;
    z.avail_out = (uInt)room;
    const bool complete = packed && deflate(&z, Z_FINISH) == Z_STREAM_END;
    *packed_size = z.total_out;
    deflateEnd(&z);
    if (complete && *packed_size < size)
        return packed;
    free(packed);
    return NULL;
}

/* The bytes compressed by gzip, in allocated memory; NULL if the client does not accept gzip, the type is not text, the
 * compressed bytes would not be fewer, or memory runs out. */
static void *gzip_bytes(const http_reply *r, const char *type, const void *bytes, size_t size, size_t *packed_size)
{
    const bool worth_it = size >= SIZE_MIN && is_text(type) && r->connection && accepts_gzip(r->connection);
    return worth_it ? deflate_all(bytes, size, packed_size) : NULL;
}

/* --- replies --- */

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

/* Replies with the bytes compressed; false if they cannot or need not be compressed. */
static bool reply_gzip(http_reply *r, int code, const char *type, const void *bytes, size_t size)
{
    size_t packed_size;
    void *packed = gzip_bytes(r, type, bytes, size, &packed_size);
    if (!packed)
        return false;
    struct MHD_Response *response = mhd.create_response_from_buffer(packed_size, packed, MHD_RESPMEM_MUST_FREE);
    if (!response)
        free(packed);
    http_reply_set(r, code, type, response);
    if (r->response && (mhd.add_response_header(response, "Content-Encoding", "gzip") != MHD_YES ||
                        mhd.add_response_header(response, "Vary", "Accept-Encoding") != MHD_YES)) {
        mhd.destroy_response(response);
        r->response = NULL;
    }
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
