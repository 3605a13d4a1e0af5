/* Validates names and paths, which must stay inside the folder, also through links. folder_list.c lists the files. */
#include "web/document/folder.h"
#include "base/text.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct folder {
    char *given; /* as given: absolute, or relative to the working directory */
    char *real;  /* absolute, without links and trailing slash: "" is the root directory */
};

static void trim_slashes(char *path, size_t least)
{
    for (size_t length = strlen(path); length > least && path[length - 1] == '/'; length--)
        path[length - 1] = 0;
}

status folder_open(const char *path, folder **out, diagnostic *why)
{
    *out = NULL;
    folder *f = calloc(1, sizeof *f);
    struct stat about;
    if (!f || !(f->given = strdup(path)) || (!(f->real = realpath(path, NULL)) && errno == ENOMEM)) {
        folder_close(f);
        return out_of_memory(why);
    }
    if (!f->real || stat(f->real, &about) != 0 || !S_ISDIR(about.st_mode)) {
        folder_close(f);
        return diagnose(why, STATUS_BAD_INPUT, "give an existing folder", "'%.300s' is not a folder", path);
    }
    trim_slashes(f->given, 1);
    trim_slashes(f->real, 0);
    *out = f;
    return STATUS_OK;
}

void folder_close(folder *f)
{
    if (!f)
        return;
    free(f->given);
    free(f->real);
    free(f);
}

const char *folder_root(const folder *f)
{
    return f->given;
}

const char *folder_real(const folder *f)
{
    return f->real;
}

const char *folder_title(const folder *f)
{
    const char *slash = strrchr(f->real, '/');
    return slash ? slash + 1 : "/";
}

/* The part of a resolved path after the folder and a slash; NULL if the path is outside. */
static const char *below(const folder *f, const char *real)
{
    const size_t length = strlen(f->real);
    return strncmp(real, f->real, length) == 0 && real[length] == '/' && real[length + 1] ? real + length + 1 : NULL;
}

/* A missing last part can be created; a dangling link cannot, because its target would become the file. */
static bool can_be_created(const char *path, const char *part)
{
    struct stat about;
    return strcmp(part, ".") != 0 && strcmp(part, "..") != 0 && lstat(path, &about) != 0 && errno == ENOENT;
}

/* Resolves links in the existing part of the path; NULL if that fails or out of memory. */
static char *resolve(const char *path)
{
    char *real = realpath(path, NULL);
    if (real || errno != ENOENT)
        return real;
    char *parent = strdup(path);
    if (!parent)
        return NULL;
    trim_slashes(parent, 1);
    char *slash = strrchr(parent, '/');
    const char *part = slash ? slash + 1 : parent;
    char *last = *part && can_be_created(parent, part) ? strdup(part) : NULL;
    if (last && slash)
        slash[slash == parent] = 0;
    char *real_parent = last ? resolve(slash ? parent : ".") : NULL;
    real = real_parent ? text_format("%s/%s", strcmp(real_parent, "/") == 0 ? "" : real_parent, last) : NULL;
    free(real_parent);
    free(last);
    free(parent);
    return real;
}

char *folder_name(const folder *f, const char *path)
{
    char *real = resolve(path);
    const char *name = real ? below(f, real) : NULL;
    char *copy = name ? strdup(name) : NULL;
    free(real);
    return copy;
}

status folder_find(const folder *f, const char *path, char **name, diagnostic *why)
{
    errno = 0;
    *name = folder_name(f, path);
    return !*name && errno == ENOMEM ? out_of_memory(why) : STATUS_OK;
}

/* Whether each part between slashes is a valid name. */
static bool is_name(const char *name)
{
    if (strlen(name) >= PATH_MAX)
        return false;
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            return false;
    for (const char *part = name;; part++) {
        const size_t length = strcspn(part, "/");
        if (length == 0 || (length == 1 && part[0] == '.') || (length == 2 && part[0] == '.' && part[1] == '.'))
            return false;
        part += length;
        if (!*part)
            return true;
    }
}

