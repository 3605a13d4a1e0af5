/* Figures of a study: the steps from the summary to a script, and gnuplot. */
#include "study/plot/plot.h"
#include "base/file.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include <errno.h>
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
