#include "base/file.h"
#include "study/row_files.h"
#include "study/table.h"
#include <stdlib.h>
#include <string.h>

static status no_memory(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "", "out of memory");
}

/* All rows of one kind into rows.csv, workers.csv or compare.csv, line by line as they are. */
static status write_joined(const row_files *files, const char *path, const char *header, diagnostic *why)
{
    file_writer writer;
    status code = file_writer_open(&writer, path, why);
    if (code != STATUS_OK)
        return code;
    fputs(header, writer.stream);
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        size_t from = ref->table->start[ref->row];
        fwrite(ref->table->raw + from, 1, ref->table->start[ref->row + 1] - from, writer.stream);
    }
    return file_writer_commit(&writer, why);
}

/* Every file is locked meanwhile, so that no row is written into one that is being replaced. */
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
    code = joined && header && locked ? table_open(joined, header, &locked[0], why) : no_memory(why);
    if (code == STATUS_OK)
        locked_count = 1;
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++)
        if (strcmp(files->paths[i], joined) != 0 &&
            (code = table_open(files->paths[i], header, &locked[locked_count], why)) == STATUS_OK)
            locked_count++;
    row_files_destroy(files);
    files = NULL;
    if (code == STATUS_OK)
        code = row_files_read(s, results, kind, &files, why);
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
    /* Worker rows first: they may be there without their row, but not the other way round. */
    status code = join(s, results, WORKER_ROWS, &joined, why);
    if (code == STATUS_OK)
        code = join(s, results, COMPARE_ROWS, &joined, why);
    if (code == STATUS_OK)
        code = join(s, results, ROWS, &joined, why);
    if (rows)
        *rows = joined;
    return code;
}