/* If the folder is the working directory, a name is a path already; but a leading "-" would look like an option to
 * other programs. */
static char *join_path(const folder *f, const char *name)
{
    if (strcmp(f->given, ".") == 0 && name[0] != '-')
        return strdup(name);
    return text_format("%s%s%s", f->given, strcmp(f->given, "/") == 0 ? "" : "/", name);
}

static status refuse_outside(const char *name, diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "choose a file inside the laboratory's folder",
                    "'%.300s' is outside of the folder", name);
}

static status check_file(const char *real, const char *name, bool must_exist, diagnostic *why)
{
    struct stat about;
    if (stat(real, &about) == 0)
        return S_ISREG(about.st_mode)
                   ? STATUS_OK
                   : diagnose(why, STATUS_BAD_INPUT, "choose a regular file", "'%.300s' is not a regular file", name);
    if (must_exist)
        return diagnose(why, STATUS_BAD_INPUT, "use a name that GET /api/files lists",
                        "the file '%.300s' does not exist", name);
    char *parent = strdup(real), *slash = parent ? strrchr(parent, '/') : NULL;
    if (!slash) {
        free(parent);
        return out_of_memory(why);
    }
    slash[slash == parent] = 0;
    const bool exists = stat(parent, &about) == 0 && S_ISDIR(about.st_mode);
    free(parent);
    return exists ? STATUS_OK
                  : diagnose(why, STATUS_BAD_INPUT, "create the folder first", "the folder of '%.300s' does not exist",
                             name);
}

status folder_path(const folder *f, const char *name, bool must_exist, char **path, diagnostic *why)
{
    *path = NULL;
    if (!is_name(name))
        return diagnose(why, STATUS_BAD_INPUT, "give a path relative to the folder, without '.' and '..'",
                        "'%.300s' is not a valid file name", name);
    char *full_path = join_path(f, name);
    if (!full_path)
        return out_of_memory(why);
    errno = 0;
    char *real = resolve(full_path);
    status code = real && below(f, real) ? STATUS_OK : errno == ENOMEM ? out_of_memory(why) : refuse_outside(name, why);
    THEN(code, check_file(real, name, must_exist, why));
    free(real);
    if (code == STATUS_OK)
        *path = full_path;
    else
        free(full_path);
    return code;
}

status folder_path_from(const folder *f, const char *name, const char *file, char **path, diagnostic *why)
{
    *path = NULL;
    char *inside = text_format("%s/any", f->given);
    const status code = inside ? write_moved_path(name, inside, file, path, why) : out_of_memory(why);
    free(inside);
    return code;
}

/* what: the object or parameter that uses the file. */
static status check_named(const folder *f, const scene *s, const char *what, const char *path, diagnostic *why)
{
    if (!path || !path[0])
        return STATUS_OK;
    char *full_path = scene_file_path(s, path);
    if (!full_path)
        return out_of_memory(why);
    char *name;
    const status code = folder_find(f, full_path, &name, why);
    free(full_path);
    TRY(code);
    const bool is_inside = name != NULL;
    free(name);
    return is_inside ? STATUS_OK
                     : diagnose(why, STATUS_BAD_INPUT,
                                "move the file into the laboratory's folder, or start the laboratory with a "
                                "folder that contains both",
                                "%.80s: '%.200s' is outside of the folder", what, path);
}

status folder_check_scene(const folder *f, const scene *s, diagnostic *why)
{
    status code = check_named(f, s, "background.image", s->background.image_path, why);
    for (size_t i = 0; i < s->mesh_count && code == STATUS_OK; i++) {
        code = check_named(f, s, s->meshes[i].name, s->meshes[i].path, why);
        THEN(code, check_named(f, s, s->meshes[i].name, s->meshes[i].script_path, why));
    }
    for (size_t i = 0; i < s->texture_count && code == STATUS_OK; i++)
        code = check_named(f, s, s->textures[i].name, s->textures[i].path, why);
    for (size_t i = 0; i < s->data_count && code == STATUS_OK; i++)
        code = check_named(f, s, s->data[i].name, s->data[i].path, why);
    return code;
}
