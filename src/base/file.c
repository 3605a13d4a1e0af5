/* Reading and atomic writing of files, temporary files (unnamed, or named and locked: open(2), flock(2)), and
 * folders. */
#include "base/file.h"

#include "base/budget.h"
#include "base/cancel.h"
#include "base/hash.h"
#include "base/status.h"
#include "base/text.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

const char *file_name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *file_next_to(const char *path, const char *name)
{
    const int folder = name[0] == '/' ? 0 : (int)(file_name_of(path) - path);
    return text_format("%.*s%s", folder, path, name);
}

/* ---- reading ---- */

/* Reads to the end of the file regardless of the size from fstat: files of /proc report 0. */
static status read_descriptor(int fd, const char *path, size_t limit, size_t expected, char **text, size_t *size,
                              diagnostic *why)
{
    enum { AT_ONCE = 1 << 24 }; /* about 10 ms between two tests for cancellation */
    size_t capacity = expected < limit ? expected + 1 : limit + 1, used = 0;
    char *buffer = malloc(capacity + 1);
    while (buffer) {
        if (cancel_asked()) {
            free(buffer);
            return cancel_check(why);
        }
        const size_t left = capacity - used;
        ssize_t got = read(fd, buffer + used, left < AT_ONCE ? left : AT_ONCE);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            status code = system_error(why, STATUS_FAILURE, path, "cannot read", errno, NULL);
            free(buffer);
            return code;
        }
        if (got == 0) {
            buffer[used] = 0;
            *text = buffer;
            *size = used;
            return STATUS_OK;
        }
        used += (size_t)got;
        if (used > limit) {
            free(buffer);
            return diagnose_at(why, path, STATUS_BAD_INPUT, "use a smaller file", "the file is larger than %zu bytes",
                               limit);
        }
        if (used == capacity) {
            capacity = capacity > limit / 2 ? limit + 1 : capacity * 2 + 4096;
            capacity = capacity > limit + 1 ? limit + 1 : capacity;
            char *larger = realloc(buffer, capacity + 1);
            if (!larger)
                free(buffer);
            buffer = larger;
        }
    }
    return locate_failure(why, path, out_of_memory(why));
}

status file_read(const char *path, size_t limit, char **text, size_t *size, diagnostic *why)
{
    return file_read_below(path, NULL, limit, text, size, why);
}

status file_read_below(const char *path, const char *root, size_t limit, char **text, size_t *size, diagnostic *why)
{
    *text = NULL;
    *size = 0;
    int fd = below_open(path, root);
    if (fd < 0 && errno == EXDEV)
        return diagnose_at(why, path, STATUS_BAD_INPUT, BELOW_REMEDY, BELOW_WHAT);
    if (fd < 0)
        return system_error(why, STATUS_BAD_INPUT, path, "cannot open", errno, NULL);
    struct stat about;
    status code;
    if (fstat(fd, &about) != 0) {
        code = system_error(why, STATUS_FAILURE, path, "cannot read", errno, NULL);
    } else if (!S_ISREG(about.st_mode)) {
        code = diagnose_at(why, path, STATUS_BAD_INPUT, "name a file", "%s",
                           S_ISDIR(about.st_mode) ? "is a folder" : "is not a regular file");
    } else {
        if (limit > SIZE_MAX / 4)
            limit = SIZE_MAX / 4;
        size_t expected = about.st_size > 0 ? (size_t)about.st_size : 4096;
        code = memory_budget_check(expected < limit ? expected : limit, "use a smaller file", why, "the file");
        if (code != STATUS_OK)
            diagnostic_locate(why, path, 0, 0);
        THEN(code, read_descriptor(fd, path, limit, expected, text, size, why));
    }
    close(fd);
    return code;
}

/* ---- temporary files ---- */

enum { NAMES_MAX = 10000 };

