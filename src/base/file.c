/* Reading and atomic writing of whole files, and folders. */
#include "base/file.h"

#include "base/below.h"
#include "base/cancel.h"
#include "base/memory_budget.h"
#include "base/system_error.h"
#include "base/temporary.h"
#include "base/text.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static status no_room(diagnostic *why, const char *path)
{
    diagnostic_locate(why, path, 0, 0);
    return out_of_memory(why);
}

/* Reads to the end of the file regardless of the size from fstat: files of /proc report 0. */
static status read_descriptor(int fd, const char *path, size_t limit, size_t expected, char **text, size_t *size,
                              diagnostic *why)
{
    enum { AT_ONCE = 1 << 24 }; /* some 10 ms, between two questions whether to stop */
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
            return diagnose_at(why, path, STATUS_BAD_INPUT, NULL, "the file is larger than %zu bytes", limit);
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
    return no_room(why, path);
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

const char *file_name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *file_beside(const char *path, const char *name)
{
    const int folder = name[0] == '/' ? 0 : (int)(file_name_of(path) - path);
    return text_format("%.*s%s", folder, path, name);
}

/* The file that path refers to after its symbolic links, which need not exist yet; NULL with errno. */
static char *resolve(const char *path)
{
    char *current = strdup(path);
    for (int links = 0; current && links < 40; links++) { /* Linux follows at most 40 links, path_resolution(7) */
        char target[PATH_MAX];
        ssize_t length = readlink(current, target, sizeof target - 1);
        if (length < 0)
            return current;
        target[length] = 0;
        char *next = file_beside(current, target);
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
    writer->whole = true;
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
        return no_room(why, path);
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
    char *folder = file_beside(path, ".");
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
    free(folder);
}

/* The reason of a write that failed before, which the stream has lost: the next one fails likewise. The file is thrown
 * away. */
static int lost_reason(const file_writer *writer)
{
    return writer->whole && write(fileno(writer->stream), "", 1) < 0 ? errno : 0;
}

/* A whole file gets its name while it is open, and so locked; after fsync, closing has no errors to report. */
static int finish(file_writer *writer)
{
    const int fd = fileno(writer->stream);
    if (ferror(writer->stream))
        return lost_reason(writer);
    if (fflush(writer->stream) != 0)
        return errno;
    if (writer->whole && (fsync(fd) != 0 || temporary_move(fd, &writer->temporary, writer->path) != 0))
        return errno;
    return 0;
}

status file_writer_commit(file_writer *writer, diagnostic *why)
{
    const status cancelled = cancel_check(why); /* its writer may have left early */
    if (cancelled != STATUS_OK) {
        file_writer_abandon(writer);
        return cancelled;
    }
    int error = finish(writer);
    bool failed = error != 0 || ferror(writer->stream) != 0;
    if (failed)
        remove_temporary(writer);
    if (fclose(writer->stream) != 0 && !failed && !writer->whole) {
        failed = true;
        error = errno;
    }
    status code = STATUS_OK;
    if (failed && error)
        code = system_error(why, STATUS_FAILURE, writer->path, "cannot write", error, NULL);
    else if (failed)
        code = diagnose_at(why, writer->path, STATUS_FAILURE, "check the free space on the disk",
                           "cannot write: a write failed");
    else if (writer->whole)
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

/* A new folder lasts only once its entry in the folder above is on disk. The last folder is flushed even if it exists:
 * the process that made it may have been killed before that. */
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
        return no_room(why, path);
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
