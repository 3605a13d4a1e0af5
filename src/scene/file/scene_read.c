/* Reads a scene from a path: a scene file (read.c), or a shared scene in a link, a PNG image or a page
 * (shared_read.c). */
#include "base/file.h"
#include "base/installed.h"
#include "scene/file/shared.h"
#include "scene/model/open.h"

#include <stdlib.h>

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
    const status code = shared_is_file(text, size) ? shared_read_file(path, text, size, out, why)
                                                   : scene_read_text(path, text, size, out, why);
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
