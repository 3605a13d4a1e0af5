/* Computes the ratios and verdicts of a comparison, and writes them as JSON. */
#include "study/summary/contrast.h"
#include "base/json_build.h"
#include "measure/statistics.h"
#include "study/plan/grid.h"
#include "study/summary/contrast_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_VALUES = 6, FEWEST_PROCESSES = 3 };

static const double DETECT = 0.03, POWER = 0.95, UPPER = 0.9;

const char *contrast_verdict_text(contrast_verdict verdict)
{
    static const char *const texts[] = {"cannot tell", "faster", "slower"};
    return texts[verdict];
}

const char *contrast_reason_text(contrast_reason reason)
{
    static const char *const texts[] = {"the interval includes 1", "a side has no rows",
                                        "there are fewer than 6 repetitions or 3 processes",
                                        "the sides did not alternate", ""};
    return texts[reason];
}

static size_t lesser(size_t a, size_t b)
{
    return a < b ? a : b;
}

static level_interval exponential(level_interval x)
{
    return (level_interval){exp(x.value), exp(x.low), exp(x.high)};
}

/* Standard deviation of the centres of the processes, or of the differences of pairs. */
static double deviation_of(const level_sample *a, const level_sample *b)
{
    double sum = 0, squares = 0;
    const double n = (double)a->processes;
    for (size_t k = 0; k < a->processes; k++) {
        const level_sample one = {a->values, a->start + k, 1};
        double d = level_centre(&one);
        if (b) {
            const level_sample other = {b->values, b->start + k, 1};
            d = level_centre(&other) - d;
        }
        sum += d;
        squares += d * d;
    }
    return a->processes > 1 ? sqrt(fmax(0.0, (squares - sum * sum / n) / (n - 1))) : NAN;
}

/* Returns the number of pairs of processes that finds a relative difference of `detect`, or of DETECT if detect is 0;
 * returns 0 if the number is unknown or too large. */
static size_t pairs_for(double deviation, size_t processes, double detect)
{
    return power_pairs(power_upper_deviation(deviation, processes, UPPER), log1p(detect > 0 ? detect : DETECT), POWER);
}

/* Sets verdict and reason; values, processes: their numbers on the side that has fewer. */
static void decide(contrast_line *line, size_t values, size_t processes)
{
    line->verdict = CONTRAST_CANNOT_TELL;
    if (values < FEWEST_VALUES || processes < FEWEST_PROCESSES)
        line->reason = CONTRAST_FEW;
    else if (!line->alternate)
        line->reason = CONTRAST_NO_TURNS;
    else if (!(line->ratio.low > 1) && !(line->ratio.high < 1))
        line->reason = CONTRAST_INTERVAL;
    else {
        line->reason = CONTRAST_CLEAR;
        line->verdict = line->ratio.low > 1 ? CONTRAST_SLOWER : CONTRAST_FASTER;
    }
}

