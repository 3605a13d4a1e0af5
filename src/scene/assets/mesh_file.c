#include "scene/assets/mesh_file.h"

#include "base/file.h"
#include "scene/assets/mesh_child.h"
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

/* The path of an image that can be opened; the original spelling is tried first. */
static status resolve_texture(const char *path, imported_material *m, diagnostic *why)
{
    char *found = file_beside(path, m->texture);
    if (!is_file(found)) {
        char *respelt = strdup(m->texture);
        if (respelt) {
            respell(respelt);
            free(found);
            found = file_beside(path, respelt);
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

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    mesh_limits all = mesh_limits_complete(limits);
    mesh_child child;
    diagnostic said = {.what = ""};
    *out = NULL;
    if (!*path)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the name of the mesh file is empty");
    status code = mesh_child_open(&child, path, &all, &said);
    mesh_import *fresh = NULL;
    if (code == STATUS_OK) {
        mesh_source source = {.read = mesh_child_read, .end = mesh_child_end, .context = &child};
        code = mesh_stream_read(&source, &all, &fresh, &said);
        code = mesh_child_close(&child, path, &all, code, &said);
    }
    for (int i = 0; i < (fresh ? fresh->material_count : 0) && code == STATUS_OK; i++)
        code = fresh->materials[i].texture ? resolve_texture(path, &fresh->materials[i], &said) : STATUS_OK;
    if (code != STATUS_OK) {
        mesh_import_destroy(fresh);
        if (why)
            *why = said;
        return code;
    }
    *out = fresh;
    return STATUS_OK;
}
