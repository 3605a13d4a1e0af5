/* The scene's text and path; each rank loads the files itself. */
#include "mpi/scene_wire.h"

#include "scene/file/write.h"
#include <stdlib.h>
#include <string.h>

status scene_wire_pack(const scene *s, char **bytes, size_t *size, diagnostic *why)
{
    char *text = NULL;
    const char *path = scene_path(s);
    TRY(scene_write_text(s, path, true, &text, why));
    const size_t name = strlen(path) + 1, length = strlen(text);
    *bytes = malloc(name + length + 1);
    if (*bytes) {
        memcpy(*bytes, path, name);
        memcpy(*bytes + name, text, length + 1);
        *size = name + length;
    }
    free(text);
    return *bytes ? STATUS_OK : out_of_memory(why);
}

status scene_wire_unpack(const char *bytes, size_t size, scene **out, diagnostic *why)
{
    const size_t name = strlen(bytes) + 1;
    TRY(scene_read_text(bytes, bytes + name, size - name, out, why));
    const status code = scene_load(*out, why);
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}
