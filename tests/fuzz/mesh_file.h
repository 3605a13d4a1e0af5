/* A mesh file read as the importer's process reads it, but in this process: without its limits on the process and
 * without its sandbox, with limits on the mesh. What it would write is then read as its reply, and must be accepted. */
#pragma once

#include "fuzz.h"
#include "import/import.h"
#include "import/obj.h"
#include "scene/assets/mesh_stream.h"
#include <assimp/cimport.h>

typedef struct reply {
    char *at;
    size_t size, read;
} reply;

__attribute__((unused)) static status take_reply(void *context, void *bytes, size_t size, diagnostic *why)
{
    reply *r = context;
    if (size > r->size - r->read)
        return diagnose(why, STATUS_BAD_INPUT, NULL, "ends early");
    memcpy(bytes, r->at + r->read, size);
    r->read += size;
    return STATUS_OK;
}

__attribute__((unused)) static status end_reply(void *context, diagnostic *why)
{
    const reply *r = context;
    return r->read == r->size ? STATUS_OK : diagnose(why, STATUS_BAD_INPUT, NULL, "goes on");
}

/* The reader may refuse what assimp makes of numbers that are not finite. */
__attribute__((unused)) static void pass_on(const request *req, const struct aiScene *scene, const flat_mesh *flat)
{
    reply r = {0};
    FILE *to = open_memstream(&r.at, &r.size);
    must(to && write_mesh(req, scene, flat, to, NULL) == STATUS_OK && fclose(to) == 0);
    const mesh_source source = {take_reply, end_reply, &r};
    const mesh_limits limits = {.triangles = req->triangles, .vertices = req->vertices};
    mesh_import *got = NULL;
    diagnostic why = {.what = ""};
    const status code = mesh_stream_read(&source, &limits, &got, &why);
    if (code != STATUS_OK)
        must_refuse(code, &why);
    mesh_import_destroy(got);
    free(r.at);
}

__attribute__((unused)) static void release_flat(flat_mesh *flat)
{
    free(flat->positions), free(flat->normals), free(flat->uvs), free(flat->triangles), free(flat->slots);
    *flat = (flat_mesh){0};
}
