/* Appends rows to a locked file. Each row is written completely or not at all, and is on disk when the function
 * returns. */
#include "study/rows/table.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/status.h"
#include "base/text.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct table {
    char *path, *header;
    int fd;
    off_t end;          /* the file's size after the last line that was appended; 0: none yet */
    bool has_layout;    /* the file has all columns of header, and layout is known */
    csv_layout *layout; /* converts header's columns to the file's; NULL if they are equal */
};

static status failed(const char *path, const char *doing, int error, diagnostic *why)
{
    char what[96];
    snprintf(what, sizeof what, "%s failed", doing);
    const status code = system_error(why, STATUS_FAILURE, path, what, error, NULL);
    if (why) {
        const size_t length = strlen(why->remedy);
        snprintf(why->remedy + length, sizeof why->remedy - length, "%srun the command again to resume",
                 length ? ", then " : "");
    }
    return code;
}

/* Appends all bytes and flushes; on failure the file is truncated to its old size and errno is set. */
static int append_all(int fd, const char *bytes, size_t size)
{
    struct stat before;
    if (fstat(fd, &before) != 0)
        return -1;
    int error = 0;
    for (size_t written = 0; written < size && !error;) {
        ssize_t count = write(fd, bytes + written, size - written);
        if (count > 0)
            written += (size_t)count;
        else if (count == 0 || errno != EINTR)
            error = count < 0 ? errno : ENOSPC;
    }
    if (!error && fsync(fd) != 0)
        error = errno;
    if (!error)
        return 0;
    if (ftruncate(fd, before.st_size) == 0)
        fsync(fd);
    errno = error;
    return -1;
}

/* Reads size bytes, in as many parts as pread returns; on failure, or if the file is shorter, errno is set. */
static int read_all(int fd, char *bytes, size_t size, size_t offset)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = pread(fd, bytes + done, size - done, (off_t)(offset + done));
        if (got > 0)
            done += (size_t)got;
        else if (got == 0)
            errno = EIO;
        if (got == 0 || (got < 0 && errno != EINTR))
            return -1;
    }
    return 0;
}

/* rows.csv -> rows.torn.csv */
static char *torn_path(const char *path)
{
    size_t length = strlen(path);
    size_t stem = length > 4 && strcmp(path + length - 4, ".csv") == 0 ? length - 4 : length;
    return text_format("%.*s.torn.csv", (int)stem, path);
}

