/* The places of files that come with the program. */
#include "base/installed.h"

#include "base/os_process.h"
#include "base/text.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char here;

char *code_path(code_file of)
{
    if (of == CODE_LIBRARY) {
        Dl_info library;
        return dladdr(&here, &library) && library.dli_fname ? realpath(library.dli_fname, NULL) : NULL;
    }
    char own[PATH_MAX];
    return os_program_path(own) ? strdup(own) : NULL;
}

/* From bin, lib or lib/ARCHITECTURE to where `make install` puts them, and from build or build/NAME to the sources. */
static char *near(char *file, const char *below)
{
    static const char *const places[] = {"/../share/cuvette", "/../../share/cuvette", "/..", "/../.."};
    char *slash = strrchr(file, '/');
    if (!slash)
        return NULL;
    *slash = 0;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        struct stat about;
        char *path = text_format("%s%s/%s", file, places[i], below), *real = path ? realpath(path, NULL) : NULL;
        free(path);
        if (real && stat(real, &about) == 0 && S_ISDIR(about.st_mode))
            return real;
        free(real);
    }
    return NULL;
}

char *installed_folder(const char *below)
{
    char *found = NULL;
    for (code_file of = CODE_PROGRAM; !found && of <= CODE_LIBRARY; of++) {
        char *file = code_path(of);
        found = file ? near(file, below) : NULL;
        free(file);
    }
    return found;
}
