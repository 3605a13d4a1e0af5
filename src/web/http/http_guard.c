/* The checks of a request: path, host, origin, token and rate. */
#include "measure/clock.h"
#include "web/http/http_library.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static int hex(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c = (char)(c | 0x20);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Whether no part is "." or "..", and no part but the last is empty. */
static bool stays_below(const char *path)
{
    for (const char *part = path; *part == '/';) {
        const size_t length = strcspn(++part, "/");
        if ((length == 0 && part[0] == '/') || (length == 1 && part[0] == '.') ||
            (length == 2 && part[0] == '.' && part[1] == '.'))
            return false;
        part += length;
    }
    return true;
}

/* The decoded path of a target. NULL if it leads upwards or is malformed, or, with *no_memory set, when out of
 * memory. */
static char *safe_path(const char *target, bool *no_memory)
{
    *no_memory = false;
    if (target[0] != '/')
        return NULL;
    char *path = malloc(strlen(target) + 1), *end = path;
    if (!path) {
        *no_memory = true;
        return NULL;
    }
    for (const char *c = target; *c && *c != '?'; c++) {
        int byte = (unsigned char)*c;
        if (byte == '%') {
            const int high = hex(c[1]), low = high < 0 ? -1 : hex(c[2]);
            byte = low < 0 ? 0 : 16 * high + low;
            /* 0 is refused below; a decoded %2f would become a separator for later code. */
            byte = byte == '/' ? 0 : byte;
            c += low < 0 ? 0 : 2;
        } else if (byte >= 0x7f || byte == '#') {
            byte = 0;
        }
        if (byte < 0x20 || byte == 0x7f || byte == '\\') {
            free(path);
            return NULL;
        }
        *end++ = (char)byte;
    }
    *end = 0;
    if (stays_below(path))
        return path;
    free(path);
    return NULL;
}

/* Compares in constant time for texts of the token's length. */
static bool same_token(const char *token, const char *given)
{
    if (!given || strlen(given) != HTTP_TOKEN_DIGITS)
        return false;
    volatile unsigned char difference = 0;
    for (int i = 0; i < HTTP_TOKEN_DIGITS; i++)
        difference = (unsigned char)(difference | (token[i] ^ given[i]));
    return difference == 0;
}

/* The target without its token; NULL when out of memory. */
static char *clean_target(const char *target)
{
    char *clean = malloc(strlen(target) + 1);
    if (!clean)
        return NULL;
    const size_t path = strcspn(target, "?");
    memcpy(clean, target, path);
    char *end = clean + path, mark = '?';
    for (const char *part = target + path; *part;) {
        const size_t length = strcspn(++part, "&");
        if (length && strncmp(part, "token=", 6) != 0) {
            *end++ = mark;
            memcpy(end, part, length);
            end += length;
            mark = '&';
        }
        part += length;
    }
    *end = 0;
    return clean;
}

/* Whether the host is a loopback name with our port. */
static bool is_local_host(const http_server *s, const char *host)
{
    static const char *const names[] = {"127.0.0.1", "localhost", "[::1]"};
    for (int i = 0; i < 3; i++) {
        char ours[32];
        snprintf(ours, sizeof ours, "%s:%d", names[i], s->port);
        if (strcasecmp(host, ours) == 0 || (s->port == 80 && strcasecmp(host, names[i]) == 0))
            return true;
    }
    return false;
}

typedef struct site_headers {
    int hosts, origins, encodings;
    const char *host, *origin, *length;
    bool lengths_differ;
} site_headers;

static enum MHD_Result collect_header(void *context, enum MHD_ValueKind kind, const char *name, const char *given)
{
    (void)kind;
    site_headers *h = context;
    const char *value = given ? given : "";
    if (strcasecmp(name, "Host") == 0) {
        h->hosts++;
        h->host = value;
    } else if (strcasecmp(name, "Origin") == 0) {
        h->origins++;
        h->origin = value;
    } else if (strcasecmp(name, "Transfer-Encoding") == 0) {
        h->encodings++;
    } else if (strcasecmp(name, "Content-Length") == 0) {
        h->lengths_differ |= h->length && strcmp(h->length, value) != 0;
        h->length = value;
    }
    return MHD_YES;
}

/* Whether the body has one length, so that a proxy and this server agree where the next request begins (RFC 9112, 6.1
 * and 6.3). */
static bool has_one_length(const site_headers *h)
{
    if (!h->length)
        return h->encodings <= 1;
    return !h->lengths_differ && h->encodings == 0 && h->length[0] && !h->length[strspn(h->length, "0123456789")];
}

static bool within_rate(http_server *s, bool known)
{
    const double rate = s->settings.requests_per_s, room = rate > 1 ? rate : 1, now_s = clock_wall_s();
    pthread_mutex_lock(&s->bucket_lock);
    http_bucket *b = known ? &s->known : &s->unknown;
    const double filled = b->filled_s > 0 ? b->left + (now_s - b->filled_s) * rate : room;
    b->left = filled < room ? filled : room;
    b->filled_s = now_s;
    const bool allowed = b->left >= 1;
    if (allowed)
        b->left -= 1;
    pthread_mutex_unlock(&s->bucket_lock);
    return allowed;
}

static int refuse(http_request *q, int code, const char *what, const char *remedy)
{
    http_reply_error(&q->reply, code, what, remedy);
    return code;
}

