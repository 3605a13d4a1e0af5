/* The places of files that come with the program. */
#include "base/installed.h"

#include "base/file.h"
#include "base/os_process.h"
#include "base/text.h"
#include <dlfcn.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char here; /* its address identifies the file with this code */

static char *find_near(const char *file, const char *const *places, size_t count, const char *name)
{
    const char *slash = strrchr(file, '/');
    for (size_t i = 0; slash && i < count; i++) {
        char *path = text_format("%.*s%s/%s", (int)(slash - file), file, places[i], name);
        if (!path)
            errno = ENOMEM;
        char *real = path ? realpath(path, NULL) : NULL;
        free(path); /* keeps errno */
        if (real || errno == ENOMEM)
            return real;
    }
    errno = ENOENT;
    return NULL;
}

char *installed_find(const char *const *places, size_t count, const char *name)
{
    char program[PATH_MAX];
    Dl_info library;
    errno = ENOENT;
    char *found = os_program_path(program) ? find_near(program, places, count, name) : NULL;
    if (found || errno == ENOMEM || !dladdr(&here, &library) || !library.dli_fname)
        return found;
    char *file = realpath(library.dli_fname, NULL);
    found = file ? find_near(file, places, count, name) : NULL;
    free(file);
    return found;
}

/* The places lead from bin, lib or lib/ARCHITECTURE to share, where `make install` puts the folder, and from build or
 * build/NAME to the sources. */
char *installed_folder(const char *below)
{
    static const char *const places[] = {"/../share/cuvette", "/../../share/cuvette", "/..", "/../.."};
    return installed_find(places, sizeof places / sizeof *places, below);
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static char *with_ending(const char *folder, const char *path, const char *ending)
{
    const char *name = file_name_of(path), *dot = strrchr(name, '.');
    const int length = (int)(dot && dot > name ? dot - path : (long)strlen(path));
    return folder ? text_format("%s/%.*s%s", folder, length - (int)(name - path), name, ending)
                  : text_format("%.*s%s", length, path, ending);
}

/* Examples are printed as experiments/..., the folder that an installation keeps in share/cuvette. A copy is not
 * suggested if it would overwrite files that the user may have changed. */
static void suggest_installed(const char *file, diagnostic *why)
{
    char *all = exists("experiments") ? NULL : installed_folder("experiments");
    const int length = snprintf(why->remedy, sizeof why->remedy, "use %s", file);
    if (all && length > 0 && (size_t)length < sizeof why->remedy)
        snprintf(why->remedy + length, sizeof why->remedy - (size_t)length, ", or copy all: cp -r %s .", all);
    free(all);
}

void installed_suggest(const char *path, const char *below, const char *ending, diagnostic *why)
{
    if (!why || !*path || exists(path))
        return;
    char *near = with_ending(NULL, path, ending), *there = with_ending(below, path, ending);
    char *installed = there ? installed_folder(there) : NULL;
    if (near && exists(near))
        snprintf(why->remedy, sizeof why->remedy, "did you mean '%s'?", near);
    else if (installed)
        suggest_installed(installed, why);
    free(installed);
    free(there);
    free(near);
}
