/* The parameters of a figure: which rows are shown, the distinct values of each parameter in them, and which parameters
 * are determined by others. */
#include "base/number.h"
#include "base/text.h"
#include "study/plan/grid.h"
#include "study/plot/plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const plot_axis *plot_axis_named(const plot_plan *p, const char *name)
{
    for (size_t i = 0; i < p->axis_count; i++)
        if (strcmp(p->axes[i].name, name) == 0)
            return &p->axes[i];
    return NULL;
}

/* Joins names as "a, b, c", cut to the size of the text. */
static const char *list_of(const char *const *names, size_t count, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < count && length + 4 < size; i++) {
        const int more = snprintf(text + length, size - length, "%s%.60s", i ? ", " : "", names[i]);
        length += more > 0 ? (size_t)more : 0;
    }
    return text;
}

/* --- axes --- */

static bool add_axis(plot_plan *p, const char *name, size_t group)
{
    const long column = summary_table_column(&p->table, name);
    if (column < 0 || p->axis_count == PLOT_AXES_MAX)
        return true;
    plot_axis *axis = &p->axes[p->axis_count++];
    *axis = (plot_axis){.name = name, .column = column, .group = group};
    axis->texts = calloc(p->table.rows + 1, sizeof *axis->texts);
    axis->reals = calloc(p->table.rows + 1, sizeof *axis->reals);
    axis->at = calloc(p->table.rows + 1, sizeof *axis->at);
    return axis->texts && axis->reals && axis->at;
}

static bool add_axes(plot_plan *p)
{
    bool good = true;
    for (size_t group = 0; good && group < p->s->axis_count; group++) {
        const study_point *first = &p->s->axes[group].points[0];
        for (size_t i = 0; good && i < first->count; i++)
            good = add_axis(p, first->paths[i], group);
    }
    return good && add_axis(p, "environment", PLOT_NONE);
}

static size_t find_value(const plot_axis *axis, const char *text)
{
    for (size_t i = 0; i < axis->count; i++)
        if (strcmp(axis->texts[i], text) == 0)
            return i;
    return PLOT_NONE;
}

/* Sorts the few values of a numeric axis. */
static void sort_values(plot_axis *axis)
{
    for (size_t i = 1; i < axis->count; i++)
        for (size_t k = i; k > 0 && axis->reals[k] < axis->reals[k - 1]; k--) {
            const double real = axis->reals[k];
            const char *text = axis->texts[k];
            axis->reals[k] = axis->reals[k - 1], axis->texts[k] = axis->texts[k - 1];
            axis->reals[k - 1] = real, axis->texts[k - 1] = text;
        }
}

/* Whether the row is shown and has a value of the axis: a cell without rows has no environment. */
static bool has_value(const plot_plan *p, const plot_axis *axis, size_t row)
{
    return p->shown[row] &&
           (axis->group != PLOT_NONE || strcmp(summary_table_text(&p->table, row, axis->column), "NA") != 0);
}

static void find_values(const plot_plan *p, plot_axis *axis)
{
    axis->count = 0;
    for (size_t row = 0; row < p->table.rows; row++) {
        const char *text = summary_table_text(&p->table, row, axis->column);
        if (has_value(p, axis, row) && find_value(axis, text) == PLOT_NONE)
            axis->texts[axis->count++] = text;
    }
    axis->numeric =
        axis->count > 0 && axis->group != PLOT_NONE; /* an environment is not a number, even if it has only digits */
    for (size_t i = 0; i < axis->count; i++)
        axis->numeric = number_parse_real(axis->texts[i], &axis->reals[i]) && axis->numeric;
    if (axis->numeric)
        sort_values(axis);
    for (size_t row = 0; row < p->table.rows; row++)
        axis->at[row] =
            has_value(p, axis, row) ? find_value(axis, summary_table_text(&p->table, row, axis->column)) : PLOT_NONE;
}

/* --- linked parameters ---
 *
 * An axis of a study can set several parameters. A parameter that the kept ones determine would be the same axis of the
 * figure under another name, so it is not kept. */

