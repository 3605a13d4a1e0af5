/* The small print under a figure: how many repetitions, which spread, what is missing, what disturbed. */
#include "study/plot_parts.h"
#include "base/text.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double caption_letter = 5.6; /* mean width, CSS pixels */

/* The end of the longest start of text that fits, at a blank if there is one. */
static size_t line_length(const char *text, size_t room)
{
    if (strlen(text) <= room)
        return strlen(text);
    for (size_t i = room; i > 0; i--)
        if (text[i] == ' ')
            return i;
    while (room > 1 && ((unsigned char)text[room] & 0xC0) == 0x80)
        room--; /* not within a character */
    return room;
}

status plot_caption_add(plot_plan *p, diagnostic *why, const char *format, ...)
{
    char text[1200];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    const size_t room = (size_t)((p->width - 20) / caption_letter);
    for (const char *rest = text; *rest && p->caption_count < PLOT_CAPTIONS_MAX; rest += *rest == ' ') {
        const size_t length = line_length(rest, room);
        p->captions[p->caption_count] = strndup(rest, length);
        if (!p->captions[p->caption_count])
            return out_of_memory(why);
        p->caption_count++;
        rest += length;
    }
    return STATUS_OK;
}

/* --- what the figure has --- */

typedef struct facts {
    double least_n, most_n, others;
    size_t intervals, ranges; /* points with an interval; with a range only */
    double widest;            /* half of the widest spread as a fraction of the value */
    double marked, disturbed;
} facts;

static double sum_of(const plot_plan *p, const char *name)
{
    const long column = plot_table_column(&p->table, name);
    double sum = 0;
    for (size_t row = 0; row < p->table.rows; row++) {
        const double value = p->shown[row] ? plot_table_real(&p->table, row, column) : NAN;
        sum += isnan(value) ? 0 : value;
    }
    return sum;
}

static facts collect(const plot_plan *p)
{
    facts f = {.least_n = INFINITY, .others = NAN, .marked = sum_of(p, "marked"), .disturbed = sum_of(p, "disturbed")};
    const long n = plot_table_column(&p->table, "n"), others = plot_table_column(&p->table, "others_share");
    for (size_t i = 0; i < p->point_count; i++) {
        const plot_point *point = &p->points[i];
        const double count = plot_table_real(&p->table, point->row, n);
        f.least_n = fmin(f.least_n, count);
        f.most_n = fmax(f.most_n, count);
        f.others = fmax(f.others, plot_table_real(&p->table, point->row, others));
        const bool interval = !isnan(plot_table_real(&p->table, point->row, p->y.low)) &&
                              !isnan(plot_table_real(&p->table, point->row, p->y.high));
        f.intervals += interval;
        f.ranges += !interval && !isnan(point->low);
        if (point->y > 0 && !isnan(point->low))
            f.widest = fmax(f.widest, (point->high - point->low) / 2 / point->y);
    }
    return f;
}

static status add_spread(plot_plan *p, const facts *f, diagnostic *why)
{
    char n[60], wide[80] = "";
    snprintf(n, sizeof n, f->least_n < f->most_n ? "n = %g to %g" : "n = %g", f->least_n, f->most_n);
    if (p->kind == PLOT_HEAT && f->intervals + f->ranges > 0)
        snprintf(wide, sizeof wide,
                 f->widest < 0.1 ? ", at most ±%.2g %% of the value" : ", at most ±%.0f %% of the value",
                 100 * f->widest);
    const char *bars = p->kind == PLOT_HEAT ? "" : "bars: ";
    if (f->most_n < 2)
        return plot_caption_add(p, why, "%s: single measurements, without any spread.", n);
    if (f->intervals && f->ranges)
        return plot_caption_add(
            p, why, "Medians, %s; %s95 %% interval of the median where n ≥ 6, elsewhere the range%s.", n, bars, wide);
    if (f->intervals)
        return plot_caption_add(p, why, "Medians, %s; %s95 %% interval of the median%s.", n, bars, wide);
    if (f->ranges)
        return plot_caption_add(p, why, "Medians, %s; %srange of the repetitions%s; fewer than 6 give no interval.", n,
                                bars, wide);
    return plot_caption_add(p, why, "Each value is of %s repetitions; the summary has no interval of it.", n);
}

