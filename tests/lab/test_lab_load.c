/* Load tests of the laboratory: many pages, many changes, hanging or faulty clients, random requests. The server keeps
 * working, its memory stays bounded, and the last change wins. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lab_fixture.h"
#include "random_stream.h"
#include "whole.h"
#include <poll.h>
#include <pthread.h>

enum { PAGES = 10, CHANGES = 1000 };

static lab_room room;

static int open_room(void **state)
{
    (void)state;
    room_open(&room, BALL_SCENE);
    return 0;
}

static int close_room(void **state)
{
    (void)state;
    room_close(&room);
    return 0;
}

/* The resident memory of this process. */
static long resident_kib(void)
{
    long pages = 0;
    FILE *in = fopen("/proc/self/statm", "r");
    assert_non_null(in);
    assert_int_equal(fscanf(in, "%*s %ld", &pages), 1);
    fclose(in);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* A page: listens to events and fetches each announced image until it has the final one of the expected generation. */
typedef struct tab {
    pthread_t thread;
    json_int_t expected, seen, serial,
        json; /* json: generation of the latest state; expected: atomic, 0 while unknown */
    bool disorder;
} tab;

static void take_event(tab *t, const char *line)
{
    json_t *json = json_loads(line, 0, NULL);
    if (json_object_get(json, "passes")) {
        const json_int_t serial = json_integer_value(json_object_get(json, "serial"));
        t->disorder |= serial <= t->serial;
        t->serial = serial;
        if (json_is_true(json_object_get(json, "final")))
            t->seen = json_integer_value(json_object_get(json, "generation"));
        free(client_ask(room.server, "GET", "/api/image.png", "", NULL));
    } else if (json_object_get(json, "undo")) {
        const json_int_t generation = json_integer_value(json_object_get(json, "generation"));
        t->disorder |= generation < t->json;
        t->json = generation;
    }
    json_decref(json);
}

static void *run_tab(void *of)
{
    tab *t = of;
    const int fd = client_connect(http_port(room.server));
    char *request = text_format("GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer %s\r\n\r\n",
                                http_port(room.server), http_token(room.server));
    client_send(fd, request, strlen(request));
    free(request);
    FILE *in = fdopen(fd, "r");
    char *line = NULL;
    size_t room_of_line = 0;
    json_int_t expected = 0;
    while ((!expected || t->seen < expected) && getline(&line, &room_of_line, in) > 0) {
        if (strncmp(line, "data: ", 6) == 0)
            take_event(t, line + 6);
        expected = __atomic_load_n(&t->expected, __ATOMIC_RELAXED);
    }
    free(line);
    fclose(in);
    return NULL;
}

static void ten_pages_receive_a_thousand_changes(void **state)
{
    (void)state;
    static tab tabs[PAGES];
    memset(tabs, 0, sizeof tabs);
    for (int i = 0; i < PAGES; i++)
        assert_int_equal(pthread_create(&tabs[i].thread, NULL, run_tab, &tabs[i]), 0);
    while (http_event_clients((http_server *)(uintptr_t)room.server) < PAGES)
        usleep(1000);
    char change[128];
    for (int i = 0; i < CHANGES; i++) {
        snprintf(change, sizeof change, "{\"set\": {\"ball.ior\": %.4f}, \"gesture\": \"g%d\"}", 1.0 + i * 0.001,
                 i / 100);
        room_post(&room, "/api/set", change);
    }
    /* The generation is already known; one more change makes sure that all pages receive it. */
    for (int i = 0; i < PAGES; i++)
        __atomic_store_n(&tabs[i].expected, CHANGES + 2, __ATOMIC_RELAXED);
    assert_int_equal(room_post(&room, "/api/set", "{\"set\": {\"ball.ior\": 1.5}}"), CHANGES + 2);
    for (int i = 0; i < PAGES; i++) {
        pthread_join(tabs[i].thread, NULL);
        assert_int_equal(tabs[i].seen, CHANGES + 2);
        assert_false(tabs[i].disorder);
    }
    char *many = room_film(&room);
    lab_room fresh;
    room_open(&fresh, BALL_SCENE);
    char *one = room_film(&fresh);
    assert_string_equal(many, one); /* 1.5 is the value of the file */
    room_close(&fresh);
    free(many);
    free(one);
}

static void *push_and_pull(void *unused)
{
    char change[64];
    for (int i = 0; i < CHANGES; i++) {
        snprintf(change, sizeof change, "{\"set\": {\"ball.ior\": %.4f}, \"gesture\": \"g\"}", 1.0 + i * 0.001);
        room_post(&room, "/api/set", change);
    }
    return unused;
}

/* The last state that is sent is the current one, whichever thread made the change. */
static void states_are_sent_in_order(void **state)
{
    (void)state;
    pthread_t others[PAGES];
    tab listener = {.seen = 0};
    assert_int_equal(pthread_create(&listener.thread, NULL, run_tab, &listener), 0);
    while (http_event_clients((http_server *)(uintptr_t)room.server) < 1)
        usleep(1000);
    for (int i = 0; i < PAGES; i++)
        assert_int_equal(pthread_create(&others[i], NULL, push_and_pull, NULL), 0);
    for (int i = 0; i < PAGES; i++)
        pthread_join(others[i], NULL);
    __atomic_store_n(&listener.expected, PAGES * CHANGES + 2, __ATOMIC_RELAXED);
    assert_int_equal(room_post(&room, "/api/set", "{\"set\": {\"ball.ior\": 1.5}}"), PAGES * CHANGES + 2);
    pthread_join(listener.thread, NULL);
    assert_false(listener.disorder);
}

static void faulty_clients_do_not_affect_others(void **state)
{
    (void)state;
    enum { HANGING = 40 };
    static const char rubbish[] = "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 GET / HTTP/9.9\r\n\r\n\0\xff\xfe";
    int fd[HANGING];
    char *half = text_format("POST /api/set HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nAuthorization: Bearer "
                             "%s\r\nContent-Type: application/json\r\nContent-Length: 1000\r\n\r\n{\"set\"",
                             http_port(room.server), http_token(room.server));
    for (int i = 0; i < HANGING; i++) {
        fd[i] = client_connect(http_port(room.server));
        client_send(fd[i], i % 2 ? half : rubbish, i % 2 ? strlen(half) : sizeof rubbish);
    }
    for (int i = 0; i < 20; i++) {
        char change[64];
        snprintf(change, sizeof change, "{\"set\": {\"ball.radius\": %.2f}}", 0.5 + i * 0.01);
        room_post(&room, "/api/set", change);
        free(room_film(&room));
    }
    for (int i = 0; i < HANGING; i++)
        close(fd[i]);
    free(half);
}

/* Valid and nearly valid requests of the API: %r is a random real number, %w a random word, %n a small number. */
static const char *const targets[][3] = {
    {"GET", "/api/state", NULL},
    {"GET", "/api/scene", NULL},
    {"GET", "/api/scene.yaml", NULL},
    {"GET", "/api/command", NULL},
    {"GET", "/api/image.png", NULL},
    {"GET", "/api/image.jpg?bits=%n", NULL},
    {"GET", "/api/trace?x=%n&y=%n", NULL},
    {"GET", "/api/trace.svg?x=%r&y=%w", NULL},
    {"GET", "/api/compare", NULL},
    {"GET", "/api/compare.png", NULL},
    {"GET", "/api/reference.png", NULL},
    {"GET", "/api/files", NULL},
    {"GET", "/api/studies", NULL},
    {"GET", "/api/studies/%w", NULL},
    {"GET", "/api/studies/%w/rows?from=%r", NULL},
    {"GET", "/api/studies/%w/compare?with=%w", NULL},
    {"GET", "/api/figures/%w", NULL},
    {"GET", "/%w", NULL},
    {"POST", "/api/set", "{\"set\": {\"ball.ior\": %r}}"},
    {"POST", "/api/set", "{\"set\": {\"%w.%w\": %r, \"ball.radius\": %r}}"},
    {"POST", "/api/set", "{\"set\": {\"render.depth\": %n, \"lamp.position\": [%r, %r, %r]}, \"gesture\": \"%w\"}"},
    {"POST", "/api/set", "{\"set\": {\"background.image\": \"%w\"}}"},
    {"POST", "/api/reset", "{\"paths\": [\"ball.ior\", \"%w.ior\"]}"},
    {"POST", "/api/reset", "{}"},
    {"POST", "/api/undo", "{}"},
    {"POST", "/api/redo", "{}"},
    {"POST", "/api/camera", "{\"orbit\": [%r, %r], \"step\": [%r, %r, %r], \"turn\": [%r, %n]}"},
    {"POST", "/api/camera", "{\"zoom\": %r, \"look\": \"top\", \"gesture\": \"%w\"}"},
    {"POST", "/api/camera", "{\"frame\": \"%w\", \"look\": \"%w\", \"zoom\": %n}"},
    {"POST", "/api/view", "{\"do\": \"back\"}"},
    {"POST", "/api/view", "{\"do\": \"keep\"}"},
    {"POST", "/api/view", "{\"do\": \"%w\"}"},
    {"POST", "/api/reference", "{}"},
    {"DELETE", "/api/reference", NULL},
    {"POST", "/api/open", "{\"file\": \"%w\"}"},
    {"POST", "/api/save", "{\"file\": \"%w.yaml\", \"replace\": true}"},
    {"POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"box\", \"name\": \"%w\"}"},
    {"POST", "/api/objects", "{\"kind\": \"%w\", \"shape\": \"%w\"}"},
    {"POST", "/api/objects", "{\"kind\": \"light\"}"},
    {"DELETE", "/api/objects/%w", NULL},
    {"GET", "/api/objects/%w/contents", NULL},
    {"POST", "/api/objects/ball/move", "{\"by\": [%r, %r, %r]}"},
    {"POST", "/api/objects/ball/scale", "{\"factor\": %r, \"with\": [\"%w\", \"%w\", %n]}"},
    {"POST", "/api/objects", "{\"kind\": \"solid\", \"shape\": \"box\", \"set\": {\"%w\": %r, \"priority\": %n}}"},
    {"POST", "/api/objects/%w/turn", "{\"by\": [%r, %n, %r]}"},
    {"POST", "/api/objects/%w/rename", "{\"to\": \"%w\"}"},
    {"POST", "/api/objects/ball/copy", "{}"},
    {"POST", "/api/slime", "{\"do\": \"%w\"}"},
    {"POST", "/api/slime", "{\"do\": \"play\"}"},
    {"POST", "/api/slime/grab", "{\"x\": %r, \"y\": %n, \"reach\": %r}"},
    {"POST", "/api/slime/move", "{\"hand\": %n, \"x\": %r, \"y\": %r}"},
    {"POST", "/api/studies/%w/run", "{}"},
    {"POST", "/api/studies/%w/stop", "{}"},
};
enum { TARGETS = sizeof targets / sizeof *targets };

/* Valid words, words with "..", and invalid words. */
static const char *const words[] = {
    "ball",
    "ground",
    "lamp",
    "tiles",
    "scene",
    "scene.yaml",
    "../scene.yaml",
    "%2e%2e%2fetc",
    "/etc/passwd",
    "..",
    ".",
    "",
    "box",
    "off",
    "restart",
    "new",
    "a b",
    "\\u0000",
    "\\ud800",
    "caf\\u00e9",
    "x",
    "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"};
static const char *const reals[] = {
    "0", "-1", "1.5", "1e300", "-1e-300", "64", "NaN", "1e999", "\"1\"", "null", "0.3333333333333333", "48", "7"};

static void fill(uint64_t *seed, const char *form, char *text, size_t size)
{
    char *at = text, *end = text + size - 1;
    for (; *form && at < end; form++) {
        char number[16];
        const char *put = NULL;
        if (form[0] == '%' && form[1] == 'w')
            put = words[random_below(seed, sizeof words / sizeof *words)];
        else if (form[0] == '%' && form[1] == 'r')
            put = reals[random_below(seed, sizeof reals / sizeof *reals)];
        else if (form[0] == '%' && form[1] == 'n')
            snprintf(number, sizeof number, "%d", random_below(seed, 20) - 2), put = number;
        if (!put) {
            *at++ = *form;
            continue;
        }
        const size_t length = strlen(put) < (size_t)(end - at) ? strlen(put) : (size_t)(end - at);
        memcpy(at, put, length);
        at += length;
        form++;
    }
    *at = 0;
}

/* Sometimes changes one byte. */
static void garble(uint64_t *seed, char *text)
{
    const size_t size = strlen(text);
    if (size && random_below(seed, 8) == 0)
        text[random_below(seed, (int)size)] = (char)(1 + random_below(seed, 255));
}

static char *ask_randomly(uint64_t *seed, const char **method)
{
    const char *const *target = targets[random_below(seed, TARGETS)];
    char path[512], body[1024] = "";
    fill(seed, target[1], path, sizeof path);
    garble(seed, path);
    if (target[2])
        fill(seed, target[2], body, sizeof body), garble(seed, body);
    *method = target[0];
    return client_ask(room.server, target[0], path, "Content-Type: application/json\r\n", target[2] ? body : NULL);
}

/* CUVETTE_LAB_FUZZ: the number of requests. */
static void the_laboratory_survives_random_requests(void **state)
{
    (void)state;
    const char *expected = getenv("CUVETTE_LAB_FUZZ");
    const long count = expected ? atol(expected) : trials_of(4000);
    uint64_t seed = 6;
    long by_hundred[6] = {0}, early_kib = 0;
    for (long i = 0; i < count; i++) {
        const char *method;
        char *reply = ask_randomly(&seed, &method);
        const int code = reply_code(reply);
        by_hundred[code >= 200 && code < 600 ? code / 100 : 0]++;
        if (code >= 500)
            fail_msg("request %ld (%s): %.600s", i, method, reply);
        free(reply);
        if (i == count / 4)
            early_kib = resident_kib();
        if (i % 500 == 499) /* keeps the scene close to what most requests refer to */
            free(client_ask(room.server, "POST", "/api/reset", "Content-Type: application/json\r\n", "{}"));
    }
    assert_true(by_hundred[2] > count / 8);
    assert_true(by_hundred[4] > count / 8);
    const long grown_kib = resident_kib() - early_kib;
    if (grown_kib > 256 * 1024)
        fail_msg("%ld KiB more than after a quarter of the requests", grown_kib);
    if (expected)
        print_message("%ld requests: %ld good, %ld refused, %ld without an answer; memory grew by %ld KiB over the "
                      "last three quarters\n",
                      count, by_hundred[2], by_hundred[4], by_hundred[0], grown_kib);
    room_post(&room, "/api/open", "{\"new\": true}");
    free(room_film(&room));
}

int main(void)
{
#define IN_A_ROOM(test) cmocka_unit_test_setup_teardown(test, open_room, close_room)
    const struct CMUnitTest cases[] = {
        IN_A_ROOM(ten_pages_receive_a_thousand_changes),
        IN_A_ROOM(states_are_sent_in_order),
        IN_A_ROOM(faulty_clients_do_not_affect_others),
        IN_A_ROOM(the_laboratory_survives_random_requests),
    };
    return cmocka_run_group_tests_name("lab_load", cases, NULL, NULL);
}
