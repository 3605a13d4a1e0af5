/* Files and their texts: which an import may open, how compressed ones are read, and how a text is divided into lines,
 * words and numbers. */
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "import/plain.h"
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum {
    MAPPED_MIN = 1 << 20,  /* bytes; smaller files are read */
    UNKNOWN_MAX = 1 << 16, /* bytes of a file of /proc, whose size is 0 */
    SUSPECT = 1 << 26,     /* expanded bytes of a small file that can take long; those of meshes are 3 to 30 times */
    SUSPECT_TIMES = 100,   /* the compressed ones */
    CHECKED = 1 << 16      /* expanded bytes that are enough for the check */
};

/* --- files --- */

file_kind file_kind_of(const char *path)
{
    static const char *const endings[] = {
        [FILE_OBJ] = ".obj", [FILE_PLY] = ".ply", [FILE_STL] = ".stl", [FILE_GLTF] = ".gltf", [FILE_GLB] = ".glb"};
    size_t length = strlen(path);
    if (length > 3 && strcasecmp(path + length - 3, ".gz") == 0)
        length -= 3;
    for (int kind = 0; kind < FILE_UNKNOWN; kind++) {
        const size_t size = strlen(endings[kind]);
        if (length >= size && strncasecmp(path + length - size, endings[kind], size) == 0)
            return (file_kind)kind;
    }
    return FILE_UNKNOWN;
}

int files_open(const char *path, const char *root, const char **reason)
{
    struct stat about;
    const int fd = below_open(path, root);
    int error = errno;
    if (fd < 0 && error == EXDEV) {
        *reason = BELOW_WHAT;
    } else if (fd < 0 || fstat(fd, &about) != 0) {
        error = errno;
        *reason = strerrordesc_np(error);
        *reason = *reason ? *reason : "unknown error";
    } else if (S_ISREG(about.st_mode)) {
        return fd;
    } else {
        error = EINVAL;
        *reason = S_ISDIR(about.st_mode) ? "is a folder" : "is not a regular file";
    }
    if (fd >= 0)
        close(fd);
    errno = error;
    return -1;
}

int files_open_beside(const request *req, const char *name, const char **reason)
{
    const char *slash = strrchr(req->path, '/');
    const int folder = slash && name[0] != '/' ? (int)(slash + 1 - req->path) : 0;
    char *path = text_format("%.*s%s", folder, req->path, name);
    errno = ENOMEM;
    const int fd = path ? files_open(path, req->root, reason) : -1, error = errno;
    free(path);
    errno = error;
    return fd;
}

/* Reads to the end of the file, or to `room` bytes; returns their number, -1 with errno on failure. */
static ssize_t read_bytes(int fd, char *to, size_t room)
{
    size_t done = 0;
    while (done < room) {
        const ssize_t got = read(fd, to + done, room - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return -1;
        if (got == 0)
            break;
        done += (size_t)got;
    }
    return (ssize_t)done;
}

/* Maps a large file. The system fills the rest of the last page with zeros; \n is written there, into a copy of this
 * page, if there is room. False: the file must be read. */
static bool map(int fd, size_t size, file_text *text)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), last = size / page * page;
    if (size < MAPPED_MIN || size - last > page - 2)
        return false;
    char *bytes = mmap(NULL, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, fd, 0);
    if (bytes == MAP_FAILED)
        return false;
    if (mprotect(bytes + last, size - last, PROT_READ | PROT_WRITE) != 0) {
        munmap(bytes, size);
        return false;
    }
    memcpy(bytes + size, "\n", 2);
    *text = (file_text){bytes, size, size};
    return true;
}

static int read_all(int fd, size_t size, file_text *text)
{
    const size_t room = size > 0 ? size : UNKNOWN_MAX;
    char *bytes = malloc(room + 2);
    const ssize_t got = bytes ? read_bytes(fd, bytes, room) : -1;
    if (got < 0) {
        const int error = bytes ? errno : ENOMEM;
        free(bytes);
        return error;
    }
    memcpy(bytes + got, "\n", 2);
    *text = (file_text){bytes, (size_t)got, 0};
    return 0;
}

/* --- compressed files: RFC 1952 --- */

bool files_compressed(const char *bytes, size_t size)
{
    return size >= 18 && memcmp(bytes, "\x1f\x8b\x08", 3) == 0; /* the size of an empty member; deflate */
}

/* What is being read: for the checks and the errors. most: bytes that a compressed file may expand to. */
typedef struct reading {
    const request *req;
    file_kind kind;
    size_t most;
    diagnostic *why;
} reading;

static status expands_too_far(const reading *r, size_t compressed)
{
    return diagnose(r->why, STATUS_BAD_INPUT, "raise --memory-limit, or use a mesh with fewer triangles",
                    "its %.3g MB expand to more than %.0f MB, a quarter of the memory that reading it may take",
                    1e-6 * (double)compressed, 1e-6 * (double)r->most);
}

/* Fills *out, which grows up to the limit. What has been expanded is checked on the way: a small file can have a large
 * text. */
