/* Which files an import may open, and whether a file is complete before assimp reads it. */
#include "base/file.h"
#include "import/import.h"
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

status no_memory_for(const request *req, diagnostic *why)
{
    return diagnose_at(why, req->path, STATUS_BAD_INPUT,
                       "use a mesh of less detail, or export the file again if it is damaged",
                       "the file requires more memory than the limit of %llu MiB", (unsigned long long)req->memory_mib);
}

/* --- the file access of assimp --- */

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

/* --- is the file complete? ---
 *
 * A PLY or STL file must have the length that its header implies: assimp fills missing data with zeros or uninitialised
 * memory, reads headers without an end for minutes, and allocates memory by counts that no file can hold. OBJ has no
 * counts and no end marker. assimp checks the lengths of glTF itself, but assimp 5.4 reads text and binary glTF files
 * under either ending, which 5.2 refuses. PLY: Greg Turk, "The PLY Polygon File Format", 1994. STL: 80 bytes, a count,
 * and 50 bytes per facet; or a text from 'solid' to 'endsolid'. */

enum { PROPERTIES_MAX = 64, WORD_MAX = 63 };

typedef struct property {
    int count_bytes; /* size of a list's length; 0: not a list */
    int bytes;       /* size of a value */
} property;

typedef struct ply {
    const char *at, *end;
    long line;
    bool ascii, big;
    diagnostic *why;
    struct element {
        char name[WORD_MAX + 1];
        uint64_t count;
        property properties[PROPERTIES_MAX];
        int property_count;
    } elements[16];
    int element_count;
} ply;

static status truncated(diagnostic *why, const char *what, uint64_t index, uint64_t count)
{
    return diagnose(why, STATUS_BAD_INPUT, "the file is truncated, or its header is wrong; export it again",
                    "the file ends within %s %llu of %llu", what, (unsigned long long)index + 1,
                    (unsigned long long)count);
}

/* ---- header ---- */

static int type_bytes(const char *type)
{
    static const struct {
        const char *name;
        int bytes;
    } types[] = {
        {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},   {"short", 2}, {"ushort", 2},
        {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},    {"int32", 4}, {"uint32", 4},
        {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8},
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(type, types[i].name) == 0)
            return types[i].bytes;
    return 0;
}

static status bad_header(ply *p, const char *what)
{
    diagnostic_locate(p->why, p->why->file, p->line, 0);
    return diagnose(p->why, STATUS_BAD_INPUT, "fix the header", "%s", what);
}

static status add_property(ply *p, char words[6][WORD_MAX + 1], int count)
{
    if (p->element_count == 0)
        return bad_header(p, "a property without an element");
    struct element *e = &p->elements[p->element_count - 1];
    bool list = count >= 5 && strcmp(words[1], "list") == 0;
    property parsed = {.count_bytes = list ? type_bytes(words[2]) : 0, .bytes = type_bytes(words[list ? 3 : 1])};
    if (!parsed.bytes || (list && !parsed.count_bytes))
        return bad_header(p, "a property of unknown type");
    if (e->property_count == PROPERTIES_MAX)
        return bad_header(p, "more than 64 properties");
    e->properties[e->property_count++] = parsed;
    return STATUS_OK;
}

static status add_element(ply *p, const char *name, const char *number)
{
    if (p->element_count == (int)(sizeof p->elements / sizeof *p->elements))
        return bad_header(p, "more than 16 PLY elements");
    char *end = NULL;
    uint64_t count = isdigit((unsigned char)*number) && strlen(number) < 19 ? strtoull(number, &end, 10) : 0;
    if (!end || *end)
        return bad_header(p, "the count of an element is invalid");
    struct element *e = &p->elements[p->element_count++];
    e->count = count;
    strcpy(e->name, name);
    return STATUS_OK;
}

/* Reads the words of the next line; returns their number, -1 if there is no complete line. */
static int next_line(ply *p, char words[6][WORD_MAX + 1])
{
    const char *end = p->at < p->end ? memchr(p->at, '\n', (size_t)(p->end - p->at)) : NULL;
    int count = 0;
    if (!end)
        return -1;
    p->line++;
    for (const char *at = p->at; at < end && count < 6;) {
        int length = 0;
        for (; at < end && isspace((unsigned char)*at); at++) {
        }
        for (; at < end && !isspace((unsigned char)*at); at++)
            if (length < WORD_MAX)
                words[count][length++] = *at;
        words[count][length] = 0;
        count += length > 0;
    }
    p->at = end + 1;
    return count;
}

static status read_header(ply *p)
{
    char words[6][WORD_MAX + 1];
    for (bool format = false;;) {
        int count = next_line(p, words);
        status code = STATUS_OK;
        if (count < 0)
            return bad_header(p, "the header has no end");
        if (count == 0)
            continue;
        if (strcmp(words[0], "end_header") == 0)
            return format ? STATUS_OK : bad_header(p, "the header names no format");
        if (p->line == 1 && strcasecmp(words[0], "ply") != 0)
            return bad_header(p, "a PLY file begins with the line 'ply'");
        if (strcmp(words[0], "format") == 0 && count >= 2) {
            p->ascii = strcmp(words[1], "ascii") == 0;
            p->big = strcmp(words[1], "binary_big_endian") == 0;
            format = p->ascii || p->big || strcmp(words[1], "binary_little_endian") == 0;
            code = format ? STATUS_OK
                          : bad_header(p, "the format is not ascii, binary_little_endian or binary_big_endian");
        } else if (strcmp(words[0], "element") == 0 && count >= 3) {
            code = add_element(p, words[1], words[2]);
        } else if (strcmp(words[0], "property") == 0 && count >= 3) {
            code = add_property(p, words, count);
        }
        if (code != STATUS_OK)
            return code;
    }
}

