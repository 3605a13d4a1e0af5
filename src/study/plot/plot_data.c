/* Collects the points of a figure, measured and published, and writes its data file: a block for each line of the
 * figure, in the order of `index` in the script. */
#include "base/csv.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "study/plot/plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t panel_of(const plot_plan *p, size_t row)
{
    size_t panel = 0;
    for (size_t i = 0; i < p->faceted_count; i++)
        panel = panel * p->faceted[i]->count + p->faceted[i]->at[row];
    return panel;
}

/* The interval of a value; without one, the range of the repetitions. */
static void find_spread(const plot_plan *p, plot_point *point)
{
    const plot_quantity *q = &p->y;
    point->low = summary_table_real(&p->table, point->row, q->low);
    point->high = summary_table_real(&p->table, point->row, q->high);
    if (!isnan(point->low) && !isnan(point->high))
        return;
    point->low = summary_table_real(&p->table, point->row, q->least);
    point->high = summary_table_real(&p->table, point->row, q->most);
}

static int compare_points(const void *a, const void *b)
{
    const plot_point *x = a, *y = b;
    const size_t keys[][2] = {
        {x->panel, y->panel}, {x->series, y->series}, {x->along, y->along}, {x->up, y->up}, {x->row, y->row}};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (keys[i][0] != keys[i][1])
            return keys[i][0] < keys[i][1] ? -1 : 1;
    return 0;
}

/* The shift of a point of a dot plot, so that bars of several series at the same word do not overlap. */
static double dodge(const plot_plan *p, const plot_point *point)
{
    const double step = 0.6 / (double)p->series_count;
    return step * ((double)point->series - 0.5 * (double)(p->series_count - 1));
}

static bool find_point(const plot_plan *p, size_t row, plot_point *out)
{
    *out = (plot_point){.row = row, .y = summary_table_real(&p->table, row, p->y.value)};
    if (!p->shown[row] || isnan(out->y))
        return false;
    out->panel = panel_of(p, row);
    out->series = p->by ? p->by->at[row] : 0;
    out->along = p->along ? p->along->at[row] : 0;
    out->up = p->up ? p->up->at[row] : 0;
    out->x = p->x.value >= 0                     ? summary_table_real(&p->table, row, p->x.value)
             : p->kind == PLOT_LINES && p->along ? p->along->reals[out->along]
             : p->kind == PLOT_DOTS              ? (double)out->along + dodge(p, out)
                                                 : (double)out->along;
    find_spread(p, out);
    return !isnan(out->x);
}

status plot_points_collect(plot_plan *p, diagnostic *why)
{
    p->series_count = p->by ? p->by->count : 1;
    p->points = calloc(p->table.rows + 1, sizeof *p->points);
    p->panels = calloc(p->panel_count, sizeof *p->panels);
    if (!p->points || !p->panels)
        return out_of_memory(why);
    for (size_t row = 0; row < p->table.rows; row++)
        if (find_point(p, row, &p->points[p->point_count])) {
            p->panels[p->points[p->point_count].panel].used = true;
            p->point_count++;
        }
    qsort(p->points, p->point_count, sizeof *p->points, compare_points);
    return p->point_count ? STATUS_OK
                          : diagnose_at(why, p->s->path, STATUS_FAILURE, "measure them with cuvette study run",
                                        "none of the chosen cells has a value of %s", p->y.name);
}

/* --- published numbers ---
 *
 * They come from a CSV file with the columns of the figure's axes. */

enum { SERIES_MAX = 6 };

/* The column with the name, or with the part of it after a dot: `depth` for render.depth. */
static int column_named(const csv *table, const char *name)
{
    for (; name; name = strchr(name, '.'), name = name ? name + 1 : NULL)
        if (csv_column(table, name) >= 0)
            return csv_column(table, name);
    return -1;
}

/* A published time of any clock can be drawn, because all are in seconds; the caption names its column. */
static int column_of_time(const csv *table, const char *name)
{
    static const char *const times[] = {"wall_s", "time_s", "cpu_s"};
    const size_t length = strlen(name);
    for (size_t i = 0; length > 2 && strcmp(name + length - 2, "_s") == 0 && i < sizeof times / sizeof *times; i++)
        if (csv_column(table, times[i]) >= 0)
            return csv_column(table, times[i]);
    return -1;
}

