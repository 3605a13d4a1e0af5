/* A library for LD_PRELOAD: records what a program does to the files below the folder RECORD_ROOT, in order, as lines
 * of the file RECORD_LOG. Files and folders are numbered by inode:
 *
 *   create INODE PATH      write INODE OFFSET HEX    truncate INODE SIZE    sync INODE     tmpfile INODE
 *   link INODE PATH        rename FROM TO            unlink PATH            mkdir INODE PATH    rmdir PATH
 *
 * RECORD_KILL=N kills the program (SIGKILL) before its Nth event. A stream from fdopen writes inside libc, where no
 * library can see it; so it becomes a stream of fopencookie, whose write is the one below. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILES_MAX = 1024, STREAMS_MAX = 64 };

static char root[PATH_MAX];
static int log_fd = -1;
static dev_t device;
static long kill_at, seen;
static bool recorded[FILES_MAX]; /* descriptors opened for writing below the root */
static struct {
    FILE *stream;
    int fd;
} streams[STREAMS_MAX];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

#define NEXT(name) ((__typeof__(&name))(uintptr_t)dlsym(RTLD_NEXT, #name))

static void begin_event(void)
{
    pthread_mutex_lock(&lock);
    if (++seen == kill_at)
        raise(SIGKILL);
}

__attribute__((format(printf, 1, 2))) static void event(const char *format, ...)
{
    char *line = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int size = vasprintf(&line, format, arguments);
    va_end(arguments);
    if (size < 0 || NEXT(write)(log_fd, line, (size_t)size) != size)
        abort(); /* without its log the run proves nothing */
    free(line);
}

static void end_event(void)
{
    const int error = errno;
    pthread_mutex_unlock(&lock);
    errno = error;
}

/* The path without links in its folder; false for one outside of the root. */
static bool below_root(const char *path, char out[PATH_MAX])
{
    char copy[PATH_MAX], folder[PATH_MAX];
    const int error = errno;
    if (log_fd < 0 || snprintf(copy, sizeof copy, "%s", path) >= (int)sizeof copy)
        return false;
    char *slash = strrchr(copy, '/');
    const char *name = slash ? slash + 1 : copy;
    if (slash)
        *slash = 0;
    const char *above = !slash ? "." : slash == copy ? "/" : copy;
    const bool known = realpath(above, folder) && snprintf(out, PATH_MAX, "%s/%s", folder, name) < PATH_MAX;
    errno = error;
    const size_t length = strlen(root);
    return known && strncmp(out, root, length) == 0 && (out[length] == '/' || !out[length]);
}

static bool number_of(int fd, unsigned long *number, long *size)
{
    struct stat about;
    if (log_fd < 0 || fstat(fd, &about) != 0 || about.st_dev != device)
        return false;
    *number = (unsigned long)about.st_ino;
    *size = (long)about.st_size;
    return true;
}

static bool is_recorded(int fd)
{
    return log_fd >= 0 && fd >= 0 && fd < FILES_MAX && recorded[fd];
}

int open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) ? (mode_t)va_arg(arguments, int) : 0;
    va_end(arguments);
    char whole[PATH_MAX];
    if ((flags & O_ACCMODE) == O_RDONLY || !below_root(path, whole))
        return NEXT(open)(path, flags, mode);
    begin_event();
    unsigned long number = 0;
    long size = 0;
    const bool is_unnamed = (flags & O_TMPFILE) == O_TMPFILE;
    const bool is_new = !is_unnamed && (flags & O_CREAT) && access(path, F_OK) != 0;
    const int fd = NEXT(open)(path, flags, mode);
    if (fd >= 0 && fd < FILES_MAX && number_of(fd, &number, &size)) {
        recorded[fd] = true;
        if (is_unnamed)
            event("tmpfile\t%lu\n", number);
        else if (is_new)
            event("create\t%lu\t%s\n", number, whole);
        else if (flags & O_TRUNC)
            event("truncate\t%lu\t0\n", number);
    }
    end_event();
    return fd;
}

int close(int fd)
{
    if (fd >= 0 && fd < FILES_MAX)
        recorded[fd] = false;
    return NEXT(close)(fd);
}

ssize_t write(int fd, const void *bytes, size_t count)
{
    unsigned long number = 0;
    long size = 0;
    if (!is_recorded(fd))
        return NEXT(write)(fd, bytes, count);
    begin_event();
    const bool known = number_of(fd, &number, &size);
    const long at = (fcntl(fd, F_GETFL) & O_APPEND) ? size : (long)lseek(fd, 0, SEEK_CUR);
    const ssize_t done = NEXT(write)(fd, bytes, count);
    char *hex = known && done > 0 ? malloc((size_t)done * 2 + 1) : NULL;
    for (ssize_t i = 0; hex && i < done; i++)
        sprintf(hex + 2 * i, "%02x", ((const unsigned char *)bytes)[i]);
    if (hex)
        event("write\t%lu\t%ld\t%s\n", number, at, hex);
    free(hex);
    end_event();
    return done;
}