/* ---- body ---- */

/* Skips `count` words and stores the last one in *number. False at the end of the file. */
static bool skip_words(ply *p, uint64_t count, double *number)
{
    for (; count > 0; count--) {
        for (; p->at < p->end && isspace((unsigned char)*p->at); p->at++) {
        }
        char text[32];
        size_t length = 0;
        for (; p->at < p->end && !isspace((unsigned char)*p->at); p->at++)
            if (length < sizeof text - 1)
                text[length++] = *p->at;
        if (length == 0)
            return false;
        text[length] = 0;
        if (number && count == 1)
            *number = strtod(text, NULL);
    }
    return true;
}

static bool skip_bytes(ply *p, uint64_t count)
{
    const bool complete = (uint64_t)(p->end - p->at) >= count;
    p->at += complete ? count : 0;
    return complete;
}

/* Reads the length of a list, an integer of at most eight bytes. A length of type float or double makes no sense; its
 * bits, read as an integer, usually exceed the rest of the file, so that the file counts as truncated. */
static bool read_length(ply *p, int bytes, uint64_t *length)
{
    if (p->end - p->at < bytes)
        return false;
    *length = 0;
    for (int i = 0; i < bytes; i++) {
        uint64_t byte = (unsigned char)p->at[p->big ? bytes - 1 - i : i];
        *length |= byte << (8 * i);
    }
    p->at += bytes;
    return *length < (uint64_t)1 << 40;
}

static bool skip_property(ply *p, const property *skipped)
{
    uint64_t length = 1;
    if (p->ascii) {
        double number = 1;
        if (skipped->count_bytes && (!skip_words(p, 1, &number) || !(number >= 0 && number < 1e12)))
            return false;
        return skip_words(p, (uint64_t)number, NULL);
    }
    return (!skipped->count_bytes || read_length(p, skipped->count_bytes, &length)) &&
           skip_bytes(p, length * (uint64_t)skipped->bytes);
}

static status check_ply(ply *p)
{
    status code = read_header(p);
    for (int i = 0; i < p->element_count && code == STATUS_OK; i++) {
        const struct element *e = &p->elements[i];
        for (uint64_t k = 0; e->property_count && k < e->count; k++) {
            for (int q = 0; q < e->property_count; q++)
                if (!skip_property(p, &e->properties[q]))
                    return truncated(p->why, e->name, k, e->count);
        }
    }
    return code;
}

static status check_stl(const char *bytes, size_t size, diagnostic *why)
{
    uint64_t count = 0;
    for (size_t i = 0; size >= 84 && i < 4; i++)
        count |= (uint64_t)(unsigned char)bytes[80 + i] << 8 * i; /* little-endian */
    const uint64_t needed = 84 + 50 * count;
    if (size >= 84 && size == needed)
        return STATUS_OK;
    if (strncasecmp(bytes, "solid", size < 5 ? size : 5) == 0 && size > 5) {
        for (size_t i = size < 4096 ? 0 : size - 4096; i + 8 <= size; i++)
            if (strncasecmp(bytes + i, "endsolid", 8) == 0)
                return STATUS_OK;
        return diagnose(why, STATUS_BAD_INPUT, "the file is truncated; export it again",
                        "the text does not end in 'endsolid'");
    }
    if (size < 84)
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete and has the right ending",
                        "this is not a file of format STL");
    return size > needed ? STATUS_OK : truncated(why, "facet", (size - 84) / 50, count);
}

static status check_gltf(const char *bytes, size_t size, bool binary, diagnostic *why)
{
    if ((size >= 4 && memcmp(bytes, "glTF", 4) == 0) == binary)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "name a JSON file .gltf and a binary glTF file .glb",
                    binary ? "a binary glTF file begins with 'glTF'" : "this is a binary glTF file");
}

static status check_bytes(file_kind kind, const char *bytes, size_t size, diagnostic *why)
{
    ply p = {.at = bytes, .end = bytes + size, .why = why};
    switch (kind) {
    case FILE_PLY: return check_ply(&p);
    case FILE_STL: return check_stl(bytes, size, why);
    case FILE_GLTF:
    case FILE_GLB: return check_gltf(bytes, size, kind == FILE_GLB, why);
    case FILE_OBJ:
    case FILE_UNKNOWN: break;
    }
    return STATUS_OK;
}

status files_check_complete(const request *req, diagnostic *why)
{
    if (req->kind == FILE_OBJ)
        return STATUS_OK;
    struct stat about;
    int fd = below_open(req->path, req->root);
    const bool found = fd >= 0 && fstat(fd, &about) == 0;
    void *bytes = found ? mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE, fd, 0) : MAP_FAILED;
    const int reason = errno;
    if (fd >= 0)
        close(fd);
    if (bytes == MAP_FAILED && found && reason == ENOMEM)
        return no_memory_for(req, why);
    diagnostic_locate(why, req->path, 0, 0);
    if (bytes == MAP_FAILED)
        return diagnose(why, STATUS_BAD_INPUT, "give a readable mesh file", "cannot read: %s", strerrordesc_np(reason));
    status code = check_bytes(req->kind, bytes, (size_t)about.st_size, why);
    munmap(bytes, (size_t)about.st_size);
    return code;
}