static status keep_torn(const char *path, const char *bytes, size_t size, diagnostic *why)
{
    char *torn = torn_path(path);
    if (!torn)
        return failed(path, "moving an incomplete row away", ENOMEM, why);
    status code = STATUS_OK;
    int fd = open(torn, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    /* Ends an incomplete line with a newline, so that the next one starts a new line. */
    if (fd < 0 || append_all(fd, bytes, size) != 0 || (bytes[size - 1] != '\n' && append_all(fd, "\n", 1) != 0))
        code = failed(torn, "moving an incomplete row away", errno, why);
    if (fd >= 0)
        close(fd);
    file_flush_folder(torn);
    free(torn);
    return code;
}

status table_set_aside(table *t, size_t offset, diagnostic *why)
{
    struct stat now;
    if (fstat(t->fd, &now) != 0)
        return failed(t->path, "examining the file", errno, why);
    if ((size_t)now.st_size <= offset)
        return STATUS_OK;
    size_t size = (size_t)now.st_size - offset;
    char *bytes = malloc(size);
    if (!bytes)
        return failed(t->path, "moving an incomplete row away", ENOMEM, why);
    status code = STATUS_OK;
    if (read_all(t->fd, bytes, size, offset) != 0)
        code = failed(t->path, "reading an incomplete row", errno, why);
    THEN(code, keep_torn(t->path, bytes, size, why));
    if (code == STATUS_OK && (ftruncate(t->fd, (off_t)offset) != 0 || fsync(t->fd) != 0))
        code = failed(t->path, "truncating an incomplete row", errno, why);
    if (t->end > 0)
        t->end = (off_t)offset;
    free(bytes);
    return code;
}

/* The offset after the last complete line (csv_complete_size). Reads from the end of the file, up to two newlines. */
static status find_end(table *t, size_t *end, diagnostic *why)
{
    enum { BLOCK_BYTES = 4096 };
    struct stat now;
    if (fstat(t->fd, &now) != 0)
        return failed(t->path, "examining the file", errno, why);
    const size_t size = now.st_size > 0 ? (size_t)now.st_size : 0;
    status code = STATUS_OK;
    bool enough = false;
    *end = 0;
    for (size_t block = BLOCK_BYTES; code == STATUS_OK && !enough; block *= 2) {
        const size_t part = block < size ? block : size, from = size - part;
        char *text = malloc(part + 1);
        if (!text)
            code = failed(t->path, "reading", ENOMEM, why);
        else if (read_all(t->fd, text, part, from) != 0)
            code = failed(t->path, "reading", errno, why);
        const char *last = code == STATUS_OK ? memrchr(text, '\n', part) : NULL;
        enough = part == size || (last && memrchr(text, '\n', (size_t)(last - text)));
        if (code == STATUS_OK && enough)
            *end = from + csv_complete_size(text, part);
        free(text);
    }
    return code;
}

/* Opens and locks the file. A merge may replace it, so the name must still refer to the locked file. */
static status lock(table *t, diagnostic *why)
{
    for (;;) {
        t->fd = open(t->path, O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
        if (t->fd < 0)
            return failed(t->path, "opening", errno, why);
        if (flock(t->fd, LOCK_EX | LOCK_NB) != 0) {
            if (errno != EWOULDBLOCK)
                return failed(t->path, "locking", errno, why);
            return diagnose_at(why, t->path, STATUS_BAD_INPUT,
                               "wait for it to finish, or run the study in several processes with --shard I/N",
                               "another process is writing these rows");
        }
        struct stat named, opened;
        if (fstat(t->fd, &opened) == 0 && stat(t->path, &named) == 0 && named.st_ino == opened.st_ino &&
            named.st_dev == opened.st_dev)
            return STATUS_OK;
        close(t->fd);
    }
}

/* What another program did to the file since the last row, or NULL. */
static const char *foreign_change(const table *t)
{
    struct stat named, opened;
    if (t->end == 0 || fstat(t->fd, &opened) != 0)
        return NULL;
    if (stat(t->path, &named) != 0)
        return "was removed";
    if (named.st_ino != opened.st_ino || named.st_dev != opened.st_dev)
        return "was replaced by another file";
    return opened.st_size < t->end ? "was truncated" : opened.st_size > t->end ? "was changed" : NULL;
}

/* Writes rows.rescued.csv: the rows that this process can still read, perhaps their only copy, and the new ones. */
static status rescue(const table *t, const char *change, const char *lines, size_t size, diagnostic *why)
{
    const size_t length = strlen(t->path);
    struct stat now;
    char *path = text_format("%.*s.rescued.csv", (int)(length > 4 ? length - 4 : length), t->path), *bytes = NULL;
    status code = path ? STATUS_OK : out_of_memory(why);
    char *folder = code == STATUS_OK ? file_next_to(t->path, ".") : NULL;
    if (code == STATUS_OK) /* the folder may be gone, too */
        code = folder ? file_make_directory(folder, why) : out_of_memory(why);
    free(folder);
    int fd = -1;
    if (code == STATUS_OK && (fd = open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666)) < 0)
        code = failed(path, "writing", errno, why);
    const size_t before = code == STATUS_OK && fstat(t->fd, &now) == 0 ? (size_t)now.st_size : 0;
    if (code == STATUS_OK && !(bytes = malloc(before + 1)))
        code = out_of_memory(why);
    if (code == STATUS_OK && (read_all(t->fd, bytes, before, 0) != 0 || append_all(fd, bytes, before) != 0 ||
                              append_all(fd, lines, size) != 0))
        code = failed(path, "writing", errno, why);
    if (code == STATUS_OK) {
        char remedy[400];
        snprintf(remedy, sizeof remedy, "put back its rows from %.300s, and run the command again", path);
        code = diagnose_at(why, t->path, STATUS_FAILURE, remedy, "the file %s while the study ran", change);
    }
    if (fd >= 0)
        close(fd);
    free(bytes);
    free(path);
    return code;
}

static status append(table *t, const char *lines, size_t size, diagnostic *why)
{
    struct stat now;
    const char *change = foreign_change(t);
    if (change)
        return rescue(t, change, lines, size, why);
    if (append_all(t->fd, lines, size) != 0)
        return failed(t->path, "writing a row", errno, why);
    t->end = fstat(t->fd, &now) == 0 ? now.st_size : 0;
    return STATUS_OK;
}

status table_open(const char *path, const char *header, table **out, diagnostic *why)
{
    *out = NULL;
    table *t = calloc(1, sizeof *t);
    if (!t || !(t->path = strdup(path)) || !(t->header = strdup(header))) {
        if (t)
            free(t->path);
        free(t);
        return failed(path, "opening", ENOMEM, why);
    }
    size_t end = 0;
    status code = lock(t, why);
    THEN(code, find_end(t, &end, why));
    THEN(code, table_set_aside(t, end, why));
    if (code == STATUS_OK && end == 0) {
        code = append(t, header, strlen(header), why);
        t->has_layout = true;
    }
    struct stat now;
    t->end = code == STATUS_OK && fstat(t->fd, &now) == 0 ? now.st_size : 0;
    file_flush_folder(path); /* also for an old file, whose creator may have been killed before it flushed the folder */
    if (code != STATUS_OK) {
        table_close(t);
        return code;
    }
    *out = t;
    return STATUS_OK;
}

/* Adds missing columns to the file; called before the first row, so that a process without rows changes nothing. */
static status find_layout(table *t, diagnostic *why)
{
    bool replaced = false;
    status code = csv_layout_settle(t->path, t->header, &t->layout, &replaced, why);
    if (code == STATUS_OK && replaced) {
        file_flush_folder(t->path);
        close(t->fd);
        t->end = 0;
        code = lock(t, why);
    }
    t->has_layout = code == STATUS_OK;
    return code;
}

status table_append(table *t, const char *lines, size_t size, diagnostic *why)
{
    csv_buffer converted = {0};
    status code = t->has_layout ? STATUS_OK : find_layout(t, why);
    if (code != STATUS_OK || !t->layout)
        return code == STATUS_OK ? append(t, lines, size, why) : code;
    code = csv_layout_place(t->layout, lines, size, &converted, why);
    THEN(code, append(t, converted.text, converted.size, why));
    csv_buffer_free(&converted);
    return code;
}

void table_close(table *t)
{
    if (!t)
        return;
    if (t->fd >= 0)
        close(t->fd);
    csv_layout_destroy(t->layout);
    free(t->header);
    free(t->path);
    free(t);
}
