/* Writes the summary of a study, a line per cell and environment, and reads it back as a table. */
#include "study/summary/summary.h"
#include "base/number.h"
#include "base/text.h"
#include "measure/statistics.h"
#include "scene/model/open.h"
#include "study/plan/grid.h"
#include "study/rows/compare_rows.h"
#include "study/rows/row_files.h"
#include "study/rows/row_quantity.h"
#include "study/rows/rows.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The columns of a summary; summary.h describes their order. Spreads are medians with intervals, of columns and of
 * quotients formed row by row. */
static const row_quantity time_spreads[] = {{"wall_s", NULL}, {"cpu_s", NULL}};
static const char *const ray_medians[] = {"rays_total",  "rays_camera",          "rays_reflect",  "rays_refract",
                                          "rays_shadow", "cut_depth_throughput", "total_internal"};
static const char *const machine_medians[] = {"busy_s_mean",      "busy_s_max",     "waiting_s_mean", "others_fraction",
                                              "worker_cpu_s_sum", "peak_rss_bytes", "noise_rms",      "triangles",
                                              "instances",        "accel_bytes",    "drawn",          "drawn_bytes",
                                              "motion_steps",     "cut_fraction"};
static const row_quantity quotient_spreads[] = {
    {"build_s", NULL},
    {"imbalance", NULL},
    {"visibility_s_sum", NULL},
    {"motion_s", NULL},
    {"query_rays", NULL},
    {"query_boxes", NULL},
    {"query_triangles", NULL},
    {"rays_total", "cpu_s"},
    {"visibility_s_sum", "wall_s"},
    {"visibility_s_sum", "rays_total"},
    {"motion_s", "motion_steps"},
    {"query_boxes", "query_rays"},
    {"query_triangles", "query_rays"},
};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* The rows of a cell, for one line; or none, for the header line. */
typedef struct cell_rows {
    bool header;
    size_t number;
    const char *environment;   /* of the rows; "NA" without a row */
    const char *film_expected; /* NULL without a row */
    const row_ref **rows;
    size_t count, marked, excluded, disturbed,
        judged; /* judged: rows for which it is known whether they are disturbed */
    const noise_rule *rule;
    const excluded *without; /* the rows that a person excluded */
    double *values;
    const row_ref *compared; /* the cell's row of compare.csv, or NULL */
    FILE *out;
} cell_rows;

static status put_spread(const cell_rows *cell, row_quantity column, diagnostic *why)
{
    static const char *const parts[] = {"median", "low", "high", "mean", "min", "max"};
    row_spread spread = {.known = 0};
    if (!cell->header)
        TRY(row_quantity_spread(cell->rows, cell->count, column, cell->values, &spread, why));
    const double values[] = {spread.median.value, spread.median.low, spread.median.high,
                             spread.mean,         spread.minimum,    spread.maximum};
    for (size_t part = 0; part < COUNT(parts); part++)
        if (cell->header)
            fprintf(cell->out, "\t%s%s%s_%s", column.name, column.divisor ? "/" : "",
                    column.divisor ? column.divisor : "", parts[part]);
        else
            grid_put_number(cell->out, values[part]);
    return STATUS_OK;
}

static status put_spreads(const cell_rows *cell, const row_quantity *columns, size_t count, diagnostic *why)
{
    for (size_t i = 0; i < count; i++)
        TRY(put_spread(cell, columns[i], why));
    return STATUS_OK;
}

/* Writes the columns of undisturbed rows, by the study's present rule. */
static status put_undisturbed(const cell_rows *cell, diagnostic *why)
{
    if (cell->header) {
        fputs("\tdisturbed\tundisturbed_n\tundisturbed_wall_s_median\tundisturbed_wall_s_low\tundisturbed_wall_s_high",
              cell->out);
        return STATUS_OK;
    }
    if (cell->judged == 0) {
        fputs("\tNA\tNA\tNA\tNA\tNA", cell->out);
        return STATUS_OK;
    }
    level_interval median = {NAN, NAN, NAN};
    row_noise_columns at = {.table = NULL};
    row_quantity_values(cell->rows, cell->count, time_spreads[0], cell->values);
    for (size_t i = 0; i < cell->count; i++)
        if (row_noise_judge(cell->rule, &at, cell->rows[i]) != NOISE_UNDISTURBED)
            cell->values[i] = NAN;
    TRY(row_quantity_median(cell->rows, cell->values, cell->count, row_quantity_range(time_spreads[0]), &median, why));
    fprintf(cell->out, "\t%zu\t%zu", cell->disturbed, cell->judged - cell->disturbed);
    grid_put_number(cell->out, median.value);
    grid_put_number(cell->out, median.low);
    grid_put_number(cell->out, median.high);
    return STATUS_OK;
}

static void put_median(const cell_rows *cell, const char *name)
{
    if (cell->header) {
        fprintf(cell->out, "\t%s", name);
        return;
    }
    const size_t known = row_quantity_known(cell->rows, cell->count, (row_quantity){name, NULL}, cell->values);
    grid_put_number(cell->out, known ? summarize(cell->values, known).median : NAN);
}

