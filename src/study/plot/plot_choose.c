/* Chooses the kind of a figure, and which parameters become the x axis, lines and panels. */
#include "study/plot/plot.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEAT_MIN = 3 }; /* values of each axis of a heat map */

static bool is_free(const plot_plan *p, const plot_axis *axis)
{
    return axis->kept && axis != p->along && axis != p->up && axis != p->by;
}

/* The free parameter with the most values, from `least` to `limit`; among equals the last, which varies fastest. */
static const plot_axis *largest(const plot_plan *p, bool numeric, size_t least, size_t limit)
{
    const plot_axis *found = NULL;
    for (size_t i = 0; i < p->axis_count; i++) {
        const plot_axis *axis = &p->axes[i];
        if (is_free(p, axis) && axis->group != PLOT_NONE && axis->numeric == numeric && axis->count >= least &&
            axis->count <= limit && (!found || axis->count >= found->count))
            found = axis;
    }
    return found;
}

/* A parameter with three or more numbers is a scale, and comes first. Two numbers are alternatives, and come after
 * words if there are more words. */
static const plot_axis *choose_along(const plot_plan *p)
{
    const plot_axis *number = largest(p, true, HEAT_MIN, SIZE_MAX);
    const plot_axis *word = largest(p, false, 2, SIZE_MAX), *pair = largest(p, true, 2, SIZE_MAX);
    const plot_axis *few = word && (!pair || word->count > pair->count) ? word : pair;
    return number ? number : few;
}

/* Whether most pairs of values have a cell. */
static bool is_filled(const plot_plan *p, const plot_axis *a, const plot_axis *b)
{
    const size_t room = a->count * b->count;
    bool *seen = calloc(room, sizeof *seen);
    size_t count = 0;
    for (size_t row = 0; seen && row < p->table.rows; row++)
        if (p->shown[row] && a->at[row] != PLOT_NONE && b->at[row] != PLOT_NONE) {
            bool *pair = &seen[a->at[row] * b->count + b->at[row]];
            count += !*pair;
            *pair = true;
        }
    free(seen);
    return (double)count >= 0.6 * (double)room;
}

static const plot_axis *environments(const plot_plan *p)
{
    const plot_axis *axis = plot_axis_named(p, "environment");
    return axis && is_free(p, axis) ? axis : NULL;
}

/* Colours distinguish environments first, then words, then a family of numbers. */
static const plot_axis *choose_by(const plot_plan *p)
{
    const plot_axis *environment = environments(p), *word = largest(p, false, 2, PLOT_COLORS);
    if (environment && environment->count <= PLOT_SERIES_MAX)
        return environment;
    return word ? word : largest(p, true, 2, PLOT_SERIES_MAX);
}

static status count_panels(plot_plan *p, diagnostic *why)
{
    double count = 1;
    for (size_t i = 0; i < p->axis_count; i++)
        if (is_free(p, &p->axes[i])) {
            p->faceted[p->faceted_count++] = &p->axes[i];
            count *= (double)p->axes[i].count;
        }
    if (count > 1e6)
        return diagnose_at(why, p->s->path, STATUS_BAD_INPUT, "show a part of the grid with --where PATH=VALUE",
                           "%g panels are too many", count);
    p->panel_count = (size_t)count;
    return STATUS_OK;
}

status plot_axes_choose(plot_plan *p, diagnostic *why)
{
    const plot_request *r = p->request;
    TRY(plot_quantity_find(p, "--y", r->y ? r->y : "wall_s", &p->y, why));
    p->x.value = -1;
    p->by = r->by ? plot_axis_named(p, r->by) : NULL;
    p->along = r->x ? plot_axis_named(p, r->x) : choose_along(p);
    if (r->x && !p->along) {
        TRY(plot_quantity_find(p, "--x", r->x, &p->x, why));
        p->along = choose_along(p); /* lines join points in the order of this axis */
    }
    if (p->by && p->by == p->along)
        return diagnose_at(why, "--by", STATUS_BAD_INPUT, "choose another parameter, or another one for --x",
                           "'%s' is the x axis already", p->by->name);
    if (p->by && p->by->count > PLOT_SERIES_MAX)
        return diagnose_at(why, "--by", STATUS_BAD_INPUT, "choose another parameter, or fewer values with --where",
                           "'%s' has %zu values; at most %d lines can be distinguished", p->by->name, p->by->count,
                           PLOT_SERIES_MAX);
    p->kind = p->x.value >= 0 || (p->along && p->along->numeric) ? PLOT_LINES : PLOT_DOTS;
    const plot_axis *second = largest(p, true, HEAT_MIN, SIZE_MAX);
    if (p->kind == PLOT_LINES && p->x.value < 0 && !r->by && !r->published && p->along->count >= HEAT_MIN && second &&
        is_filled(p, p->along, second)) {
        p->kind = PLOT_HEAT;
        p->up = second;
    } else if (!p->by) {
        p->by = choose_by(p);
    }
    return count_panels(p, why);
}
