/* Tests of the HTTP server: access checks and their errors, limits of bodies and rates, slow clients. The clients are
 * plain sockets. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "http_fixture.h"
#include "web/lab.h"

enum { BODY_MAX = 10000 };

static void hello(void *context, const http_request *q, http_reply *r)
{
    const char *word = http_query_value(q, "word");
    http_reply_header(r, "X-Word", "one\r\nX-Evil: two");
    http_reply_header(r, "X-Good", "three");
    http_reply_json(r, 200,
                    json_pack("{s:s, s:s, s:s}", "hello", context, "word", word ? word : "(none)", "path", q->path));
}

static void part(void *context, const http_request *q, http_reply *r)
{
    (void)context;
    assert_null(http_path_value(q, "nam"));
    http_reply_json(
        r, 200, json_pack("{s:s, s:s}", "name", http_path_value(q, "name"), "member", http_path_value(q, "member")));
}

static void number(void *context, const http_request *q, http_reply *r)
{
    (void)context;
    json_t *value = http_body_json(q, r);
    if (value)
        http_reply_json(r, 200, value);
}

static void nothing(void *context, const http_request *q, http_reply *r)
{
    (void)context, (void)q, (void)r;
}

static void slow(void *context, const http_request *q, http_reply *r)
{
    usleep(2500000);
    hello(context, q, r);
}

static const http_route routes[] = {
    {"GET", "/hello", hello, (void *)"you"},
    {"POST", "/echo", echo, NULL},
    {"GET", "/of/{name}/all/{member}", part, NULL},
    {"PUT", "/number", number, NULL},
    {"DELETE", "/number", number, NULL},
    {"GET", "/nothing", nothing, NULL},
    {"GET", "/slow", slow, (void *)"sleeper"},
};

static http_server *start(http_settings s)
{
    http_server *server;
    s.routes = routes;
    s.route_count = sizeof routes / sizeof *routes;
    s.files = page_files;
    s.file_count = page_file_count;
    s.body_max = BODY_MAX;
    assert_int_equal(http_start(&s, &server, NULL), STATUS_OK);
    return server;
}

static int set_up(void **state)
{
    *state = start((http_settings){0});
    return 0;
}

static int tear_down(void **state)
{
    http_stop(*state);
    return 0;
}

/* Sends a request and checks the code of the reply. */
static void expect(const http_server *s, int code, const char *method, const char *target, const char *heads,
                   const char *body)
{
    char *reply = client_ask(s, method, target, heads, body);
    if (reply_code(reply) != code)
        fail_msg("%s %s replied %.200s, expected %d", method, target, reply, code);
    free(reply);
}

static void expect_as(const http_server *s, int code, const char *method, const char *target, char *heads)
{
    char *reply = client_ask_as(http_port(s), method, target, heads, NULL);
    if (reply_code(reply) != code)
        fail_msg("%s with %s replied %.200s, expected %d", target, heads, reply, code);
    free(reply);
    free(heads);
}

