/* Converts rows between headers of different versions of the program, and widens files by missing columns. */
#include "base/file.h"
#include "study/rows/table.h"
#include <stdlib.h>
#include <string.h>

typedef struct names {
    char *text, **name;
    size_t count;
} names;

struct csv_layout {
    size_t from_count, to_count;
    int *source; /* for each column of `to`: the index of that column in `from`, or -1 */
};

static void names_free(names *n)
{
    free(n->text);
    free(n->name);
}

/* Splits a line, with or without its newline, into fields. False if memory runs out or quotes are invalid. */
static bool names_split(const char *line, size_t size, names *out)
{
    size -= size > 0 && line[size - 1] == '\n';
    size_t most = 1;
    for (size_t i = 0; i < size; i++)
        most += line[i] == ',';
    *out = (names){.text = strndup(line, size), .name = malloc(most * sizeof *out->name)};
    out->count = out->text && out->name ? csv_split(out->text, out->name) : 0;
    return out->count > 0;
}

static int find(const names *in, const char *name)
{
    for (size_t i = 0; i < in->count; i++)
        if (strcmp(in->name[i], name) == 0)
            return (int)i;
    return -1;
}

status csv_layout_create(const char *from, const char *to, csv_layout **out, diagnostic *why)
{
    names source = {0}, target = {0};
    *out = NULL;
    csv_layout *l = calloc(1, sizeof *l);
    if (l && names_split(from, strlen(from), &source) && names_split(to, strlen(to), &target)) {
        *l = (csv_layout){source.count, target.count, malloc(target.count * sizeof *l->source)};
        for (size_t i = 0; l->source && i < target.count; i++)
            l->source[i] = find(&source, target.name[i]);
    }
    names_free(&source);
    names_free(&target);
    if (!l || !l->source) {
        csv_layout_destroy(l);
        return out_of_memory(why);
    }
    *out = l;
    return STATUS_OK;
}

void csv_layout_destroy(csv_layout *l)
{
    if (l)
        free(l->source);
    free(l);
}

status csv_layout_place(const csv_layout *l, const char *lines, size_t size, csv_buffer *out, diagnostic *why)
{
    for (size_t at = 0; at < size;) {
        const char *newline = memchr(lines + at, '\n', size - at);
        const size_t length = newline ? (size_t)(newline - lines) - at + 1 : size - at;
        names fields;
        const bool right = names_split(lines + at, length, &fields) && fields.count == l->from_count;
        for (size_t i = 0; right && i < l->to_count; i++)
            csv_text(out, l->source[i] >= 0 ? fields.name[l->source[i]] : NULL);
        csv_end(out);
        names_free(&fields);
        if (!right || out->failed)
            return out_of_memory(why);
        at += length;
    }
    return STATUS_OK;
}

char *csv_header_extend(const char *header, const char *more, size_t *added)
{
    names first = {0}, second = {0};
    csv_buffer line = {0};
    *added = 0;
    bool right = names_split(header, strlen(header), &first) && names_split(more, strlen(more), &second);
    for (size_t i = 0; right && i < first.count; i++)
        csv_text(&line, first.name[i]);
    for (size_t i = 0; right && i < second.count; i++)
        if (find(&first, second.name[i]) < 0) {
            csv_text(&line, second.name[i]);
            ++*added;
        }
    csv_end(&line);
    names_free(&first);
    names_free(&second);
    if (right && !line.failed)
        return line.text;
    csv_buffer_free(&line);
    return NULL;
}

/* --- in a file --- */

enum { TABLE_BYTES_MAX = 1 << 30 };

/* Rewrites the file's lines under a wider header; the additional values are NA. */
static status widen(const char *path, const char *lines, const char *header, size_t added, diagnostic *why)
{
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    fputs(header, writer.stream);
    for (const char *line = lines, *end; (end = strchr(line, '\n')); line = end + 1) {
        fwrite(line, 1, (size_t)(end - line), writer.stream);
        for (size_t i = 0; i < added; i++)
            fputs(",NA", writer.stream);
        fputc('\n', writer.stream);
    }
    return file_writer_commit(&writer, why);
}

static status add_columns(const char *path, char *text, const char *header, csv_layout **layout, bool *replaced,
                          diagnostic *why)
{
    char *end = strchr(text, '\n');
    char *old = end ? strndup(text, (size_t)(end - text) + 1) : NULL;
    size_t added = 0;
    char *all = old ? csv_header_extend(old, header, &added) : NULL;
    status code = all ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && added > 0) {
        code = widen(path, end + 1, all, added, why);
        *replaced = code == STATUS_OK;
    }
    if (code == STATUS_OK && strcmp(all, header) != 0)
        code = csv_layout_create(header, all, layout, why);
    free(old);
    free(all);
    return code;
}

status csv_layout_settle(const char *path, const char *header, csv_layout **layout, bool *replaced, diagnostic *why)
{
    char *text;
    size_t size;
    *layout = NULL;
    *replaced = false;
    TRY(file_read(path, TABLE_BYTES_MAX, &text, &size, why));
    status code = STATUS_OK;
    if (size < strlen(header) || memcmp(text, header, strlen(header)) != 0)
        code = add_columns(path, text, header, layout, replaced, why);
    free(text);
    return code;
}
