/* Compares rows with each other: duplicates, orphans of killed processes, and quantities that must be equal. */
#include "job/quantities.h"
#include "study/rows/row_files.h"
#include <stdlib.h>
#include <string.h>

static const char *path_of(const row_files *files, const csv *table)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->tables[i] == table)
            return files->paths[i];
    return "";
}

/* Drops the rows whose table was set to NULL. */
static void compact(row_files *files)
{
    size_t kept = 0;
    for (size_t i = 0; i < files->row_count; i++)
        if (files->rows[i].table)
            files->rows[kept++] = files->rows[i];
    files->row_count = kept;
}

/* --- one repetition in several rows --- */

static int compare_repetitions(const row_ref *x, const row_ref *y)
{
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    if (x->repetition != y->repetition)
        return x->repetition < y->repetition ? -1 : 1;
    return 0;
}

static int compare_keys(const void *a, const void *b)
{
    const row_ref *x = *(row_ref *const *)a, *y = *(row_ref *const *)b;
    const int repetition = compare_repetitions(x, y);
    if (repetition != 0)
        return repetition;
    if (x->worker != y->worker)
        return x->worker < y->worker ? -1 : 1;
    return (x > y) - (x < y);
}

/* Pointers to the rows in the order of their keys, which the caller frees; NULL if memory runs out. */
static row_ref **sort_rows(const row_files *files)
{
    row_ref **sorted = malloc((files->row_count + 1) * sizeof(row_ref *));
    for (size_t i = 0; sorted && i < files->row_count; i++)
        sorted[i] = &files->rows[i];
    if (sorted)
        qsort(sorted, files->row_count, sizeof *sorted, compare_keys);
    return sorted;
}

static int find_repetition(const void *key, const void *element)
{
    return compare_repetitions(key, *(row_ref *const *)element);
}

status row_check_drop_orphans(row_files *workers, const row_files *rows, diagnostic *why)
{
    row_ref **sorted = sort_rows(rows);
    if (!sorted)
        return out_of_memory(why);
    for (size_t i = 0; i < workers->row_count; i++)
        if (!bsearch(&workers->rows[i], sorted, rows->row_count, sizeof *sorted, find_repetition))
            workers->rows[i].table = NULL;
    free(sorted);
    compact(workers);
    return STATUS_OK;
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
    const csv *x = a->table, *y = b->table;
    const size_t length = x->start[a->row + 1] - x->start[a->row];
    if (length == y->start[b->row + 1] - y->start[b->row] &&
        memcmp(x->raw + x->start[a->row], y->raw + y->start[b->row], length) == 0)
        return true;
    return has_values(a, b) && has_values(b, a);
}

/* Drops the later of two rows with the same key, with an issue unless it is the same row in another file. */
static status drop_twin(row_files *files, const row_ref *first, row_ref *second, diagnostic *why)
{
    const char *path = path_of(files, second->table);
    const bool copied = same_row(first, second), merged = copied && first->table != second->table;
    const size_t line = second->row + 2, cell = second->cell;
    second->table = NULL;
    if (merged ||
        row_files_add_issue(files, ROW_DUPLICATE, path, (long)line, "duplicate row: cell %zu, repetition %ld, %s", cell,
                            second->repetition, copied ? "twice in one file" : "with different values") == STATUS_OK)
        return STATUS_OK;
    return out_of_memory(why);
}

status row_check_drop_twins(row_files *files, diagnostic *why)
{
    row_ref **sorted = sort_rows(files);
    status code = sorted ? STATUS_OK : out_of_memory(why);
    for (size_t i = 1, kept = 0; code == STATUS_OK && i < files->row_count; i++)
        if (compare_repetitions(sorted[kept], sorted[i]) != 0 || sorted[kept]->worker != sorted[i]->worker)
            kept = i;
        else
            code = drop_twin(files, sorted[kept], sorted[i], why);
    free(sorted);
    compact(files);
    return code;
}

/* --- equal quantities --- */

/* The columns of a table that must be equal in all rows of a cell. */
typedef struct equal_columns {
    const csv *table;
    int column[128];
    size_t count;
    int marked, film, expected;
    bool
        has_first_header; /* the header equals that of the first table, so that columns have the same numbers in both */
} equal_columns;

static equal_columns find_equal_columns(const csv *table)
{
    equal_columns c = {.table = table,
                       .marked = csv_column(table, "marked"),
                       .film = csv_column(table, "film_hash"),
                       .expected = csv_column(table, "film_expected")};
    for (size_t i = 0; table->header && i < table->column_count; i++) {
        const char *dot = strchr(table->header[i], '.');
        const quantity *q = frame_quantity(table->header[i]);
        const bool of_solid =
            dot && (strncmp(table->header[i], "first_hits.", 11) == 0 || strncmp(table->header[i], "hits.", 5) == 0);
        const bool is_equal = of_solid || (q && q->column && q->merge == QUANTITY_SAME && q->type != QUANTITY_HASH);
        if (is_equal && c.count < sizeof c.column / sizeof *c.column)
            c.column[c.count++] = (int)i;
    }
    return c;
}

static bool same_header(const csv *a, const csv *b)
{
    return a->header && b->header && a->start[0] == b->start[0] && memcmp(a->raw, b->raw, a->start[0]) == 0;
}

typedef struct equal_check {
    row_files *files;
    equal_columns *columns; /* of each table */
} equal_check;

static const equal_columns *columns_of(const equal_check *c, const csv *table)
{
    size_t i = 0;
    while (c->columns[i].table != table)
        i++;
    return &c->columns[i];
}

