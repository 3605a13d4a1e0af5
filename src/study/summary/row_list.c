/* Writes all rows of a study as one CSV table, each with its environment and whether summaries leave it out. */
#include "base/file.h"
#include "base/text.h"
#include "study/rows/row_files.h"
#include "study/summary/summary.h"
#include <stdlib.h>
#include <string.h>

static const char *const use_words[] = {"", "warm-up", "marked", "excluded"};

/* "3d2be922: 18 rows, ...", as many as the text holds. */
static void list_environments(const row_environment_count *all, size_t count, char *text, size_t size)
{
    text[0] = 0;
    for (size_t i = 0, at = 0; i < count && at < size; i++)
        at += (size_t)snprintf(text + at, size - at, "%s%s: %zu rows", i ? ", " : "", all[i].key, all[i].rows);
}

static status choose(const row_environment_count *all, size_t count, const char *wanted, const char *folder,
                     diagnostic *why)
{
    char listed[256];
    list_environments(all, count, listed, sizeof listed);
    if (!wanted && count > 1)
        return diagnose_at(
            why, folder, STATUS_BAD_INPUT,
            "choose one by its key or as main, or choose all and group the rows by the column environment",
            "the rows are of %zu environments (%s), whose times must not be pooled", count, listed);
    bool found = !wanted;
    for (size_t i = 0; i < count; i++)
        found |= wanted && strcmp(all[i].key, wanted) == 0;
    char remedy[300];
    snprintf(remedy, sizeof remedy, "choose one of %s", listed);
    return found ? STATUS_OK
                 : diagnose_at(why, folder, STATUS_BAD_INPUT, remedy, "there are no rows of the environment '%.64s'",
                               wanted);
}

/* Finds the environment whose rows are written; *key: "" for all. */
static status find_environment(const row_files *files, const char *wanted, const char *folder,
                               char key[ENVIRONMENT_KEY], diagnostic *why)
{
    key[0] = 0;
    if (wanted && strcmp(wanted, "all") == 0)
        return STATUS_OK;
    if (wanted && strcmp(wanted, "main") == 0)
        return row_environments_main(files, key, why);
    row_environment_count *all;
    size_t count;
    TRY(row_environments_find(files, &all, &count, why));
    const status code = choose(all, count, wanted, folder, why);
    free(all);
    if (wanted)
        snprintf(key, ENVIRONMENT_KEY, "%s", wanted);
    return code;
}

/* The names of all columns, borrowed: those of the first table, then further ones of the others. */
static status merge_headers(const row_files *files, const char ***names, size_t *count, diagnostic *why)
{
    size_t room = 1;
    for (size_t t = 0; t < files->count; t++)
        room += files->tables[t] ? files->tables[t]->column_count : 0;
    *count = 0;
    *names = calloc(room, sizeof **names);
    if (!*names)
        return out_of_memory(why);
    for (size_t t = 0; t < files->count; t++)
        for (size_t i = 0; files->tables[t] && files->tables[t]->header && i < files->tables[t]->column_count; i++) {
            size_t k = 0;
            while (k < *count && strcmp((*names)[k], files->tables[t]->header[i]) != 0)
                k++;
            if (k == *count)
                (*names)[(*count)++] = files->tables[t]->header[i];
        }
    return STATUS_OK;
}

static void put_line(csv_buffer *line, FILE *out)
{
    csv_end(line);
    if (!line->failed)
        fwrite(line->text, 1, line->size, out);
    line->size = 0;
}

/* Columns are looked up once for each table. */
static status put_rows(const row_files *files, const excluded *without, const char *key, FILE *out, diagnostic *why)
{
    const char **names = NULL;
    size_t count = 0;
    csv_buffer line = {0};
    status code = merge_headers(files, &names, &count, why);
    int *at = code == STATUS_OK ? malloc((count + 1) * sizeof *at) : NULL;
    const csv *table = NULL;
    for (size_t k = 0; at && k < count; k++)
        csv_text(&line, names[k]);
    csv_text(&line, "environment");
    csv_text(&line, "left_out");
    put_line(&line, out);
    for (size_t i = 0; at && i < files->row_count; i++) {
        const row_ref *row = &files->rows[i];
        if (key[0] && strcmp(row->environment, key) != 0)
            continue;
        for (size_t k = 0; row->table != table && k < count; k++)
            at[k] = csv_column(row->table, names[k]);
        table = row->table;
        for (size_t k = 0; k < count; k++)
            csv_text(&line, csv_field(table, row->row, at[k]));
        csv_text(&line, row->environment);
        csv_text(&line, use_words[row_use_of(without, row)]);
        put_line(&line, out);
    }
    if (code == STATUS_OK && (!at || line.failed))
        code = out_of_memory(why);
    csv_buffer_free(&line);
    free(at);
    free(names);
    return code;
}

static status write_rows(const study *s, const char *results, const char *environment, FILE *out, diagnostic *verdict,
                         diagnostic *why)
{
    row_files *files;
    excluded *without = NULL;
    char key[ENVIRONMENT_KEY], *folder = study_folder(s, results);
    if (!folder)
        return out_of_memory(why);
    status code = row_files_read(s, results, ROWS, &files, why);
    if (code == STATUS_OK && files->row_count == 0)
        code = diagnose_at(why, folder, STATUS_BAD_INPUT, "give the folder of a study's results, such as results/depth",
                           "there are no rows");
    THEN(code, excluded_read(s, results, &without, why));
    THEN(code, find_environment(files, environment, folder, key, why));
    THEN(code, put_rows(files, without, key, out, why));
    if (code == STATUS_OK && verdict)
        row_files_judge(files, verdict);
    excluded_destroy(without);
    row_files_destroy(files);
    free(folder);
    return code;
}

/* Writes the rows of a study of which only the name is known, from its folder. */
static status write_folder(const char *folder, const char *environment, FILE *out, diagnostic *verdict, diagnostic *why)
{
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    char *place = strndup(folder, length);
    char *slash = place ? strrchr(place, '/') : NULL;
    study bare = {.name = slash ? slash + 1 : place, .base = scene_create()};
    bare.path = bare.name;
    const char *results = !slash ? "." : slash == place ? "/" : place;
    if (slash)
        *slash = 0;
    const status code =
        place && bare.base ? write_rows(&bare, results, environment, out, verdict, why) : out_of_memory(why);
    scene_destroy(bare.base);
    free(place);
    return code;
}

status row_list_write(const study *s, const char *results, const char *environment, FILE *out, diagnostic *verdict,
                      diagnostic *why)
{
    return s ? write_rows(s, results, environment, out, verdict, why)
             : write_folder(results, environment, out, verdict, why);
}