static status no_column(const plot_plan *p, const csv *table, const char *name, diagnostic *why)
{
    char remedy[300] = "choose from its columns: ";
    for (size_t i = 0; i < table->column_count && strlen(remedy) < 200; i++)
        snprintf(remedy + strlen(remedy), sizeof remedy - strlen(remedy), "%s%.40s", i ? ", " : "", table->header[i]);
    return diagnose_at(why, p->request->published, STATUS_BAD_INPUT, remedy, "no column for '%s'", name);
}

/* Finds the series of a row by the column `source`. */
static status series_of(const plot_plan *p, plot_published *out, const csv *table, size_t row, diagnostic *why)
{
    size_t *series = &out->series[out->count];
    const int source = csv_column(table, "source");
    const char *name = source < 0 ? "" : csv_field(table, row, source);
    for (*series = 0; *series < out->series_count; ++*series)
        if (strcmp(out->names[*series], name) == 0)
            return STATUS_OK;
    if (out->series_count == SERIES_MAX)
        return diagnose_at(why, p->request->published, STATUS_BAD_INPUT, "keep at most six sources in the file",
                           "the column 'source' has more than %d values", SERIES_MAX);
    if (!(out->names[out->series_count] = strdup(name)))
        return out_of_memory(why);
    out->series_count++;
    return STATUS_OK;
}

/* The x of a published value: a number, or, in a dot plot, the place of its word on the axis. */
static double x_of(const plot_plan *p, const csv *table, size_t row, int column)
{
    if (p->kind == PLOT_LINES)
        return csv_field_real(table, row, column);
    for (size_t i = 0; p->along && i < p->along->count; i++)
        if (strcmp(p->along->texts[i], csv_field(table, row, column)) == 0)
            return (double)i;
    return NAN;
}

static void describe(plot_published *out, const csv *table, int x, int y)
{
    const int machine = csv_column(table, "machine"), where = csv_column(table, "where");
    const char *place = csv_field(table, 0, where), *computer = csv_field(table, 0, machine);
    const char *line = strstr(place, ", line "); /* line numbers differ between rows */
    const int length = (int)(line ? line - place : (long)strlen(place));
    snprintf(out->caption, sizeof out->caption, "Published: %.40s by %.40s%s%.80s%s%.*s.", table->header[y],
             table->header[x], machine < 0 ? "" : ", machine: ", machine < 0 ? "" : computer, where < 0 ? "" : "; ",
             where < 0     ? 0
             : length > 90 ? 90
                           : length,
             place);
}

static status read_published(plot_plan *p, const csv *table, int x, int y, diagnostic *why)
{
    plot_published *out = &p->published;
    out->x = calloc(table->row_count + 1, sizeof *out->x);
    out->y = calloc(table->row_count + 1, sizeof *out->y);
    out->series = calloc(table->row_count + 1, sizeof *out->series);
    out->names = calloc(SERIES_MAX, sizeof *out->names);
    if (!out->x || !out->y || !out->series || !out->names)
        return out_of_memory(why);
    for (size_t row = 0; row < table->row_count; row++) {
        const double at = x_of(p, table, row, x), value = csv_field_real(table, row, y);
        if (isnan(at) || isnan(value))
            continue;
        out->x[out->count] = at;
        out->y[out->count] = value;
        TRY(series_of(p, out, table, row, why));
        out->count++;
    }
    if (!out->count)
        return diagnose_at(why, p->request->published, STATUS_BAD_INPUT,
                           "give a CSV file with values of the figure's x axis and numbers of its quantity",
                           "no row has numbers of '%s' and '%s'", table->header[x], table->header[y]);
    describe(out, table, x, y);
    return STATUS_OK;
}

