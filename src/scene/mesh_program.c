#include "scene/mesh_child.h"

#include "base/text.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PROGRAM "cuvette-import"
#ifndef CUVETTE_LIBEXEC
#define CUVETTE_LIBEXEC "/usr/local/libexec/cuvette"
#endif

char *mesh_child_program(void)
{
    const char *asked = getenv("CUVETTE_IMPORT");
    if (asked && *asked) {
        return strdup(asked);
    }
    char own[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    own[length > 0 ? length : 0] = 0;
    char *slash = strrchr(own, '/');
    if (slash) {
        *slash = 0;
        static const char *const places[] = {"", "/../libexec/cuvette"};
        for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
            char *path = text_format("%s%s/" PROGRAM, own, places[i]);
            if (!path || access(path, X_OK) == 0) {
                return path;
            }
            free(path);
        }
    }
    return strdup(CUVETTE_LIBEXEC "/" PROGRAM);
}
