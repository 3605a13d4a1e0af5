/* Names and lists of row files; fields, issues and environments of rows. study/rows/row_read.c reads the files. */
#include "study/rows/row_files.h"
#include "base/array.h"
#include "base/file.h"
#include "base/status.h"
#include "base/text.h"
#include "study/rows/compare_rows.h"
#include "study/rows/rows.h"
#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const stems[] = {"rows", "workers", "compare"};

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
    csv_buffer line = {0};
    row_columns_header(&line, s, columns[kind]);
    if (!line.failed)
        return line.text;
    csv_buffer_free(&line);
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
        return system_error(why, STATUS_FAILURE, folder, "cannot be read", errno, "make the folder readable");
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
        const shard_name name = i > 0 ? shards[i - 1] : (shard_name){0, 1};
        char *path = row_file_path(folder, kind, name.shard, name.shards);
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
        return diagnose(why, STATUS_FAILURE, "list the rows with `cuvette study verify`", "%s%s", first->text, more);
    }
    return STATUS_OK;
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

/* --- environments --- */

status row_environments_find(const row_files *files, row_environment_count **out, size_t *count, diagnostic *why)
{
    *out = NULL;
    *count = 0;
    for (size_t i = 0, at = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        if (at >= *count || strcmp((*out)[at].key, ref->environment) != 0)
            for (at = 0; at < *count && strcmp((*out)[at].key, ref->environment) != 0; at++) {
            }
        if (at == *count) {
            if (!room_for_one(out, *count, sizeof **out)) {
                free(*out);
                *out = NULL;
                return out_of_memory(why);
            }
            (*out)[(*count)++] = (row_environment_count){.rows = 0};
            memcpy((*out)[at].key, ref->environment, ENVIRONMENT_KEY);
        }
        (*out)[at].rows += !ref->warmup;
        if (ref->run >= 0)
            (*out)[at].run = &files->runs->entry[ref->run];
    }
    return STATUS_OK;
}

status row_environments_main(const row_files *files, char key[ENVIRONMENT_KEY], diagnostic *why)
{
    row_environment_count *all;
    size_t count, most = 0;
    TRY(row_environments_find(files, &all, &count, why));
    for (size_t i = 1; i < count; i++)
        most = all[i].rows >= all[most].rows ? i : most;
    key[0] = 0;
    if (count > 0)
        memcpy(key, all[most].key, ENVIRONMENT_KEY);
    free(all);
    return STATUS_OK;
}

status row_environments_choose(const row_files *files, const char *text, char key[ENVIRONMENT_KEY], diagnostic *why)
{
    key[0] = 0;
    if (!text)
        return STATUS_OK;
    if (strcmp(text, "main") == 0)
        return row_environments_main(files, key, why);
    row_environment_count *all;
    size_t count, at = 0;
    char remedy[300] = "give one of these: ";
    TRY(row_environments_find(files, &all, &count, why));
    while (at < count && strcmp(all[at].key, text) != 0)
        at++;
    for (size_t i = 0; i < count && strlen(remedy) + ENVIRONMENT_KEY + 2 < sizeof remedy; i++)
        snprintf(remedy + strlen(remedy), sizeof remedy - strlen(remedy), "%s%s", i ? ", " : "", all[i].key);
    const status code =
        at < count ? STATUS_OK : diagnose(why, STATUS_BAD_INPUT, remedy, "no row is of the environment '%.64s'", text);
    if (code == STATUS_OK)
        memcpy(key, all[at].key, ENVIRONMENT_KEY);
    free(all);
    return code;
}
