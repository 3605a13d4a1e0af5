/* Compressed replies (RFC 9110, 8.4.1.3), for pages that reach the laboratory over a slow link, such as ssh. */
#include "web/http/http_callbacks.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <zlib.h>

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

static void *compress_whole(const void *bytes, size_t size, size_t *packed_size)
{
    z_stream z = {.next_in = (z_const Bytef *)(uintptr_t)bytes, .avail_in = (uInt)size};
    if (size > UINT32_MAX / 2 || deflateInit2(&z, LEVEL, Z_DEFLATED, GZIP_WINDOW, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return NULL;
    const uLong room = deflateBound(&z, (uLong)size);
    void *packed = malloc(room);
    z.next_out = packed;
    z.avail_out = (uInt)room;
    const bool whole = packed && deflate(&z, Z_FINISH) == Z_STREAM_END;
    *packed_size = z.total_out;
    deflateEnd(&z);
    if (whole && *packed_size < size)
        return packed;
    free(packed);
    return NULL;
}

void *http_gzip(const http_reply *r, const char *type, const void *bytes, size_t size, size_t *packed_size)
{
    const bool worth_it = size >= SIZE_MIN && is_text(type) && r->connection && accepts_gzip(r->connection);
    return worth_it ? compress_whole(bytes, size, packed_size) : NULL;
}
