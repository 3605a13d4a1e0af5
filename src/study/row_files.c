#include "study/row_files.h"
#include "base/status.h"
#include "base/file.h"
#include "base/array.h"
#include "base/text.h"
#include "study/compare_rows.h"
#include "study/row_check.h"
#include "study/row_read.h"
#include "study/rows.h"
#include "scene/model/open.h"
#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const stems[] = {"rows", "workers", "compare"};

char *study_folder(const study *s, const char *results)
{
    return text_format("%s/%s", results, s->name);
}

char *row_file_path(const char *folder, row_kind kind, long shard, long shards)
{
    return shards > 1 ? text_format("%s/%s.shard-%ld-of-%ld.csv", folder, stems[kind], shard, shards)
                      : text_format("%s/%s.csv", folder, stems[kind]);
}

const char *row_file_stem(row_kind kind)
{
    return stems[kind];
}

char *row_file_header(const study *s, row_kind kind)
{
    static row_columns *const columns[] = {row_each_column, worker_each_column, compare_each_column};
    csv_line line = {0};
    row_columns_header(&line, s, columns[kind]);
    if (!line.failed)
        return line.text;
    csv_line_free(&line);
    return NULL;
}

typedef struct shard_name {
    long shard, shards;
} shard_name;

static int compare_shards(const void *a, const void *b)
{
    const shard_name *x = a, *y = b;
    if (x->shards != y->shards)
        return x->shards < y->shards ? -1 : 1;
    return (x->shard > y->shard) - (x->shard < y->shard);
}

/* Whether name is exactly the file of a shard; rows.shard-0-of-2.torn.csv is not. */
static bool parse_shard(const char *name, row_kind kind, shard_name *out)
{
    char format[64], again[128];
    snprintf(format, sizeof format, "%s.shard-%%9ld-of-%%9ld.csv", stems[kind]);
    if (sscanf(name, format, &out->shard, &out->shards) != 2)
        return false;
    snprintf(again, sizeof again, "%s.shard-%ld-of-%ld.csv", stems[kind], out->shard, out->shards);
    return strcmp(name, again) == 0;
}

/* The files of the shards in a folder, sorted. *list is owned by the caller; NULL after an error. */
static status list_shards(const char *folder, row_kind kind, shard_name **list, size_t *count, diagnostic *why)
{
    struct dirent **entries = NULL;
    const int found = scandir(folder, &entries, NULL, NULL);
    *count = 0;
    *list = NULL;
    if (found < 0 && errno != ENOENT)
        return system_error(why, STATUS_FAILURE, folder, "cannot be read", errno, "give a folder that can be read");
    *list = calloc(found > 0 ? (size_t)found : 1, sizeof **list);
    for (int i = 0; i < found; i++) {
        *count += *list && parse_shard(entries[i]->d_name, kind, &(*list)[*count]);
        free(entries[i]);
    }
    free(entries);
    if (!*list)
        return out_of_memory(why);
    qsort(*list, *count, sizeof **list, compare_shards);
    return STATUS_OK;
}

status row_files_list(const char *folder, row_kind kind, char ***paths, size_t *count, diagnostic *why)
{
    shard_name *shards;
    size_t shard_count;
    *paths = NULL;
    *count = 0;
    TRY(list_shards(folder, kind, &shards, &shard_count, why));
    char **list = calloc(shard_count + 1, sizeof *list);
    status code = list ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i <= shard_count; i++) {
        const shard_name of = i > 0 ? shards[i - 1] : (shard_name){0, 1};
        char *path = row_file_path(folder, kind, of.shard, of.shards);
        if (!path)
            code = out_of_memory(why);
        else if (access(path, F_OK) == 0)
            list[(*count)++] = path;
        else
            free(path);
    }
    free(shards);
    *paths = list;
    return code;
}

static status open_files(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    status code = row_files_list(folder, kind, &files->paths, &files->count, why);
    files->tables = calloc(files->count + 1, sizeof(csv *));
    if (code == STATUS_OK && !files->tables)
        code = out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++)
        code = csv_read_rows(files->paths[i], scene_root(s->base), &files->tables[i], why);
    return code;
}

