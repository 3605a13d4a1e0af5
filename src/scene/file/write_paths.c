#include "scene/file/write_parts.h"
#include "base/text.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The folder of a file, absolute and without links; unchanged if it does not exist. NULL if memory runs out. */
static char *real_folder(const char *file)
{
    const char *slash = strrchr(file, '/');
    char *folder = slash ? strndup(file, (size_t)(slash - file) + 1) : strdup("."), here[PATH_MAX];
    char *real = folder ? realpath(folder, NULL) : NULL;
    if (folder && !real && errno != ENOMEM) /* then the folder may exist, but elsewhere */
        real = folder[0] != '/' && getcwd(here, sizeof here) ? text_format("%s/%s", here, folder) : strdup(folder);
    free(folder);
    for (size_t length = real ? strlen(real) : 0; length > 1 && real[length - 1] == '/'; length--)
        real[length - 1] = 0;
    return real;
}

/* Joins folder and path; each "../" at the start of path removes a part of folder, which has no links. */
static char *join(const char *folder, const char *path)
{
    size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
    for (;;) {
        if (strncmp(path, "./", 2) == 0) {
            path += 2;
        } else if (*path == '/') {
            path++;
        } else if (strncmp(path, "../", 3) == 0) {
            path += 3;
            while (length > 0 && folder[--length] != '/') {
            }
        } else {
            return text_format("%.*s/%s", (int)length, folder, path);
        }
    }
}

/* The absolute path relative to a folder; absolute if they share only the root. */
static char *relative(const char *path, const char *folder)
{
    size_t shared = 0; /* bytes, including the last slash */
    size_t at = 0;
    for (; path[at] && path[at] == folder[at]; at++)
        shared = path[at] == '/' ? at + 1 : shared;
    if (!folder[at] && path[at] == '/') /* the whole of folder is a prefix of path */
        return text_format("%s%s", path[at + 1] == ' ' ? "./" : "", path + at + 1);
    if (shared <= 1)
        return strdup(path);
    char *steps = strdup("");
    for (const char *rest = folder + shared; steps && rest; rest = strchr(rest, '/')) {
        rest += *rest == '/';
        char *longer = text_format("%s../", steps);
        free(steps);
        steps = longer;
    }
    char *text = steps ? text_format("%s%s", steps, path + shared) : NULL;
    free(steps);
    return text;
}

status write_moved_path(const char *path, const char *old_file, const char *new_file, char **moved, diagnostic *why)
{
    char *from = real_folder(old_file), *to = real_folder(new_file);
    char *whole = from ? join(from, path) : NULL;
    const bool stays = path[0] == '/' || (from && to && strcmp(from, to) == 0);
    *moved = stays ? strdup(path) : whole && to ? relative(whole, to) : NULL;
    free(from);
    free(to);
    free(whole);
    return *moved ? STATUS_OK : out_of_memory(why);
}
