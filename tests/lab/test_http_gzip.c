/* Compressed replies of the HTTP server: who gets them, and that they decompress to the plain reply. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "http_fixture.h"
#include <zlib.h>

enum { LONG = 20000 };

/* ?size=N: a JSON string of N letters. */
static void letters(void *context, const http_request *q, http_reply *r)
{
    const char *as = context, *size = http_query_value(q, "size");
    char *text = text_format("\"%*s\"", size ? atoi(size) : LONG, "x");
    http_reply_bytes(r, 200, as, text, strlen(text));
}

static char page[1500]; /* filled by set_up */
static const http_route routes[] = {
    {"GET", "/json", letters, (void *)"application/json"},
    {"GET", "/image", letters, (void *)"image/jpeg"},
};
static const http_file files[] = {{"page.js", "text/javascript", (const unsigned char *)page, sizeof page}};

static int set_up(void **state)
{
    memset(page, '/', sizeof page);
    const http_settings s = {.routes = routes, .route_count = 2, .files = files, .file_count = 1};
    return http_start(&s, (http_server **)state, NULL) == STATUS_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    http_stop(*state);
    return 0;
}

static char *ask(http_server *s, const char *target, const char *accept)
{
    char *heads = accept ? text_format("Accept-Encoding: %s\r\n", accept) : strdup("");
    char *reply = client_ask(s, "GET", target, heads, NULL);
    free(heads);
    assert_int_equal(reply_code(reply), 200);
    return reply;
}

static bool is_compressed(const char *reply)
{
    return strstr(reply, "Content-Encoding: gzip") && strstr(reply, "Vary: Accept-Encoding");
}

/* The body of a compressed reply. */
static char *inflated(const char *reply)
{
    static char text[LONG * 4];
    const char *length = strstr(reply, "Content-Length: ");
    assert_non_null(length);
    z_stream z = {.next_in = (Bytef *)(uintptr_t)reply_body(reply),
                  .avail_in = (uInt)atoi(length + strlen("Content-Length: ")),
                  .next_out = (Bytef *)text,
                  .avail_out = sizeof text - 1};
    assert_int_equal(inflateInit2(&z, 15 + 16), Z_OK);
    assert_int_equal(inflate(&z, Z_FINISH), Z_STREAM_END);
    assert_int_equal(z.avail_in, 0);
    text[z.total_out] = 0;
    inflateEnd(&z);
    return text;
}

static void compressed_replies_hold_the_plain_ones(void **state)
{
    static const char *const targets[] = {"/json", "/json?size=1400", "/page.js"};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        char *plain = ask(*state, targets[i], NULL), *packed = ask(*state, targets[i], "br, gzip");
        assert_false(is_compressed(plain));
        assert_true(is_compressed(packed));
        assert_string_equal(inflated(packed), reply_body(plain));
        free(plain);
        free(packed);
    }
}

static void the_client_decides(void **state)
{
    static const struct {
        const char *accept;
        bool compressed;
    } cases[] = {{"gzip", true},          {"deflate", false},  {"gzip;q=0", false},    {"gzip; q=0.5", true},
                 {"GZip, deflate", true}, {"identity", false}, {"gzip ;q=0.0", false}, {"deflate, gzip", true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *reply = ask(*state, "/json", cases[i].accept);
        if (is_compressed(reply) != cases[i].compressed)
            fail_msg("Accept-Encoding: %s", cases[i].accept);
        free(reply);
    }
}

static void images_and_short_replies_stay_as_they_are(void **state)
{
    static const char *const targets[] = {"/image", "/json?size=1000"};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        char *reply = ask(*state, targets[i], "gzip");
        assert_false(is_compressed(reply));
        free(reply);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compressed_replies_hold_the_plain_ones),
        cmocka_unit_test(the_client_decides),
        cmocka_unit_test(images_and_short_replies_stay_as_they_are),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