int ftruncate(int fd, off_t length)
{
    unsigned long number = 0;
    long size = 0;
    begin_event();
    const int code = NEXT(ftruncate)(fd, length);
    if (code == 0 && is_recorded(fd) && number_of(fd, &number, &size))
        event("truncate\t%lu\t%ld\n", number, (long)length);
    end_event();
    return code;
}

/* Also of folders, which are opened for reading. */
int fsync(int fd)
{
    unsigned long number = 0;
    long size = 0;
    begin_event();
    const int code = NEXT(fsync)(fd);
    if (code == 0 && number_of(fd, &number, &size))
        event("sync\t%lu\n", number);
    end_event();
    return code;
}

int rename(const char *from, const char *to)
{
    char old[PATH_MAX], new[PATH_MAX];
    const bool known = below_root(from, old) && below_root(to, new);
    begin_event();
    const int code = NEXT(rename)(from, to);
    if (code == 0 && known)
        event("rename\t%s\t%s\n", old, new);
    end_event();
    return code;
}

/* Only of open files, by /proc/self/fd. */
int linkat(int from_folder, const char *from, int folder, const char *path, int flags)
{
    char whole[PATH_MAX];
    unsigned long number = 0;
    long size = 0;
    int fd;
    const bool known = sscanf(from, "/proc/self/fd/%d", &fd) == 1 && below_root(path, whole);
    begin_event();
    const int code = NEXT(linkat)(from_folder, from, folder, path, flags);
    if (code == 0 && known && number_of(fd, &number, &size))
        event("link\t%lu\t%s\n", number, whole);
    end_event();
    return code;
}

static void removed(const char *what, bool known, const char *whole)
{
    if (known)
        event("%s\t%s\n", what, whole);
}

int unlink(const char *path)
{
    char whole[PATH_MAX];
    const bool known = below_root(path, whole);
    begin_event();
    const int code = NEXT(unlink)(path);
    removed("unlink", code == 0 && known, whole);
    end_event();
    return code;
}

int unlinkat(int folder, const char *name, int flags)
{
    char of[64], above[PATH_MAX], path[2 * PATH_MAX], whole[PATH_MAX];
    snprintf(of, sizeof of, "/proc/self/fd/%d", folder);
    const ssize_t length = readlink(of, above, sizeof above - 1);
    above[length > 0 ? length : 0] = 0;
    snprintf(path, sizeof path, "%s/%s", above, name);
    const bool known = below_root(path, whole);
    begin_event();
    const int code = NEXT(unlinkat)(folder, name, flags);
    removed(flags & AT_REMOVEDIR ? "rmdir" : "unlink", code == 0 && known, whole);
    end_event();
    return code;
}

int rmdir(const char *path)
{
    char whole[PATH_MAX];
    const bool known = below_root(path, whole);
    begin_event();
    const int code = NEXT(rmdir)(path);
    removed("rmdir", code == 0 && known, whole);
    end_event();
    return code;
}

int mkdir(const char *path, mode_t mode)
{
    char whole[PATH_MAX];
    struct stat about;
    const bool known = below_root(path, whole);
    begin_event();
    const int code = NEXT(mkdir)(path, mode);
    if (code == 0 && known && stat(path, &about) == 0)
        event("mkdir\t%lu\t%s\n", (unsigned long)about.st_ino, whole);
    end_event();
    return code;
}

/* --- streams --- */

static ssize_t stream_write(void *cookie, const char *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t now = write((int)(intptr_t)cookie, bytes + done, size - done);
        if (now < 0 && errno != EINTR)
            return 0;
        done += now > 0 ? (size_t)now : 0;
    }
    return (ssize_t)done;
}

static int stream_close(void *cookie)
{
    for (int i = 0; i < STREAMS_MAX; i++)
        if (streams[i].stream && streams[i].fd == (int)(intptr_t)cookie)
            streams[i].stream = NULL;
    return close((int)(intptr_t)cookie);
}

FILE *fdopen(int fd, const char *mode)
{
    if (!is_recorded(fd))
        return NEXT(fdopen)(fd, mode);
    FILE *stream =
        fopencookie((void *)(intptr_t)fd, mode, (cookie_io_functions_t){.write = stream_write, .close = stream_close});
    pthread_mutex_lock(&lock);
    int i = 0;
    while (i < STREAMS_MAX && streams[i].stream)
        i++;
    if (!stream || i == STREAMS_MAX)
        abort();
    streams[i].stream = stream;
    streams[i].fd = fd;
    pthread_mutex_unlock(&lock);
    return stream;
}

int fileno(FILE *stream)
{
    for (int i = 0; i < STREAMS_MAX; i++)
        if (streams[i].stream == stream)
            return streams[i].fd;
    return NEXT(fileno)(stream);
}

__attribute__((constructor)) static void begin(void)
{
    const char *path = getenv("RECORD_LOG"), *below = getenv("RECORD_ROOT"), *at = getenv("RECORD_KILL");
    struct stat about;
    if (!path || !below || !realpath(below, root) || stat(root, &about) != 0)
        return;
    device = about.st_dev;
    kill_at = at ? atol(at) : 0;
    log_fd = NEXT(open)(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
}