/* Returns a short name, because the name of the target may be as long as the file system allows. */
static char *name_at(const char *path, const char *ending, unsigned n)
{
    char host[256] = "", name[64];
    gethostname(host, sizeof host - 1);
    const uint64_t hash = hash_finish(hash_bytes(HASH_START, host, strlen(host)));
    snprintf(name, sizeof name, ".cuvette-%08x-%u.part%.16s", (unsigned)(hash >> 32), n, ending);
    char *full = file_next_to(path, name);
    if (!full)
        errno = ENOMEM;
    return full;
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

/* Removes files of killed writers, from the name with number n to the first that does not exist. */
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

/* Creates and locks a file of this name. Some file systems have no locks: then only O_EXCL protects the name, and
 * nobody removes the file. */
static int create(const char *name)
{
    const int fd = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return -1;
    const bool is_locked = flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (is_locked && is_named(fd, name))
        return fd;
    close(fd); /* another process removed it as a file without a writer */
    errno = EEXIST;
    return -1;
}

/* Links through /proc, because AT_EMPTY_PATH needs a capability. */
static int link_name(int fd, const char *name)
{
    char fd_path[64];
    snprintf(fd_path, sizeof fd_path, "/proc/self/fd/%d", fd);
    return linkat(AT_FDCWD, fd_path, AT_FDCWD, name, AT_SYMLINK_FOLLOW);
}

/* Finds the first free name, and creates a file there (fd < 0) or links the open one. Returns the descriptor. */
static int reserve_name(const char *path, const char *ending, int fd, char **name)
{
    for (unsigned n = 0; n < NAMES_MAX; n++) {
        *name = name_at(path, ending, n);
        if (!*name)
            return -1;
        int opened_fd;
        bool exists;
        do {
            opened_fd = fd < 0 ? create(*name) : link_name(fd, *name) == 0 ? fd : -1;
            exists = opened_fd < 0 && errno == EEXIST;
        } while (exists && remove_left(*name));
        if (opened_fd >= 0)
            remove_all_left(path, ending, n + 1);
        if (!exists)
            return opened_fd;
        free(*name);
        *name = NULL;
    }
    return -1;
}

static int open_unnamed(const char *path)
{
    if (access("/proc/self/fd", X_OK) != 0)
        return -1;
    char *folder = file_next_to(path, ".");
    const int fd = folder ? open(folder, O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666) : -1;
    free(folder);
    if (fd >= 0)
        flock(fd, LOCK_EX | LOCK_NB); /* protects the temporary name that it may get */
    return fd;
}

int temporary_open(const char *path, char **name)
{
    *name = NULL;
    const int fd = open_unnamed(path);
    return fd >= 0 ? fd : reserve_name(path, "", -1, name);
}

int temporary_open_named(const char *path, const char *ending, char **name)
{
    return reserve_name(path, ending, -1, name);
}

int temporary_move(int fd, char **name, const char *path)
{
    if (!*name && link_name(fd, path) == 0)
        return 0;
    if (!*name && (errno != EEXIST || reserve_name(path, "", fd, name) < 0))
        return -1;
    return rename(*name, path);
}

/* ---- writing ---- */

/* The file that path refers to after symbolic links are followed; it need not exist. NULL with errno. */
static char *resolve(const char *path)
{
    char *current = strdup(path);
    for (int links = 0; current && links < 40; links++) { /* Linux follows at most 40 links, path_resolution(7) */
        char target[PATH_MAX];
        ssize_t length = readlink(current, target, sizeof target - 1);
        if (length < 0)
            return current;
        target[length] = 0;
        char *next = file_next_to(current, target);
        free(current);
        current = next;
    }
    errno = current ? ELOOP : ENOMEM;
    free(current);
    return NULL;
}

static void remove_temporary(const file_writer *writer)
{
    if (writer->temporary)
        unlink(writer->temporary);
}

static int open_target(file_writer *writer)
{
    if (strcmp(writer->path, "-") == 0) {
        fflush(stdout); /* keeps earlier output first */
        return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    }
    char *resolved = resolve(writer->path);
    if (!resolved)
        return -1;
    free(writer->path);
    writer->path = resolved;
    struct stat about;
    bool exists = stat(resolved, &about) == 0;
    if (!exists && errno != ENOENT)
        return -1;
    if (exists && !S_ISREG(about.st_mode))
        return open(resolved, O_WRONLY | O_CLOEXEC | O_NOCTTY); /* a device or pipe is written directly */
    if (exists && euidaccess(resolved, W_OK) != 0)
        return -1;
    writer->atomic = true;
    int fd = temporary_open(resolved, &writer->temporary);
    if (fd >= 0 && exists && fchmod(fd, about.st_mode & 0777) != 0 && errno != EPERM && errno != EOPNOTSUPP) {
        int error = errno;
        close(fd);
        remove_temporary(writer);
        errno = error;
        return -1;
    }
    return fd;
}

static void release(file_writer *writer)
{
    free(writer->path);
    free(writer->temporary);
    *writer = (file_writer){0};
}

status file_writer_open(file_writer *writer, const char *path, diagnostic *why)
{
    *writer = (file_writer){0};
    if (!*path)
        return diagnose_at(why, NULL, STATUS_BAD_INPUT, "name a file, or - for standard output",
                           "the name of the file to write is empty");
    writer->path = strdup(path);
    if (!writer->path)
        return locate_failure(why, path, out_of_memory(why));
    int fd = open_target(writer);
    if (fd >= 0)
        writer->stream = fdopen(fd, "wb");
    if (writer->stream)
        return STATUS_OK;
    int error = errno;
    if (fd >= 0) {
        close(fd);
        remove_temporary(writer);
    }
    release(writer);
    return system_error(why, STATUS_FAILURE, path, "cannot write", error, NULL);
}

void file_flush_folder(const char *path)
{
    char *folder = file_next_to(path, ".");
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
    free(folder);
}

/* The errno of an earlier failed write, which the stream has lost: another write fails in the same way. */
static int lost_reason(const file_writer *writer)
{
    return writer->atomic && write(fileno(writer->stream), "", 1) < 0 ? errno : 0;
}

/* Renames a temporary file while it is open, and so locked; after fsync, closing reports no errors. */
static int finish(file_writer *writer)
{
    const int fd = fileno(writer->stream);
    if (ferror(writer->stream))
        return lost_reason(writer);
    if (fflush(writer->stream) != 0)
        return errno;
    if (writer->atomic && (fsync(fd) != 0 || temporary_move(fd, &writer->temporary, writer->path) != 0))
        return errno;
    return 0;
}

status file_writer_commit(file_writer *writer, diagnostic *why)
{
    const status cancelled = cancel_check(why); /* the writer may have returned early */
    if (cancelled != STATUS_OK) {
        file_writer_abandon(writer);
        return cancelled;
    }
    int error = finish(writer);
    bool failed = error != 0 || ferror(writer->stream) != 0;
    if (failed)
        remove_temporary(writer);
    if (fclose(writer->stream) != 0 && !failed && !writer->atomic) {
        failed = true;
        error = errno;
    }
    status code = STATUS_OK;
    if (failed && error)
        code = system_error(why, STATUS_FAILURE, writer->path, "cannot write", error, NULL);
    else if (failed)
        code = diagnose_at(why, writer->path, STATUS_FAILURE,
                           "check the free space on the disk, or that the reader of the pipe runs",
                           "cannot write: a write failed");
    else if (writer->atomic)
        file_flush_folder(writer->path);
    release(writer);
    return code;
}

void file_writer_abandon(file_writer *writer)
{
    remove_temporary(writer);
    if (writer->stream)
        fclose(writer->stream);
    release(writer);
}

status file_writer_end(file_writer *writer, status code, diagnostic *why)
{
    if (code == STATUS_OK)
        return file_writer_commit(writer, why);
    file_writer_abandon(writer);
    return code;
}

status file_write(const char *path, const char *text, diagnostic *why)
{
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    fputs(text, writer.stream);
    return file_writer_commit(&writer, why);
}

/* ---- folders ---- */

/* A new folder survives a power cut only once its entry in the parent folder is on disk. The last folder is flushed
 * even if it exists: the process that made it may have been killed before that. */
static int make_one_directory(const char *path, bool last)
{
    struct stat about;
    if (mkdir(path, 0777) == 0) {
        file_flush_folder(path);
        return 0;
    }
    int error = errno;
    if (stat(path, &about) != 0)
        return error;
    if (last)
        file_flush_folder(path);
    return S_ISDIR(about.st_mode) ? 0 : ENOTDIR;
}

status file_make_directory(const char *path, diagnostic *why)
{
    char *part = strdup(path);
    if (!part)
        return locate_failure(why, path, out_of_memory(why));
    size_t length = strlen(part);
    while (length > 1 && part[length - 1] == '/')
        part[--length] = 0;
    int error = *path ? 0 : ENOENT;
    for (char *c = part; *c && !error; c++) {
        if (*c == '/' && c > part && c[-1] != '/') {
            *c = 0;
            error = make_one_directory(part, false);
            *c = '/';
        }
    }
    if (!error)
        error = make_one_directory(part, true);
    free(part);
    return error ? system_error(why, STATUS_FAILURE, path, "cannot make the folder", error, NULL) : STATUS_OK;
}
