/* Opening files below a root folder: the file is checked after it was opened, through /proc/self/fd. */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY };

/* The path /proc/self/fd/N of an open file; opening that path opens the same file. */
typedef struct fd_path {
    char name[32];
} fd_path;

static fd_path fd_path_of(int fd)
{
    fd_path s;
    snprintf(s.name, sizeof s.name, "/proc/self/fd/%d", fd);
    return s;
}

static bool is_below(const char *name, const char *root)
{
    char real[PATH_MAX];
    const size_t length = strlen(root);
    const ssize_t size = readlink(name, real, sizeof real);
    /* A name that fills the buffer may be truncated. */
    return size > 0 && (size_t)size < sizeof real && (size_t)size > length + 1 && memcmp(real, root, length) == 0 &&
           real[length] == '/';
}

int below_open(const char *path, const char *root)
{
    if (!root || !*root)
        return open(path, FLAGS);
    const int place = open(path, O_PATH | O_CLOEXEC); /* O_PATH has no side effects, even on devices */
    if (place < 0)
        return -1;
    const fd_path file = fd_path_of(place);
    int fd = -1, error = EXDEV;
    if (is_below(file.name, root)) {
        fd = open(file.name, FLAGS);
        error = errno;
    }
    close(place);
    errno = error;
    return fd;
}
