/* The files of a glTF scene: the file access of assimp, and what is checked before assimp reads the scene. */
#include "base/file.h"
#include "import/import.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- the file access of assimp --- */

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
    errno = 0;
    const int fd = strpbrk(mode, "wa+") ? -1 : files_open(path, access->root, &reason);
    const bool outside = fd < 0 && errno == EXDEV;
    FILE *stream = fd >= 0 ? fdopen(fd, "rb") : NULL;
    if (fd >= 0 && !stream)
        close(fd);
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

status files_needed(const file_access *access, diagnostic *why)
{
    if (access->outside)
        return diagnose(why, STATUS_BAD_INPUT, BELOW_REMEDY, "needs the file '%s', which %s", access->missing,
                        access->reason);
    return diagnose(why, STATUS_BAD_INPUT,
                    "put this file where the mesh file expects it, or remove the line that names it",
                    "needs the file '%s': %s", access->missing, access->reason ? access->reason : "cannot be opened");
}

/* --- the scene's file --- */

/* assimp checks the lengths of glTF itself, but assimp 5.4 reads text and binary files under either ending, which 5.2
 * refuses. */
status files_check(const request *req, diagnostic *why)
{
    char first[4];
    int fd;
    TRY(files_open_mesh(req, &fd, why));
    const ssize_t got = read(fd, first, sizeof first);
    close(fd);
    const bool binary = req->kind == FILE_GLB;
    if (got < 1)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the file is empty");
    if ((got == sizeof first && memcmp(first, "glTF", sizeof first) == 0) == binary)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "name a JSON file .gltf and a binary glTF file .glb",
                    binary ? "a binary glTF file begins with 'glTF'" : "this is a binary glTF file");
}
