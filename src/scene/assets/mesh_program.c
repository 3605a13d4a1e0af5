#include "scene/assets/mesh_child.h"

#include "base/os_process.h"
#include "base/text.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PROGRAM "cuvette-import"
#ifndef CUVETTE_LIBEXEC
#define CUVETTE_LIBEXEC "/usr/local/libexec/cuvette"
#endif

static const char here;

/* Looks next to a file, or where `make install` puts it if the file is in bin, lib or lib/ARCHITECTURE; NULL if it is
 * in none of them. */
static char *near(char *file)
{
    static const char *const places[] = {"", "/../libexec/cuvette", "/../../libexec/cuvette"};
    char *slash = strrchr(file, '/');
    if (!slash)
        return NULL;
    *slash = 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        char *path = text_format("%s%s/" PROGRAM, file, places[i]);
        if (path && access(path, X_OK) == 0)
            return path;
        free(path);
    }
    return NULL;
}

char *mesh_child_program(void)
{
    const char *asked = getenv("CUVETTE_IMPORT");
    if (asked && *asked)
        return strdup(asked);
    char own[PATH_MAX];
    os_program_path(own);
    char *path = near(own);
    Dl_info library; /* the shared library with this code, if it is not part of the program */
    if (!path && dladdr(&here, &library) && library.dli_fname) {
        snprintf(own, sizeof own, "%s", library.dli_fname);
        path = near(own);
    }
    return path ? path : strdup(CUVETTE_LIBEXEC "/" PROGRAM);
}