status plot_published_read(plot_plan *p, diagnostic *why)
{
    csv *table = NULL;
    if (!p->request->published)
        return STATUS_OK;
    const char *name = p->x.value >= 0 ? p->x.name : p->along ? p->along->name : "";
    status code = csv_read_any(p->request->published, NULL, &table, why);
    if (code == STATUS_OK && !table)
        code = diagnose_at(why, p->request->published, STATUS_BAD_INPUT, "give a CSV file", "no such file");
    if (code == STATUS_OK && table->torn)
        code = diagnose_at(why, p->request->published, STATUS_BAD_INPUT, "complete it, or remove it",
                           "the last line is incomplete");
    if (code != STATUS_OK) {
        csv_destroy(table);
        return code;
    }
    const int x = column_named(table, name);
    int y = column_named(table, p->y.name);
    y = y < 0 ? column_of_time(table, p->y.name) : y;
    if (x < 0 || y < 0)
        code = no_column(p, table, x < 0 ? name : p->y.name, why);
    THEN(code, read_published(p, table, x, y, why));
    csv_destroy(table);
    return code;
}

/* --- the file --- */

static void put(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isnan(value) ? "NA" : number_format_digits(value, 9, text));
}

/* Writes the number in a cell of a heat map and its colour: white on the dark colours of viridis. */
static void put_text(FILE *out, const plot_plan *p, double value)
{
    char text[NUMBER_TEXT_MAX];
    const double fraction =
        p->y.log ? log(value / p->y.from) / log(p->y.to / p->y.from) : (value - p->y.from) / (p->y.to - p->y.from);
    const bool plain = fabs(value) >= 1000 && fabs(value) < 1e6; /* 8750, not 8.75e+03 */
    if (plain)
        snprintf(text, sizeof text, "%.0f", value);
    else
        number_format_digits(value, 3, text);
    fprintf(out, "\t%s\t%d", text, fraction < 0.6 ? 0xffffff : 0x222222);
}

static void put_point(FILE *out, const plot_plan *p, const plot_point *point)
{
    fputs(summary_table_text(&p->table, point->row, summary_table_column(&p->table, "cell")), out);
    put(out, point->x);
    if (p->kind == PLOT_HEAT) {
        put(out, (double)point->up);
        put(out, point->y);
        put_text(out, p, point->y);
    } else {
        put(out, point->y);
        put(out, isnan(point->low) ? point->y : point->low);
        put(out, isnan(point->high) ? point->y : point->high);
    }
    fprintf(out, "\t%s\n", summary_table_text(&p->table, point->row, summary_table_column(&p->table, "n")));
}

static void put_head(FILE *out, const plot_plan *p)
{
    fprintf(out, "# %s: %s%s%s\n", p->s->name, p->y.name, p->y.unit[0] ? " / " : "", p->y.unit);
    fputs(p->kind == PLOT_HEAT ? "# cell\tx\ty\tvalue\ttext\tcolor\tn\n" : "# cell\tx\tmedian\tlow\thigh\tn\n", out);
}

static void put_blocks(FILE *out, const plot_plan *p)
{
    for (size_t i = 0; i < p->point_count; i++) {
        const plot_point *point = &p->points[i];
        if (i > 0 && (point[-1].panel != point->panel || point[-1].series != point->series))
            fputs("\n\n", out);
        if (i == 0 || point[-1].panel != point->panel || point[-1].series != point->series) {
            fprintf(out, "# %s", p->panels[point->panel].title ? p->panels[point->panel].title : "");
            if (p->by)
                fprintf(out, " %s = %s", p->by->name, p->by->texts[point->series]);
            fputc('\n', out);
        }
        put_point(out, p, point);
    }
}

static void put_published(FILE *out, const plot_published *published)
{
    for (size_t series = 0; series < published->series_count; series++) {
        fprintf(out, "\n\n# %s\n", published->names[series]);
        for (size_t i = 0; i < published->count; i++)
            if (published->series[i] == series) {
                fputs("NA", out);
                put(out, published->x[i]);
                put(out, published->y[i]);
                fputc('\n', out);
            }
    }
}

status plot_data_write(const plot_plan *p, const char *path, diagnostic *why)
{
    file_writer file;
    TRY(file_writer_open(&file, path, why));
    put_head(file.stream, p);
    put_blocks(file.stream, p);
    put_published(file.stream, &p->published);
    return file_writer_end(&file, STATUS_OK, why);
}