/* The kept parameters of one axis of the study, and the shown rows, which are sorted to test another parameter. */
typedef struct link {
    const plot_axis *kept[PLOT_AXES_MAX];
    size_t count;
    size_t *rows, row_count;
} link;

static int compare_rows(const void *a, const void *b, void *context)
{
    const link *l = context;
    for (size_t i = 0; i < l->count; i++) {
        const size_t x = l->kept[i]->at[*(const size_t *)a], y = l->kept[i]->at[*(const size_t *)b];
        if (x != y)
            return x < y ? -1 : 1;
    }
    return 0;
}

/* Whether rows that agree in the kept parameters also agree in this axis. */
static bool determines(link *l, const plot_axis *axis)
{
    qsort_r(l->rows, l->row_count, sizeof *l->rows, compare_rows, l);
    for (size_t i = 1; i < l->row_count; i++)
        if (compare_rows(&l->rows[i - 1], &l->rows[i], l) == 0 && axis->at[l->rows[i - 1]] != axis->at[l->rows[i]])
            return false;
    return true;
}

static bool is_wanted(const plot_plan *p, const plot_axis *axis)
{
    const plot_request *r = p->request;
    return (r->x && strcmp(r->x, axis->name) == 0) || (r->by && strcmp(r->by, axis->name) == 0);
}

/* Whether a is tested before b: first parameters that the user names, then those with more values. Among equals,
 * numbers come before words for the first kept parameter (`first`), because it becomes a scale, and words before
 * numbers for the others, because they name lines. */
static bool is_better(const plot_plan *p, const plot_axis *a, const plot_axis *b, bool first)
{
    if (is_wanted(p, a) != is_wanted(p, b))
        return is_wanted(p, a);
    if (a->count != b->count)
        return a->count > b->count;
    return a->numeric != b->numeric && a->numeric == first;
}

/* Keeps the first two parameters of the group whose pairs of values are exactly the axis' points, and returns whether
 * there are such: two independent parameters show more than one that has a value for each point. */
static bool keep_pair(plot_plan *p, size_t group, link *l)
{
    size_t points = 0;
    for (size_t i = 0; i < p->axis_count; i++)
        if (p->axes[i].group == group && p->axes[i].count > points)
            points = p->axes[i].count;
    for (size_t i = 0; i < p->axis_count; i++)
        for (size_t k = i + 1; k < p->axis_count; k++) {
            plot_axis *a = &p->axes[i], *b = &p->axes[k];
            if (a->group != group || b->group != group || a->count < 2 || b->count < 2 || a->count * b->count != points)
                continue;
            l->kept[0] = a, l->kept[1] = b, l->count = 2;
            for (size_t other = 0; l->count && other < p->axis_count; other++)
                if (p->axes[other].group == group && !determines(l, &p->axes[other]))
                    l->count = 0;
            a->kept = b->kept = l->count == 2;
            if (l->count)
                return true;
        }
    return false;
}

static bool wants_one(const plot_plan *p, size_t group)
{
    for (size_t i = 0; i < p->axis_count; i++)
        if (p->axes[i].group == group && is_wanted(p, &p->axes[i]))
            return true;
    return false;
}

static void link_group(plot_plan *p, size_t group, link *l)
{
    bool tested[PLOT_AXES_MAX] = {false};
    for (;;) {
        size_t best = PLOT_NONE;
        for (size_t i = 0; i < p->axis_count; i++)
            if (!tested[i] && p->axes[i].group == group && p->axes[i].count > 1 &&
                (best == PLOT_NONE || is_better(p, &p->axes[i], &p->axes[best], l->count == 0)))
                best = i;
        if (best == PLOT_NONE)
            return;
        tested[best] = true;
        p->axes[best].kept = is_wanted(p, &p->axes[best]) || !determines(l, &p->axes[best]);
        if (p->axes[best].kept)
            l->kept[l->count++] = &p->axes[best];
    }
}

