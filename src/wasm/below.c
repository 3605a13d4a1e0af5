/* Opening files below a root folder, in the files of a module, which nobody else changes. See base/file.h. */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

int below_open(const char *path, const char *root)
{
    char real[PATH_MAX];
    if (!root || !*root)
        return open(path, O_RDONLY);
    const size_t length = strlen(root);
    if (!realpath(path, real))
        return -1;
    if (strncmp(real, root, length) != 0 || real[length] != '/') {
        errno = EXDEV;
        return -1;
    }
    return open(real, O_RDONLY);
}
