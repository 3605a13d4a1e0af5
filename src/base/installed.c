/* The places of files that come with the program. */
#include "base/installed.h"

#include "base/os_process.h"
#include "base/text.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

static const char here;

static char *find_near(const char *file, const char *const *places, size_t count, const char *name)
{
    const char *slash = strrchr(file, '/');
    for (size_t i = 0; slash && i < count; i++) {
        char *path = text_format("%.*s%s/%s", (int)(slash - file), file, places[i], name);
        char *real = path ? realpath(path, NULL) : NULL;
        free(path);
        if (real)
            return real;
    }
    return NULL;
}

char *installed_find(const char *const *places, size_t count, const char *name)
{
    char program[PATH_MAX];
    Dl_info library;
    char *found = os_program_path(program) ? find_near(program, places, count, name) : NULL;
    if (found || !dladdr(&here, &library) || !library.dli_fname)
        return found;
    char *file = realpath(library.dli_fname, NULL);
    found = file ? find_near(file, places, count, name) : NULL;
    free(file);
    return found;
}

/* From bin, lib or lib/ARCHITECTURE to where `make install` puts them, and from build or build/NAME to the sources. */
char *installed_folder(const char *below)
{
    static const char *const places[] = {"/../share/cuvette", "/../../share/cuvette", "/..", "/../.."};
    return installed_find(places, sizeof places / sizeof *places, below);
}
