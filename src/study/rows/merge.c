/* Merges the row files of all shards into one: every line of every file once, in the order of runs. */
#include "base/file.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/rows/table.h"
#include <stdlib.h>
#include <string.h>

/* A line of any file. Lines of cells that the study no longer has, and lines with a wrong checksum, are merged, too. */
typedef struct merged_line {
    const csv *source;
    size_t row, position;
    long run;
    uint64_t values; /* a hash of its values, in any order of columns */
} merged_line;

static int compare_values(const void *a, const void *b)
{
    const merged_line *x = a, *y = b;
    if (x->values != y->values)
        return x->values < y->values ? -1 : 1;
    return (x->position > y->position) - (x->position < y->position);
}

/* The rows of a run stay together and in order, and runs are in the order of runs.json. */
static int compare_runs(const void *a, const void *b)
{
    const merged_line *x = a, *y = b;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    return (x->position > y->position) - (x->position < y->position);
}

static void list_table(const row_files *files, const csv *source, merged_line *lines, size_t *count)
{
    const int run = csv_column(source, "run");
    for (size_t row = 0; row < source->row_count; row++, ++*count)
        lines[*count] = (merged_line){.source = source,
                                      .row = row,
                                      .position = *count,
                                      .run = runs_find(files->runs, csv_field(source, row, run))};
}

/* Whether two files have lines of one run, so that lines may be duplicates. All unknown runs count as one run. */
static status has_common_runs(const row_files *files, const merged_line *lines, size_t count, bool *common,
                              diagnostic *why)
{
    const csv **first = calloc(files->runs->count + 1, sizeof *first);
    *common = false;
    if (!first)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++) {
        const csv **first_source = &first[lines[i].run + 1];
        *common = *common || (*first_source && *first_source != lines[i].source);
        *first_source = lines[i].source;
    }
    free(first);
    return STATUS_OK;
}

static status hash_lines(merged_line *lines, size_t count, diagnostic *why)
{
    checksum_columns columns = {.count = 0};
    const csv *source = NULL;
    status code = STATUS_OK;
    for (size_t i = 0; i < count && code == STATUS_OK; i++) {
        if (lines[i].source != source) {
            checksum_columns_free(&columns);
            source = lines[i].source;
            code = checksum_columns_create(source->header, source->column_count, &columns, why);
        }
        if (code == STATUS_OK)
            lines[i].values = checksum_values(&columns, source->fields + lines[i].row * source->column_count);
    }
    checksum_columns_free(&columns);
    return code;
}

/* Keeps one of the equal lines of different files. */
static status drop_copies(merged_line *lines, size_t *count, diagnostic *why)
{
    size_t kept = 0;
    TRY(hash_lines(lines, *count, why));
    qsort(lines, *count, sizeof *lines, compare_values);
    for (size_t i = 0; i < *count; i++)
        if (kept == 0 || lines[kept - 1].values != lines[i].values || lines[kept - 1].source == lines[i].source)
            lines[kept++] = lines[i];
    *count = kept;
    return STATUS_OK;
}

/* Lists all different lines of all files, in the order of runs. */
static status list_lines(const row_files *files, merged_line **out, size_t *count, diagnostic *why)
{
    size_t total = 0;
    bool common;
    for (size_t i = 0; i < files->count; i++)
        total += files->tables[i]->row_count;
    merged_line *lines = malloc((total + 1) * sizeof *lines);
    *out = lines;
    *count = 0;
    if (!lines)
        return out_of_memory(why);
    for (size_t i = 0; i < files->count; i++)
        if (files->tables[i]->header)
            list_table(files, files->tables[i], lines, count);
    TRY(has_common_runs(files, lines, *count, &common, why));
    if (common)
        TRY(drop_copies(lines, count, why));
    qsort(lines, *count, sizeof *lines, compare_runs);
    return STATUS_OK;
}

/* Writes lines of one file, converted to the common columns. */
static status write_lines(FILE *out, const merged_line *lines, size_t count, const char *header, diagnostic *why)
{
    const csv *source = lines[0].source;
    char *from = strndup(source->raw, source->start[0]);
    csv_layout *layout = NULL;
    csv_buffer converted = {0};
    status code = from ? csv_layout_create(from, header, &layout, why) : out_of_memory(why);
    const bool same_columns = from && strcmp(from, header) == 0;
    for (size_t i = 0; code == STATUS_OK && i < count; i++) {
        const size_t start = source->start[lines[i].row], size = source->start[lines[i].row + 1] - start;
        if (same_columns) {
            fwrite(source->raw + start, 1, size, out);
        } else if ((code = csv_layout_place(layout, source->raw + start, size, &converted, why)) == STATUS_OK) {
            fwrite(converted.text, 1, converted.size, out);
            converted.size = 0;
        }
    }
    csv_buffer_free(&converted);
    csv_layout_destroy(layout);
    free(from);
    return code;
}

