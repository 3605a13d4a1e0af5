/* Finds the columns and units of a figure's quantities, and chooses their scales. */
#include "base/text.h"
#include "scene/model/params.h"
#include "study/plot/plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { QUANTITIES_MAX = 256 /* the most names that are compared to suggest the nearest */ };

/* --- units --- */

/* The unit of a parameter of the study; "" if it has none or its name ends with the unit. */
static void plot_unit_of(const study *s, const char *path, char unit[32])
{
    param_place at;
    const bool is_parameter = param_place_find(s->base, path, &at, NULL) == STATUS_OK;
    snprintf(unit, 32, "%s", is_parameter ? at.row->unit : "");
    const size_t length = strlen(path), end = strlen(unit);
    if (length > end && path[length - end - 1] == '_' && strcmp(path + length - end, unit) == 0)
        unit[0] = '\0'; /* the name contains the unit, as in lambda_nm */
}

/* --- columns --- */

static long column_of(const plot_plan *p, const char *stem, const char *ending)
{
    char name[96];
    snprintf(name, sizeof name, "%s%s", stem, ending);
    return summary_table_column(&p->table, name);
}

static bool ends_with(const char *text, const char *ending)
{
    const size_t length = strlen(text), end = strlen(ending);
    return length >= end && strcmp(text + length - end, ending) == 0;
}

/* The name of a quantity: wall_s of the column wall_s_median. */
static void stem_of(const char *column, char stem[64])
{
    const size_t end = ends_with(column, "_median") ? strlen("_median") : 0;
    snprintf(stem, 64, "%.*s", (int)(strlen(column) - end), column);
}

static status no_such_column(const plot_plan *p, const char *option, const char *name, diagnostic *why)
{
    char stems[QUANTITIES_MAX][64];
    const char *names[QUANTITIES_MAX];
    size_t count = 0;
    for (size_t i = 0; i < p->table.columns && count < QUANTITIES_MAX; i++)
        if (!plot_axis_named(p, p->table.names[i])) {
            names[count] = stems[count];
            stem_of(p->table.names[i], stems[count++]);
        }
    const char *near = text_nearest(name, names, count);
    if (near && strcmp(near, name) == 0)
        return diagnose_at(why, option, STATUS_BAD_INPUT, "choose another quantity, or measure a scene that has it",
                           "no cell of %s has a value of '%.64s'", p->s->name, name);
    char remedy[200] = "choose one, such as wall_s, cpu_s or rays_total; see cuvette-results(5)";
    if (near)
        snprintf(remedy, sizeof remedy, "did you mean '%.64s'?", near);
    return diagnose_at(why, option, STATUS_BAD_INPUT, remedy, "the summary of %s has no column of numbers '%.64s'",
                       p->s->name, name);
}

