/* The images that a mesh file names. */
#include "scene/assets/mesh_textures.h"

#include "base/file.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Alternative spellings of a file name: \ for / (MTL files from Windows), and %20 for a blank (URIs in glTF). */
static void respell(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        char digits[3] = {from[0] == '%' ? from[1] : (char)0, 0, 0};
        digits[1] = digits[0] ? from[2] : (char)0;
        char *end = digits;
        long byte = strtol(digits, &end, 16);
        if (end == digits + 2 && byte >= 0x20) {
            *to++ = (char)byte;
            from += 2;
        } else {
            *to++ = *from == '\\' ? '/' : *from;
        }
    }
    *to = 0;
}

static bool is_file(const char *path)
{
    struct stat about;
    return path && stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

/* The original spelling is tried first. */
static status resolve(const char *path, imported_material *m, diagnostic *why)
{
    char *found = file_next_to(path, m->texture);
    if (!is_file(found)) {
        char *respelt = strdup(m->texture);
        if (respelt) {
            respell(respelt);
            free(found);
            found = file_next_to(path, respelt);
        }
        free(respelt);
    }
    if (!found)
        return out_of_memory(why);
    if (!is_file(found)) {
        diagnose(why, STATUS_BAD_INPUT,
                 "put the image where the mesh file expects it, or remove the line that names it",
                 "the image '%.200s' of material '%.100s' does not exist", m->texture, m->name ? m->name : "");
        free(found);
        return STATUS_BAD_INPUT;
    }
    free(m->texture);
    m->texture = found;
    return STATUS_OK;
}

status mesh_textures_find(const char *path, mesh_import *imported, diagnostic *why)
{
    status code = STATUS_OK;
    for (int i = 0; i < imported->material_count && code == STATUS_OK; i++)
        code = imported->materials[i].texture ? resolve(path, &imported->materials[i], why) : STATUS_OK;
    return code;
}
