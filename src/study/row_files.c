#include "study/row_files.h"
#include "base/number.h"
#include "base/text.h"
#include "study/accepted.h"
#include "study/compare_rows.h"
#include "study/row_check.h"
#include "study/rows.h"
#include "scene/model/open.h"
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

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

/* The files of the shards in a folder, sorted. *list is owned by the caller. */
static status list_shards(const char *folder, row_kind kind, shard_name **list, size_t *count, diagnostic *why)
{
    struct dirent **entries = NULL;
    const int found = scandir(folder, &entries, NULL, NULL);
    *count = 0;
    *list = calloc(found > 0 ? (size_t)found : 1, sizeof **list);
    for (int i = 0; i < found; i++) {
        *count += *list && parse_shard(entries[i]->d_name, kind, &(*list)[*count]);
        free(entries[i]);
    }
    free(entries);
    if (!*list)
        return out_of_memory(why);
    if (found < 0 && errno != ENOENT)
        return diagnose_at(why, folder, STATUS_FAILURE, "make the folder readable", "cannot be read: %s",
                           strerror(errno));
    qsort(*list, *count, sizeof **list, compare_shards);
    return STATUS_OK;
}

static status add_file(row_files *files, const study *s, char *path, diagnostic *why)
{
    if (!path)
        return out_of_memory(why);
    csv *table;
    status code = csv_read_below(path, scene_root(s->base), &table, why);
    if (code != STATUS_OK || !table) {
        free(path);
        return code;
    }
    files->paths[files->count] = path;
    files->tables[files->count++] = table;
    return STATUS_OK;
}

static status open_files(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    shard_name *shards;
    size_t count;
    status code = list_shards(folder, kind, &shards, &count, why);
    if (code == STATUS_OK) {
        files->paths = calloc(count + 1, sizeof *files->paths);
        files->tables = calloc(count + 1, sizeof *files->tables);
        code = files->paths && files->tables ? add_file(files, s, row_file_path(folder, kind, 0, 1), why)
                                             : out_of_memory(why);
    }
    for (size_t i = 0; code == STATUS_OK && i < count; i++)
        code = add_file(files, s, row_file_path(folder, kind, shards[i].shard, shards[i].shards), why);
    free(shards);
    return code;
}

static status another_definition(const char *path, long line, row_kind kind, const char *reason, diagnostic *why)
{
    diagnostic_locate(why, path, line, 1);
    return diagnose(why, STATUS_BAD_INPUT,
                    kind == COMPARE_ROWS
                        ? "move this file away: the images will be compared again; nothing is measured again"
                        : "move this folder away, choose another with --results, or give the study another name",
                    "these rows have another definition%s%s", reason[0] ? ": " : "", reason);
}

const char *row_field(const row_ref *ref, const char *name)
{
    return csv_field(ref->table, ref->row, csv_column(ref->table, name));
}

double row_field_real(const row_ref *ref, const char *name)
{
    return csv_field_real(ref->table, ref->row, csv_column(ref->table, name));
}

/* An integer from 0 to highest in the named column. */
static bool field_integer(const row_ref *ref, const char *name, int64_t highest, int64_t *out)
{
    return number_parse_int(row_field(ref, name), out) && *out >= 0 && *out <= highest;
}

static status read_row(const study *s, row_ref *ref, const char *path, row_kind kind, accepted *known, diagnostic *why)
{
    const long line = (long)ref->row + 2;
    const char *definition = row_field(ref, "definition");
    if (strcmp(row_field(ref, "study"), s->name) != 0)
        return another_definition(path, line, kind, "they belong to another study", why);
    if (!accepted_has(known, definition, kind == COMPARE_ROWS))
        return another_definition(path, line, kind, accepted_why_not(known), why);
    int64_t cell, repetition = 0, warmup = 0, worker = 0;
    if (!field_integer(ref, "cell", (int64_t)study_cell_count(s) - 1, &cell) ||
        (kind != COMPARE_ROWS &&
         (!field_integer(ref, "repetition", INT32_MAX, &repetition) || !field_integer(ref, "warmup", 1, &warmup))) ||
        (kind == WORKER_ROWS && !field_integer(ref, "worker", INT32_MAX, &worker))) {
        diagnostic_locate(why, path, line, 1);
        return diagnose(why, STATUS_BAD_INPUT, "move the file away, or use a copy without this line",
                        "the row is damaged");
    }
    ref->cell = (size_t)cell;
    ref->repetition = (long)repetition;
    ref->warmup = warmup != 0;
    ref->worker = (long)worker;
    return STATUS_OK;
}

static status read_rows(row_files *files, const study *s, const char *folder, row_kind kind, diagnostic *why)
{
    accepted known;
    accepted_start(&known, s, folder);
    size_t total = 0;
    for (size_t i = 0; i < files->count; i++)
        total += files->tables[i]->row_count;
    files->rows = malloc((total + 1) * sizeof *files->rows);
    status code = files->rows ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++) {
        const csv *table = files->tables[i];
        if (!table->header)
            continue;
        code = row_check_columns(table, files->paths[i], kind, why);
        for (size_t row = 0; code == STATUS_OK && row < table->row_count; row++) {
            row_ref *ref = &files->rows[files->row_count++];
            *ref = (row_ref){.table = table, .row = row};
            code = read_row(s, ref, files->paths[i], kind, &known, why);
        }
    }
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
        row_check_drop_orphans(*out, rows);
    row_files_destroy(rows);
    THEN(code, row_check_drop_twins(*out, why));
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
        csv_destroy(files->tables[i]);
    }
    free(files->paths);
    free(files->tables);
    free(files->rows);
    free(files);
}
