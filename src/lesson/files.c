/* Finds the lesson files of a folder, and the folder of the installed lessons. */
#include "base/array.h"
#include "base/installed.h"
#include "base/status.h"
#include "base/text.h"
#include "lesson/lesson.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

char *lesson_folder(void)
{
    return installed_folder("experiments/lessons");
}

static bool is_lesson(const char *name)
{
    const char *ending = strrchr(name, '.');
    return name[0] != '.' && ending && strcmp(ending, ".lesson") == 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

status lesson_list_find(const char *folder, lesson_list *out, diagnostic *why)
{
    *out = (lesson_list){.path = NULL};
    DIR *d = opendir(folder);
    if (!d)
        return system_error(why, STATUS_BAD_INPUT, folder, "cannot be listed", errno, "give a folder with lessons");
    status code = STATUS_OK;
    for (const struct dirent *e; code == STATUS_OK && (e = readdir(d));) {
        if (!is_lesson(e->d_name))
            continue;
        char *path = text_format("%s/%s", folder, e->d_name);
        if (path && GROW(out->path, out->room, out->count + 1))
            out->path[out->count++] = path;
        else
            free(path), code = out_of_memory(why);
    }
    closedir(d);
    if (out->count > 1)
        qsort(out->path, out->count, sizeof *out->path, by_name);
    if (code != STATUS_OK)
        lesson_list_release(out);
    return code;
}

void lesson_list_release(lesson_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->path[i]);
    free(l->path);
    *l = (lesson_list){.path = NULL};
}