/* Whether another site opened the address, such as the local file that cuvette lab opens in the browser. The browser
 * would withhold the cookie after a redirect from there; it sends the cookie if a page of this server opens "/". */
static bool comes_from_another_page(const http_request *q)
{
    const char *site = mhd.lookup_connection_value(q->connection, MHD_HEADER_KIND, "Sec-Fetch-Site");
    return site && strcmp(site, "cross-site") == 0;
}

/* Whether the browser loads the page into a frame of a page that may show it. The content policy stops other frames. */
static bool is_framed(const http_request *q)
{
    const char *place = mhd.lookup_connection_value(q->connection, MHD_HEADER_KIND, "Sec-Fetch-Dest");
    return q->server->settings.frame_origin_count && place && strcmp(place, "iframe") == 0;
}

/* Whether another site's page requests something other than to show this page; a frame's cookie does not stop it. */
static bool is_taken_from_outside(const http_request *q)
{
    const char *place = mhd.lookup_connection_value(q->connection, MHD_HEADER_KIND, "Sec-Fetch-Dest");
    return comes_from_another_page(q) && place && strcmp(place, "document") != 0 && strcmp(place, "iframe") != 0;
}

static const char reload_page[] = "<!DOCTYPE html><meta charset=\"utf-8\"><title>Cuvette</title>"
                                  "<meta http-equiv=\"refresh\" content=\"0; url=/\">";

/* Answers the first request: stores the token in a cookie that no script can read and removes it from the address. */
static int set_token_cookie(http_request *q)
{
    char *clean = clean_target(q->target), cookie[128];
    const bool framed = is_framed(q);
    const int code = comes_from_another_page(q) && !framed ? 200 : 303;
    snprintf(cookie, sizeof cookie, "%s=%s; Path=/; HttpOnly; SameSite=%s", q->server->cookie, q->server->token,
             framed ? "None; Secure; Partitioned" : "Strict");
    if (code == 200) {
        http_reply_static(&q->reply, code, "text/html; charset=utf-8", reload_page, sizeof reload_page - 1);
    } else {
        http_reply_static(&q->reply, code, "text/plain; charset=utf-8", "", 0);
        http_reply_header(&q->reply, "Location", clean ? clean : "/");
    }
    http_reply_header(&q->reply, "Set-Cookie", cookie);
    free(clean);
    return code;
}

static bool has_token(const http_request *q)
{
    const char *bearer = mhd.lookup_connection_value(q->connection, MHD_HEADER_KIND, "Authorization");
    if (bearer && strncasecmp(bearer, "Bearer ", 7) == 0 && same_token(q->server->token, bearer + 7))
        return true;
    return same_token(q->server->token, mhd.lookup_connection_value(q->connection, MHD_COOKIE_KIND, q->server->cookie));
}

/* Checks version, path, host and origin, against requests that another site's page could cause. */
static int guard_site(http_request *q, const char *version)
{
    site_headers h = {0};
    bool no_memory;
    mhd.get_connection_values(q->connection, MHD_HEADER_KIND, collect_header, &h);
    if (strcmp(version, "HTTP/1.1") != 0 && strcmp(version, "HTTP/1.0") != 0)
        return refuse(q, 400, "this is not HTTP/1.1", "send HTTP/1.1");
    q->path = safe_path(q->target, &no_memory);
    if (no_memory)
        return refuse(q, 500, "out of memory for the request", "try again later");
    if (!q->path)
        return refuse(q, 400, "the path contains '..' or invalid characters", "use a path as in the page's links");
    q->length_unclear = !has_one_length(&h);
    if (q->length_unclear) {
        http_reply_header(&q->reply, "Connection", "close");
        return refuse(q, 400, "the length of the body is not clear",
                      "send one Content-Length, in digits, or one Transfer-Encoding");
    }
    if (h.hosts != 1 || h.origins > 1)
        return refuse(q, 400, "exactly one Host and at most one Origin are required",
                      "send the header Host once, and Origin at most once");
    if (!is_local_host(q->server, h.host))
        return refuse(q, 421, "unknown host name", "use the address that the program printed");
    if (is_taken_from_outside(q))
        return refuse(q, 403, "the request comes from another site's page", "use this server's own page");
    if (h.origin && (strncmp(h.origin, "http://", 7) != 0 || strcasecmp(h.origin + 7, h.host) != 0))
        return refuse(q, 403, "the request comes from another site's page", "use this server's own page");
    return 0;
}

int http_guard(http_request *q, const char *version)
{
    const int code = guard_site(q, version);
    if (code)
        return code;
    const char *query_token = strcmp(q->method, "GET") == 0
                                  ? mhd.lookup_connection_value(q->connection, MHD_GET_ARGUMENT_KIND, "token")
                                  : NULL;
    const bool in_address = same_token(q->server->token, query_token), known = in_address || has_token(q);
    if (!within_rate(q->server, known)) {
        http_reply_header(&q->reply, "Retry-After", "1");
        return refuse(q, 429, "too many requests", "try again in a second");
    }
    if (!known) {
        http_reply_header(&q->reply, "WWW-Authenticate", "Bearer");
        return refuse(q, 401, "the token is missing or wrong",
                      "open the address that the program printed, with its token");
    }
    http_watch_known(q->server, q->connection);
    return in_address ? set_token_cookie(q) : 0;
}
