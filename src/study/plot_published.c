/* Numbers of others next to the measured ones: a CSV file with the columns of the figure's axes. */
#include "study/plot_parts.h"
#include "base/text.h"
#include "base/csv.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SERIES_MAX = 6 };

/* The column of that name, or of an end of it after a dot: `depth` for render.depth. */
static int column_named(const csv *table, const char *name)
{
    for (; name; name = strchr(name, '.'), name = name ? name + 1 : NULL)
        if (csv_column(table, name) >= 0)
            return csv_column(table, name);
    return -1;
}

/* Times of all clocks have one unit; the caption says which it is. */
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
    char remedy[300] = "its columns are: ";
    for (size_t i = 0; i < table->column_count && strlen(remedy) < 200; i++)
        snprintf(remedy + strlen(remedy), sizeof remedy - strlen(remedy), "%s%.40s", i ? ", " : "", table->header[i]);
    return diagnose_at(why, p->request->published, STATUS_BAD_INPUT, remedy, "no column for '%s'", name);
}

/* The series of a row by the column `source`; PLOT_NONE: out of memory or too many. */
static size_t series_of(plot_published *out, const csv *table, size_t row)
{
    const int source = csv_column(table, "source");
    const char *name = source < 0 ? "" : csv_field(table, row, source);
    for (size_t i = 0; i < out->series_count; i++)
        if (strcmp(out->names[i], name) == 0)
            return i;
    if (out->series_count == SERIES_MAX || !(out->names[out->series_count] = strdup(name)))
        return PLOT_NONE;
    return out->series_count++;
}

/* A word of a dot plot is found in the axis. */
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
    const char *place = csv_field(table, 0, where), *on = csv_field(table, 0, machine);
    const char *line = strstr(place, ", line "); /* each row has its own */
    const int length = (int)(line ? line - place : (long)strlen(place));
    snprintf(out->caption, sizeof out->caption, "Published: %.40s by %.40s%s%.80s%s%.*s.", table->header[y],
             table->header[x], machine < 0 ? "" : ", machine: ", machine < 0 ? "" : on, where < 0 ? "" : "; ",
             where < 0     ? 0
             : length > 90 ? 90
                           : length,
             place);
}

static status take_rows(plot_plan *p, const csv *table, int x, int y, diagnostic *why)
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
        out->series[out->count] = series_of(out, table, row);
        if (out->series[out->count] == PLOT_NONE)
            return diagnose_at(why, p->request->published, STATUS_BAD_INPUT, "leave at most six in the file",
                               "the column 'source' has more than %d values", SERIES_MAX);
        out->count++;
    }
    if (!out->count)
        return diagnose_at(why, p->request->published, STATUS_BAD_INPUT,
                           "give a CSV file with the x axis and the quantity of the figure as columns",
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
    THEN(code, take_rows(p, table, x, y, why));
    csv_destroy(table);
    return code;
}
