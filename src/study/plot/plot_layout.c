/* Computes the sizes of a figure, in CSS pixels: panels in a grid, the title above, the key or the color bar on the
 * right, captions below. */
#include "base/text.h"
#include "study/plot/plot.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LETTER = 7,
    TITLE_LETTER = 8,
    TURNED_LETTER = 9,
    TITLE = 36,
    LINE = 13 /* of captions */,
    GAP = 24,
    PANEL_TITLE = 26,
    WIDTH_MIN = 560
};

typedef struct grid {
    size_t count, columns, rows;
    int width, height;       /* of a panel */
    int left, right, bottom; /* margins of the figure, without captions */
} grid;

static int longest(const plot_axis *axis)
{
    size_t most = 0;
    for (size_t i = 0; axis && i < axis->count; i++)
        most = strlen(axis->texts[i]) > most ? strlen(axis->texts[i]) : most;
    return (int)most;
}

static int limited(int value, int least, int most)
{
    return value < least ? least : value > most ? most : value;
}

/* --- panels --- */

static const char *last_part(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : path;
}

/* "render.accel = bvh, render.width = 80"; names are shortened if the title is too long. */
static char *panel_title(const plot_plan *p, size_t panel, bool full)
{
    char *title = strdup("");
    for (size_t i = p->faceted_count; title && i-- > 0;) {
        const plot_axis *axis = p->faceted[i];
        char *longer = text_format("%s = %s%s%s", full ? axis->name : last_part(axis->name),
                                   axis->texts[panel % axis->count], title[0] ? ", " : "", title);
        panel /= axis->count;
        free(title);
        title = longer;
    }
    return title;
}

/* Names the panels, and widens them for names that are too long even when shortened. */
static bool name_panels(plot_plan *p, int *width)
{
    int letters = 0;
    for (size_t i = 0; i < p->panel_count; i++) {
        if (!p->panels[i].used)
            continue;
        p->panels[i].title = panel_title(p, i, true);
        if (p->panels[i].title && (int)strlen(p->panels[i].title) * TITLE_LETTER > *width) {
            free(p->panels[i].title);
            p->panels[i].title = panel_title(p, i, false);
        }
        if (!p->panels[i].title)
            return false;
        letters = (int)strlen(p->panels[i].title) > letters ? (int)strlen(p->panels[i].title) : letters;
    }
    *width = limited(letters * TITLE_LETTER, *width, *width > 480 ? *width : 480);
    return true;
}

static void size_panels(const plot_plan *p, grid *g)
{
    static const size_t columns[] = {1, 1, 2, 3, 2, 3, 3, 4, 4, 3};
    static const int widths[] = {0, 560, 380, 300, 290, 250};
    g->columns = g->count < 10 ? columns[g->count] : g->count <= 12 ? 4 : g->count <= 25 ? 5 : 6;
    g->rows = (g->count + g->columns - 1) / g->columns;
    g->width = g->columns < 6 ? widths[g->columns] : 220;
    g->height = g->count == 1 ? 350 : g->width * 3 / 4;
    if (p->kind == PLOT_HEAT) {
        const int cell = g->count == 1 ? 68 : 50;
        g->width = limited((int)p->along->count * cell, g->count == 1 ? 420 : 170, g->width + 260);
        g->height = limited((int)p->up->count * 34, 110, 620);
    } else if (p->kind == PLOT_DOTS && p->along) {
        g->width = limited((int)(p->along->count * (p->series_count > 2 ? p->series_count * 12 : 26)), g->width, 1000);
    }
}

/* --- margins --- */

static int key_width(const plot_plan *p)
{
    int letters = p->by ? longest(p->by) : 0;
    if (!p->by && !p->published.series_count)
        return 0;
    letters = p->by && (int)strlen(p->by->name) > letters + 4 ? (int)strlen(p->by->name) - 4 : letters;
    for (size_t i = 0; i < p->published.series_count; i++)
        letters = limited((int)strlen(p->published.names[i]) + 12, letters, 36);
    return limited(letters * LETTER + 54, 120, 330);
}

/* The estimated number of characters of the longest tic label of the y axis. */
static int y_letters(const plot_plan *p)
{
    const double most = fmax(fabs(p->y.from), fabs(p->y.to));
    const int digits = most >= 1 && most < 1e7 ? 1 + (int)log10(most) : 5;
    return limited(digits + (p->y.from < 0) + (p->y.to - p->y.from < 3 || p->y.from < 0.1 ? 1 : 0), 4, 8);
}

static void find_margins(const plot_plan *p, grid *g)
{
    const int slot = p->along ? g->width / (int)p->along->count : g->width;
    const bool words = p->kind != PLOT_LINES;
    const bool turned = words && longest(p->along) * LETTER > slot;
    g->left = 46 + LETTER * (p->kind == PLOT_HEAT ? longest(p->up) : y_letters(p));
    g->right = 18 + (p->kind == PLOT_HEAT ? 96 : key_width(p));
    g->bottom = 50 + (turned ? limited(longest(p->along) * TURNED_LETTER - 8, 0, 240) : 0);
}

/* --- captions ---
 *
 * They state the number of repetitions, the spread, missing values and disturbances. */

static const double caption_letter = 5.6; /* mean width, CSS pixels */

/* The length of the longest beginning of text that fits, cut at a blank if there is one. */
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

/* --- facts of the captions --- */

typedef struct facts {
    double least_n, most_n, others;
    size_t intervals, ranges; /* points with an interval; with only a range */
    double widest;            /* half of the widest spread as a fraction of the value */
    double marked, disturbed;
} facts;

