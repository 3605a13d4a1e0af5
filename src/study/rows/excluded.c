/* Reads the list of excluded rows, looks up rows in it, and adds rows to it. */
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "study/plan/grid.h"
#include "study/rows/row_files.h"
#include "study/rows/rows.h"
#include "study/rows/table.h"
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { REASON_LENGTH = 500 };

/* The columns that identify a row; a list that a person wrote may lack the first four. `cell` is the row's number in
 * rows.csv, by the grid at that time; `identity` is the same in every grid. */
static const char *const keys[] = {"checksum", "identity", "run", "process", "cell", "repetition"};
enum { CHECKSUM, IDENTITY, RUN, PROCESS, CELL, REPETITION, KEY_COUNT };

struct excluded {
    csv *table; /* NULL without a file */
    int column[KEY_COUNT];
};

static char *excluded_path(const study *s, const char *results)
{
    return text_format("%s/%s/excluded.csv", results, s->name);
}

static bool is_known(const char *field)
{
    return field[0] && strcmp(field, "NA") != 0;
}

static const char *field_of(const excluded *list, size_t line, int key)
{
    return csv_field(list->table, line, list->column[key]);
}

static status check_list(const excluded *list, const char *path, diagnostic *why)
{
    for (int key = CELL; key < KEY_COUNT; key++)
        if (list->column[key] < 0) {
            diagnostic_locate(why, path, 1, 0);
            return diagnose(why, STATUS_BAD_INPUT, "restore the file, or move it away", "there is no column '%s'",
                            keys[key]);
        }
    for (size_t line = 0; line < list->table->row_count; line++)
        for (int key = CELL; key < KEY_COUNT; key++) {
            int64_t number;
            if (number_parse_int(field_of(list, line, key), &number))
                continue;
            diagnostic_locate(why, path, (long)line + 2, 0);
            return diagnose(why, STATUS_BAD_INPUT, "restore the line, or remove it", "%s is not a number", keys[key]);
        }
    return STATUS_OK;
}

status excluded_read(const study *s, const char *results, excluded **out, diagnostic *why)
{
    *out = NULL;
    char *path = excluded_path(s, results);
    excluded *list = calloc(1, sizeof *list);
    status code = path && list ? csv_read_any(path, scene_root(s->base), &list->table, why) : out_of_memory(why);
    if (code == STATUS_OK && list->table && !list->table->header) { /* the program was killed before the header */
        csv_destroy(list->table);
        list->table = NULL;
    }
    for (int key = 0; code == STATUS_OK && list->table && key < KEY_COUNT; key++)
        list->column[key] = csv_column(list->table, keys[key]);
    if (code == STATUS_OK && list->table)
        code = check_list(list, path, why);
    free(path);
    if (code == STATUS_OK)
        *out = list;
    else
        excluded_destroy(list);
    return code;
}

void excluded_destroy(excluded *list)
{
    if (list)
        csv_destroy(list->table);
    free(list);
}

/* Whether the line and the row agree in a column; a column that either lacks is ignored (*decided = false). */
static bool agrees(const excluded *list, size_t line, const row_ref *row, int key, bool *decided)
{
    const char *listed = field_of(list, line, key), *value = row_field(row, keys[key]);
    *decided = is_known(listed) && is_known(value);
    return !*decided || strcmp(listed, value) == 0;
}

static bool names(const excluded *list, size_t line, const row_ref *row)
{
    int64_t repetition = -1, listed = -1, cell = -1;
    bool decided;
    if (agrees(list, line, row, CHECKSUM, &decided) && decided)
        return true;
    number_parse_int(field_of(list, line, REPETITION), &repetition);
    if (repetition != row->repetition || !agrees(list, line, row, RUN, &decided) ||
        !agrees(list, line, row, PROCESS, &decided) || !agrees(list, line, row, IDENTITY, &decided))
        return false;
    number_parse_int(field_of(list, line, CELL), &listed);
    return decided || (number_parse_int(row_field(row, keys[CELL]), &cell) && listed == cell);
}

bool excluded_has(const excluded *list, const row_ref *row)
{
    for (size_t line = 0; list->table && line < list->table->row_count; line++)
        if (names(list, line, row))
            return true;
    return false;
}

