#include "study/row_check.h"
#include <stdlib.h>
#include <string.h>

/* The file of rows for a file of worker rows: workers.shard-0-of-2.csv -> rows.shard-0-of-2.csv. */
static const csv *rows_beside(const row_files *rows, const char *workers_path)
{
    const char *ending = strrchr(workers_path, '/') + 1 + strlen("workers");
    for (size_t i = 0; i < rows->count; i++)
        if (strcmp(strrchr(rows->paths[i], '/') + 1 + strlen("rows"), ending) == 0)
            return rows->tables[i];
    return NULL;
}

static bool has_row(const row_files *rows, const csv *table, const row_ref *worker)
{
    for (size_t i = rows->row_count; i > 0; i--) {
        const row_ref *ref = &rows->rows[i - 1];
        if (ref->table == table && ref->cell == worker->cell && ref->repetition == worker->repetition)
            return true;
    }
    return false;
}

void row_check_drop_orphans(row_files *workers, const row_files *rows)
{
    size_t kept = 0;
    row_ref last = {0};
    bool last_kept = false;
    for (size_t i = 0, file = 0; i < workers->row_count; i++) {
        row_ref ref = workers->rows[i];
        while (workers->tables[file] != ref.table)
            file++;
        /* The worker rows of one repetition are consecutive. */
        if (ref.table != last.table || ref.cell != last.cell || ref.repetition != last.repetition)
            last_kept = has_row(rows, rows_beside(rows, workers->paths[file]), &ref);
        last = ref;
        if (last_kept)
            workers->rows[kept++] = ref;
    }
    workers->row_count = kept;
}

static int compare_keys(const void *a, const void *b)
{
    const row_ref *x = *(row_ref *const *)a, *y = *(row_ref *const *)b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->repetition != y->repetition)
        return x->repetition < y->repetition ? -1 : 1;
    if (x->worker != y->worker)
        return x->worker < y->worker ? -1 : 1;
    return (x > y) - (x < y);
}

/* Whether b has the same value as a in every column of a. */
static bool has_values(const row_ref *a, const row_ref *b)
{
    for (size_t i = 0; i < a->table->column_count; i++) {
        const int there = csv_column(b->table, a->table->header[i]);
        if (strcmp(csv_field(a->table, a->row, (int)i), csv_field(b->table, b->row, there)) != 0)
            return false;
    }
    return true;
}

static bool same_row(const row_ref *a, const row_ref *b)
{
    return has_values(a, b) && has_values(b, a);
}

status row_check_drop_twins(row_files *files, diagnostic *why)
{
    row_ref **sorted = malloc((files->row_count + 1) * sizeof(row_ref *));
    if (!sorted)
        return out_of_memory(why);
    for (size_t i = 0; i < files->row_count; i++)
        sorted[i] = &files->rows[i];
    qsort(sorted, files->row_count, sizeof *sorted, compare_keys);
    status code = STATUS_OK;
    for (size_t i = 1, kept = 0; code == STATUS_OK && i < files->row_count; i++) {
        const row_ref *a = sorted[kept];
        row_ref *b = sorted[i];
        if (a->cell != b->cell || a->repetition != b->repetition || a->worker != b->worker) {
            kept = i;
        } else if (same_row(a, b) && a->table != b->table) {
            b->table = NULL;
        } else {
            for (size_t f = 0; f < files->count; f++)
                if (files->tables[f] == b->table)
                    diagnostic_locate(why, files->paths[f], (long)b->row + 2, 1);
            code = diagnose(why, STATUS_BAD_INPUT, "two processes ran the same cells: move one of the files away",
                            "duplicate row: cell %zu, repetition %ld, with different values", b->cell, b->repetition);
        }
    }
    free(sorted);
    size_t kept = 0;
    for (size_t i = 0; i < files->row_count; i++)
        if (files->rows[i].table)
            files->rows[kept++] = files->rows[i];
    files->row_count = kept;
    return code;
}

/* The required columns of a row; others are "NA" if they are missing. */
static const char *const needed[][10] = {
    [ROWS] = {"study", "definition", "cell", "repetition", "warmup", "film_hash", "film_expected", "marked", "wall_s"},
    [WORKER_ROWS] = {"study", "definition", "cell", "repetition", "warmup", "worker"},
    [COMPARE_ROWS] = {"study", "definition", "cell", "film_hash"},
};

status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why)
{
    for (size_t i = 0; needed[kind][i]; i++) {
        if (csv_column(table, needed[kind][i]) >= 0)
            continue;
        diagnostic_locate(why, path, 1, 1);
        return diagnose(why, STATUS_BAD_INPUT, "move the file away, or choose another folder with --results",
                        "the rows lack the column %s, which identifies them", needed[kind][i]);
    }
    return STATUS_OK;
}
