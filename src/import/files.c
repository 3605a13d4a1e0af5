/* File access for assimp: regular files below the root, read only. */
#include "import/import.h"

#include "base/file.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Opens a regular file; NULL and the reason on failure. Does not wait for the writer of a FIFO. */
static FILE *open_regular(const char *path, const char *root, const char **reason, bool *outside)
{
    int fd = below_open(path, root);
    struct stat about;
    FILE *stream = NULL;
    *outside = fd < 0 && errno == EXDEV;
    if (*outside) {
        *reason = BELOW_WHAT;
    } else if (fd < 0 || fstat(fd, &about) != 0) {
        *reason = strerrordesc_np(errno);
    } else if (!S_ISREG(about.st_mode)) {
        *reason = S_ISDIR(about.st_mode) ? "is a folder" : "is not a regular file";
    } else {
        stream = fdopen(fd, "rb");
        *reason = stream ? NULL : strerrordesc_np(errno);
    }
    if (fd >= 0 && !stream)
        close(fd);
    return stream;
}

FILE *files_open(const request *req)
{
    const char *reason;
    bool outside;
    return open_regular(req->path, req->root, &reason, &outside);
}

status files_check(const request *req, diagnostic *why)
{
    const char *reason = NULL;
    bool outside;
    diagnostic_locate(why, req->path, 0, 0);
    FILE *stream = open_regular(req->path, req->root, &reason, &outside);
    if (outside)
        return diagnose(why, STATUS_BAD_INPUT, BELOW_REMEDY, BELOW_WHAT);
    if (!stream)
        return diagnose(why, STATUS_BAD_INPUT, "give a readable mesh file", "cannot open: %s",
                        reason ? reason : "unknown error");
    int first = fgetc(stream);
    fclose(stream);
    return first == EOF ? diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the file is empty") : STATUS_OK;
}

/* ---- callbacks of assimp ---- */

static FILE *stream_of(struct aiFile *file)
{
    return (FILE *)(void *)file->UserData;
}

static size_t on_read(struct aiFile *file, char *to, size_t size, size_t count)
{
    return fread(to, size, count, stream_of(file));
}

static size_t on_write(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file;
    (void)from;
    (void)size;
    (void)count;
    return 0;
}

static size_t on_tell(struct aiFile *file)
{
    long at = ftell(stream_of(file));
    return at < 0 ? 0 : (size_t)at;
}

static size_t on_size(struct aiFile *file)
{
    FILE *stream = stream_of(file);
    const long at = ftell(stream);
    const long size = at >= 0 && fseek(stream, 0, SEEK_END) == 0 ? ftell(stream) : -1;
    return size > 0 && fseek(stream, at, SEEK_SET) == 0 ? (size_t)size : 0;
}

static enum aiReturn on_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    int whence = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek(stream_of(file), (long)offset, whence) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void on_flush(struct aiFile *file)
{
    (void)file;
}

static struct aiFile *on_open(struct aiFileIO *io, const char *path, const char *mode)
{
    file_access *access = (file_access *)(void *)io->UserData;
    const char *reason = "is not writable";
    struct aiFile *file = NULL;
    bool outside = false;
    FILE *stream = strpbrk(mode, "wa+") ? NULL
                   : access->text && strcmp(path, access->path) == 0
                       ? fmemopen((char *)(uintptr_t)access->text, access->text_length, "rb")
                       : open_regular(path, access->root, &reason, &outside);
    if (stream && (file = calloc(1, sizeof *file))) {
        *file = (struct aiFile){on_read, on_write, on_tell, on_size, on_seek, on_flush, (char *)(void *)stream};
    } else if (stream) {
        fclose(stream);
    } else if (!access->missing[0]) {
        snprintf(access->missing, sizeof access->missing, "%s", *path ? path : "(no name)");
        access->reason = reason;
        access->outside = outside;
    }
    return file;
}

static void on_close(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (file) {
        fclose(stream_of(file));
        free(file);
    }
}

void files_prepare(file_access *access, const request *req)
{
    *access = (file_access){.io = {on_open, on_close, (char *)(void *)access}, .root = req->root};
}