static size_t shown_cells(const plot_plan *p)
{
    const long cell = plot_table_column(&p->table, "cell");
    bool *seen = calloc(study_cell_count(p->s) + 1, sizeof *seen);
    size_t count = 0;
    for (size_t row = 0; seen && row < p->table.rows; row++) {
        const double number = plot_table_real(&p->table, row, cell);
        if (!p->shown[row] || !(number >= 0 && number < (double)study_cell_count(p->s)) || seen[(size_t)number])
            continue;
        seen[(size_t)number] = true;
        count++;
    }
    free(seen);
    return count;
}

static status add_missing(plot_plan *p, diagnostic *why)
{
    const plot_axis *environment = plot_axis_named(p, "environment");
    const size_t environments = environment && environment->count > 1 ? environment->count : 1;
    const size_t cells = shown_cells(p) * environments;
    if (p->point_count >= cells)
        return STATUS_OK;
    return plot_caption_add(p, why, "%zu of %zu cells%s have no value of %s.", cells - p->point_count, cells,
                            environments > 1 ? ", counted by environment," : "", p->y.name);
}

/* Environments share no line. */
static status add_environments(plot_plan *p, diagnostic *why)
{
    const plot_axis *axis = plot_axis_named(p, "environment");
    char list[600] = "";
    if (!axis || axis->count == 0)
        return STATUS_OK;
    for (size_t i = 0; i < axis->count && strlen(list) < 500; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%.40s", i ? ", " : "", axis->texts[i]);
    return axis->count == 1 ? plot_caption_add(p, why, "Environment: %s.", list)
                            : plot_caption_add(p, why, "%zu environments, not joined: %s.", axis->count, list);
}

/* The names under which a kept axis could be shown as well. */
static status add_linked(plot_plan *p, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t group = 0; code == STATUS_OK && group < p->s->axis_count; group++) {
        char kept[300] = "", others[500] = "";
        for (size_t i = 0; i < p->axis_count; i++) {
            const plot_axis *axis = &p->axes[i];
            char *list = axis->kept ? kept : others;
            const size_t size = axis->kept ? sizeof kept : sizeof others, length = strlen(list);
            if (axis->group == group && axis->count > 1)
                snprintf(list + length, size - length, "%s%s", length ? ", " : "", axis->name);
        }
        if (others[0] && kept[0])
            code = plot_caption_add(p, why, "Set together with %s: %s.", kept, others);
    }
    return code;
}

static status add_conditions(plot_plan *p, diagnostic *why)
{
    char list[600] = "";
    for (size_t i = 0; i < p->request->where_count && strlen(list) < 500; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%.100s", i ? ", " : "", p->request->where[i]);
    return list[0] ? plot_caption_add(p, why, "Only cells with %s.", list) : STATUS_OK;
}

/* Rows that are not in the values, and how busy the machine was. */
static status add_noise(plot_plan *p, const facts *f, diagnostic *why)
{
    char disturbed[60] = "";
    if (plot_table_column(&p->table, "disturbed") >= 0)
        snprintf(disturbed, sizeof disturbed, "; disturbed: %g", f->disturbed);
    const double share = 100 * f->others;
    if (isnan(share))
        return plot_caption_add(p, why, "Rows marked and left out: %g%s.", f->marked, disturbed);
    return plot_caption_add(p, why,
                            share < 10
                                ? "Rows marked and left out: %g%s. Other processes: at most %.2g %% of the machine."
                                : "Rows marked and left out: %g%s. Other processes: at most %.0f %% of the machine.",
                            f->marked, disturbed, share);
}

status plot_captions(plot_plan *p, diagnostic *why)
{
    const facts f = collect(p);
    TRY(add_spread(p, &f, why));
    TRY(add_missing(p, why));
    TRY(add_noise(p, &f, why));
    TRY(add_environments(p, why));
    TRY(add_conditions(p, why));
    TRY(add_linked(p, why));
    return p->published.caption[0] ? plot_caption_add(p, why, "%s", p->published.caption) : STATUS_OK;
}
