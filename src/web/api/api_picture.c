/* The picture's part of the API. See web/README.md. */
#include "web/lab_private.h"
#include "base/number.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double final_wait_s = 120.0;

static void add_number(http_reply *r, const char *name, uint64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    http_reply_header(r, name, text);
}

/* Only what cannot be mistaken for the end of the header's text. */
static void name_download(http_reply *r, const char *name)
{
    char text[160], *at = text;
    at += snprintf(text, sizeof text, "attachment; filename=\"");
    for (const char *c = name; *c && at < text + sizeof text - 8; c++)
        *at++ = isalnum((unsigned char)*c) || strchr("._-", *c) ? *c : '_';
    snprintf(at, 2, "\"");
    http_reply_header(r, "Content-Disposition", text);
}

static const picture *take(lab *l, bool final, http_reply *r)
{
    const picture *p = NULL;
    if (!final) {
        p = painter_take(l->painter);
        if (!p)
            http_reply_error(r, 404, "there is no picture yet", "ask with ?wait=1");
        return p;
    }
    diagnostic why = {.line = 0};
    if (painter_take_final(l->painter, final_wait_s, &p, &why) != STATUS_OK)
        http_reply_error(r, 409, why.what, why.remedy);
    return p;
}

/* A reply's own bytes. */
static status encode_own(const picture *p, image_format format, int bits, unsigned char **bytes, size_t *size,
                         diagnostic *why)
{
    if (format != IMAGE_PNG || bits != 8)
        return image_encode(p->linear, format, bits, false, bytes, size, why);
    const unsigned char *shared;
    status code = picture_png(p, &shared, size, why);
    *bytes = code == STATUS_OK ? malloc(*size) : NULL;
    if (*bytes)
        memcpy(*bytes, shared, *size);
    else if (code == STATUS_OK)
        code = out_of_memory(why);
    return code;
}

/* Small ones, as they come while something moves, wait for nobody. */
static status encode(lab *l, const picture *p, image_format format, int bits, unsigned char **bytes, size_t *size,
                     diagnostic *why)
{
    const double small = 1e6; /* pixels */
    if ((double)p->width * p->height <= small)
        return encode_own(p, format, bits, bytes, size, why);
    status code = gate_enter(l->heavy, why);
    if (code != STATUS_OK)
        return code;
    code = encode_own(p, format, bits, bytes, size, why);
    gate_leave(l->heavy);
    return code;
}

static void reply_picture(lab *l, const http_request *q, http_reply *r, image_format format, const char *type)
{
    const char *wait = http_query_value(q, "wait"), *bits_text = http_query_value(q, "bits"),
               *download = http_query_value(q, "download");
    int64_t bits = 8;
    if (bits_text && !(number_parse_int(bits_text, &bits) && (bits == 8 || bits == 16))) {
        http_reply_error(r, 400, "a picture has no such number of bits", "give 8 or 16");
        return;
    }
    const picture *p = take(l, wait && strcmp(wait, "0") != 0, r);
    if (!p)
        return;
    diagnostic why = {.line = 0};
    unsigned char *bytes = NULL;
    size_t size;
    const status code = encode(l, p, format, (int)bits, &bytes, &size, &why);
    if (code == STATUS_OK) {
        http_reply_bytes(r, 200, type, bytes, size);
        add_number(r, "X-Cuvette-Serial", p->serial);
        add_number(r, "X-Cuvette-Generation", p->generation);
        add_number(r, "X-Cuvette-Pass", (uint64_t)p->pass);
        add_number(r, "X-Cuvette-Final", p->final);
        if (download)
            name_download(r, download);
    } else {
        http_reply_diagnostic(r, code, &why);
    }
    picture_release(p);
}

static void get_png(void *of, const http_request *q, http_reply *r)
{
    reply_picture(of, q, r, IMAGE_PNG, "image/png");
}

static void get_jpeg(void *of, const http_request *q, http_reply *r)
{
    reply_picture(of, q, r, IMAGE_JPEG, "image/jpeg");
}

static const http_route routes[] = {
    {"GET", "/api/picture.png", get_png, NULL},
    {"GET", "/api/picture.jpg", get_jpeg, NULL},
};
const lab_routes picture_routes = {routes, sizeof routes / sizeof *routes};
