/* `cuvette study run --dry-run`. */
#include "cli/study_commands.h"
#include "cli/terminal.h"
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

static void print_rows(const study *s, const study_estimate *e)
{
    printf("%s: %zu of %zu cells lack rows: ", s->name, e->cells_lacking, e->cells);
    if (e->rows_least != e->rows_most)
        printf("%zu to ", e->rows_least);
    printf("%zu rows and %zu warm-ups to measure\n", e->rows_most, e->warmups);
}

static void print_basis(const study_estimate *e)
{
    const char *before = ", from ";
    if (e->from_rows)
        printf("%sthe rows of %zu cell%s", before, e->from_rows, e->from_rows == 1 ? "" : "s"), before = " and ";
    if (e->from_trials)
        printf("%strial frames of %zu cell%s, extrapolated in pixels", before, e->from_trials,
               e->from_trials == 1 ? "" : "s");
    if (e->from_others)
        printf("; for %zu other cell%s their mean", e->from_others, e->from_others == 1 ? "" : "s");
    if (e->comparisons)
        printf("; without the reference images");
    putchar('\n');
}

static void print_time(const study *s, const study_estimate *e)
{
    char least[32], most[32];
    if (isnan(e->most_s)) {
        printf("%s: time unknown: a trial frame with few pixels takes more than %g s\n", s->name,
               STUDY_ESTIMATE_TRIALS_S);
        return;
    }
    duration(e->least_s, least, sizeof least);
    duration(e->most_s, most, sizeof most);
    printf("%s: %s ", s->name, e->cut ? "more than" : e->most_s < 0.05 ? "less than" : "about");
    if (strcmp(least, most) != 0)
        printf("%s to ", least);
    printf("%s", most);
    print_basis(e);
}

static void print_files(const study *s, const study_request *request, const study_estimate *e)
{
    if (e->files) {
        printf("%s: %zu files to keep in %s/%s/images:", s->name, e->files, request->results, s->name);
        const char *ending;
        for (size_t i = 0; (ending = keep_ending(s, i)); i++)
            printf("%s CELL%s", i ? "," : "", ending);
        putchar('\n');
    }
    if (e->comparisons)
        printf("%s: %zu cells to compare with their reference\n", s->name, e->comparisons);
}

status study_dry_run(const study *s, const study_request *request, diagnostic *why)
{
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .by_repetition = request->by_repetition,
                                   .any_environment = request->any_environment,
                                   .stop = terminal_stop_requested};
    study_estimate e;
    TRY(study_estimate_run(s, &options, &e, why));
    if (request->quiet)
        return STATUS_OK;
    if (!e.cells_lacking && !e.cells_to_keep) {
        printf("%s: complete, nothing to do\n", s->name);
        return terminal_flush(why);
    }
    print_rows(s, &e);
    print_time(s, &e);
    print_files(s, request, &e);
    return terminal_flush(why);
}
