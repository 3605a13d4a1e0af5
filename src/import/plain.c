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
    TRY(load(req, &text, why));
    const status code = req->kind == FILE_OBJ   ? obj_read(req, text.bytes, text.size, flat, why)
                        : req->kind == FILE_PLY ? ply_read(req, text.bytes, text.size, flat, why)
                                                : stl_read(req, text.bytes, text.size, flat, why);
    files_release(&text);
    return code;
}