static status inflate_all(z_stream *z, const reading *r, file_text *out, size_t room)
{
    const size_t compressed = z->avail_in;
    for (int code = Z_OK;;) {
        if (out->size + 2 >= room) {
            const size_t more = room < r->most / 2 ? 2 * room : r->most + 3;
            char *bytes = realloc(out->bytes, more);
            if (!bytes)
                return no_memory_for(r->req, r->why);
            out->bytes = bytes;
            room = more;
        }
        const size_t left = room - out->size - 2, chunk = out->size < CHECKED ? CHECKED : 1 << 24;
        const uInt part = (uInt)(left < chunk ? left : chunk);
        z->next_out = (Bytef *)out->bytes + out->size;
        z->avail_out = part;
        code = inflate(z, Z_NO_FLUSH);
        out->size += part - z->avail_out;
        if (out->size >= CHECKED)
            TRY(r->req->check(r->kind, out->bytes, out->size, false, r->why));
        if (out->size > r->most)
            return expands_too_far(r, compressed);
        if (out->size > SUSPECT && out->size / SUSPECT_TIMES > compressed - z->avail_in)
            return diagnose(r->why, STATUS_BAD_INPUT, "if it is a mesh all the same, expand it first",
                            "its first %.3g MB expand to %.0f MB, over %d times as much, as no mesh does",
                            1e-6 * (double)(compressed - z->avail_in), 1e-6 * (double)out->size, (int)SUSPECT_TIMES);
        if (code == Z_STREAM_END) { /* members can follow one another */
            if (!files_compressed((const char *)z->next_in, z->avail_in))
                break;
            code = inflateReset(z);
        }
        if (code == Z_MEM_ERROR)
            return no_memory_for(r->req, r->why);
        if (code != Z_OK)
            return diagnose(r->why, STATUS_BAD_INPUT, "check that the file is complete, or compress it again",
                            "the compressed file is damaged");
    }
    memcpy(out->bytes + out->size, "\n", 2);
    return STATUS_OK;
}

static status inflate_text(const file_text *text, const reading *r, file_text *plain)
{
    enum { GZIP = 16 + MAX_WBITS };
    const size_t room = text->size < r->most / 4 ? 4 * text->size : r->most + 3;
    z_stream z = {.next_in = (Bytef *)text->bytes, .avail_in = (uInt)text->size};
    if (text->size > UINT_MAX)
        return diagnose(r->why, STATUS_BAD_INPUT, "expand it", "the compressed file is larger than 4 GB");
    plain->bytes = malloc(room);
    if (!plain->bytes || inflateInit2(&z, GZIP) != Z_OK)
        return no_memory_for(r->req, r->why);
    const status code = inflate_all(&z, r, plain, room);
    inflateEnd(&z);
    return code;
}

/* Replaces a compressed text. */
static status decompress(file_text *text, const reading *r)
{
    file_text plain = {0};
    const status code = inflate_text(text, r, &plain);
    files_release(text);
    *text = plain;
    return code;
}

status files_read(const request *req, int fd, file_kind kind, file_text *text, diagnostic *why)
{
    const uint64_t quarter = req->memory_mib << 18, all = SIZE_MAX / 2;
    const reading r = {req, kind, (size_t)(quarter && quarter < all ? quarter : all), why};
    struct stat about;
    *text = (file_text){0};
    int error = fstat(fd, &about) == 0 ? 0 : errno;
    if (!error && !map(fd, (size_t)about.st_size, text))
        error = read_all(fd, (size_t)about.st_size, text);
    close(fd);
    if (error == ENOMEM)
        return no_memory_for(req, why);
    if (error)
        return system_error(why, STATUS_BAD_INPUT, NULL, "cannot read", error, "give a readable mesh file");
    status code = STATUS_OK;
    if (kind != FILE_BUFFER && files_compressed(text->bytes, text->size)) /* a buffer may begin with any bytes */
        code = decompress(text, &r);
    THEN(code, req->check(kind, text->bytes, text->size, true, why));
    if (code != STATUS_OK)
        files_release(text);
    return code;
}

void files_release(file_text *text)
{
    if (text->mapped)
        munmap(text->bytes, text->mapped);
    else
        free(text->bytes);
    *text = (file_text){0};
}

status files_open_mesh(const request *req, int *fd, diagnostic *why)
{
    const char *reason = "";
    diagnostic_locate(why, req->path, 0, 0);
    *fd = files_open(req->path, req->root, &reason);
    if (*fd < 0 && errno == EXDEV)
        return diagnose(why, STATUS_BAD_INPUT, BELOW_REMEDY, "%s", reason);
    if (*fd < 0)
        return diagnose(why, STATUS_BAD_INPUT, "give a readable mesh file", "cannot open: %s", reason);
    return STATUS_OK;
}

/* --- texts --- */

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\f' || c == '\v';
}

size_t text_begin(const char *text, size_t size)
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

lines lines_of(const char *text, size_t size)
{
    return (lines){.at = text + text_begin(text, size), .end = text + size, .line = 1};
}

bool lines_next(lines *l)
{
    while (l->at < l->end && !is_line_end(*l->at))
        l->at++;
    if (l->at >= l->end)
        return false;
    l->at += l->at[0] == '\r' && l->at[1] == '\n' ? 2 : 1;
    l->line++;
    return l->at < l->end;
}

bool lines_word(lines *l, const char **word, size_t *length)
{
    while (l->at < l->end && is_blank(*l->at))
        l->at++;
    const char *p = l->at;
    while (p < l->end && !is_blank(*p) && !is_line_end(*p))
        p++;
    *word = l->at;
    *length = (size_t)(p - l->at);
    l->at = p;
    return *length > 0;
}

bool lines_any_word(lines *l, const char **word, size_t *length)
{
    while (!lines_word(l, word, length))
        if (!lines_next(l))
            return false;
    return true;
}

bool lines_number(const char *word, size_t length, double *number)
{
    const char *at = word;
    return number_scan(&at, number) && at == word + length;
}

bool lines_is(const char *word, size_t length, const char *text)
{
    return strlen(text) == length && strncasecmp(word, text, length) == 0;
}

size_t lines_rest(const lines *l, const char **text)
{
    const char *from = l->at;
    while (from < l->end && is_blank(*from))
        from++;
    const char *to = from;
    while (to < l->end && !is_line_end(*to))
        to++;
    while (to > from && is_blank(to[-1]))
        to--;
    *text = from;
    return (size_t)(to - from);
}
