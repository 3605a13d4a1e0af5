/* Reads a file with the reader of its format. */
#include "import/plain.h"

#include <errno.h>

static status load(const request *req, file_text *text, diagnostic *why)
{
    int fd;
    TRY(files_open_mesh(req, &fd, why));
    const int error = files_read(fd, text);
    if (error == ENOMEM)
        return no_memory_for(req, why);
    if (error == EBADMSG)
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete, or compress it again",
                        "the compressed file is damaged");
    if (error)
        return system_error(why, STATUS_BAD_INPUT, req->path, "cannot read", error, "give a readable mesh file");
    if (text->size > 0)
        return STATUS_OK;
    files_release(text);
    return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the file is empty");
}

status plain_read(const request *req, flat_mesh *flat, diagnostic *why)
{
    file_text text;
    if (req->kind == FILE_UNKNOWN)
        return diagnose_at(why, req->path, STATUS_BAD_INPUT,
                           "use a file that ends in .obj, .ply, .stl, .gltf or .glb, or in .xyz for points",
                           "unknown mesh format");
    TRY(load(req, &text, why));
    status (*const read)(const request *, const char *, size_t, flat_mesh *, diagnostic *) =
        req->kind == FILE_OBJ   ? obj_read
        : req->kind == FILE_PLY ? ply_read
        : req->kind == FILE_STL ? stl_read
                                : gltf_read;
    const status code = read(req, text.bytes, text.size, flat, why);
    files_release(&text);
    return code;
}