static status put_solids(const study *s, const cell_rows *cell, diagnostic *why)
{
    for (size_t i = 0; i < scene_solid_count(s->base); i++) {
        char *name = text_format("first_hits.%s", scene_solid_name(s->base, (int)i));
        if (!name)
            return out_of_memory(why);
        put_median(cell, name);
        free(name);
    }
    return STATUS_OK;
}

/* An image has one comparison, so its values are shown unchanged. */
static void put_compared(const study *s, const cell_rows *cell)
{
    for (size_t i = 0; s->reference.count && i < compare_summary_column_count; i++)
        fprintf(cell->out, "\t%s",
                cell->header     ? compare_summary_columns[i]
                : cell->compared ? row_field(cell->compared, compare_summary_columns[i])
                                 : "NA");
}

static status put_line(const study *s, const cell_rows *cell, diagnostic *why)
{
    if (cell->header) {
        fputs("cell", cell->out);
        grid_put_paths(s, cell->out);
        fputs("\tn", cell->out);
    } else {
        fprintf(cell->out, "%zu", cell->number);
        grid_put_values(s, cell->number, cell->out);
        fprintf(cell->out, "\t%zu", cell->count);
    }
    TRY(put_spreads(cell, time_spreads, COUNT(time_spreads), why));
    for (size_t i = 0; i < COUNT(ray_medians); i++)
        put_median(cell, ray_medians[i]);
    if (cell->header)
        fputs("\tfilm_hash\tmarked\texcluded", cell->out);
    else
        fprintf(cell->out, "\t%s\t%zu\t%zu", cell->film_expected ? cell->film_expected : "NA", cell->marked,
                cell->excluded);
    for (size_t i = 0; i < COUNT(machine_medians); i++)
        put_median(cell, machine_medians[i]);
    status code = put_solids(s, cell, why);
    THEN(code, put_spreads(cell, quotient_spreads, COUNT(quotient_spreads), why));
    put_compared(s, cell);
    THEN(code, put_undisturbed(cell, why));
    if (s->quick)
        fputs(cell->header ? "\tquick" : "\t1", cell->out);
    fprintf(cell->out, "\t%s\n", cell->header ? "environment" : cell->environment);
    return code;
}

/* Collects the rows of a line: those of a cell in one environment. */
static void collect(cell_rows *cell, row_ref *const *rows, size_t count)
{
    cell->film_expected = NULL;
    cell->count = cell->marked = cell->excluded = cell->disturbed = cell->judged = 0;
    for (size_t i = 0; i < count; i++) {
        const bool marked = strcmp(row_field(rows[i], "marked"), "0") != 0;
        cell->film_expected = cell->film_expected ? cell->film_expected : row_field(rows[i], "film_expected");
        const bool is_excluded = excluded_has(cell->without, rows[i]);
        cell->marked += marked;
        cell->excluded += is_excluded;
        if (row_use_of(cell->without, rows[i]) == ROW_COUNTS)
            cell->rows[cell->count++] = rows[i];
    }
    row_noise_columns at = {.table = NULL};
    for (size_t i = 0; i < cell->count; i++) {
        const noise_verdict verdict = row_noise_judge(cell->rule, &at, cell->rows[i]);
        cell->disturbed += verdict == NOISE_DISTURBED;
        cell->judged += verdict != NOISE_NOT_KNOWN;
    }
}

static int compare_lines(const void *a, const void *b)
{
    const row_ref *x = *(row_ref *const *)a, *y = *(row_ref *const *)b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    const int environment = strcmp(x->environment, y->environment);
    return environment ? environment : (x > y) - (x < y);
}

/* A cell has a line for each environment in which it has rows, or one line if it has none. */
static status put_cell(const study *s, cell_rows *cell, row_ref *const *rows, size_t count, diagnostic *why)
{
    size_t from = 0, to;
    do {
        for (to = from; to < count && strcmp(rows[to]->environment, rows[from]->environment) == 0; to++) {
        }
        cell->environment = to > from ? rows[from]->environment : "NA";
        collect(cell, rows + from, to - from);
        TRY(put_line(s, cell, why));
        from = to;
    } while (from < count);
    return STATUS_OK;
}

