/* Where lessons are. */
#include "lesson/lesson.h"

#include "base/grow.h"
#include "base/os_process.h"
#include "base/text.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* From the program in bin to where `make install` puts them, and from build or build/NAME to the sources. */
char *lesson_folder(void)
{
    static const char *const places[] = {"/../share/cuvette", "/..", "/../.."};
    char own[PATH_MAX];
    os_program_path(own);
    char *slash = strrchr(own, '/');
    if (!slash)
        return NULL;
    *slash = 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct stat about;
        char *path = text_format("%s%s/experiments/lessons", own, places[i]),
             *real = path ? realpath(path, NULL) : NULL;
        free(path);
        if (real && stat(real, &about) == 0 && S_ISDIR(about.st_mode))
            return real;
        free(real);
    }
    return NULL;
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
        return diagnose_at(why, folder, STATUS_BAD_INPUT, "give a folder with lessons", "%s", strerror(errno));
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
