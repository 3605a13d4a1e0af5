/* Figures of a study: the steps from the summary to a script, and gnuplot. */
#include "study/plot.h"
#include "base/child.h"
#include "base/file.h"
#include "base/text.h"
#include "study/plot_parts.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

status study_plot_write(const study *s, const plot_request *request, const char *base, diagnostic *why)
{
    plot_plan p = {.s = s, .request = request};
    const status code = request->images ? plot_sheet_write(&p, base, why) : plot_figure_write(&p, base, why);
    plot_plan_free(&p);
    return code;
}

/* --- gnuplot --- */

/* A drawing, and when to end it. */
typedef struct drawing {
    const char *script, *scratch, *format; /* the figure appears at SCRATCH.FORMAT */
    double limit_s;
    const atomic_bool *stop;
} drawing;

enum { NOT_FOUND = 127 /* of env(1) */ };

/* format='png'; output='/path/.figure.drawing-12' */
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

/* The first line of gnuplot's output that is an error message. */
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
    static const atomic_bool never;
    char *settings = settings_of(d->scratch, d->format), *output = NULL;
    int exit_code = -1;
    if (!settings)
        return out_of_memory(why);
    const char *const arguments[] = {"/usr/bin/env", "gnuplot", "-d", "-e", settings, d->script, NULL};
    status code = child_run((char *const *)(uintptr_t)arguments, d->limit_s, d->stop ? d->stop : &never, &output,
                            &exit_code, why);
    if (code == STATUS_OK && exit_code != 0)
        code = explain(d->script, exit_code, output, why);
    free(settings);
    free(output);
    return code;
}

/* Complete or absent, after a power cut too. */
static bool move_figure(const char *made, const char *target)
{
    const int fd = open(made, O_RDONLY | O_CLOEXEC);
    const bool flushed = fd >= 0 && fsync(fd) == 0;
    if (fd >= 0)
        close(fd);
    if (!flushed || rename(made, target) != 0)
        return false;
    file_flush_folder(target);
    return true;
}

status study_plot_draw(const char *base, const char *format, double limit_s, const atomic_bool *stop, diagnostic *why)
{
    const char *name = file_name_of(base);
    char *scratch = text_format("%.*s.%s.drawing-%d", (int)(name - base), base, name, (int)getpid());
    char *made = text_format("%s.%s", scratch ? scratch : "", format), *target = text_format("%s.%s", base, format);
    char *script = text_format("%s.gp", base);
    status code = scratch && made && target && script ? STATUS_OK : out_of_memory(why);
    THEN(code, run_gnuplot(&(drawing){script, scratch, format, limit_s, stop}, why));
    if (code == STATUS_OK && !move_figure(made, target))
        code = diagnose_at(why, target, STATUS_FAILURE, "", "the figure cannot be written");
    if (code != STATUS_OK && made)
        unlink(made);
    free(script);
    free(target);
    free(made);
    free(scratch);
    return code;
}