const char *row_field(const row_ref *ref, const char *name)
{
    return csv_field(ref->table, ref->row, csv_column(ref->table, name));
}

double row_field_real(const row_ref *ref, const char *name)
{
    return csv_field_real(ref->table, ref->row, csv_column(ref->table, name));
}

const char *row_environment(const row_ref *ref)
{
    return ref->environment;
}

status row_files_add_issue(row_files *files, row_fault fault, const char *path, long line, const char *format, ...)
{
    if (!room_for_one(&files->issues, files->issue_count, sizeof *files->issues))
        return STATUS_FAILURE;
    row_issue *added = &files->issues[files->issue_count++];
    *added = (row_issue){.fault = fault, .path = file_name_of(path), .line = line};
    files->fault_count += fault != ROW_TORN;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(added->text, sizeof added->text, format, arguments);
    va_end(arguments);
    return STATUS_OK;
}

status row_files_judge(const row_files *files, diagnostic *why)
{
    for (size_t i = 0; i < files->issue_count; i++) {
        const row_issue *first = &files->issues[i];
        if (first->fault == ROW_TORN)
            continue;
        char more[64] = "";
        if (files->fault_count > 1)
            snprintf(more, sizeof more, "; and %zu more", files->fault_count - 1);
        diagnostic_locate(why, first->path, first->line, first->line ? 1 : 0);
        return diagnose(why, STATUS_FAILURE, "`cuvette study verify` lists the rows", "%s%s", first->text, more);
    }
    return STATUS_OK;
}

/* --- reading --- */

static status read_tables(row_reader *r, diagnostic *why)
{
    row_files *files = r->into;
    size_t total = 0;
    for (size_t i = 0; i < files->count; i++)
        total += files->tables[i] ? files->tables[i]->row_count : 0;
    files->rows = malloc((total + 1) * sizeof *files->rows);
    r->chain = calloc(files->runs->count + 1, sizeof *r->chain);
    status code = files->rows && r->chain ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++) {
        if (!files->tables[i] || !files->tables[i]->header)
            continue;
        code = row_check_columns(files->tables[i], files->paths[i], r->kind, why);
        THEN(code, row_read_table(r, files->tables[i], files->paths[i], why));
    }
    THEN(code, row_read_seals(r, why));
    free(r->chain);
    return code;
}

static status read_rows(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    row_reader r = {.s = s, .kind = kind, .into = files};
    status code = runs_read(folder, scene_root(s->base), &files->runs, why);
    THEN(code, row_cells_create(s, kind, &r.cells, why));
    THEN(code, read_tables(&r, why));
    row_cells_free(&r.cells);
    return code;
}

static status load(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why)
{
    *out = NULL;
    row_files *files = calloc(1, sizeof *files);
    char *folder = study_folder(s, results);
    status code = files && folder ? open_files(files, s, folder, kind, why) : out_of_memory(why);
    THEN(code, read_rows(files, s, folder, kind, why));
    free(folder);
    if (code != STATUS_OK) {
        row_files_destroy(files);
        return code;
    }
    *out = files;
    return STATUS_OK;
}

status row_files_read(const study *s, const char *results, row_kind kind, row_files **out, diagnostic *why)
{
    status code = load(s, results, kind, out, why);
    row_files *rows = NULL;
    if (code == STATUS_OK && kind == WORKER_ROWS && (code = load(s, results, ROWS, &rows, why)) == STATUS_OK)
        code = row_check_drop_orphans(*out, rows, why);
    row_files_destroy(rows);
    THEN(code, row_check_drop_twins(*out, why));
    if (code == STATUS_OK && kind == ROWS)
        code = row_check_quantities(*out, why);
    if (code != STATUS_OK) {
        row_files_destroy(*out);
        *out = NULL;
    }
    return code;
}

void row_files_destroy(row_files *files)
{
    if (!files)
        return;
    for (size_t i = 0; i < files->count; i++) {
        free(files->paths[i]);
        if (files->tables)
            csv_destroy(files->tables[i]);
    }
    free(files->paths);
    free(files->tables);
    free(files->rows);
    free(files->issues);
    runs_destroy(files->runs);
    free(files);
}