/* The header extended by the additional columns of all files; fresh memory, or NULL. */
static char *joined_header(const row_files *files, const char *header)
{
    char *all = strdup(header);
    for (size_t i = 0; all && i < files->count; i++) {
        const csv *source = files->tables[i];
        size_t added;
        char *columns = source->header ? strndup(source->raw, source->start[0]) : strdup(header);
        char *more = columns ? csv_header_extend(all, columns, &added) : NULL;
        free(columns);
        free(all);
        all = more;
    }
    return all;
}

static status write_joined(const row_files *files, const char *path, const char *header, diagnostic *why)
{
    merged_line *lines = NULL;
    size_t count = 0;
    file_writer writer;
    char *all = joined_header(files, header);
    status code = all ? list_lines(files, &lines, &count, why) : out_of_memory(why);
    THEN(code, file_writer_open(&writer, path, why));
    if (code == STATUS_OK) {
        fputs(all, writer.stream);
        for (size_t from = 0, to; code == STATUS_OK && from < count; from = to) {
            for (to = from + 1; to < count && lines[to].source == lines[from].source; to++) {
            }
            code = write_lines(writer.stream, lines + from, to - from, all, why);
        }
        code = file_writer_end(&writer, code, why);
    }
    free(lines);
    free(all);
    return code;
}

/* Fails for lines that are not rows, and for two rows of one repetition, of which a person must choose one. */
static status refuse(const row_files *files, diagnostic *why)
{
    for (size_t i = 0; i < files->issue_count; i++) {
        const row_issue *at = &files->issues[i];
        if (at->fault != ROW_DAMAGED && at->fault != ROW_DUPLICATE)
            continue;
        diagnostic_locate(why, at->path, at->line, 1);
        return diagnose(why, STATUS_BAD_INPUT,
                        at->fault == ROW_DAMAGED
                            ? "move the file away, or use a copy without this line"
                            : "keep one of the rows: move the other's file away, or use a copy without its line",
                        "%s", at->text);
    }
    return STATUS_OK;
}

/* Locks every file during the merge, so that no row is written into a file that is being replaced. */
static status lock_files(const char *joined, const char *header, char *const *paths, size_t path_count, table **locked,
                         size_t *count, diagnostic *why)
{
    status code = table_open(joined, header, &locked[0], why);
    *count = code == STATUS_OK;
    for (size_t i = 0; code == STATUS_OK && i < path_count; i++)
        if (strcmp(paths[i], joined) != 0 && (code = table_open(paths[i], header, &locked[*count], why)) == STATUS_OK)
            ++*count;
    return code;
}

typedef struct merge {
    const study *s;
    const char *results;
    size_t rows;
    diagnostic *verdict;
    bool judged;
} merge;

static status join(merge *m, row_kind kind, diagnostic *why)
{
    char **paths = NULL, *folder = study_folder(m->s, m->results), *header = row_file_header(m->s, kind);
    char *joined = folder ? row_file_path(folder, kind, 0, 1) : NULL;
    size_t count = 0, locked_count = 0;
    status code = header && joined ? row_files_list(folder, kind, &paths, &count, why) : out_of_memory(why);
    table **locked = calloc(count + 2, sizeof(table *));
    row_files *files = NULL;
    if (code == STATUS_OK && !locked)
        code = out_of_memory(why);
    if (code == STATUS_OK && count > 0) {
        code = lock_files(joined, header, paths, count, locked, &locked_count, why);
        THEN(code, row_files_read(m->s, m->results, kind, &files, why));
        THEN(code, refuse(files, why));
        if (code == STATUS_OK && files->count > 1)
            code = write_joined(files, joined, header, why);
        if (code == STATUS_OK) {
            m->rows = files->row_count + files->other_cells;
            m->judged = m->judged || row_files_judge(files, m->verdict) != STATUS_OK;
        }
    }
    row_files_destroy(files);
    while (locked_count > 0)
        table_close(locked[--locked_count]);
    for (size_t i = 0; i < count; i++)
        free(paths[i]);
    free(paths);
    free(locked);
    free(joined);
    free(header);
    free(folder);
    return code;
}

status study_merge(const study *s, const char *results, size_t *rows, diagnostic *verdict, diagnostic *why)
{
    merge m = {.s = s, .results = results, .verdict = verdict};
    char *folder = study_folder(s, results);
    status code = folder ? runs_merge(folder, scene_root(s->base), why) : out_of_memory(why);
    /* Worker rows come before rows: worker rows without their row are valid, a row without its worker rows is not. */
    static const row_kind kinds[] = {WORKER_ROWS, COMPARE_ROWS, ROWS};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && code == STATUS_OK; i++)
        code = join(&m, kinds[i], why);
    if (rows)
        *rows = m.rows;
    free(folder);
    return code;
}
