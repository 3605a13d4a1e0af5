#include "study/value_table.h"
#include "base/number.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct value_row {
    const char *cell;
    size_t process, line;
    double value;
} value_row;

/* Numbers by value. */
static int by_name(const char *a, const char *b)
{
    double x, y;
    if (number_parse_real(a, &x) && number_parse_real(b, &y) && x != y)
        return x < y ? -1 : 1;
    return strcmp(a, b);
}

static int by_place(const void *a, const void *b)
{
    const value_row *x = a, *y = b;
    const int cells = by_name(x->cell, y->cell);
    if (cells)
        return cells;
    if (x->process != y->process)
        return x->process < y->process ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

/* The number of a process: the place of its first row among those of other processes. Rows of one are neighbours. */
static size_t process_of(const char *id, const char **ids, size_t *count)
{
    for (size_t i = *count; i-- > 0;)
        if (strcmp(ids[i], id) == 0)
            return i;
    ids[*count] = id;
    return (*count)++;
}

static bool counts(const csv *table, size_t row, double value)
{
    const int warmup = csv_column(table, "warmup"), marked = csv_column(table, "marked");
    return value > 0 && isfinite(value) && !(csv_field_real(table, row, warmup) > 0) &&
           !(csv_field_real(table, row, marked) > 0);
}

static status fill(value_cell *cell, const value_row *rows, size_t count, diagnostic *why)
{
    *cell = (value_cell){.name = rows->cell,
                         .values = calloc(count, sizeof *cell->values),
                         .start = calloc(count + 1, sizeof *cell->start),
                         .process = calloc(count, sizeof *cell->process)};
    if (!cell->values || !cell->start || !cell->process)
        return out_of_memory(why);
    size_t processes = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || rows[i].process != rows[i - 1].process) {
            cell->process[processes] = rows[i].process;
            cell->start[processes++] = i;
        }
        cell->values[i] = log(rows[i].value);
    }
    cell->start[processes] = count;
    cell->sample = (level_sample){cell->values, cell->start, processes};
    return STATUS_OK;
}

static status divide(value_table *t, value_row *rows, size_t count, diagnostic *why)
{
    qsort(rows, count, sizeof *rows, by_place);
    t->cells = calloc(count + 1, sizeof *t->cells);
    if (!t->cells)
        return out_of_memory(why);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && strcmp(rows[end].cell, rows[i].cell) == 0;)
            end++;
        TRY(fill(&t->cells[t->count++], rows + i, end - i, why));
    }
    return STATUS_OK;
}

static status find_columns(const char *path, const char *column, const csv *table, int found[3], diagnostic *why)
{
    const char *const names[] = {"cell", csv_column(table, "run") < 0 ? "process" : "run", column};
    for (int i = 0; i < 3; i++)
        if ((found[i] = csv_column(table, names[i])) < 0)
            return diagnose_at(why, path, STATUS_BAD_INPUT,
                               "columns cell, run (or process) and the measured one are needed",
                               "there is no column '%.64s'", names[i]);
    return STATUS_OK;
}

static status read_rows(const char *path, const char *column, value_table *t, diagnostic *why)
{
    int at[3];
    size_t count = 0, processes = 0;
    TRY(find_columns(path, column, t->file, at, why));
    value_row *rows = calloc(t->file->row_count + 1, sizeof *rows);
    const char **ids = calloc(t->file->row_count + 1, sizeof *ids);
    status code = rows && ids ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < t->file->row_count; i++) {
        const double value = csv_field_real(t->file, i, at[2]);
        if (counts(t->file, i, value))
            rows[count++] = (value_row){csv_field(t->file, i, at[0]),
                                        process_of(csv_field(t->file, i, at[1]), ids, &processes), i, value};
    }
    if (code == STATUS_OK && count == 0)
        code = diagnose_at(why, path, STATUS_BAD_INPUT, "give a column of positive numbers, such as wall_s",
                           "no row has a value of '%.64s'", column);
    THEN(code, divide(t, rows, count, why));
    free(ids);
    free(rows);
    return code;
}

status value_table_read(const char *path, const char *column, value_table *out, diagnostic *why)
{
    *out = (value_table){.count = 0};
    status code = csv_read_any(path, NULL, &out->file, why);
    if (code == STATUS_OK && !out->file)
        code = diagnose_at(why, path, STATUS_BAD_INPUT, "give a CSV file, such as results/STUDY/rows.csv",
                           "there is no such file");
    if (code == STATUS_OK && out->file->torn)
        code =
            diagnose_at(why, path, STATUS_BAD_INPUT, "complete it, or remove it; if a study is writing the file, wait",
                        "the last line is incomplete");
    THEN(code, read_rows(path, column, out, why));
    if (code != STATUS_OK)
        value_table_release(out);
    return code;
}

void value_table_release(value_table *t)
{
    for (size_t i = 0; i < t->count; i++) {
        free(t->cells[i].values);
        free(t->cells[i].start);
        free(t->cells[i].process);
    }
    free(t->cells);
    csv_destroy(t->file);
    *t = (value_table){.count = 0};
}

const value_cell *value_table_find(const value_table *t, const char *name)
{
    for (size_t i = 0; i < t->count; i++)
        if (strcmp(t->cells[i].name, name) == 0)
            return &t->cells[i];
    return NULL;
}

bool value_cells_share(const value_cell *a, const value_cell *b)
{
    return a->sample.processes == b->sample.processes &&
           memcmp(a->process, b->process, a->sample.processes * sizeof *a->process) == 0;
}