row_use row_use_of(const excluded *without, const row_ref *row)
{
    return row->warmup                                  ? ROW_IS_WARMUP
           : strcmp(row_field(row, "marked"), "0") != 0 ? ROW_IS_MARKED
           : excluded_has(without, row)                 ? ROW_IS_EXCLUDED
                                                        : ROW_COUNTS;
}

size_t excluded_count(const excluded *list)
{
    return list->table ? list->table->row_count : 0;
}

/* --- excluding --- */

/* Whether text is CELL:REPETITION of the row, or its checksum. cell: the row's column, or its number in the present
 * grid. */
static bool is_meant(const char *text, const row_ref *row, const char *cell)
{
    const char *checksum = row_field(row, keys[CHECKSUM]);
    if (is_known(checksum) && strcmp(checksum, text) == 0)
        return true;
    char number[64];
    snprintf(number, sizeof number, "%.32s:%ld", cell, row->repetition);
    return strcmp(number, text) == 0;
}

static status wrong_row(const char *text, diagnostic *why, const char *remedy, const char *what)
{
    char where[160];
    snprintf(where, sizeof where, "--row %.120s", text);
    diagnostic_locate(why, where, 0, 0);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
}

/* CELL is the column of rows.csv. When the grid has changed since, it may be the present number of another row, which
 * the user may mean: that is refused. */
static status find_row(const row_files *files, const excluded *list, const char *text, const row_ref **out,
                       diagnostic *why)
{
    size_t candidates = 0;
    *out = NULL;
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *row = &files->rows[i];
        char now[32];
        snprintf(now, sizeof now, "%zu", row->cell);
        const bool named = is_meant(text, row, row_field(row, keys[CELL]));
        candidates += named || is_meant(text, row, now);
        if (named)
            *out = row;
    }
    if (*out && candidates > 1)
        return wrong_row(text, why, "give the row's value in the column checksum",
                         "more than one row has this number, in rows.csv or in the present grid");
    if (!*out)
        return wrong_row(text, why, "give CELL:REPETITION, such as 3:2, or the row's value in the column checksum",
                         "there is no such row");
    if ((*out)->warmup)
        return wrong_row(text, why, "", "this row is a warm-up, which summaries never use");
    if (excluded_has(list, *out))
        return wrong_row(text, why, "", "this row is excluded already");
    return STATUS_OK;
}

/* Appends a line with the columns of this version; list: the present contents of the file. */
static status append(const study *s, const char *results, const excluded *list, const row_ref *row, const char *reason,
                     diagnostic *why)
{
    static const char header[] = "checksum,identity,run,process,cell,repetition,reason,time_utc\n";
    char *path = excluded_path(s, results), number[32], utc[ROW_TIME_MAX];
    struct timespec now = {0};
    table *to = NULL;
    csv_buffer line = {0};
    for (int key = CHECKSUM; key <= CELL; key++) {
        const char *field = row_field(row, keys[key]);
        csv_text(&line, is_known(field) ? field : NULL);
    }
    snprintf(number, sizeof number, "%ld", row->repetition);
    csv_text(&line, number);
    csv_text(&line, reason);
    clock_gettime(CLOCK_REALTIME, &now);
    csv_text(&line, row_time((int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000, utc));
    csv_end(&line);
    status code = path && !line.failed ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && list->table && list->table->mended)
        code = file_write(path, list->table->raw, why);
    THEN(code, table_open(path, header, &to, why));
    THEN(code, table_append(to, line.text, line.size, why));
    table_close(to);
    csv_buffer_free(&line);
    free(path);
    return code;
}

status excluded_add(const study *s, const char *results, const char *row, const char *reason, diagnostic *why)
{
    if (reason[strspn(reason, " ")] == '\0' || strlen(reason) > REASON_LENGTH || !read_grid_plain(reason)) {
        diagnostic_locate(why, "--reason", 0, 0);
        return diagnose(why, STATUS_BAD_INPUT, "write one line of at most 500 characters", "this is not a reason");
    }
    row_files *files = NULL;
    excluded *list = NULL;
    const row_ref *found = NULL;
    status code = row_files_read(s, results, ROWS, &files, why);
    THEN(code, excluded_read(s, results, &list, why));
    THEN(code, find_row(files, list, row, &found, why));
    THEN(code, append(s, results, list, found, reason, why));
    excluded_destroy(list);
    row_files_destroy(files);
    return code;
}
