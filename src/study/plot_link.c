/* Parameters that one axis of a study sets together: if the kept ones determine another, it is the same axis of the
 * figure under another name, and counts once. */
#include "study/plot_parts.h"
#include <stdlib.h>
#include <string.h>

/* The kept parameters of one axis of the study, and one to test against them. */
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

/* Whether rows that agree in the kept parameters agree in this one as well. */
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

/* The order of the test: what the user names, then most values; the first is better a number (it becomes an axis with
 * a scale), the others are better words (they become names of lines). */
static bool is_better(const plot_plan *p, const plot_axis *a, const plot_axis *b, bool first)
{
    if (is_wanted(p, a) != is_wanted(p, b))
        return is_wanted(p, a);
    if (a->count != b->count)
        return a->count > b->count;
    return a->numeric != b->numeric && a->numeric == first;
}

/* Two parameters whose pairs of values are exactly the points say more than one with a value for each point: they are
 * independent. Keeps the first such pair. */
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

status plot_axes_link(plot_plan *p, diagnostic *why)
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