static void only_the_token_grants_access(void **state)
{
    const http_server *s = *state;
    const int port = http_port(s);
    char wrong[33];
    strcpy(wrong, http_token(s));
    assert_int_equal(strspn(wrong, "0123456789abcdef"), 32);
    wrong[31] = wrong[31] == '0' ? '1' : '0';
    expect_as(s, 401, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\n", port));
    expect_as(s, 401, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n", port, wrong));
    expect_as(s, 401, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nAuthorization: Bearer %s0\r\n", port, http_token(s)));
    expect_as(s, 401, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nAuthorization: Bearer %.31s\r\n", port, http_token(s)));
    expect_as(s, 401, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\nAuthorization: Bearer \r\n", port));
    expect_as(s, 401, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nAuthorization: Basic %s\r\n", port, http_token(s)));
    expect_as(s, 401, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nCookie: cuvette_%d=%s\r\n", port, port, wrong));
    expect_as(s, 401, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nCookie: cuvette=%s\r\n", port, http_token(s)));
    expect_as(s, 200, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nCookie: a=b; cuvette_%d=%s\r\n", port, port, http_token(s)));
    expect_as(s, 200, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nAuthorization: bearer %s\r\n", port, http_token(s)));
    char *target = text_format("/hello?token=%s", wrong);
    expect_as(s, 401, "GET", target, text_format("Host: 127.0.0.1:%d\r\n", port));
    free(target);
    target = text_format("/echo?token=%s", http_token(s));
    expect_as(s, 401, "POST", target, text_format("Host: 127.0.0.1:%d\r\nContent-Type: application/json\r\n", port));
    free(target);
}

static void a_token_in_the_address_sets_a_cookie(void **state)
{
    const http_server *s = *state;
    char *target = text_format("/hello?word=a%%20b&token=%s&x", http_token(s)),
         *heads = text_format("Host: localhost:%d\r\n", http_port(s));
    char *reply = client_ask_as(http_port(s), "GET", target, heads, NULL);
    char *cookie =
        text_format("Set-Cookie: cuvette_%d=%s; Path=/; HttpOnly; SameSite=Strict", http_port(s), http_token(s));
    assert_int_equal(reply_code(reply), 303);
    assert_true(reply_has(reply, "Location: /hello?word=a%20b&x"));
    assert_true(reply_has(reply, cookie));
    char *address = text_format("http://127.0.0.1:%d/?token=%s", http_port(s), http_token(s));
    assert_string_equal(http_address(s), address);
    free(address);
    free(cookie);
    free(reply);
    free(heads);
    free(target);
}

/* Chromium withholds a SameSite=Strict cookie after a redirect of a request that another page began. */
static void an_address_opened_by_a_file_is_answered_by_a_page(void **state)
{
    const http_server *s = *state;
    char *target = text_format("/?token=%s", http_token(s)),
         *heads = text_format("Host: 127.0.0.1:%d\r\nSec-Fetch-Site: cross-site\r\n", http_port(s)),
         *cookie =
             text_format("Set-Cookie: cuvette_%d=%s; Path=/; HttpOnly; SameSite=Strict", http_port(s), http_token(s));
    char *reply = client_ask_as(http_port(s), "GET", target, heads, NULL);
    assert_int_equal(reply_code(reply), 200);
    assert_true(reply_has(reply, cookie));
    assert_non_null(strstr(reply_body(reply), "content=\"0; url=/\""));
    assert_null(strstr(reply_body(reply), http_token(s)));
    free(reply);
    free(cookie);
    free(heads);
    free(target);
}

static void foreign_hosts_and_origins_are_refused(void **state)
{
    const http_server *s = *state;
    const int port = http_port(s);
    static const char *const hosts[] = {
        "evil.example", "127.0.0.1", "127.0.0.1.evil.example", "127.0.0.2", "localhost.", "0.0.0.0", "[::2]"};
    char token[64];
    snprintf(token, sizeof token, "Authorization: Bearer %s\r\n", http_token(s));
    for (size_t i = 0; i < sizeof hosts / sizeof *hosts; i++) {
        expect_as(s, 421, "GET", "/hello", text_format("Host: %s\r\n%s", hosts[i], token));
        if (i != 1)
            expect_as(s, 421, "GET", "/hello", text_format("Host: %s:%d\r\n%s", hosts[i], port, token));
    }
    expect_as(s, 421, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\n%s", port ^ 1, token));
    expect_as(s, 400, "GET", "/hello", text_format("%s", token));
    expect_as(s, 400, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\nHost: evil.example\r\n%s", port, token));
    expect_as(s, 200, "GET", "/hello", text_format("Host: LocalHost:%d\r\n%s", port, token));
    expect_as(s, 200, "GET", "/hello", text_format("Host: [::1]:%d\r\n%s", port, token));
    static const char *const origins[] = {"null",
                                          "http://evil.example",
                                          "http://127.0.0.1",
                                          "",
                                          "https://127.0.0.1:%d",
                                          "http://localhost:%d",
                                          "http://127.0.0.1:%d0"};
    for (size_t i = 0; i < sizeof origins / sizeof *origins; i++) {
        char origin[64];
        snprintf(origin, sizeof origin, "%.*s", (int)strcspn(origins[i], "%"), origins[i]);
        if (strchr(origins[i], '%'))
            snprintf(origin + strlen(origin), 16, "%d%s", port, strchr(origins[i], '%') + 2);
        expect_as(s, 403, "GET", "/hello", text_format("Host: 127.0.0.1:%d\r\nOrigin: %s\r\n%s", port, origin, token));
    }
    expect_as(s, 200, "GET", "/hello",
              text_format("Host: 127.0.0.1:%d\r\nOrigin: http://127.0.0.1:%d\r\n%s", port, port, token));
}

static void paths_that_leave_the_root_are_refused(void **state)
{
    static const char *const bad[] = {"/../etc/passwd",
                                      "/%2e%2e/etc/passwd",
                                      "/.%2E/x",
                                      "/a/..",
                                      "/a/%2e",
                                      "/.",
                                      "//evil.example",
                                      "/a//b",
                                      "/%2f",
                                      "/..%2f..%2fetc",
                                      "/a%00",
                                      "/%00",
                                      "/a%",
                                      "/a%2",
                                      "/a%zz",
                                      "/\\evil",
                                      "/%5cevil",
                                      "/a%0d%0aX:y",
                                      "/\x7f",
                                      "/\xc3\xa9",
                                      "*",
                                      "hello",
                                      "http://127.0.0.1/hello"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        expect(*state, 400, "GET", bad[i], "", NULL);
    static const char *const absent[] = {"/nobody",   "/hello/",       "/hell",  "/hello/x",
                                         "/...",      "/%252e%252e/x", "/Hello", "/page/index.html",
                                         "/lab.css/", "/of/a/all/"};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; i++)
        expect(*state, 404, "GET", absent[i], "", NULL);
    char nul[256];
    const int size = snprintf(
        nul, sizeof nul,
        "GET /hello%cx HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nConnection: close\r\nAuthorization: Bearer %s\r\n\r\n", 0,
        http_port(*state), http_token(*state));
    char *reply = client_raw(http_port(*state), nul, (size_t)size);
    /* libmicrohttpd 0.9 ends the request line there, and so do the server's checks; 1.0 closes the connection. */
    assert_true(!*reply || reply_code(reply) == 400 || strstr(reply_body(reply), "\"path\":\"/hello\""));
    free(reply);
    expect(*state, 200, "GET", "/hello", "", NULL);
}

static void routes_receive_decoded_values(void **state)
{
    char *reply = client_ask(*state, "GET", "/of/a%20b/all/..c?x=1", "", NULL);
    assert_string_equal(reply_body(reply), "{\"name\":\"a b\",\"member\":\"..c\"}");
    free(reply);
    reply = client_ask(*state, "GET", "/h%65llo?word=%c3%a9%26+x&y", "", NULL);
    assert_string_equal(reply_body(reply), "{\"hello\":\"you\",\"word\":\"\xc3\xa9& x\",\"path\":\"/hello\"}");
    assert_true(reply_has(reply, "X-Good: three"));
    assert_null(strstr(reply, "X-Evil"));
    free(reply);
    expect(*state, 500, "GET", "/nothing", "", NULL);
}

static void a_wrong_method_is_refused_with_the_allowed_ones(void **state)
{
    char *reply = client_ask(*state, "PATCH", "/number", "Content-Type: application/json\r\n", "1");
    assert_int_equal(reply_code(reply), 405);
    assert_true(reply_has(reply, "Allow: PUT, DELETE"));
    free(reply);
    reply = client_ask(*state, "POST", "/", "Content-Type: application/json\r\n", "1");
    assert_int_equal(reply_code(reply), 405);
    assert_true(reply_has(reply, "Allow: GET, HEAD"));
    free(reply);
    reply = client_ask(*state, "HEAD", "/hello", "", NULL);
    assert_int_equal(reply_code(reply), 200);
    assert_string_equal(reply_body(reply), "");
    free(reply);
    expect(*state, 405, "OPTIONS", "/hello", "", NULL);
}

static void every_reply_has_security_headers(void **state)
{
    static const struct {
        const char *method, *target, *heads;
    } requests[] = {
        {"GET", "/", ""},
        {"GET", "/hello", ""},
        {"GET", "/../x", ""},
        {"GET", "/none", ""},
        {"GET", "/hello", "Origin: null\r\n"},
        {"GET", "/hello", "Host: x\r\n"},
        {"PUT", "/number", ""},
        {"POST", "/hello", ""},
        {"GET", "/nothing", ""},
    };
    static const char *const lines[] = {("Content-Security-Policy: default-src 'none'; script-src 'self'; style-src "
                                         "'self'; img-src 'self' blob: data:; media-src blob:; connect-src 'self'; "
                                         "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"),
                                        "X-Content-Type-Options: nosniff",
                                        "Referrer-Policy: no-referrer",
                                        "Cache-Control: no-store",
                                        "Cross-Origin-Opener-Policy: same-origin",
                                        "Cross-Origin-Resource-Policy: same-origin"};
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        char *reply = client_ask(*state, requests[i].method, requests[i].target, requests[i].heads, NULL);
        for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
            assert_true(reply_has(reply, lines[k]));
        if (reply_code(reply) >= 400) { /* with an error and a remedy */
            json_t *error = json_loads(reply_body(reply), 0, NULL);
            assert_non_null(json_string_value(json_object_get(error, "error")));
            assert_non_null(json_string_value(json_object_get(error, "remedy")));
            json_decref(error);
        }
        free(reply);
    }
}

/* A frame gets a cookie that browsers accept from another site; other requests get the usual one. */
static void chosen_sites_may_frame_the_page(void **state)
{
    (void)state;
    static const char *const origins[] = {"https://lms.example", "http://localhost:8080"};
    static const char *const wrong[] = {"",
                                        "lms.example",
                                        "https://",
                                        "https://lms.example/",
                                        "https://lms.example:0x",
                                        "https://lms.example:70000",
                                        "https://*",
                                        "https://a b",
                                        "https://a;script-src",
                                        "https://A.example",
                                        "https://[::1",
                                        "data:x"};
    static const char frame[] = "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Dest: iframe\r\n";
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        http_server *none;
        const http_settings settings = {.frame_origins = wrong + i, .frame_origin_count = 1};
        assert_false(http_is_origin(wrong[i]));
        assert_int_equal(http_start(&settings, &none, NULL), STATUS_BAD_INPUT);
    }
    assert_true(http_is_origin("https://lms.example:8000"));
    assert_false(http_is_origin("https://[::1]:8000"));
    http_server *s = start((http_settings){.frame_origins = origins, .frame_origin_count = 2});
    char *target = text_format("/?embed=1&token=%s", http_token(s));
    for (int framed = 0; framed < 2; framed++) {
        char *heads = text_format("Host: 127.0.0.1:%d\r\n%s", http_port(s), framed ? frame : "");
        char *reply = client_ask_as(http_port(s), "GET", target, heads, NULL);
        free(heads);
        assert_int_equal(reply_code(reply), 303);
        assert_true(reply_has(reply, "Location: /?embed=1"));
        assert_non_null(strstr(reply, "; frame-ancestors https://lms.example http://localhost:8080\r\n"));
        assert_non_null(strstr(reply, framed ? "; HttpOnly; SameSite=None; Secure; Partitioned\r\n"
                                             : "; HttpOnly; SameSite=Strict\r\n"));
        free(reply);
    }
    free(target);
    http_stop(s);
}

static void the_page_is_embedded(void **state)
{
    for (size_t i = 0; i < page_file_count; i++) {
        static char bytes[1 << 20];
        char *path = text_format("src/web/page/%s", page_files[i].name);
        FILE *stream = fopen(path, "rb");
        assert_non_null(stream);
        const size_t size = fread(bytes, 1, sizeof bytes, stream);
        fclose(stream);
        assert_int_equal(page_files[i].size, size);
        assert_memory_equal(page_files[i].bytes, bytes, size);
        free(path);
    }
    char *named = client_ask(*state, "GET", "/index.html", "", NULL), *bare = client_ask(*state, "GET", "/", "", NULL);
    assert_true(reply_has(bare, "Content-Type: text/html; charset=utf-8"));
    assert_non_null(strstr(reply_body(bare), "<title>Cuvette</title>"));
    assert_string_equal(reply_body(bare), reply_body(named));
    free(bare);
    free(named);
    char *style = client_ask(*state, "GET", "/lab.css", "", NULL);
    assert_true(reply_has(style, "Content-Type: text/css; charset=utf-8"));
    free(style);
}

static void changes_require_json(void **state)
{
    expect(*state, 415, "PUT", "/number", "", "1");
    expect(*state, 415, "PUT", "/number", "Content-Type: text/plain\r\n", "1");
    expect(*state, 415, "PUT", "/number", "Content-Type: application/jsonp\r\n", "1");
    expect(*state, 415, "DELETE", "/number", "", NULL);
    expect(*state, 200, "PUT", "/number", "Content-Type: application/json\r\n", "1");
    expect(*state, 200, "PUT", "/number", "Content-Type: Application/JSON; charset=utf-8\r\n", "{\"a\":[1]}");
    expect(*state, 400, "PUT", "/number", "Content-Type: application/json\r\n", "{\"a\":1,\"a\":2}");
    expect(*state, 400, "PUT", "/number", "Content-Type: application/json\r\n", NULL);
    char *reply = client_ask(*state, "PUT", "/number", "Content-Type: application/json\r\n", "[1,\n 2,,]");
    assert_int_equal(reply_code(reply), 400);
    assert_non_null(strstr(reply_body(reply), "\"line\":2,\"column\":4"));
    free(reply);
}

/* Sends chunks of 1000 bytes and a last one with the rest. */
static char *ask_in_chunks(const http_server *s, size_t size)
{
    const size_t room = size + 16 * (size / 1000 + 2);
    char *chunks = malloc(room), *end = chunks;
    for (size_t left = size; left; left -= left < 1000 ? left : 1000) {
        const size_t piece = left < 1000 ? left : 1000;
        end += sprintf(end, "%zx\r\n", piece);
        memset(end, 'x', piece);
        end = stpcpy(end + piece, "\r\n");
    }
    stpcpy(end, "0\r\n\r\n");
    char *request =
        text_format("POST /echo HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\nConnection: close\r\n"
                    "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n%s",
                    http_port(s), http_token(s), chunks);
    char *reply = client_raw(http_port(s), request, strlen(request));
    free(request);
    free(chunks);
    return reply;
}

static void bodies_are_limited_in_size(void **state)
{
    char body[2 * BODY_MAX + 1];
    memset(body, 'x', sizeof body);
    body[2 * BODY_MAX] = 0;
    expect(*state, 413, "POST", "/echo", "Content-Type: application/json\r\n", body);
    body[BODY_MAX + 1] = 0;
    expect(*state, 413, "POST", "/echo", "Content-Type: application/json\r\n", body);
    body[BODY_MAX] = 0;
    char *reply = client_ask(*state, "POST", "/echo", "Content-Type: application/json\r\n", body);
    assert_int_equal(reply_code(reply), 200);
    assert_string_equal(reply_body(reply), body);
    free(reply);
    reply = ask_in_chunks(*state, BODY_MAX);
    assert_int_equal(reply_code(reply), 200);
    assert_string_equal(reply_body(reply), body);
    free(reply);
    reply = ask_in_chunks(*state, BODY_MAX + 1);
    assert_int_equal(reply_code(reply), 413);
    free(reply);
    free(ask_in_chunks(*state, 20 * BODY_MAX)); /* the connection is closed, the server keeps running */
    reply =
        client_ask(*state, "POST", "/echo", "Content-Type: application/json\r\nContent-Length: 99999999999\r\n", NULL);
    assert_int_equal(reply_code(reply), 413);
    free(reply);
    expect(*state, 200, "POST", "/echo", "Content-Type: application/json\r\n", "");
}

/* A request whose body has two lengths can hide another request behind it from a proxy (RFC 9112, 11.2). */
static void a_body_has_one_length(void **state)
{
    const http_server *s = *state;
    const struct {
        int code;
        const char *heads;
    } cases[] = {
        {200, "Content-Length: 5\r\n"},
        {200, "Content-Length: 5\r\nContent-Length: 5\r\n"},
        {400, "Content-Length: 5\r\nContent-Length: 6\r\n"},
        {400, "Content-Length: 6\r\nContent-Length: 5\r\n"},
        {400, "Content-Length: 5\r\ncontent-length: 0\r\n"},
        {400, "Content-Length: 5, 5\r\n"},
        {400, "Content-Length: +5\r\n"},
        {400, "Content-Length: 5x\r\n"},
        {400, "Content-Length: -5\r\n"},
        {400, "Content-Length: \r\n"},
        {400, "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n"},
        {400, "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *request = text_format("POST /echo HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n"
                                    "Connection: close\r\nContent-Type: application/json\r\n%s\r\nhello",
                                    http_port(s), http_token(s), cases[i].heads);
        char *reply = client_raw(http_port(s), request, strlen(request));
        if (reply_code(reply) != cases[i].code)
            fail_msg("a body with %s replied %.200s, expected %d", cases[i].heads, reply, cases[i].code);
        free(reply);
        free(request);
    }
}

static void a_connection_serves_a_thousand_requests(void **state)
{
    const http_server *s = *state;
    char *request = text_format("GET /hello HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(s), http_token(s));
    const int fd = client_connect(http_port(s));
    for (int i = 0; i < 1000; i++) {
        char reply[4096] = "";
        size_t size = 0;
        assert_true(client_send(fd, request, strlen(request)));
        while (!strstr(reply, "\"/hello\"}")) {
            const ssize_t got = recv(fd, reply + size, sizeof reply - 1 - size, 0);
            assert_true(got > 0);
            reply[size += (size_t)got] = 0;
        }
        assert_int_equal(reply_code(reply), 200);
    }
    close(fd);
    free(request);
    for (int i = 0; i < 200; i++)
        expect(s, 200, "GET", "/hello", "", NULL);
}

static void the_request_rate_is_limited(void **state)
{
    (void)state;
    http_server *s = start((http_settings){.requests_per_s = 1});
    int many = 0;
    for (int i = 0; i < 500 && !many; i++) { /* clients without the token do not slow down the others */
        char *heads = text_format("Host: 127.0.0.1:%d\r\n", http_port(s)),
             *reply = client_ask_as(http_port(s), "GET", "/hello", heads, NULL);
        many += reply_code(reply) == 429;
        free(reply);
        free(heads);
    }
    assert_int_equal(many, 1);
    expect(s, 200, "GET", "/hello", "", NULL);
    many = 0;
    for (int i = 0; i < 500 && !many; i++) {
        char *reply = client_ask(s, "GET", "/hello", "", NULL);
        many += reply_code(reply) == 429 && reply_has(reply, "Retry-After: 1");
        free(reply);
    }
    assert_int_equal(many, 1);
    http_stop(s);
}

static void slow_clients_are_disconnected(void **state)
{
    (void)state;
    http_server *s = start((http_settings){.timeout_s = 1});
    const char *const halves[] = {"", "GET", "GET /hello HTTP/1.1\r\nHost: 127", "GET /hello HTTP/1.1\r\n",
                                  "POST /echo HTTP/1.1\r\nContent-Length: 10\r\n\r\nabc"};
    int fd[5];
    for (int i = 0; i < 5; i++)
        client_send(fd[i] = client_connect(http_port(s)), halves[i], strlen(halves[i]));
    const int dribble = client_connect(http_port(s));
    client_send(dribble, "GET /", 5);
    int sent = 0;
    while (client_send(dribble, "a", 1) && sent++ < 30000) /* active all the time, but fills its 32 KiB in an hour */
        usleep(100000);
    assert_true(sent < 30000);
    close(dribble);
    for (int i = 0; i < 5; i++) {
        char byte;
        while (recv(fd[i], &byte, 1, 0) > 0)
            continue;
        close(fd[i]);
    }
    expect(s, 200, "GET", "/slow", "", NULL); /* a handler may take longer than a client */
    http_stop(s);
}

static void strangers_do_not_lock_the_owner_out(void **state)
{
    (void)state;
    enum { STRANGERS = 128 };
    int fd[STRANGERS];
    http_server *s = start((http_settings){.connections = 128, .timeout_s = 10000});
    const char line[] = "GET /hello HTTP/1.1\r\n";
    for (int i = 0; i < STRANGERS; i++) {
        fd[i] = client_connect(http_port(s));
        client_send(fd[i], line, i % 2 ? strlen(line) : 0);
    }
    for (int i = 0; i < 10; i++)
        expect(s, 200, "GET", "/hello", "", NULL);
    for (int i = 0; i < STRANGERS; i++)
        close(fd[i]);
    http_stop(s);
}

/* The connection of somebody with the token stays, whoever else comes. */
static void strangers_do_not_displace_the_owner(void **state)
{
    (void)state;
    enum { STRANGERS = 64 };
    int fd[STRANGERS];
    http_server *s = start((http_settings){.connections = 16, .timeout_s = 10000});
    char *request = text_format("GET /hello HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(s), http_token(s)),
         reply[2048];
    const int mine = client_connect(http_port(s));
    for (int round = 0; round < 2; round++) {
        assert_true(client_send(mine, request, strlen(request)));
        const ssize_t got = recv(mine, reply, sizeof reply - 1, 0);
        assert_true(got > 0);
        reply[got] = 0;
        assert_int_equal(reply_code(reply), 200);
        for (int i = 0; i < STRANGERS && round == 0; i++)
            fd[i] = client_connect(http_port(s));
    }
    for (int i = 0; i < STRANGERS; i++)
        close(fd[i]);
    close(mine);
    free(request);
    http_stop(s);
}

static void a_port_in_use_is_refused(void **state)
{
    const http_server *s = *state;
    http_server *second;
    diagnostic why = {.what = ""};
    http_settings settings = {.port = http_port(s)};
    assert_int_equal(http_start(&settings, &second, &why), STATUS_BAD_INPUT);
    assert_null(second);
    assert_non_null(strstr(why.what, "cannot listen on port"));
    settings.port = 65536;
    assert_int_equal(http_start(&settings, &second, &why), STATUS_BAD_INPUT);
    settings = (http_settings){.connections = 2000};
    assert_int_equal(http_start(&settings, &second, &why), STATUS_BAD_INPUT);
    http_server *other = start((http_settings){0});
    assert_string_not_equal(http_token(other), http_token(s));
    const int port = http_port(other);
    expect(other, 200, "GET", "/hello", "", NULL);
    http_stop(other);
    other = start((http_settings){.port = port}); /* the port is free again immediately */
    assert_int_equal(http_port(other), port);
    http_stop(other);
}

int main(void)
{
    const struct CMUnitTest cases[] = {
        cmocka_unit_test(only_the_token_grants_access),
        cmocka_unit_test(a_token_in_the_address_sets_a_cookie),
        cmocka_unit_test(an_address_opened_by_a_file_is_answered_by_a_page),
        cmocka_unit_test(foreign_hosts_and_origins_are_refused),
        cmocka_unit_test(paths_that_leave_the_root_are_refused),
        cmocka_unit_test(routes_receive_decoded_values),
        cmocka_unit_test(a_wrong_method_is_refused_with_the_allowed_ones),
        cmocka_unit_test(every_reply_has_security_headers),
        cmocka_unit_test(chosen_sites_may_frame_the_page),
        cmocka_unit_test(the_page_is_embedded),
        cmocka_unit_test(changes_require_json),
        cmocka_unit_test(bodies_are_limited_in_size),
        cmocka_unit_test(a_body_has_one_length),
        cmocka_unit_test(a_connection_serves_a_thousand_requests),
        cmocka_unit_test(the_request_rate_is_limited),
        cmocka_unit_test(slow_clients_are_disconnected),
        cmocka_unit_test(strangers_do_not_lock_the_owner_out),
        cmocka_unit_test(strangers_do_not_displace_the_owner),
        cmocka_unit_test(a_port_in_use_is_refused),
    };
    return cmocka_run_group_tests_name("http", cases, set_up, tear_down);
}
