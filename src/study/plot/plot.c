/* Figures of a study: the steps from the summary to a script, and gnuplot; the kind of figure, and which
 * parameters become the x axis, lines and panels. */
#include "study/plot/plot.h"
#include "base/file.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

status plot_figure_write(plot_plan *p, const char *base, diagnostic *why)
{
    char *data = text_format("%s.tsv", base);
    status code = data ? plot_axes_read(p, why) : out_of_memory(why);
    THEN(code, plot_axes_choose(p, why));
    THEN(code, plot_points_collect(p, why));
    THEN(code, plot_published_read(p, why));
    THEN(code, plot_scale(p, why));
    THEN(code, plot_layout(p, why));
    THEN(code, plot_data_write(p, data, why));
    THEN(code, plot_script_write(p, base, why));
    free(data);
    return code;
}

void plot_plan_free(plot_plan *p)
{
    for (size_t i = 0; i < p->axis_count; i++) {
        free(p->axes[i].texts);
        free(p->axes[i].reals);
        free(p->axes[i].at);
    }
    for (size_t i = 0; p->panels && i < p->panel_count; i++)
        free(p->panels[i].title);
    for (size_t i = 0; i < p->caption_count; i++)
        free(p->captions[i]);
    for (size_t i = 0; p->published.names && i < p->published.series_count; i++)
        free(p->published.names[i]);
    free(p->published.names);
    free(p->published.x);
    free(p->published.y);
    free(p->published.series);
    free(p->panels);
    free(p->points);
    free(p->shown);
    summary_table_free(&p->table);
    *p = (plot_plan){0};
}

status study_plot_write(const study *s, const plot_request *request, const char *base, diagnostic *why)
{
    plot_plan p = {.s = s, .request = request};
    const status code = request->images ? plot_sheet_write(&p, base, why) : plot_figure_write(&p, base, why);
    plot_plan_free(&p);
    return code;
}

/* --- gnuplot --- */

/* A drawing and its time limit. */
typedef struct drawing {
    const char *script, *scratch, *format; /* the figure appears at SCRATCH.FORMAT */
    double limit_s;
} drawing;

enum { NOT_FOUND = 127 /* of env(1) */ };

/* Commands that precede the script, such as: format='png'; output='/path/.cuvette-0123abcd-0.part' */
static char *settings_of(const char *scratch, const char *format)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fprintf(out, "format='%s'; output=", format);
    plot_script_text(out, scratch);
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}

/* Fails with the first error message in gnuplot's output. */
static status explain(const char *script, int code, char *output, diagnostic *why)
{
    if (code == NOT_FOUND)
        return diagnose_at(why, "gnuplot", STATUS_FAILURE, "apt-get install --no-install-recommends gnuplot-nox",
                           "the program is not installed; the script %s is written", script);
    char *line = output;
    for (char *next = output, *part; (part = strsep(&next, "\n"));)
        if (strstr(part, "line ")) {
            line = strstr(part, "line ");
            break;
        }
    return diagnose_at(why, script, STATUS_FAILURE, "", "gnuplot failed: %.300s", line);
}

static status run_gnuplot(const drawing *d, diagnostic *why)
{
    char *settings = settings_of(d->scratch, d->format), *output = NULL;
    int exit_code = -1;
    if (!settings)
        return out_of_memory(why);
    const char *const arguments[] = {"/usr/bin/env", "gnuplot", "-d", "-e", settings, d->script, NULL};
    status code = child_run((char *const *)(uintptr_t)arguments, d->limit_s, &output, &exit_code, why);
    if (code == STATUS_OK && exit_code != 0)
        code = explain(d->script, exit_code, output, why);
    free(settings);
    free(output);
    return code;
}

/* Moves the drawn figure to its name: complete or absent, even after a power cut. */
static status move_figure(int fd, char **temporary, const char *target, diagnostic *why)
{
    struct stat about;
    if (fstat(fd, &about) == 0 && about.st_size == 0)
        return diagnose_at(why, target, STATUS_FAILURE, "check that the gnuplot in PATH works", "gnuplot drew nothing");
    if (fsync(fd) != 0 || temporary_move(fd, temporary, target) != 0)
        return system_error(why, STATUS_FAILURE, target, "cannot write", errno, "");
    file_flush_folder(target);
    return STATUS_OK;
}

/* The temporary file has a name, because gnuplot opens it (base/file.h). */
static status draw_figure(drawing *d, const char *target, diagnostic *why)
{
    char *temporary = NULL, *ending = text_format(".%s", d->format);
    const int fd = ending ? temporary_open_named(target, ending, &temporary) : -1, reason = errno;
    char *scratch = temporary ? strndup(temporary, strlen(temporary) - strlen(ending)) : NULL;
    status code = STATUS_OK;
    if (ending && fd < 0)
        code = system_error(why, STATUS_FAILURE, target, "cannot write", reason, "");
    else if (!scratch)
        code = out_of_memory(why);
    d->scratch = scratch;
    THEN(code, run_gnuplot(d, why));
    THEN(code, move_figure(fd, &temporary, target, why));
    if (code != STATUS_OK && fd >= 0)
        unlink(temporary);
    if (fd >= 0)
        close(fd);
    free(scratch);
    free(ending);
    free(temporary);
    return code;
}

status study_plot_draw(const char *base, const char *format, double limit_s, diagnostic *why)
{
    char *target = text_format("%s.%s", base, format), *script = text_format("%s.gp", base);
    drawing d = {.script = script, .format = format, .limit_s = limit_s};
    const status code = target && script ? draw_figure(&d, target, why) : out_of_memory(why);
    free(script);
    free(target);
    return code;
}

/* --- the kind of figure --- */

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
