/* Temporary files: unnamed, or named and locked. open(2), flock(2). */
#include "base/temporary.h"

#include "base/file.h"
#include "base/hash.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAMES_MAX = 10000 };

/* Short, because the name of the target may be as long as the file system allows. */
static char *name_at(const char *path, const char *ending, unsigned n)
{
    char host[256] = "", name[64];
    gethostname(host, sizeof host - 1);
    const uint64_t hash = hash_finish(hash_bytes(HASH_START, host, strlen(host)));
    snprintf(name, sizeof name, ".cuvette-%08x-%u.part%.16s", (unsigned)(hash >> 32), n, ending);
    char *whole = file_beside(path, name);
    if (!whole)
        errno = ENOMEM;
    return whole;
}

static bool is_named(int fd, const char *name)
{
    struct stat opened, named;
    return fstat(fd, &opened) == 0 && lstat(name, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/* Removes a file whose writer is gone. Returns whether the name is free. */
static bool remove_left(const char *name)
{
    const int fd = open(name, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0)
        return errno == ENOENT;
    const bool left = flock(fd, LOCK_EX | LOCK_NB) == 0 && is_named(fd, name) && unlink(name) == 0;
    close(fd);
    return left;
}

/* Removes what killed writers have left under the names after n. */
static void remove_all_left(const char *path, const char *ending, unsigned n)
{
    struct stat about;
    char *name;
    for (bool there = true; there && n < NAMES_MAX && (name = name_at(path, ending, n)); n++) {
        there = lstat(name, &about) == 0;
        if (there)
            remove_left(name);
        free(name);
    }
}

/* A file of that name and its lock. Some file systems have no locks: the name is then protected by O_EXCL alone, and
 * nobody removes the file. */
static int create(const char *name)
{
    const int fd = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return -1;
    const bool is_locked = flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (is_locked && is_named(fd, name))
        return fd;
    close(fd); /* somebody has taken it for a file without a writer */
    errno = EEXIST;
    return -1;
}

/* Through /proc, because AT_EMPTY_PATH needs a capability. */
static int give_name(int fd, const char *name)
{
    char own[64];
    snprintf(own, sizeof own, "/proc/self/fd/%d", fd);
    return linkat(AT_FDCWD, own, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

/* The first free name: for a new file (fd < 0), or for the open one. Returns the descriptor. */
static int take_name(const char *path, const char *ending, int fd, char **name)
{
    for (unsigned n = 0; n < NAMES_MAX; n++) {
        *name = name_at(path, ending, n);
        if (!*name)
            return -1;
        int taken;
        bool exists;
        do {
            taken = fd < 0 ? create(*name) : give_name(fd, *name) == 0 ? fd : -1;
            exists = taken < 0 && errno == EEXIST;
        } while (exists && remove_left(*name));
        if (taken >= 0)
            remove_all_left(path, ending, n + 1);
        if (!exists)
            return taken;
        free(*name);
        *name = NULL;
    }
    return -1;
}

static int open_unnamed(const char *path)
{
    if (access("/proc/self/fd", X_OK) != 0)
        return -1;
    char *folder = file_beside(path, ".");
    const int fd = folder ? open(folder, O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666) : -1;
    free(folder);
    if (fd >= 0)
        flock(fd, LOCK_EX | LOCK_NB); /* for the time when it has a temporary name */
    return fd;
}

int temporary_open(const char *path, char **name)
{
    *name = NULL;
    const int fd = open_unnamed(path);
    return fd >= 0 ? fd : take_name(path, "", -1, name);
}

int temporary_open_named(const char *path, const char *ending, char **name)
{
    return take_name(path, ending, -1, name);
}

int temporary_move(int fd, char **name, const char *path)
{
    if (!*name && give_name(fd, path) == 0)
        return 0;
    if (!*name && (errno != EEXIST || take_name(path, "", fd, name) < 0))
        return -1;
    return rename(*name, path);
}
