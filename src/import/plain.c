/* Reads a file with the reader of its format, once its first bytes are those of the format. */
#include "import/plain.h"

#include <string.h>

/* UTF-16 has a byte order mark, or, in the words that begin a mesh file, 0 as every other byte. */
static bool is_utf16(const char *bytes, size_t size)
{
    bool first = size >= 8, second = size >= 8;
    if (size >= 2 && (memcmp(bytes, "\xff\xfe", 2) == 0 || memcmp(bytes, "\xfe\xff", 2) == 0))
        return true;
    for (size_t i = 0; i < 8 && i < size; i++) {
        first = first && !bytes[i] == (i % 2 == 0);
        second = second && !bytes[i] == (i % 2 == 1);
    }
    return first || second;
}

static status foreign(const char *what, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "check that the file has the right ending", "%s", what);
}

static status plain_check(file_kind kind, const char *bytes, size_t size, bool whole, diagnostic *why)
{
    enum { BLOCK = 1 << 16 };
    if (kind == FILE_BUFFER || size == 0)
        return STATUS_OK;
    if (files_compressed(bytes, size))
        return diagnose(why, STATUS_BAD_INPUT, "expand it once", "the file is compressed twice");
    if (kind != FILE_GLB && (kind != FILE_STL || (whole && !stl_agrees(bytes, size))) && is_utf16(bytes, size))
        return diagnose(why, STATUS_BAD_INPUT, "save it as UTF-8", "the text is UTF-16");
    if ((kind == FILE_OBJ || kind == FILE_MTL) && memchr(bytes, 0, size < BLOCK ? size : BLOCK))
        return foreign(kind == FILE_OBJ ? "this is not an OBJ file: it has bytes that no text has"
                                        : "this is not an MTL file: it has bytes that no text has",
                       why);
    if (kind == FILE_STL)
        return stl_check(bytes, size, whole, why);
    const bool binary = size >= 4 && memcmp(bytes, "glTF", 4) == 0;
    const char *word;
    size_t length;
    lines l = lines_of(bytes, size);
    if (kind == FILE_GLB ? !binary : kind == FILE_GLTF && binary)
        return diagnose(why, STATUS_BAD_INPUT, "name a JSON file .gltf and a binary glTF file .glb", "%s",
                        binary ? "this is a binary glTF file" : "a binary glTF file begins with 'glTF'");
    if (kind == FILE_GLTF && (!lines_any_word(&l, &word, &length) || *word != '{'))
        return foreign("this JSON is not glTF: it does not begin with '{'", why);
    if (kind == FILE_PLY && (!lines_word(&l, &word, &length) || !lines_is(word, length, "ply")))
        return foreign("a PLY file begins with the line 'ply'", why);
    return STATUS_OK;
}

static status load(const request *req, file_text *text, diagnostic *why)
{
    int fd;
    TRY(files_open_mesh(req, &fd, why));
    TRY(files_read(req, fd, req->kind, text, why));
    if (text->size > 0)
        return STATUS_OK;
    files_release(text);
    return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the file is empty");
}

status plain_read(const request *given, flat_mesh *flat, diagnostic *why)
{
    request with = *given, *req = &with;
    file_text text;
    with.check = plain_check;
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