/* Rows are in the order of time; they are sorted by cell and environment. */
static status put_cells(const study *s, const row_files *files, const row_files *compared, const excluded *without,
                        const char *environment, FILE *out, diagnostic *why)
{
    const size_t room = files->row_count + 1;
    row_ref **sorted = malloc(room * sizeof *sorted);
    cell_rows cell = {.rows = malloc(room * sizeof *cell.rows),
                      .values = malloc(room * sizeof *cell.values),
                      .rule = &s->disturbed,
                      .without = without,
                      .out = out};
    const row_ref **compared_with = calloc(study_cell_count(s), sizeof *compared_with);
    status code = sorted && cell.rows && cell.values && compared_with ? STATUS_OK : out_of_memory(why);
    size_t count = 0;
    for (size_t i = 0; code == STATUS_OK && i < files->row_count; i++)
        if (!environment[0] || strcmp(files->rows[i].environment, environment) == 0)
            sorted[count++] = &files->rows[i];
    if (code == STATUS_OK)
        qsort(sorted, count, sizeof *sorted, compare_lines);
    for (size_t i = compared && code == STATUS_OK ? compared->row_count : 0; i > 0; i--)
        compared_with[compared->rows[i - 1].cell] = &compared->rows[i - 1];
    size_t from = 0, to;
    for (size_t number = 0; code == STATUS_OK && number < study_cell_count(s); number++, from = to) {
        for (to = from; to < count && sorted[to]->cell == number; to++) {
        }
        cell.number = number;
        cell.compared = compared_with[number];
        code = put_cell(s, &cell, sorted + from, to - from, why);
    }
    free(sorted);
    free(cell.rows);
    free(cell.values);
    free(compared_with);
    return code;
}

static status no_rows(const study *s, const char *results, diagnostic *why)
{
    char remedy[256];
    snprintf(remedy, sizeof remedy,
             "run cuvette study run %.128s first, or give the folder of its results with --results", s->path);
    return diagnose_at(why, s->path, STATUS_FAILURE, remedy, "no rows in %s/%s", results, s->name);
}

status study_summary_of(const study *s, const char *results, const summary_options *options, FILE *out,
                        diagnostic *verdict, diagnostic *why)
{
    row_files *files, *compared = NULL;
    excluded *without = NULL;
    char environment[ENVIRONMENT_KEY] = "";
    status code = row_files_read(s, results, ROWS, &files, why);
    if (code == STATUS_OK && files->row_count == 0)
        code = no_rows(s, results, why);
    THEN(code, row_environments_choose(files, options->environment, environment, why));
    THEN(code, excluded_read(s, results, &without, why));
    if (code == STATUS_OK && s->reference.count)
        code = row_files_read(s, results, COMPARE_ROWS, &compared, why);
    if (code == STATUS_OK)
        code = put_line(s, &(cell_rows){.header = true, .out = out}, why);
    THEN(code, put_cells(s, files, compared, without, environment, out, why));
    if (code == STATUS_OK && verdict && row_files_judge(files, verdict) == STATUS_OK && compared)
        row_files_judge(compared, verdict);
    excluded_destroy(without);
    row_files_destroy(compared);
    row_files_destroy(files);
    return code;
}

status study_summary(const study *s, const char *results, FILE *out, diagnostic *why)
{
    return study_summary_of(s, results, &(summary_options){.environment = NULL}, out, NULL, why);
}

/* --- as a table --- */

static size_t count_of(const char *text, char end, char wanted)
{
    size_t count = 0;
    for (; *text && *text != end; text++)
        count += *text == wanted;
    return count;
}

/* Splits a line into at most `columns` fields; absent ones are NA. */
static void split_line(char *line, const char **fields, size_t columns)
{
    for (size_t i = 0; i < columns; i++) {
        const char *field = strsep(&line, "\t");
        fields[i] = field ? field : "NA";
    }
}

status summary_table_split(char *text, summary_table *out, diagnostic *why)
{
    *out = (summary_table){.text = text, .columns = count_of(text, '\n', '\t') + 1};
    const size_t lines = count_of(text, '\0', '\n');
    out->rows = lines ? lines - 1 : 0;
    out->names = calloc(out->columns, sizeof *out->names);
    out->fields = calloc(out->rows * out->columns + 1, sizeof *out->fields);
    if (!out->names || !out->fields) {
        summary_table_free(out);
        return out_of_memory(why);
    }
    split_line(strsep(&text, "\n"), out->names, out->columns);
    for (size_t row = 0; row < out->rows; row++)
        split_line(strsep(&text, "\n"), &out->fields[row * out->columns], out->columns);
    return STATUS_OK;
}

status summary_table_read(const study *s, const char *results, summary_table *out, diagnostic *why)
{
    char *text = NULL;
    text_writer writer;
    *out = (summary_table){0};
    TRY(text_writer_open(&writer, why));
    const status code = study_summary(s, results, writer.stream, why);
    TRY(text_writer_end(&writer, code, &text, NULL, why));
    return summary_table_split(text, out, why);
}

void summary_table_free(summary_table *t)
{
    free(t->names);
    free(t->fields);
    free(t->text);
    *t = (summary_table){0};
}

long summary_table_column(const summary_table *t, const char *name)
{
    for (size_t i = 0; i < t->columns; i++)
        if (strcmp(t->names[i], name) == 0)
            return (long)i;
    return -1;
}

const char *summary_table_text(const summary_table *t, size_t row, long column)
{
    return column < 0 ? "NA" : t->fields[row * t->columns + (size_t)column];
}

double summary_table_real(const summary_table *t, size_t row, long column)
{
    double value;
    return number_parse_real(summary_table_text(t, row, column), &value) ? value : NAN;
}
