/* Kept files are named by the number of their cell. images/cells.tsv has the identities of the cells in that numbering;
 * when the grid has changed, the files are renamed. Files of cells that the study no longer has are named by identity,
 * and get a number again when the cell returns. */
#include "base/file.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "study/plan/identity.h"
#include "study/plan/keep.h"
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { IDENTITY_DIGITS = 16, CELLS_BYTES_MAX = 16 << 20 };

/* The identities of cells, by number. */
typedef struct numbering {
    uint64_t *identity;
    size_t count;
} numbering;

static char *cells_path(const char *images)
{
    return text_format("%s/cells.tsv", images);
}

/* The numbering of the files in the folder: the lines of cells.tsv up to the first damaged one; empty without the
 * file. */
static status read_numbering(const char *images, const char *root, numbering *out, diagnostic *why)
{
    char *path = cells_path(images), *text = NULL;
    size_t size;
    *out = (numbering){NULL, 0};
    status code = path ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && access(path, F_OK) == 0)
        code = file_read_below(path, root, CELLS_BYTES_MAX, &text, &size, why);
    free(path);
    if (code != STATUS_OK || !text)
        return code;
    out->identity = calloc(size + 1, sizeof *out->identity);
    char *line = strchr(text, '\n');
    for (; out->identity && line && line[1]; line = strchr(line + 1, '\n')) {
        char *end;
        const unsigned long number = strtoul(line + 1, &end, 10);
        if (*end != '\t' || number != out->count)
            break;
        out->identity[out->count++] = strtoull(end + 1, NULL, 16);
    }
    free(text);
    return out->identity ? STATUS_OK : out_of_memory(why);
}

/* Files renamed to identities must be on disk before the new numbering: after a power cut, a file with an old number
 * would belong to another cell. */
static status write_numbering(const study *s, const char *images, diagnostic *why)
{
    file_writer writer;
    char *path = cells_path(images);
    if (path)
        file_flush_folder(path);
    status code = path ? file_writer_open(&writer, path, why) : out_of_memory(why);
    free(path);
    if (code != STATUS_OK)
        return code;
    fputs("cell\tidentity\n", writer.stream);
    for (size_t cell = 0; cell < study_cell_count(s); cell++)
        fprintf(writer.stream, "%zu\t%016" PRIx64 "\n", cell, s->identity[cell]);
    return file_writer_commit(&writer, why);
}

static bool is_current(const study *s, const numbering *n)
{
    return n->count == study_cell_count(s) && memcmp(n->identity, s->identity, n->count * sizeof *n->identity) == 0;
}

/* The length of the number or identity that a name starts with, before "." or "-"; 0 if there is none. */
static size_t head_of(const char *name, const char *digits, size_t least, size_t most)
{
    const size_t length = strspn(name, digits);
    return length >= least && length <= most && (name[length] == '.' || name[length] == '-') ? length : 0;
}

static status rename_in(const char *images, const char *name, char *other, diagnostic *why)
{
    char *from = text_format("%s/%s", images, name), *to = other ? text_format("%s/%s", images, other) : NULL;
    status code = from && to ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && rename(from, to) != 0)
        code = system_error(why, STATUS_FAILURE, from, "renaming failed", errno, NULL);
    free(other);
    free(from);
    free(to);
    return code;
}

/* Renames a file from the number of its cell to its identity. */
static status name_by_identity(const char *images, const char *name, const numbering *old, diagnostic *why)
{
    const size_t head = head_of(name, "0123456789", 4, 8);
    if (!head)
        return STATUS_OK;
    const size_t number = strtoul(name, NULL, 10);
    return rename_in(images, name,
                     number < old->count ? text_format("%016" PRIx64 "%s", old->identity[number], name + head)
                                         : text_format("unknown-%s", name),
                     why);
}

/* Renames a file from the identity of its cell to its number, if the study has the cell. */
static status name_by_number(const char *images, const char *name, const study *s, diagnostic *why)
{
    const size_t head = head_of(name, "0123456789abcdef", IDENTITY_DIGITS, IDENTITY_DIGITS);
    const size_t cell = head ? identity_cell(s, strtoull(name, NULL, 16)) : 0;
    if (!head || cell >= study_cell_count(s))
        return STATUS_OK;
    return rename_in(images, name, text_format("%04zu%s", cell, name + head), why);
}

static status rename_all(const study *s, const char *images, const numbering *old, diagnostic *why)
{
    struct dirent **names = NULL;
    const int count = scandir(images, &names, NULL, alphasort);
    status code = STATUS_OK;
    if (count < 0 && errno != ENOENT)
        return system_error(why, STATUS_FAILURE, images, "cannot be read", errno, "make the folder readable");
    for (int i = 0; i < count; i++) {
        if (code == STATUS_OK)
            code = old ? name_by_identity(images, names[i]->d_name, old, why)
                       : name_by_number(images, names[i]->d_name, s, why);
        free(names[i]);
    }
    free(names);
    return code;
}

static status renumber(const study *s, const char *images, bool *changed, diagnostic *why)
{
    numbering old;
    TRY(read_numbering(images, scene_root(s->base), &old, why));
    status code = STATUS_OK;
    *changed = !old.identity || !is_current(s, &old);
    if (*changed)
        code = rename_all(s, images, &old, why);
    THEN(code, write_numbering(s, images, why));
    THEN(code, rename_all(s, images, NULL, why));
    free(old.identity);
    return code;
}

status keep_renumber(const study *s, const char *folder, bool create, bool *changed, diagnostic *why)
{
    char *images = text_format("%s/images", folder);
    *changed = false;
    status code = images ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && create)
        code = file_make_directory(images, why);
    if (code == STATUS_OK && access(images, F_OK) == 0) {
        const int lock = open(images, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (lock >= 0)
            flock(lock, LOCK_EX);
        code = renumber(s, images, changed, why);
        if (lock >= 0)
            close(lock);
    }
    free(images);
    return code;
}
