/* The program that reads mesh files: CUVETTE_IMPORT, next to this program or library, or where it was installed. */
#include "scene/assets/mesh_child.h"

#include "base/installed.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "cuvette-import"
#ifndef CUVETTE_LIBEXEC
#define CUVETTE_LIBEXEC "/usr/local/libexec/cuvette"
#endif

char *mesh_child_program(void)
{
    /* Next to a build; from bin, lib or lib/ARCHITECTURE to where `make install` puts it. */
    static const char *const places[] = {"", "/../libexec/cuvette", "/../../libexec/cuvette"};
    const char *asked = getenv("CUVETTE_IMPORT");
    if (asked && *asked)
        return strdup(asked);
    char *path = installed_find(places, sizeof places / sizeof *places, PROGRAM);
    return path || errno == ENOMEM ? path : strdup(CUVETTE_LIBEXEC "/" PROGRAM);
}
