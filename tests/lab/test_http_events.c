/* Tests of event streams: the limit on their number, delivery, slow clients, clients that disconnect, and a server that
 * stops while streams are open; and of requests with random bytes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "http_fixture.h"
#include "random_stream.h"

static const http_route routes[] = {
    {"GET", "/events", http_events, NULL}, {"POST", "/a/{b}", echo, NULL}, {"GET", "/a/{b}", echo, NULL}};

static http_server *start(http_settings s)
{
    http_server *server;
    s.routes = routes;
    s.route_count = 3;
    assert_int_equal(http_start(&s, &server, NULL), STATUS_OK);
    return server;
}

/* Opens the stream and reads the header of the reply. */
static int listen_to(const http_server *s, int *code)
{
    const int fd = client_connect(http_port(s));
    char *request = text_format("GET /events HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(s), http_token(s));
    client_send(fd, request, strlen(request));
    free(request);
    char head[4096] = "";
    for (size_t size = 0; !strstr(head, "\r\n\r\n") && size < sizeof head - 1; size++)
        if (recv(fd, head + size, 1, 0) != 1)
            break;
    *code = reply_code(head);
    if (*code == 200)
        assert_true(reply_has(head, "Content-Type: text/event-stream"));
    return fd;
}

/* Reads up to the end of that text; false if the stream ends before. */
static bool read_until(int fd, const char *end)
{
    enum { BLOCK = 65536, KEEP = 256 };
    static char block[KEEP + BLOCK]; /* the last bytes read before, and the new ones */
    const size_t length = strlen(end);
    size_t overlap = 0;
    assert_true(length <= KEEP);
    for (ssize_t got; (got = recv(fd, block + overlap, BLOCK, MSG_PEEK)) > 0;) {
        const char *at = memmem(block, overlap + (size_t)got, end, length);
        const size_t here = at ? (size_t)(at + length - block) - overlap : (size_t)got;
        assert_int_equal(recv(fd, block + overlap, here, MSG_WAITALL), here);
        if (at)
            return true;
        const size_t all = overlap + here;
        overlap = all < length - 1 ? all : length - 1;
        memmove(block, block + all - overlap, overlap);
    }
    return false;
}

static void publish(http_server *s, const char *event, json_t *value)
{
    assert_int_equal(http_publish(s, event, value, NULL), STATUS_OK);
    json_decref(value);
}

static void wait_for_clients(http_server *s, int count)
{
    while (http_event_clients(s) != count)
        usleep(10000);
}

static void all_listeners_get_events(void **state)
{
    (void)state;
    http_server *s = start((http_settings){0});
    int fd[40], refused = 0;
    for (int i = 0; i < 40; i++) {
        int code;
        fd[i] = listen_to(s, &code);
        assert_int_equal(code, i < 32 ? 200 : 503);
        refused += code == 503;
    }
    assert_int_equal(refused, 8);
    publish(s, "tick", json_pack("{s:i, s:s}", "n", 7, "text", "a\nb"));
    for (int i = 0; i < 32; i++)
        assert_true(read_until(fd[i], "event: tick\ndata: {\"n\":7,\"text\":\"a\\nb\"}\n\n"));
    for (int i = 30; i < 40; i++)
        close(fd[i]);
    wait_for_clients(s, 30); /* the server notices that they left without an event */
    int code, late = listen_to(s, &code);
    assert_int_equal(code, 200);
    publish(s, "tock", json_integer(8));
    assert_true(read_until(late, "event: tock\ndata: 8\n\n"));
    for (int i = 0; i < 30; i++)
        assert_true(read_until(fd[i], "event: tock\ndata: 8\n\n"));
    json_t *null = json_null();
    assert_int_equal(http_publish(s, "a\nb", null, NULL), STATUS_BAD_INPUT);
    assert_int_equal(http_publish(s, "", null, NULL), STATUS_BAD_INPUT);
    http_stop(s);
    for (int i = 0; i < 30; i++) {
        assert_false(read_until(fd[i], "event"));
        close(fd[i]);
    }
    close(late);
}

static void slow_listeners_get_the_last_state(void **state)
{
    (void)state;
    enum { EVENTS = 250, SIZE = 65536 };
    http_server *s = start((http_settings){0});
    int code;
    const int slow = listen_to(s, &code), fast = listen_to(s, &code);
    const int little = 65536; /* a fixed size, which the system does not enlarge */
    setsockopt(slow, SOL_SOCKET, SO_RCVBUF, &little, sizeof little);
    char *filling = malloc(SIZE + 1), end[64];
    memset(filling, 'x', SIZE);
    filling[SIZE] = 0;
    /* 16 MB, more than the sockets' buffers. The fast client reads each event before the next is sent; the slow one
     * reads nothing. */
    for (int i = 0; i < EVENTS; i++) {
        publish(s, "state", json_pack("[i, s, i]", i, filling, i));
        snprintf(end, sizeof end, "x\",%d]\n\n", i);
        assert_true(read_until(fast, end));
    }
    publish(s, "other", json_pack("[i]", EVENTS));
    shutdown(fast, SHUT_RDWR);
    wait_for_clients(s, 1);
    /* When the slow client finally reads, it gets the event being sent, then the last state and the other event. */
    snprintf(end, sizeof end, "data: [%d]\n\n", EVENTS);
    char *text = NULL;
    size_t size = 0, room = 0;
    do {
        if (room - size < 65536)
            text = realloc(text, room = 2 * room + 131072);
        const ssize_t got = recv(slow, text + size, room - size - 1, 0);
        assert_true(got > 0);
        size += (size_t)got;
        text[size] = 0;
    } while (!strstr(size > 4096 ? text + size - 4096 : text, end));
    int count = 0, last = -1, before = -1, on_its_way = -1;
    for (const char *at = text; (at = strstr(at, "data: [")); at++, count++) {
        on_its_way = before;
        before = last;
        last = atoi(at + 7);
        assert_true(last > before);
    }
    assert_int_equal(last, EVENTS);
    assert_int_equal(before, EVENTS - 1);
    assert_true(on_its_way < EVENTS - 2 && count < EVENTS);
    free(text);
    free(filling);
    http_stop(s);
    close(slow);
    close(fast);
}

static void many_event_names_do_not_fill_memory(void **state)
{
    (void)state;
    http_server *s = start((http_settings){0});
    int code;
    const int fd = listen_to(s, &code);
    for (int i = 0; i < 5000; i++) {
        char name[16];
        snprintf(name, sizeof name, "e%d", i);
        publish(s, name, json_integer(i));
    }
    assert_true(read_until(fd, "event: e4999\ndata: 4999\n\n"));
    close(fd);
    wait_for_clients(s, 0);
    http_stop(s);
}

static void a_stopped_server_leaks_no_descriptor_or_thread(void **state)
{
    (void)state;
    http_stop(start((http_settings){0})); /* libraries open some files only once */
    const int files = count_entries("/proc/self/fd"), threads = count_entries("/proc/self/task");
    http_server *s = start((http_settings){0});
    const char *const get = "GET /a/b HTTP/1.1\r\nHost: ",
                      *const post = "POST /a/b HTTP/1.1\r\nContent-Length: 100\r\nHost: x\r\n\r\nabc";
    enum { CLIENTS = 70 }; /* more than connections: some are never accepted */
    int fd[CLIENTS], code;
    for (int i = 0; i < 10; i++)
        fd[i] = listen_to(s, &code);
    for (int i = 10; i < CLIENTS; i++) {
        fd[i] = client_connect(http_port(s));
        if (i % 3 == 0)
            client_send(fd[i], get, strlen(get));
        if (i % 3 == 1)
            client_send(fd[i], post, strlen(post));
    }
    publish(s, "last", json_integer(1));
    http_stop(s);
    assert_int_equal(count_entries("/proc/self/fd"), files + CLIENTS);
    assert_int_equal(count_entries("/proc/self/task"), threads);
    for (int i = 0; i < CLIENTS; i++)
        close(fd[i]);
}

/* A valid request with some bytes changed, cut, repeated or inserted. */
static size_t mutate(uint64_t *seed, char *to, const char *good, size_t size)
{
    static const char *const pieces[] = {"\r\n",
                                         "\r\n\r\n",
                                         "%2e%2e/",
                                         "%00",
                                         ":",
                                         " ",
                                         "HTTP/1.1",
                                         "Content-Length: 5\r\n",
                                         "Content-Length: -1\r\n",
                                         "?token=",
                                         ";",
                                         ",",
                                         "=",
                                         "Transfer-Encoding: chunked\r\n",
                                         "ffffffffffffffff\r\n",
                                         "0\r\n\r\n",
                                         "Expect: 100-continue\r\n",
                                         "Cookie: ",
                                         "&&",
                                         "\n"};
    memcpy(to, good, size);
    for (int changes = 1 + random_below(seed, 4); changes > 0 && size > 0; changes--) {
        const size_t at = (size_t)random_below(seed, (int)size), left = size - at;
        if (random_below(seed, 4) == 0) {
            to[at] = (char)random_bits(seed);
        } else if (random_below(seed, 3) == 0) {
            const size_t cut = (size_t)random_below(seed, (int)(left < 20 ? left : 20) + 1);
            memmove(to + at, to + at + cut, left - cut);
            size -= cut;
        } else if (random_below(seed, 12) == 0) {
            size = at;
        } else {
            const char *piece = pieces[random_below(seed, (int)(sizeof pieces / sizeof *pieces))];
            const size_t length = strlen(piece);
            memmove(to + at + length, to + at, left);
            memcpy(to + at, piece, length);
            size += length;
        }
    }
    return size;
}

/* CUVETTE_HTTP_FUZZ: the number of requests. Half of the connections close at once, the others shut down writing and
 * read the reply. */
static void the_server_survives_random_requests(void **state)
{
    (void)state;
    const char *expected = getenv("CUVETTE_HTTP_FUZZ");
    const long count = expected ? atol(expected) : 20000;
    http_server *s = start((http_settings){.requests_per_s = 1e9});
    char *good[3];
    const char *const host = "Host: 127.0.0.1:", *const bearer = "\r\nAuthorization: Bearer ";
    good[0] = text_format("GET /a/b?c=d HTTP/1.1\r\n%s%d%s%s\r\nOrigin: http://127.0.0.1:%d\r\n\r\n", host,
                          http_port(s), bearer, http_token(s), http_port(s));
    good[1] = text_format(
        "POST /a/b HTTP/1.1\r\n%s%d%s%s\r\nContent-Type: application/json\r\nContent-Length: 5\r\n\r\n[1,2]", host,
        http_port(s), bearer, http_token(s));
    good[2] = text_format("POST /a/b HTTP/1.1\r\n%s%d\r\nCookie: cuvette_%d=%s\r\nContent-Type: "
                          "application/json\r\nTransfer-Encoding: chunked\r\n\r\n3\r\n[1,\r\n2\r\n2]\r\n0\r\n\r\n",
                          host, http_port(s), http_port(s), http_token(s));
    uint64_t seed = 20;
    long answered = 0, passed = 0;
    for (long i = 0; i < count; i++) {
        char request[2048], reply[4096];
        const char *from = good[i % 3];
        const size_t size = mutate(&seed, request, from, strlen(from));
        const int fd = client_connect(http_port(s));
        client_send(fd, request, size);
        if (i & 1) {
            shutdown(fd, SHUT_WR);
            const ssize_t got = recv(fd, reply, sizeof reply - 1, 0);
            reply[got > 0 ? got : 0] = 0;
            answered += got > 0;
            passed += reply_code(reply) == 200;
        }
        close(fd);
    }
    assert_true(answered > count / 10);
    assert_true(passed > 0 || count < 1000);
    for (int i = 0; i < 3; i++) {
        const int fd = client_connect(http_port(s));
        client_send(fd, good[i], strlen(good[i]));
        char reply[16] = "";
        assert_true(recv(fd, reply, 15, MSG_WAITALL) == 15);
        assert_int_equal(reply_code(reply), 200);
        close(fd);
        free(good[i]);
    }
    http_stop(s);
}

int main(void)
{
    const struct CMUnitTest cases[] = {
        cmocka_unit_test(all_listeners_get_events),
        cmocka_unit_test(slow_listeners_get_the_last_state),
        cmocka_unit_test(many_event_names_do_not_fill_memory),
        cmocka_unit_test(a_stopped_server_leaks_no_descriptor_or_thread),
        cmocka_unit_test(the_server_survives_random_requests),
    };
    return cmocka_run_group_tests_name("http_events", cases, NULL, NULL);
}
