/* The points of a figure, and its data file: a block of lines for each line of the figure, in the order of the
 * script's `index`. */
#include "study/plot_parts.h"
#include "base/file.h"
#include "base/number.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
    point->low = plot_table_real(&p->table, point->row, q->low);
    point->high = plot_table_real(&p->table, point->row, q->high);
    if (!isnan(point->low) && !isnan(point->high))
        return;
    point->low = plot_table_real(&p->table, point->row, q->least);
    point->high = plot_table_real(&p->table, point->row, q->most);
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

/* Words of several lines stand next to each other, so that their bars do not overlap. */
static double dodge(const plot_plan *p, const plot_point *point)
{
    const double step = 0.6 / (double)p->series_count;
    return step * ((double)point->series - 0.5 * (double)(p->series_count - 1));
}

static bool take_point(const plot_plan *p, size_t row, plot_point *out)
{
    *out = (plot_point){.row = row, .y = plot_table_real(&p->table, row, p->y.value)};
    if (!p->shown[row] || isnan(out->y))
        return false;
    out->panel = panel_of(p, row);
    out->series = p->by ? p->by->at[row] : 0;
    out->along = p->along ? p->along->at[row] : 0;
    out->up = p->up ? p->up->at[row] : 0;
    out->x = p->x.value >= 0                     ? plot_table_real(&p->table, row, p->x.value)
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
        if (take_point(p, row, &p->points[p->point_count])) {
            p->panels[p->points[p->point_count].panel].used = true;
            p->point_count++;
        }
    qsort(p->points, p->point_count, sizeof *p->points, compare_points);
    return p->point_count ? STATUS_OK
                          : diagnose_at(why, p->s->path, STATUS_FAILURE, "measure them with cuvette study run",
                                        "none of the chosen cells has a value of %s", p->y.name);
}

/* --- the file --- */

static void put(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isnan(value) ? "NA" : number_format_digits(value, 9, text));
}

/* A number of a cell of a heat map, on a ground that is dark below the middle of viridis. */
static void put_text(FILE *out, const plot_plan *p, double value)
{
    char text[NUMBER_TEXT_MAX];
    const double share =
        p->y.log ? log(value / p->y.from) / log(p->y.to / p->y.from) : (value - p->y.from) / (p->y.to - p->y.from);
    const bool plain = fabs(value) >= 1000 && fabs(value) < 1e6; /* 8750, not 8.75e+03 */
    if (plain)
        snprintf(text, sizeof text, "%.0f", value);
    else
        number_format_digits(value, 3, text);
    fprintf(out, "\t%s\t%d", text, share < 0.6 ? 0xffffff : 0x222222);
}

static void put_point(FILE *out, const plot_plan *p, const plot_point *point)
{
    fputs(plot_table_text(&p->table, point->row, plot_table_column(&p->table, "cell")), out);
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
    fprintf(out, "\t%s\n", plot_table_text(&p->table, point->row, plot_table_column(&p->table, "n")));
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
