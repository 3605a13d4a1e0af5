/* Writes medians and intervals of columns of rows.csv, or of quotients of two columns, by cell and environment. */
#include "study/plan/grid.h"
#include "study/rows/row_files.h"
#include "study/rows/row_quantity.h"
#include "study/summary/summary.h"
#include <stdlib.h>
#include <string.h>

typedef struct column_list {
    char *text; /* owned, cut into names */
    row_quantity *columns;
    size_t count;
} column_list;

static void column_list_release(column_list *list)
{
    free(list->text);
    free(list->columns);
}

static status column_list_read(const char *text, column_list *out, diagnostic *why)
{
    const size_t length = strlen(text);
    *out = (column_list){.text = strdup(text), .columns = calloc(length + 1, sizeof *out->columns)};
    if (!out->text || !out->columns)
        return out_of_memory(why);
    char *rest = out->text;
    for (char *name; (name = strsep(&rest, ",")) != NULL;) {
        char *slash = strchr(name, '/');
        if (slash)
            *slash++ = '\0';
        if (!*name || (slash && !*slash))
            return diagnose(why, STATUS_BAD_INPUT, "give columns of rows.csv, such as build_s,visibility_s_sum/wall_s",
                            "invalid list of columns '%.128s'", text);
        out->columns[out->count++] = (row_quantity){name, slash};
    }
    return STATUS_OK;
}

/* A column may be missing in some files, which were written by other versions of the program, but not in all. */
static bool is_known(const row_files *files, const char *name)
{
    for (size_t i = 0; i < files->count; i++)
        if (csv_column(files->tables[i], name) >= 0)
            return true;
    return false;
}

static status check_names(const row_files *files, const column_list *list, diagnostic *why)
{
    for (size_t i = 0; i < list->count; i++) {
        const row_quantity *c = &list->columns[i];
        const char *unknown = !is_known(files, c->name)                    ? c->name
                              : c->divisor && !is_known(files, c->divisor) ? c->divisor
                                                                           : NULL;
        if (unknown)
            return diagnose(why, STATUS_BAD_INPUT, "see `man cuvette-results` for the columns of rows.csv",
                            "the rows have no column '%.64s'", unknown);
    }
    return STATUS_OK;
}

static int by_cell_and_environment(const void *a, const void *b)
{
    const row_ref *x = *(const row_ref *const *)a, *y = *(const row_ref *const *)b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    return strcmp(row_environment(x), row_environment(y));
}

/* Writes the line of a column over the rows of a cell and environment. values: scratch memory for count numbers. */
static status put_line(const study *s, const row_ref **rows, size_t count, const row_quantity *c, double *values,
                       FILE *out, diagnostic *why)
{
    row_spread spread;
    TRY(row_quantity_spread(rows, count, *c, values, &spread, why));
    const double numbers[] = {spread.median.value, spread.median.low, spread.median.high, spread.minimum,
                              spread.maximum};
    fprintf(out, "%zu", rows[0]->cell);
    grid_put_values(s, rows[0]->cell, out);
    fprintf(out, "\t%s\t%s%s%s\t%zu", row_environment(rows[0]), c->name, c->divisor ? "/" : "",
            c->divisor ? c->divisor : "", spread.known);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        grid_put_number(out, numbers[i]);
    fputc('\n', out);
    return STATUS_OK;
}

static void put_header(const study *s, FILE *out)
{
    fputs("cell", out);
    grid_put_paths(s, out);
    fputs("\tenvironment\tcolumn\tn\tmedian\tlow\thigh\tmin\tmax\n", out);
}

/* environment: "" for all. */
static status put_all(const study *s, const row_files *files, const column_list *list, const excluded *without,
                      const char *environment, FILE *out, diagnostic *why)
{
    const row_ref **rows = malloc((files->row_count + 1) * sizeof *rows);
    double *values = malloc((files->row_count + 1) * sizeof *values);
    if (!rows || !values) {
        free(rows);
        free(values);
        return out_of_memory(why);
    }
    size_t count = 0;
    for (size_t i = 0; i < files->row_count; i++) {
        const row_ref *ref = &files->rows[i];
        const bool wanted = !environment[0] || strcmp(row_environment(ref), environment) == 0;
        if (wanted && row_use_of(without, ref) == ROW_COUNTS)
            rows[count++] = ref;
    }
    qsort(rows, count, sizeof *rows, by_cell_and_environment);
    put_header(s, out);
    status code = STATUS_OK;
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && by_cell_and_environment(&rows[first], &rows[end]) == 0; end++)
            ;
        for (size_t i = 0; i < list->count && code == STATUS_OK; i++)
            code = put_line(s, rows + first, end - first, &list->columns[i], values, out, why);
    }
    free(rows);
    free(values);
    return code;
}

status study_spread(const study *s, const char *results, const char *columns, const summary_options *options, FILE *out,
                    diagnostic *verdict, diagnostic *why)
{
    column_list list = {0};
    row_files *files = NULL;
    excluded *without = NULL;
    char environment[ENVIRONMENT_KEY] = "";
    status code = column_list_read(columns, &list, why);
    THEN(code, row_files_read(s, results, ROWS, &files, why));
    if (code == STATUS_OK && files->row_count == 0)
        code = diagnose_at(why, s->path, STATUS_FAILURE,
                           "run the study first, or give the folder of its results with --results", "no rows in %s/%s",
                           results, s->name);
    THEN(code, check_names(files, &list, why));
    THEN(code, row_environments_choose(files, options->environment, environment, why));
    THEN(code, excluded_read(s, results, &without, why));
    THEN(code, put_all(s, files, &list, without, environment, out, why));
    if (code == STATUS_OK && verdict)
        (void)row_files_judge(files, verdict);
    excluded_destroy(without);
    row_files_destroy(files);
    column_list_release(&list);
    return code;
}