/* Marks the axes that vary and are not determined by others (plot_axis.kept). */
static status link_axes(plot_plan *p, diagnostic *why)
{
    link l = {.rows = calloc(p->table.rows + 1, sizeof *l.rows)};
    if (!l.rows)
        return out_of_memory(why);
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->shown[row])
            l.rows[l.row_count++] = row;
    for (size_t group = 0; group < p->s->axis_count; group++) {
        l.count = 0;
        if (wants_one(p, group) || !keep_pair(p, group, &l))
            link_group(p, group, &l);
    }
    for (size_t i = 0; i < p->axis_count; i++)
        if (p->axes[i].group == PLOT_NONE)
            p->axes[i].kept = p->axes[i].count > 1;
    free(l.rows);
    return STATUS_OK;
}

/* --- shown rows --- */

static status no_such_axis(const plot_plan *p, const char *option, const char *name, diagnostic *why)
{
    const char *names[PLOT_AXES_MAX];
    char list[300];
    for (size_t i = 0; i < p->axis_count; i++)
        names[i] = p->axes[i].name;
    const char *near = text_nearest(name, names, p->axis_count);
    char remedy[400];
    snprintf(remedy, sizeof remedy, near ? "did you mean '%s'?" : "choose from: %s",
             near ? near : list_of(names, p->axis_count, list, sizeof list));
    return diagnose_at(why, option, STATUS_BAD_INPUT, remedy, "the grid of %s has no parameter '%.64s'", p->s->name,
                       name);
}

static status apply_where(plot_plan *p, const char *setting, diagnostic *why)
{
    const char *equals = strchr(setting, '=');
    char name[200], list[300];
    snprintf(name, sizeof name, "%.*s", (int)(equals ? equals - setting : 0), setting);
    if (!equals || !name[0])
        return diagnose_at(why, "--where", STATUS_BAD_INPUT, "give PATH=VALUE, such as render.depth=4",
                           "'%.64s' is not a condition", setting);
    const plot_axis *axis = plot_axis_named(p, name);
    if (!axis)
        return no_such_axis(p, "--where", name, why);
    size_t remaining = 0;
    for (size_t row = 0; row < p->table.rows; row++) {
        p->shown[row] &= grid_same_value(summary_table_text(&p->table, row, axis->column), equals + 1);
        remaining += p->shown[row];
    }
    if (remaining)
        return STATUS_OK;
    char remedy[400];
    snprintf(remedy, sizeof remedy, "choose from: %s", list_of(axis->texts, axis->count, list, sizeof list));
    return diagnose_at(why, "--where", STATUS_BAD_INPUT, remedy, "no cell has %.100s", setting);
}

status plot_axes_read(plot_plan *p, diagnostic *why)
{
    if (!p->table.text)
        TRY(summary_table_read(p->s, p->request->results, &p->table, why));
    p->shown = calloc(p->table.rows + 1, sizeof *p->shown);
    if (!p->shown || !add_axes(p))
        return out_of_memory(why);
    memset(p->shown, true, p->table.rows);
    for (size_t i = 0; i < p->axis_count; i++)
        find_values(p, &p->axes[i]);
    status code = STATUS_OK;
    for (size_t i = 0; code == STATUS_OK && i < p->request->where_count; i++)
        code = apply_where(p, p->request->where[i], why);
    for (size_t i = 0; code == STATUS_OK && i < p->axis_count; i++)
        find_values(p, &p->axes[i]);
    const char *by = p->request->by, *x = p->request->x;
    if (code == STATUS_OK && by && !plot_axis_named(p, by))
        code = no_such_axis(p, "--by", by, why);
    if (code == STATUS_OK && x && !plot_axis_named(p, x) && summary_table_column(&p->table, x) < 0) {
        char median[80];
        snprintf(median, sizeof median, "%.64s_median", x);
        code = summary_table_column(&p->table, median) < 0 ? no_such_axis(p, "--x", x, why) : STATUS_OK;
    }
    THEN(code, link_axes(p, why));
    return code;
}