/* "wall time" of wall_s, "CPU time" of cpu_s; of other names, the words without the unit: "busy max" of busy_s_max. */
static void name_time(const char name[64], char label[96])
{
    static const char *const known[][2] = {{"wall_s", "wall time"}, {"cpu_s", "CPU time"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strncmp(name, known[i][0], strlen(known[i][0])) == 0) {
            snprintf(label, 96, "%s%s", known[i][1], ends_with(name, "_mean") ? ", mean" : "");
            return;
        }
    size_t length = 0;
    for (const char *c = name; *c; c++) {
        const bool is_unit = c[0] == '_' && c[1] == 's' && (c[2] == '_' || c[2] == '\0');
        c += is_unit ? 1 : 0;
        if (!is_unit)
            label[length++] = *c == '_' ? ' ' : *c;
    }
    label[length] = '\0';
}

static bool is_number(const plot_plan *p, long column)
{
    for (size_t row = 0; row < p->table.rows; row++)
        if (!isnan(summary_table_real(&p->table, row, column)))
            return true;
    return false;
}

status plot_quantity_find(const plot_plan *p, const char *option, const char *name, plot_quantity *out, diagnostic *why)
{
    *out = (plot_quantity){.factor = 1, .value = -1, .low = -1, .high = -1, .least = -1, .most = -1};
    stem_of(name, out->name);
    out->value = column_of(p, out->name, "_median");
    out->low = column_of(p, out->name, "_low");
    out->high = column_of(p, out->name, "_high");
    out->least = column_of(p, out->name, "_min");
    out->most = column_of(p, out->name, "_max");
    if (out->value < 0)
        out->value = summary_table_column(&p->table, name);
    if (out->value < 0 || plot_axis_named(p, name) || strcmp(name, "cell") == 0 || !is_number(p, out->value))
        return no_such_column(p, option, name, why);
    const bool time = ends_with(out->name, "_s") || strstr(out->name, "_s_");
    snprintf(out->unit, sizeof out->unit, "%s", time ? "s" : ends_with(out->name, "_bytes") ? "bytes" : "");
    if (time)
        name_time(out->name, out->label);
    else
        snprintf(out->label, sizeof out->label, "%s", out->name);
    return STATUS_OK;
}

/* --- scales --- */

typedef struct extent {
    double least, most; /* of finite values */
    double positive;    /* the least above 0 */
    size_t count;
} extent;

static void extend(extent *e, double value)
{
    if (isnan(value))
        return;
    e->least = e->count ? fmin(e->least, value) : value;
    e->most = e->count ? fmax(e->most, value) : value;
    if (value > 0)
        e->positive = e->positive > 0 ? fmin(e->positive, value) : value;
    e->count++;
}

static extent extent_of(const plot_plan *p, bool vertical)
{
    extent e = {0};
    for (size_t i = 0; i < p->point_count; i++) {
        const plot_point *point = &p->points[i];
        extend(&e, vertical ? point->y : point->x);
        if (vertical && p->kind != PLOT_HEAT) {
            extend(&e, point->low);
            extend(&e, point->high);
        }
    }
    for (size_t i = 0; i < p->published.count; i++)
        extend(&e, vertical ? p->published.y[i] : p->published.x[i]);
    return e;
}

/* Chooses the largest prefix with which the typical value is at least 1, or the smallest prefix of the unit. */
static void choose_prefix(plot_quantity *q, double typical)
{
    static const struct {
        const char *unit, *shown;
        double size;
    } prefixes[] = {
        {"s", "µs", 1e-6},
        {"s", "ms", 1e-3},
        {"s", "s", 1},
        {"bytes", "bytes", 1},
        {"bytes", "KiB", 1024},
        {"bytes", "MiB", 1048576},
        {"bytes", "GiB", 1073741824},
        {"", "", 1},
        {"", "10⁶", 1e6},
        {"", "10⁹", 1e9},
    };
    char unit[sizeof q->unit];
    snprintf(unit, sizeof unit, "%s", q->unit);
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
        if (strcmp(prefixes[i].unit, unit) == 0 && (typical >= prefixes[i].size || i == 0)) {
            q->factor = 1 / prefixes[i].size;
            snprintf(q->unit, sizeof q->unit, "%s", prefixes[i].shown);
        }
}

/* Chooses the shown range: with from_zero, from 0 unless a value is negative or all are far from 0; with a margin at
 * the other ends. */
static void choose_range(plot_quantity *q, const extent *e, bool from_zero)
{
    if (q->log) {
        const double margin = pow(e->most / e->positive, 0.05);
        q->from = e->positive / fmax(margin, 1.05);
        q->to = e->most * fmax(margin, 1.05);
        return;
    }
    const double span = e->most - e->least;
    const double margin = span > 0 ? 0.05 * span : e->most != 0 ? 0.05 * fabs(e->most) : 1;
    q->from = from_zero && e->least >= 0 && e->least < 0.6 * e->most ? 0 : e->least - margin;
    q->to = e->most + margin;
}

static status check_log(const char *option, const char *name, const extent *e, diagnostic *why)
{
    return e->least > 0
               ? STATUS_OK
               : diagnose_at(why, option, STATUS_BAD_INPUT, "exclude these values with --where, or use a linear scale",
                             "%s reaches %g; a logarithmic scale needs positive values", name, e->least);
}

/* Whether at least four positive values, over a factor of at least 8, are spread more evenly by their ratios than by
 * their differences. */
static bool is_geometric(const plot_axis *axis)
{
    const size_t n = axis->count;
    if (n < 4 || axis->reals[0] <= 0 || axis->reals[n - 1] / axis->reals[0] < 8)
        return false;
    double ratio = 0, difference = 0; /* largest steps, as fractions of the span */
    const double span = axis->reals[n - 1] - axis->reals[0], ratios = log(axis->reals[n - 1] / axis->reals[0]);
    for (size_t i = 1; i < n; i++) {
        ratio = fmax(ratio, log(axis->reals[i] / axis->reals[i - 1]) / ratios);
        difference = fmax(difference, (axis->reals[i] - axis->reals[i - 1]) / span);
    }
    return ratio < difference;
}

static status scale_x(plot_plan *p, diagnostic *why)
{
    const plot_log wish = p->request->log;
    const bool wants = wish == PLOT_LOG_X || wish == PLOT_LOG_XY, chooses = wish == PLOT_LOG_AUTO;
    extent e = extent_of(p, false);
    if (p->x.value >= 0) {
        choose_prefix(&p->x, e.most);
        for (size_t i = 0; i < p->point_count; i++)
            p->points[i].x *= p->x.factor;
        for (size_t i = 0; i < p->published.count; i++)
            p->published.x[i] *= p->x.factor;
        e = extent_of(p, false);
        snprintf(p->x_label, sizeof p->x_label, "%s%s%s", p->x.label, p->x.unit[0] ? " / " : "", p->x.unit);
    } else if (p->along) {
        char unit[32];
        plot_unit_of(p->s, p->along->name, unit);
        snprintf(p->x_label, sizeof p->x_label, "%.110s%s%s", p->along->name, unit[0] ? " / " : "", unit);
    }
    if (p->kind != PLOT_LINES) {
        p->x.from = -0.5;
        p->x.to = (p->along ? (double)p->along->count : 1) - 0.5;
        return wants ? diagnose_at(why, "--log", STATUS_BAD_INPUT, "use --log y, or name a numeric parameter with --x",
                                   "the x axis of this figure has no scale")
                     : STATUS_OK;
    }
    if (wants)
        TRY(check_log("--log x", p->x.value >= 0 ? p->x.name : p->along->name, &e, why));
    p->x.log = wants || (chooses && e.least > 0 && (p->x.value >= 0 ? e.most / e.least >= 30 : is_geometric(p->along)));
    choose_range(&p->x, &e, p->x.value >= 0);
    return STATUS_OK;
}

static status scale_y(plot_plan *p, diagnostic *why)
{
    const plot_log wish = p->request->log;
    extent e = extent_of(p, true);
    const bool wants = wish == PLOT_LOG_Y || wish == PLOT_LOG_XY;
    if (wants)
        TRY(check_log("--log y", p->y.name, &e, why));
    p->y.log = wants || (wish == PLOT_LOG_AUTO && e.least > 0 && e.most / e.least >= 30);
    choose_prefix(&p->y, p->y.log ? sqrt(e.most * e.positive) : e.most);
    for (size_t i = 0; i < p->point_count; i++) {
        p->points[i].y *= p->y.factor;
        p->points[i].low *= p->y.factor;
        p->points[i].high *= p->y.factor;
    }
    for (size_t i = 0; i < p->published.count; i++)
        p->published.y[i] *= p->y.factor;
    e = extent_of(p, true);
    choose_range(&p->y, &e, p->kind != PLOT_HEAT);
    return STATUS_OK;
}

status plot_scale(plot_plan *p, diagnostic *why)
{
    TRY(scale_x(p, why));
    return scale_y(p, why);
}
