/* The fuzzer of the laboratory's requests, in this process: each part of the input is a request, "METHOD TARGET" in its
 * first line and the body after it, sent with the token; a part that begins with "!" is sent as it is, without it.
 * Requests that start programs or take long are left out, and so are streams, which do not end. Every input begins with
 * the same scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "fuzz.h"
#include "lab_fixture.h"

static void stop(void);

static const lab_room *the_room(void)
{
    static lab_room room;
    if (!room.lab) {
        snprintf(room.folder, sizeof room.folder, "%s", fuzz_folder());
        room_write(&room, "scene.yaml", BALL_SCENE);
        room_write(&room, "other.yaml", BALL_SCENE "  cube: {shape: box, position: [2, 1, 0]}\n");
        room_start(&room, "scene.yaml", (lab_settings){.port = 0});
        must(atexit(stop) == 0);
    }
    return &room;
}

/* Before the folder is removed. */
static void stop(void)
{
    lab_stop(the_room()->lab);
}

static bool is_left_out(const char *method, const char *target)
{
    static const char *const parts[] = {"/run",     "/draw",        "/api/events", "/api/motion",
                                        "/measure", "/api/realism", "wait="};
    bool left_out = memchr(target, '%', strcspn(target, "?")); /* another spelling of these */
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        left_out = left_out || strstr(target, parts[i]);
    return left_out || strpbrk(method, "\r\n \t") || strpbrk(target, "\r\n \t");
}

/* The connection is closed behind the bytes: the server has nothing to wait for. */
static void send_raw(const lab_room *room, const void *bytes, size_t size)
{
    const int fd = client_connect(http_port(room->server));
    client_send(fd, bytes, size);
    shutdown(fd, SHUT_WR);
    free(client_read_all(fd));
    close(fd);
}

static void send_request(const lab_room *room, const fuzz_part *part)
{
    char *text = strndup(part->at, part->size), *body = strchr(text, '\n'), *target = strchr(text, ' ');
    must(text);
    if (body)
        *body++ = 0;
    target = target ? strchr(text, ' ') : NULL; /* in the first line */
    if (target && target[1] == '/') {
        *target++ = 0;
        if (!is_left_out(text, target)) {
            const bool has_body = body && strcmp(text, "GET") != 0;
            char *reply = client_ask(room->server, text, target, has_body ? "Content-Type: application/json\r\n" : "",
                                     has_body ? body : NULL);
            must(reply_code(reply) != 500);
            free(reply);
        }
    }
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { REQUESTS_MAX = 12 };
    const lab_room *room = the_room();
    fuzz_part rest = {(const char *)data, size}, part;
    room_write(room, "scene.yaml", BALL_SCENE);
    free(client_ask(room->server, "POST", "/api/open", "Content-Type: application/json\r\n",
                    "{\"file\": \"scene.yaml\"}"));
    for (int i = 0; i < REQUESTS_MAX && fuzz_next(&rest, &part); i++)
        if (part.size > 0 && part.at[0] == '!')
            send_raw(room, part.at + 1, part.size - 1);
        else
            send_request(room, &part);
    return 0;
}