/* Compares two samples; seed: of the bootstrap. */
static status judge(const contrast_rows *ra, const contrast_sample *a, const contrast_rows *rb,
                    const contrast_sample *b, const contrast_options *options, uint64_t seed, contrast_line *line,
                    diagnostic *why)
{
    const level_sample *la = &a->levels, *lb = &b->levels;
    line->a.processes = la->processes;
    line->b.processes = lb->processes;
    line->a.count = la->start[la->processes];
    line->b.count = lb->start[lb->processes];
    line->ratio = (level_interval){NAN, NAN, NAN};
    line->reason = CONTRAST_NO_ROWS;
    if (!la->processes || !lb->processes)
        return STATUS_OK;
    line->alternate = contrast_alternate(ra, a, rb, b);
    level_interval difference;
    TRY(level_bootstrap(la, lb, line->alternate, level_difference, NULL, seed, &difference, why));
    line->ratio = exponential(difference);
    const double deviation =
        line->alternate ? deviation_of(la, lb) : hypot(deviation_of(la, NULL), deviation_of(lb, NULL));
    line->pairs_needed = pairs_for(deviation, lesser(la->processes, lb->processes), options->detect);
    decide(line, lesser(line->a.count, line->b.count), lesser(la->processes, lb->processes));
    return STATUS_OK;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static status describe(const contrast_rows *r, size_t cell, contrast_half *out, diagnostic *why)
{
    const size_t from = r->first_of[cell], count = r->first_of[cell + 1] - from;
    *out = (contrast_half){.cell = cell, .median = NAN};
    if (count == 0)
        return STATUS_OK;
    double *values = malloc(count * sizeof *values);
    if (!values)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        values[i] = r->rows[from + i].value;
    qsort(values, count, sizeof *values, by_value);
    out->median = 0.5 * (values[(count - 1) / 2] + values[count / 2]);
    out->film = row_field(r->rows[from].ref, "film_expected");
    out->rays = row_field(r->rows[from].ref, "rays_total");
    free(values);
    return STATUS_OK;
}

static status make_line(const contrast_rows *a, const contrast_rows *b, const size_t pair[2],
                        const contrast_options *options, contrast_line *line, diagnostic *why)
{
    contrast_sample sa = {.values = NULL}, sb = {.values = NULL};
    status code = describe(a, pair[0], &line->a, why);
    THEN(code, describe(b, pair[1], &line->b, why));
    THEN(code, contrast_sample_of_cell(a, pair[0], &sa, why));
    THEN(code, contrast_sample_of_cell(b, pair[1], &sb, why));
    THEN(code, judge(a, &sa, b, &sb, options, pair[0] * 2 + 1, line, why));
    contrast_sample_free(&sa);
    contrast_sample_free(&sb);
    return code;
}

static status make_all(const contrast_rows *a, const contrast_rows *b, const contrast_options *options, contrast *c,
                       diagnostic *why)
{
    size_t(*pairs)[2] = calloc(c->count + 1, sizeof *pairs), count = 0;
    if (!pairs)
        return out_of_memory(why);
    for (size_t i = 0; i < c->count; i++)
        if (c->lines[i].reason != CONTRAST_NO_ROWS) {
            pairs[count][0] = c->lines[i].a.cell;
            pairs[count++][1] = c->lines[i].b.cell;
        }
    contrast_all all;
    const status code = contrast_all_make(a, b, (const size_t(*)[2])pairs, count, &all, why);
    free(pairs);
    TRY(code);
    contrast_line *line = &c->all;
    *line = (contrast_line){.a = {.count = all.values[0], .processes = all.processes[0], .median = NAN},
                            .b = {.count = all.values[1], .processes = all.processes[1], .median = NAN},
                            .ratio = exponential(all.ratio),
                            .alternate = all.alternate,
                            .reason = CONTRAST_NO_ROWS};
    if (count == 0)
        return STATUS_OK;
    line->pairs_needed = pairs_for(all.deviation, all.fewest, options->detect);
    decide(line, all.fewest_values, all.fewest);
    return STATUS_OK;
}

static status make_lines(const study *s, const study_side *a, const study_side *b, const contrast_options *options,
                         const contrast_rows rows[2], contrast *c, diagnostic *why)
{
    size_t(*pairs)[2];
    TRY(side_cells(s, a, b, &pairs, &c->count, why));
    c->lines = calloc(c->count + 1, sizeof *c->lines);
    status code = c->lines ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < c->count; i++) {
        contrast_line *line = &c->lines[i];
        code = make_line(&rows[0], &rows[1], pairs[i], options, line, why);
        if (code != STATUS_OK || line->reason == CONTRAST_NO_ROWS)
            continue;
        c->compared++;
        c->same += strcmp(line->a.film, "NA") != 0 && strcmp(line->a.film, line->b.film) == 0 &&
                   strcmp(line->a.rays, line->b.rays) == 0;
    }
    free(pairs);
    THEN(code, make_all(&rows[0], &rows[1], options, c, why));
    return code;
}