static double sum_of(const plot_plan *p, const char *name)
{
    const long column = summary_table_column(&p->table, name);
    double sum = 0;
    for (size_t row = 0; row < p->table.rows; row++) {
        const double value = p->shown[row] ? summary_table_real(&p->table, row, column) : NAN;
        sum += isnan(value) ? 0 : value;
    }
    return sum;
}

static facts collect(const plot_plan *p)
{
    facts f = {.least_n = INFINITY, .others = NAN, .marked = sum_of(p, "marked"), .disturbed = sum_of(p, "disturbed")};
    const long n = summary_table_column(&p->table, "n"), others = summary_table_column(&p->table, "others_fraction");
    for (size_t i = 0; i < p->point_count; i++) {
        const plot_point *point = &p->points[i];
        const double count = summary_table_real(&p->table, point->row, n);
        f.least_n = fmin(f.least_n, count);
        f.most_n = fmax(f.most_n, count);
        f.others = fmax(f.others, summary_table_real(&p->table, point->row, others));
        const bool interval = !isnan(summary_table_real(&p->table, point->row, p->y.low)) &&
                              !isnan(summary_table_real(&p->table, point->row, p->y.high));
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
        return plot_caption_add(p, why, "Medians, %s; %s95 %% interval of the median if n ≥ 6, otherwise the range%s.",
                                n, bars, wide);
    if (f->intervals)
        return plot_caption_add(p, why, "Medians, %s; %s95 %% interval of the median%s.", n, bars, wide);
    if (f->ranges)
        return plot_caption_add(p, why, "Medians, %s; %srange of the repetitions%s; fewer than 6 give no interval.", n,
                                bars, wide);
    return plot_caption_add(p, why, "Values of %s repetitions; the summary has no interval of this quantity.", n);
}

static size_t shown_cells(const plot_plan *p)
{
    const long cell = summary_table_column(&p->table, "cell");
    bool *seen = calloc(study_cell_count(p->s) + 1, sizeof *seen);
    size_t count = 0;
    for (size_t row = 0; seen && row < p->table.rows; row++) {
        const double number = summary_table_real(&p->table, row, cell);
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

/* Names the environments, whose values no line joins. */
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

/* Names the parameters that are set together with a kept one. */
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

/* States how many rows are excluded, and how busy the machine was. */
static status add_noise(plot_plan *p, const facts *f, diagnostic *why)
{
    char disturbed[60] = "";
    if (summary_table_column(&p->table, "disturbed") >= 0)
        snprintf(disturbed, sizeof disturbed, "; disturbed: %g", f->disturbed);
    const double percent = 100 * f->others;
    if (isnan(percent))
        return plot_caption_add(p, why, "Rows marked and left out: %g%s.", f->marked, disturbed);
    return plot_caption_add(p, why,
                            percent < 10
                                ? "Rows marked and left out: %g%s. Other processes: at most %.2g %% of the machine."
                                : "Rows marked and left out: %g%s. Other processes: at most %.0f %% of the machine.",
                            f->marked, disturbed, percent);
}

/* Adds captions on n, spread, missing cells, marked rows, other processes, environments, --where, linked parameters and
 * published numbers. */
static status add_captions(plot_plan *p, diagnostic *why)
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

/* --- places --- */

static void place_panels(plot_plan *p, const grid *g, int captions)
{
    size_t place = 0;
    for (size_t i = 0; i < p->panel_count; i++) {
        plot_panel *panel = &p->panels[i];
        if (!panel->used)
            continue;
        const size_t row = place / g->columns, column = place % g->columns;
        const double left = g->left + (double)column * (g->width + GAP);
        const double below = (double)(g->rows - 1 - row) * (g->height + PANEL_TITLE + GAP / 2.0);
        panel->left = left / p->width;
        panel->right = (left + g->width) / p->width;
        panel->bottom = (captions + g->bottom + below) / p->height;
        panel->top = (captions + g->bottom + below + g->height) / p->height;
        panel->shows_x = place + g->columns >= g->count;
        panel->shows_y = column == 0;
        place++;
    }
    p->key_left = (g->left + (double)g->columns * (g->width + GAP) - GAP + 14) / p->width;
    p->key_top = 1.0 - (double)(TITLE + (g->count > 1 ? PANEL_TITLE : 0)) / p->height;
}

status plot_layout(plot_plan *p, diagnostic *why)
{
    grid g = {0};
    for (size_t i = 0; i < p->panel_count; i++)
        g.count += p->panels[i].used;
    if (g.count > PLOT_PANELS_MAX)
        return diagnose_at(why, p->s->path, STATUS_BAD_INPUT,
                           "show a part of the grid with --where PATH=VALUE, or choose --x and --by",
                           "%zu panels are more than %d", g.count, PLOT_PANELS_MAX);
    size_panels(p, &g);
    if (!name_panels(p, &g.width))
        return out_of_memory(why);
    find_margins(p, &g);
    p->width = g.left + (int)g.columns * (g.width + GAP) - GAP + g.right;
    p->width = p->width < WIDTH_MIN ? WIDTH_MIN : p->width;
    TRY(add_captions(p, why));
    const int captions = (int)p->caption_count * LINE + 10, titles = g.count > 1 ? PANEL_TITLE : 0;
    p->height =
        TITLE + titles + (int)g.rows * g.height + (int)(g.rows - 1) * (PANEL_TITLE + GAP / 2) + g.bottom + captions;
    place_panels(p, &g, captions);
    return STATUS_OK;
}
