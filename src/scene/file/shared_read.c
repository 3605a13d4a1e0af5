/* Reads a scene from a path: a scene file (read.c), or a shared scene in a link, in the metadata of a PNG or OpenEXR
 * image, or in a shared page. */
#include "base/file.h"
#include "base/installed.h"
#include "base/text.h"
#include "scene/file/read_lens.h"
#include "scene/file/shared.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

bool shared_is_link(const char *path)
{
    return strstr(path, SHARED_FRAGMENT) != NULL;
}

bool shared_is_file(const char *bytes, size_t size)
{
    static const char page[] = "<!doctype html>";
    return image_holds_text(bytes, size) || (size >= sizeof page - 1 && memcmp(bytes, page, sizeof page - 1) == 0);
}

status shared_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why)
{
    *out = NULL;
    if (size > SHARED_TEXT_MAX)
        return diagnose_at(why, name, STATUS_BAD_INPUT, "make the scene smaller, or send the scene file instead",
                           "the shared scene is longer than %d bytes", SHARED_TEXT_MAX);
    TRY(scene_read_text(name, text, size, out, why));
    const status code = locate_failure(why, name, shared_scene_check(*out, why));
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

/* Expands at most SHARED_TEXT_MAX bytes, whatever the data claim. */
static status expand(const char *name, const unsigned char *packed, size_t size, char **text, size_t *length,
                     diagnostic *why)
{
    uLongf room = SHARED_TEXT_MAX;
    *text = malloc(room + 1);
    if (!*text)
        return out_of_memory(why);
    const int result = uncompress((Bytef *)*text, &room, packed, (uLong)size);
    if (result == Z_OK) {
        (*text)[room] = 0;
        *length = room;
        return STATUS_OK;
    }
    free(*text);
    *text = NULL;
    if (result == Z_MEM_ERROR)
        return out_of_memory(why);
    return diagnose_at(why, name, STATUS_BAD_INPUT, "copy the complete link or page",
                       "the code of the shared scene is %s",
                       result == Z_BUF_ERROR ? "cut short or too long" : "damaged");
}

static status read_code(const char *name, const char *code, size_t length, scene **out, diagnostic *why)
{
    size_t packed_size = 0, size = 0;
    char *text = NULL;
    unsigned char *packed = length <= 2 * SHARED_TEXT_MAX ? base64_decode(code, length, true, &packed_size) : NULL;
    status result = packed ? expand(name, packed, packed_size, &text, &size, why)
                           : diagnose_at(why, name, STATUS_BAD_INPUT, "copy the complete link or page",
                                         "the code of the shared scene is damaged");
    THEN(result, shared_read_text(name, text, size, out, why));
    free(packed);
    free(text);
    return result;
}

/* A scene from a link has no file: its path is empty. */
status shared_read_link(const char *link, scene **out, diagnostic *why)
{
    *out = NULL;
    const char *code = strstr(link, SHARED_FRAGMENT) + strlen(SHARED_FRAGMENT);
    TRY(read_code("link", code, strlen(code), out, why));
    (*out)->path[0] = 0;
    return STATUS_OK;
}

static status no_scene(const char *name, const char *what, diagnostic *why)
{
    return diagnose_at(why, name, STATUS_BAD_INPUT,
                       "give the scene file: a scene that names files cannot be stored in an image or page",
                       "this %s holds no scene", what);
}

static status read_page(const char *name, const char *bytes, size_t size, scene **out, diagnostic *why)
{
    const char *begin = memmem(bytes, size, SHARED_PAGE_BEGIN, strlen(SHARED_PAGE_BEGIN));
    if (!begin)
        return no_scene(name, "page", why);
    begin += strlen(SHARED_PAGE_BEGIN);
    const char *end = memmem(begin, (size_t)(bytes + size - begin), SHARED_PAGE_END, strlen(SHARED_PAGE_END));
    if (!end)
        return diagnose_at(why, name, STATUS_BAD_INPUT, "copy the complete page",
                           "the scene in this page is cut short");
    return read_code(name, begin, (size_t)(end - begin), out, why);
}

status shared_read_file(const char *name, const char *bytes, size_t size, scene **out, diagnostic *why)
{
    *out = NULL;
    if (!image_holds_text(bytes, size))
        return read_page(name, bytes, size, out, why);
    char *text;
    TRY(locate_failure(why, name, image_text_read(bytes, size, SHARED_KEYWORD, SHARED_TEXT_MAX, &text, why)));
    const status code = text ? shared_read_text(name, text, strlen(text), out, why) : no_scene(name, "image", why);
    free(text);
    return code;
}

/* --- scenes of any form --- */

/* A shared image may be larger than the text of a scene, whose limit document_parse checks. */
enum { FILE_LIMIT = 1 << 28 };

static status read_file(const char *path, const char *root, scene **out, diagnostic *why)
{
    char *text;
    size_t size;
    const status read = file_read_below(path, root, FILE_LIMIT, &text, &size, why);
    if (read != STATUS_OK) {
        if (!root)
            installed_suggest(path, "experiments/scenes", ".yaml", why);
        return read;
    }
    const status code = shared_is_file(text, size)
                            ? shared_read_file(path, text, size, out, why)
                            : read_scene_text(path, text, size, &(lens_access){true, root}, out, why);
    free(text);
    return code;
}

status scene_read_below(const char *path, const char *root, scene **out, diagnostic *why)
{
    *out = NULL;
    TRY(shared_is_link(path) ? shared_read_link(path, out, why) : read_file(path, root, out, why));
    const status code = scene_limit(*out, root, 0, why);
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

status scene_read(const char *path, scene **out, diagnostic *why)
{
    return scene_read_below(path, NULL, out, why);
}
