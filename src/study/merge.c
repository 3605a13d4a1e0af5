#include "base/file.h"
#include "study/csv_layout.h"
#include "study/row_files.h"
#include "study/table.h"
#include <stdlib.h>
#include <string.h>

/* Appends the rows of one file, starting at `from`, converted to the common columns. */
static status write_rows(FILE *out, const row_files *files, size_t from, size_t to, const char *header, diagnostic *why)
{
    const csv *of = files->rows[from].table;
    char *own = strndup(of->raw, of->start[0]);
    csv_layout *layout = NULL;
    csv_line placed = {0};
    status code = own ? csv_layout_create(own, header, &layout, why) : out_of_memory(why);
    for (size_t i = from; code == STATUS_OK && i < to; i++) {
        const size_t row = files->rows[i].row, start = of->start[row], size = of->start[row + 1] - start;
        if (strcmp(own, header) == 0) {
            fwrite(of->raw + start, 1, size, out);
        } else if ((code = csv_layout_place(layout, of->raw + start, size, &placed, why)) == STATUS_OK) {
            fwrite(placed.text, 1, placed.size, out);
            placed.size = 0;
        }
    }
    csv_line_free(&placed);
    csv_layout_destroy(layout);
    free(own);
    return code;
}

/* The header extended by the additional columns of all files; fresh memory, or NULL. */
static char *joined_header(const row_files *files, const char *header)
{
    char *all = strdup(header);
    for (size_t i = 0; all && i < files->count; i++) {
        const csv *of = files->tables[i];
        size_t added;
        char *own = of->header ? strndup(of->raw, of->start[0]) : strdup(header);
        char *more = own ? csv_header_extend(all, own, &added) : NULL;
        free(own);
        free(all);
        all = more;
    }
    return all;
}

/* Merges all rows of one kind into rows.csv, workers.csv or compare.csv, unchanged line by line. */
static status write_joined(const row_files *files, const char *path, const char *header, diagnostic *why)
{
    file_writer writer;
    char *all = joined_header(files, header);
    status code = all ? file_writer_open(&writer, path, why) : out_of_memory(why);
    if (code != STATUS_OK) {
        free(all);
        return code;
    }
    fputs(all, writer.stream);
    for (size_t from = 0, to; code == STATUS_OK && from < files->row_count; from = to) {
        for (to = from; to < files->row_count && files->rows[to].table == files->rows[from].table; to++) {
        }
        code = write_rows(writer.stream, files, from, to, all, why);
    }
    free(all);
    return file_writer_end(&writer, code, why);
}

/* Every file is locked during the merge, so that no row is written into a file that is being replaced. */
static status join(const study *s, const char *results, row_kind kind, size_t *rows, diagnostic *why)
{
    *rows = 0;
    row_files *files;
    status code = row_files_read(s, results, kind, &files, why);
    if (code != STATUS_OK || files->count == 0) {
        row_files_destroy(files);
        return code;
    }
    char *folder = study_folder(s, results), *header = row_file_header(s, kind);
    char *joined = folder ? row_file_path(folder, kind, 0, 1) : NULL;
    table **locked = calloc(files->count + 1, sizeof(table *));
    size_t locked_count = 0;
    code = joined && header && locked ? table_open(joined, header, &locked[0], why) : out_of_memory(why);
    if (code == STATUS_OK)
        locked_count = 1;
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++)
        if (strcmp(files->paths[i], joined) != 0 &&
            (code = table_open(files->paths[i], header, &locked[locked_count], why)) == STATUS_OK)
            locked_count++;
    row_files_destroy(files);
    files = NULL;
    THEN(code, row_files_read(s, results, kind, &files, why));
    if (code == STATUS_OK && files->count > 1)
        code = write_joined(files, joined, header, why);
    if (code == STATUS_OK)
        *rows = files->row_count;
    while (locked_count > 0)
        table_close(locked[--locked_count]);
    free(locked);
    row_files_destroy(files);
    free(joined);
    free(header);
    free(folder);
    return code;
}

status study_merge(const study *s, const char *results, size_t *rows, diagnostic *why)
{
    size_t joined = 0;
    /* Worker rows come first: worker rows without their row are valid, the opposite is not. */
    status code = join(s, results, WORKER_ROWS, &joined, why);
    THEN(code, join(s, results, COMPARE_ROWS, &joined, why));
    THEN(code, join(s, results, ROWS, &joined, why));
    if (rows)
        *rows = joined;
    return code;
}