/* Moves the row files into the comparison, which points into them. */
static void keep_files(contrast *c, contrast_rows rows[2], diagnostic *verdict)
{
    for (int i = 0; i < 2; i++) {
        memcpy(c->environment[i], rows[i].environment, sizeof c->environment[i]);
        c->left_out[i] = rows[i].left_out;
        c->rows[i] = rows[i].files;
        rows[i].files = NULL;
        if (verdict && !verdict->what[0])
            (void)row_files_judge(c->rows[i], verdict);
    }
}

status contrast_make(const study *s, const study_side *a, const study_side *b, const contrast_options *options,
                     contrast **out, diagnostic *verdict, diagnostic *why)
{
    const char *column = options->column ? options->column : "wall_s";
    contrast_rows rows[2] = {{.files = NULL}, {.files = NULL}};
    contrast *c = *out = calloc(1, sizeof *c);
    status code = c ? contrast_rows_read(s, a, column, &rows[0], why) : out_of_memory(why);
    THEN(code, contrast_rows_read(s, b, column, &rows[1], why));
    THEN(code, make_lines(s, a, b, options, rows, c, why));
    if (code == STATUS_OK)
        keep_files(c, rows, verdict);
    contrast_rows_release(&rows[0]);
    contrast_rows_release(&rows[1]);
    if (code != STATUS_OK) {
        contrast_destroy(c);
        *out = NULL;
    }
    return code;
}

void contrast_destroy(contrast *c)
{
    if (!c)
        return;
    free(c->lines);
    row_files_destroy(c->rows[0]);
    row_files_destroy(c->rows[1]);
    free(c);
}

/* --- JSON --- */

static json_t *real_or_null(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *half_json(const contrast_half *h, bool of_cell)
{
    json_t *json = json_pack("{s:I, s:I, s:o}", "n", (json_int_t)h->count, "processes", (json_int_t)h->processes,
                             "median", real_or_null(h->median));
    if (of_cell)
        json_add_as(&json, "cell", json_integer((json_int_t)h->cell));
    return json;
}

static json_t *line_json(const contrast_line *l, bool of_cell)
{
    const char *a = l->a.film, *b = l->b.film;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:s, s:s, s:b, s:o, s:o}", "a", half_json(&l->a, of_cell), "b",
                     half_json(&l->b, of_cell), "ratio", real_or_null(l->ratio.value), "low",
                     real_or_null(l->ratio.low), "high", real_or_null(l->ratio.high), "verdict",
                     contrast_verdict_text(l->verdict), "reason", contrast_reason_text(l->reason), "alternate",
                     l->alternate, "pairs_needed",
                     l->pairs_needed ? json_integer((json_int_t)l->pairs_needed) : json_null(), "same_film",
                     a && b ? json_boolean(strcmp(a, b) == 0) : json_null());
}

static json_t *cell_json(const study *s, const contrast_line *l)
{
    json_t *json = json_pack("{s:I}", "cell", (json_int_t)l->a.cell);
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        const study_point *point = &s->axes[axis].points[study_cell_point(s, l->a.cell, axis)];
        for (size_t i = 0; i < point->count; i++)
            json_add_as(&json, point->paths[i], json_string(point->values[i]));
    }
    if (json_object_update_new(json, line_json(l, true)) == 0)
        return json;
    json_decref(json);
    return NULL;
}

json_t *contrast_json(const study *s, const contrast *c, size_t most)
{
    json_t *paths = json_array(), *cells = json_array();
    const char *path;
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        json_add(&paths, json_string(path));
    for (size_t i = 0; i < c->count && i < most; i++)
        json_add(&cells, cell_json(s, &c->lines[i]));
    return json_pack("{s:o, s:I, s:[s, s], s:{s:I, s:I}, s:o, s:o}", "columns", paths, "count", (json_int_t)c->count,
                     "environments", c->environment[0], c->environment[1], "films", "compared", (json_int_t)c->compared,
                     "same", (json_int_t)c->same, "cells", cells, "all", line_json(&c->all, false));
}
