/* Broadcasts a package in parts. */
#include "mpi/tracing.h"
#include "scene/package/package.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { PART = 4 << 20, LENGTH_END = 0, LENGTH_FAILED = -1 };

typedef struct part {
    char *bytes;
    int64_t length, at; /* length: bytes filled or received; at: how many of these bytes were read */
    uint64_t sent_bytes;
    bool ended, failed;
} part;

static void send_length(int64_t length)
{
    MPI_Bcast(&length, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
}

static void send_part(part *p)
{
    if (p->length == 0)
        return;
    send_length(p->length);
    MPI_Bcast(p->bytes, (int)p->length, MPI_BYTE, 0, MPI_COMM_WORLD);
    p->sent_bytes += (uint64_t)p->length;
    p->length = 0;
}

static status put(void *context, const void *bytes, size_t size, diagnostic *why)
{
    part *p = context;
    (void)why;
    for (const char *from = bytes; size > 0;) {
        const size_t room = (size_t)(PART - p->length), count = size < room ? size : room;
        memcpy(p->bytes + p->length, from, count);
        p->length += (int64_t)count;
        from += count;
        size -= count;
        if (p->length == PART)
            send_part(p);
    }
    return STATUS_OK;
}

status scene_wire_send(const scene *s, uint64_t *sent, diagnostic *why)
{
    part p = {.bytes = malloc(PART)};
    status code = p.bytes ? STATUS_OK : out_of_memory(why);
    THEN(code, scene_pack_to(s, put, &p, why));
    if (code == STATUS_OK)
        send_part(&p);
    send_length(code == STATUS_OK ? LENGTH_END : LENGTH_FAILED);
    *sent = p.sent_bytes;
    free(p.bytes);
    return code;
}

static void receive_part(part *p)
{
    MPI_Bcast(&p->length, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
    p->at = 0;
    p->ended = p->length <= 0;
    p->failed = p->length == LENGTH_FAILED;
    if (p->ended)
        p->length = 0;
    else
        MPI_Bcast(p->bytes, (int)p->length, MPI_BYTE, 0, MPI_COMM_WORLD);
}

static status get(void *context, void *bytes, size_t size, diagnostic *why)
{
    part *p = context;
    for (char *to = bytes; size > 0;) {
        if (p->at == p->length && !p->ended)
            receive_part(p);
        if (p->ended)
            return diagnose(why, STATUS_BAD_INPUT, "report this as a bug, with the scene", "the scene ends early");
        const size_t rest = (size_t)(p->length - p->at), count = size < rest ? size : rest;
        memcpy(to, p->bytes + p->at, count);
        p->at += (int64_t)count;
        to += count;
        size -= count;
    }
    return STATUS_OK;
}

status scene_wire_receive(scene **out, bool *failed, diagnostic *why)
{
    part p = {.bytes = malloc(PART)};
    if (!p.bytes)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE); /* the other ranks wait in the broadcast */
    *out = NULL;
    status code = scene_unpack_from(get, &p, out, why);
    while (!p.ended)
        receive_part(&p);
    *failed = p.failed;
    if (code == STATUS_OK && p.failed) {
        scene_destroy(*out);
        *out = NULL;
    }
    free(p.bytes);
    return code;
}
