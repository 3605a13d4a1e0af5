/* A mesh file read as the importer's process reads it, but in this process: without its limits on the process and
 * without its sandbox, with limits on the mesh. What it would write is then read as its reply, and must be accepted. */
#pragma once

#include "fuzz.h"
#include "import/plain.h"
#include "scene/assets/mesh_stream.h"

/* Numbers that are not finite, and materials out of range, are refused only here. */
__attribute__((unused)) static void pass_on(const request *req, const flat_mesh *flat)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&bytes, &size);
    must(to && flat_write(flat, to, NULL) == STATUS_OK && fclose(to) == 0);
    const mesh_limits limits = {.triangles = req->triangles, .vertices = req->vertices};
    mesh_import *got = NULL;
    diagnostic why = {.what = ""};
    const status code = mesh_stream_read_bytes(bytes, size, &limits, &got, &why);
    if (code != STATUS_OK)
        must_refuse(code, &why);
    mesh_import_destroy(got);
    free(bytes);
}

__attribute__((unused)) static request request_of(const char *path, file_kind kind)
{
    return (request){
        .path = path, .kind = kind, .triangles = 10000, .vertices = 30000, .memory_mib = 1024, .root = fuzz_folder()};
}

/* Reads a mesh file. Every index must exist: mesh_stream_read refuses others. */
__attribute__((unused)) static void read_plain(const char *name, file_kind kind, const uint8_t *data, size_t size)
{
    fuzz_write(name, data, size);
    char *path = fuzz_path(name);
    const request req = request_of(path, kind);
    flat_mesh flat = {0};
    diagnostic why = {.what = ""};
    const status code = plain_read(&req, &flat, &why);
    if (code == STATUS_OK)
        pass_on(&req, &flat);
    else
        must_refuse(code, &why);
    flat_release(&flat);
    free(path);
}
