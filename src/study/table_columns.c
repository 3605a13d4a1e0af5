#include "study/table_columns.h"
#include "base/file.h"
#include <stdlib.h>
#include <string.h>

enum { TABLE_BYTES_MAX = 1 << 30 };

/* The file's lines below a wider header; each goes on with as many values that are not known. */
static status widen(const char *path, const char *lines, const char *header, size_t added, diagnostic *why)
{
    file_writer writer;
    status code = file_writer_open(&writer, path, why);
    if (code != STATUS_OK)
        return code;
    fputs(header, writer.stream);
    for (const char *line = lines, *end; (end = strchr(line, '\n')); line = end + 1) {
        fwrite(line, 1, (size_t)(end - line), writer.stream);
        for (size_t i = 0; i < added; i++)
            fputs(",NA", writer.stream);
        fputc('\n', writer.stream);
    }
    return file_writer_commit(&writer, why);
}

static status settle(const char *path, char *text, const char *header, csv_layout **layout, bool *replaced,
                     diagnostic *why)
{
    char *end = strchr(text, '\n');
    char *own = end ? strndup(text, (size_t)(end - text) + 1) : NULL;
    size_t added = 0;
    char *all = own ? csv_header_extend(own, header, &added) : NULL;
    status code = all ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && added > 0) {
        code = widen(path, end + 1, all, added, why);
        *replaced = code == STATUS_OK;
    }
    if (code == STATUS_OK && strcmp(all, header) != 0)
        code = csv_layout_create(header, all, layout, why);
    free(own);
    free(all);
    return code;
}

status table_columns_settle(const char *path, const char *header, csv_layout **layout, bool *replaced, diagnostic *why)
{
    char *text;
    size_t size;
    *layout = NULL;
    *replaced = false;
    status code = file_read(path, TABLE_BYTES_MAX, &text, &size, why);
    if (code != STATUS_OK)
        return code;
    if (size < strlen(header) || memcmp(text, header, strlen(header)) != 0)
        code = settle(path, text, header, layout, replaced, why);
    free(text);
    return code;
}
