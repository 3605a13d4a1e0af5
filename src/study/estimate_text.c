/* An estimate as text. */
#include "study/estimate.h"
#include "study/keep.h"
#include <math.h>
#include <string.h>

/* "0.2 s", "42 s", "7 min", "3.5 h": an estimate has no more digits. */
static const char *duration(double s, char *text, size_t size)
{
    if (s < 0.05)
        snprintf(text, size, "0.1 s");
    else if (s < 9.95)
        snprintf(text, size, "%.1f s", s);
    else if (s < 99.5)
        snprintf(text, size, "%.0f s", s);
    else if (s < 99.5 * 60)
        snprintf(text, size, "%.0f min", s / 60);
    else
        snprintf(text, size, "%.1f h", s / 3600);
    return text;
}

static void write_rows(FILE *out, const study *s, const study_estimate *e)
{
    fprintf(out, "%s: %zu of %zu cells lack rows: ", s->name, e->cells_lacking, e->cells);
    if (e->rows_least != e->rows_most)
        fprintf(out, "%zu to ", e->rows_least);
    fprintf(out, "%zu rows and %zu warm-ups to measure\n", e->rows_most, e->warmups);
}

static void write_basis(FILE *out, const study_estimate *e)
{
    const char *before = ", from ";
    if (e->from_rows)
        fprintf(out, "%sthe rows of %zu cell%s", before, e->from_rows, e->from_rows == 1 ? "" : "s"), before = " and ";
    if (e->from_trials)
        fprintf(out, "%strial frames of %zu cell%s, extrapolated in pixels", before, e->from_trials,
                e->from_trials == 1 ? "" : "s");
    if (e->from_others)
        fprintf(out, "; for %zu other cell%s their mean", e->from_others, e->from_others == 1 ? "" : "s");
    if (e->comparisons)
        fprintf(out, "; without the reference images");
    fputc('\n', out);
}

static void write_time(FILE *out, const study *s, const study_estimate *e)
{
    char least[32], most[32];
    if (isnan(e->most_s)) {
        fprintf(out, "%s: time unknown: a trial frame with few pixels takes more than %g s\n", s->name,
                STUDY_ESTIMATE_TRIALS_S);
        return;
    }
    duration(e->least_s, least, sizeof least);
    duration(e->most_s, most, sizeof most);
    fprintf(out, "%s: %s ", s->name, e->cut ? "more than" : e->most_s < 0.05 ? "less than" : "about");
    if (strcmp(least, most) != 0)
        fprintf(out, "%s to ", least);
    fprintf(out, "%s", most);
    write_basis(out, e);
}

static void write_files(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    if (e->files) {
        fprintf(out, "%s: %zu files to keep in %s/%s/images:", s->name, e->files, results, s->name);
        const char *ending;
        for (size_t i = 0; (ending = keep_ending(s, i)); i++)
            fprintf(out, "%s CELL%s", i ? "," : "", ending);
        fputc('\n', out);
    }
    if (e->comparisons)
        fprintf(out, "%s: %zu cells to compare with their reference\n", s->name, e->comparisons);
}

static void write_room(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    char needed[80], left[32];
    disk_room_text(&e->needed, needed, sizeof needed);
    disk_room_bytes_text(e->free_bytes, left, sizeof left);
    fprintf(out, "%s: %s to write", s->name, needed);
    if (!isnan(e->free_bytes))
        fprintf(out, ", %s free in %s", left, results);
    fputc('\n', out);
}

void study_estimate_write(FILE *out, const study *s, const char *results, const study_estimate *e)
{
    if (!e->cells_lacking && !e->cells_to_keep) {
        fprintf(out, "%s: complete, nothing to do\n", s->name);
        return;
    }
    write_rows(out, s, e);
    write_time(out, s, e);
    write_files(out, s, results, e);
    write_room(out, s, results, e);
}