/* The first column of a in which b has another value, or -1; NA equals every value. Columns are looked up by name only
 * if headers differ. */
static int first_difference(const equal_check *c, const row_ref *a, const row_ref *b)
{
    const equal_columns *columns = columns_of(c, a->table);
    const bool alike = a->table == b->table || (columns->has_first_header && columns_of(c, b->table)->has_first_header);
    for (size_t i = 0; i < columns->count; i++) {
        const int column = columns->column[i];
        const int other = alike ? column : csv_column(b->table, a->table->header[column]);
        const char *x = csv_field(a->table, a->row, column), *y = csv_field(b->table, b->row, other);
        if (strcmp(x, y) != 0 && strcmp(x, "NA") != 0 && strcmp(y, "NA") != 0)
            return column;
    }
    return -1;
}

/* The row with which the majority of the rows agree, or any row if there is no majority (Boyer and Moore's majority
 * vote, 1991). */
static const row_ref *vote(const equal_check *c, row_ref *const *rows, size_t count)
{
    const row_ref *leader = NULL;
    size_t lead = 0;
    for (size_t i = 0; i < count; i++) {
        if (lead == 0)
            leader = rows[i];
        lead += lead == 0 || first_difference(c, leader, rows[i]) < 0 ? 1 : (size_t)-1;
    }
    return leader;
}

static status judge_group(const equal_check *c, row_ref **rows, size_t count, diagnostic *why)
{
    const row_ref *majority = count > 1 ? vote(c, rows, count) : NULL;
    for (size_t i = 0; majority && i < count; i++) {
        const int column = first_difference(c, majority, rows[i]);
        if (column < 0)
            continue;
        const char *name = majority->table->header[column];
        if (row_files_add_issue(c->files, ROW_DIFFERS, path_of(c->files, rows[i]->table), (long)rows[i]->row + 2,
                                "%s is %.40s, and %.40s in other rows of the cell", name, row_field(rows[i], name),
                                row_field(majority, name)) != STATUS_OK)
            return out_of_memory(why);
        rows[i]->table = NULL;
    }
    return STATUS_OK;
}

static int compare_groups(const void *a, const void *b)
{
    const row_ref *x = *(row_ref *const *)a, *y = *(row_ref *const *)b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    const int environment = strcmp(x->environment, y->environment);
    return environment ? environment : (x > y) - (x < y);
}

static bool in_one_group(const row_ref *x, const row_ref *y)
{
    return x->cell == y->cell && strcmp(x->environment, y->environment) == 0;
}

/* Fills sorted with the unmarked rows, and *count with their number. Marked rows become issues. */
static status skip_marked(const equal_check *c, row_ref **sorted, size_t *count, diagnostic *why)
{
    for (size_t i = 0; i < c->files->row_count; i++) {
        row_ref *ref = &c->files->rows[i];
        const equal_columns *columns = columns_of(c, ref->table);
        const char *hash = csv_field(ref->table, ref->row, columns->film);
        if (strcmp(csv_field(ref->table, ref->row, columns->marked), "0") == 0 &&
            strcmp(hash, csv_field(ref->table, ref->row, columns->expected)) == 0)
            sorted[(*count)++] = ref;
        else if (row_files_add_issue(c->files, ROW_MARKED, path_of(c->files, ref->table), (long)ref->row + 2,
                                     "the row is marked: its film is not the expected one") != STATUS_OK)
            return out_of_memory(why);
    }
    return STATUS_OK;
}

status row_check_quantities(row_files *files, diagnostic *why)
{
    row_ref **sorted = malloc((files->row_count + 1) * sizeof(row_ref *));
    equal_check c = {files, malloc((files->count + 1) * sizeof *c.columns)};
    size_t count = 0;
    status code = sorted && c.columns ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < files->count; i++) {
        c.columns[i] = find_equal_columns(files->tables[i]);
        c.columns[i].has_first_header = same_header(files->tables[0], files->tables[i]);
    }
    THEN(code, skip_marked(&c, sorted, &count, why));
    if (code == STATUS_OK)
        qsort(sorted, count, sizeof *sorted, compare_groups);
    for (size_t from = 0, to; code == STATUS_OK && from < count; from = to) {
        for (to = from + 1; to < count && in_one_group(sorted[from], sorted[to]); to++) {
        }
        code = judge_group(&c, sorted + from, to - from, why);
    }
    free(sorted);
    free(c.columns);
    compact(files);
    return code;
}

/* --- columns --- */

/* The required columns of a row; others are "NA" if they are missing. */
static const char *const needed[][12] = {
    [ROWS] = {"study", "identity", "cell", "repetition", "warmup", "film_hash", "film_expected", "marked", "wall_s",
              "run", "checksum"},
    [WORKER_ROWS] = {"study", "identity", "cell", "repetition", "warmup", "worker", "run", "checksum"},
    [COMPARE_ROWS] = {"study", "identity", "cell", "film_hash", "run", "checksum"},
};

status row_check_columns(const csv *table, const char *path, row_kind kind, diagnostic *why)
{
    for (size_t i = 0; needed[kind][i]; i++) {
        if (csv_column(table, needed[kind][i]) >= 0)
            continue;
        diagnostic_locate(why, path, 1, 1);
        return diagnose(why, STATUS_BAD_INPUT,
                        "move the file away and run the study again, or choose another folder with --results",
                        "the rows lack the column %s, which this version requires", needed[kind][i]);
    }
    return STATUS_OK;
}
