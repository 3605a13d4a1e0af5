#include "scene/assets/mesh_child.h"

#include "base/installed.h"
#include "base/text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PROGRAM "cuvette-import"
#ifndef CUVETTE_LIBEXEC
#define CUVETTE_LIBEXEC "/usr/local/libexec/cuvette"
#endif

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
    char *path = NULL;
    for (code_file of = CODE_PROGRAM; !path && of <= CODE_LIBRARY; of++) {
        char *own = code_path(of);
        path = own ? near(own) : NULL;
        free(own);
    }
    return path ? path : strdup(CUVETTE_LIBEXEC "/" PROGRAM);
}
