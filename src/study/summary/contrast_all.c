/* Computes the ratio over all cells of a comparison: centres by cell and process, strata of processes, resamples. */
#include "study/summary/contrast_parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FEWEST_DRAWN = 3 };

/* One side: the processes that measured a cell, sorted by the cells that they have, then by start. */
typedef struct side {
    const contrast_rows *rows;
    size_t lines, processes, strata;
    size_t *process; /* index in rows->processes */
    size_t *stratum; /* stratum[k]: the first process of stratum k; strata + 1 elements */
    bool *left_out;  /* by index in rows->processes */
    double *centre;  /* [process * lines + line]: median logarithm of the process; NaN: no row of the cell */
} side;

static void side_free(side *s)
{
    free(s->process);
    free(s->stratum);
    free(s->left_out);
    free(s->centre);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* NaN without a value. */
static double median_of(double *values, size_t count)
{
    if (count == 0)
        return NAN;
    qsort(values, count, sizeof *values, by_value);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

static status find_centres(side *s, const size_t (*pairs)[2], int which, size_t *values, diagnostic *why)
{
    const contrast_rows *r = s->rows;
    double *drawn = malloc((r->files->row_count + 1) * sizeof *drawn);
    if (!drawn)
        return out_of_memory(why);
    for (size_t i = 0; i < s->lines; i++)
        for (size_t p = 0, at = r->first_of[pairs[i][which]]; p < r->process_count; p++) {
            size_t count = 0;
            for (; at < r->first_of[pairs[i][which] + 1] && r->rows[at].process == p; at++)
                drawn[count++] = log(r->rows[at].value);
            s->centre[p * s->lines + i] = median_of(drawn, count);
            *values += count;
        }
    free(drawn);
    return STATUS_OK;
}

/* -1, 0 or 1: the order of two processes by the cells that they have. */
static int compare_cells(const side *s, size_t a, size_t b)
{
    for (size_t i = 0; i < s->lines; i++) {
        const bool in_a = !isnan(s->centre[a * s->lines + i]), in_b = !isnan(s->centre[b * s->lines + i]);
        if (in_a != in_b)
            return in_a ? -1 : 1;
    }
    return 0;
}

static bool has_a_cell(const side *s, size_t process)
{
    for (size_t i = 0; i < s->lines; i++)
        if (!isnan(s->centre[process * s->lines + i]))
            return true;
    return false;
}

/* Insertion sort keeps the order of starts, and is fast enough for few processes. */
static void sort_by_cells(side *s)
{
    s->processes = s->strata = 0;
    for (size_t p = 0; p < s->rows->process_count; p++) {
        if (s->left_out[p] || !has_a_cell(s, p))
            continue;
        size_t at = s->processes++;
        for (; at > 0 && compare_cells(s, s->process[at - 1], p) > 0; at--)
            s->process[at] = s->process[at - 1];
        s->process[at] = p;
    }
    for (size_t k = 0; k < s->processes; k++)
        if (k == 0 || compare_cells(s, s->process[k - 1], s->process[k]) != 0)
            s->stratum[s->strata++] = k;
    s->stratum[s->strata] = s->processes;
}

static status side_make(const contrast_rows *r, const size_t (*pairs)[2], size_t lines, int which, side *s,
                        size_t *values, diagnostic *why)
{
    const size_t processes = r->process_count + 1;
    *s = (side){.rows = r,
                .lines = lines,
                .process = calloc(processes, sizeof *s->process),
                .stratum = calloc(processes + 1, sizeof *s->stratum),
                .left_out = calloc(processes, sizeof *s->left_out),
                .centre = calloc(processes * (lines + 1), sizeof *s->centre)};
    if (!s->process || !s->stratum || !s->left_out || !s->centre)
        return out_of_memory(why);
    TRY(find_centres(s, pairs, which, values, why));
    sort_by_cells(s);
    return STATUS_OK;
}

/* --- strata of both sides --- */

static size_t fewest_of(const side *s)
{
    size_t fewest = SIZE_MAX;
    for (size_t k = 0; k < s->strata; k++) {
        const size_t count = s->stratum[k + 1] - s->stratum[k];
        fewest = count < fewest ? count : fewest;
    }
    return s->strata ? fewest : 0;
}

/* Whether stratum k has the same cells on both sides, and processes that alternate. */
static bool stratum_alternates(const side *a, const side *b, size_t k)
{
    const size_t from = a->stratum[k], count = a->stratum[k + 1] - from;
    if (b->stratum[k] != from || b->stratum[k + 1] != from + count)
        return false;
    for (size_t i = 0; i < a->lines; i++)
        if (isnan(a->centre[a->process[from] * a->lines + i]) != isnan(b->centre[b->process[from] * b->lines + i]))
            return false;
    const contrast_sample one = {.process = a->process + from, .levels = {.processes = count}},
                          other = {.process = b->process + from, .levels = {.processes = count}};
    return contrast_alternate(a->rows, &one, b->rows, &other);
}

static bool alternate(const side *a, const side *b)
{
    bool all = a->strata == b->strata && a->strata > 0;
    for (size_t k = 0; all && k < a->strata; k++)
        all = stratum_alternates(a, b, k);
    return all;
}

/* Whether each cell has a process that is not left out. */
static bool covers_all(const side *s)
{
    for (size_t i = 0; i < s->lines; i++) {
        bool found = false;
        for (size_t p = 0; p < s->rows->process_count; p++)
            found |= !s->left_out[p] && !isnan(s->centre[p * s->lines + i]);
        if (!found)
            return false;
    }
    return true;
}

static void mark_small(side *s)
{
    for (size_t k = 0; k < s->strata; k++)
        for (size_t i = s->stratum[k]; i < s->stratum[k + 1]; i++)
            s->left_out[s->process[i]] = s->stratum[k + 1] - s->stratum[k] < FEWEST_DRAWN;
}

/* Leaves out strata that are too small for an interval, if the other processes have all cells. Such strata arise if a
 * process lacks a cell, because a row was excluded or the run was interrupted. The process of the other side that
 * alternates with a process left out is left out as well. */
static void leave_out_small(side *a, side *b)
{
    mark_small(a);
    mark_small(b);
    for (size_t p = 0; a->rows->process_count == b->rows->process_count && p < a->rows->process_count; p++)
        a->left_out[p] = b->left_out[p] = a->left_out[p] || b->left_out[p];
    if (!covers_all(a) || !covers_all(b)) {
        memset(a->left_out, 0, a->rows->process_count * sizeof *a->left_out);
        memset(b->left_out, 0, b->rows->process_count * sizeof *b->left_out);
    }
    sort_by_cells(a);
    sort_by_cells(b);
}

/* --- estimates --- */

/* The mean over the cells of the means over the drawn processes; drawn[k]: position of a process in s->process. */
static double mean_of(const side *s, const size_t *drawn)
{
    double mean = 0;
    for (size_t i = 0; i < s->lines; i++) {
        double sum = 0, count = 0;
        for (size_t k = 0; k < s->processes; k++) {
            const double centre = s->centre[s->process[drawn[k]] * s->lines + i];
            if (!isnan(centre))
                sum += centre, count++;
        }
        mean += sum / count / (double)s->lines;
    }
    return mean;
}

static void draw_processes(const side *s, uint32_t round, uint32_t stream, size_t *drawn)
{
    for (size_t stratum = 0; stratum < s->strata; stratum++) {
        const size_t from = s->stratum[stratum], count = s->stratum[stratum + 1] - from;
        for (size_t k = from; k < from + count; k++)
            drawn[k] = from + level_draw(0, round, stream, (uint32_t)k, count);
    }
}

static status estimate(const side *a, const side *b, contrast_all *out, diagnostic *why)
{
    size_t *drawn_a = malloc((a->processes + 1) * sizeof *drawn_a);
    size_t *drawn_b = malloc((b->processes + 1) * sizeof *drawn_b);
    double *values = malloc(LEVEL_RESAMPLES * sizeof *values);
    const status code = drawn_a && drawn_b && values ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        for (size_t k = 0; k < a->processes; k++)
            drawn_a[k] = k;
        for (size_t k = 0; k < b->processes; k++)
            drawn_b[k] = k;
        out->ratio.value = mean_of(b, drawn_b) - mean_of(a, drawn_a);
        for (uint32_t round = 0; out->fewest >= FEWEST_DRAWN && round < LEVEL_RESAMPLES; round++) {
            draw_processes(a, round, 0, drawn_a);
            draw_processes(b, round, out->alternate ? 0 : 1, drawn_b);
            values[round] = mean_of(b, drawn_b) - mean_of(a, drawn_a);
        }
        if (out->fewest >= FEWEST_DRAWN)
            level_set_interval(values, out->fewest, &out->ratio);
    }
    free(values);
    free(drawn_b);
    free(drawn_a);
    return code;
}

/* The standard deviation of the processes' means over the cells, or, if b is given, of the differences of pairs. */
static double deviation_of(const side *a, const side *b)
{
    double sum = 0, squares = 0;
    for (size_t k = 0; k < a->processes; k++) {
        double mean = 0;
        for (size_t i = 0; i < a->lines; i++)
            mean += (b ? b->centre[b->process[k] * b->lines + i] : 0) - a->centre[a->process[k] * a->lines + i];
        mean /= (double)a->lines;
        sum += mean;
        squares += mean * mean;
    }
    const double n = (double)a->processes;
    return n > 1 ? sqrt(fmax(0.0, (squares - sum * sum / n) / (n - 1))) : NAN;
}

static size_t fewest_values_of(const contrast_rows *r, const size_t (*pairs)[2], size_t lines, int which)
{
    size_t fewest = SIZE_MAX;
    for (size_t i = 0; i < lines; i++) {
        const size_t count = r->first_of[pairs[i][which] + 1] - r->first_of[pairs[i][which]];
        fewest = count < fewest ? count : fewest;
    }
    return lines ? fewest : 0;
}

static size_t lesser(size_t a, size_t b)
{
    return a < b ? a : b;
}

status contrast_all_make(const contrast_rows *a, const contrast_rows *b, const size_t (*pairs)[2], size_t count,
                         contrast_all *out, diagnostic *why)
{
    side sa = {.rows = NULL}, sb = {.rows = NULL};
    *out = (contrast_all){.ratio = {NAN, NAN, NAN}, .deviation = NAN};
    status code = side_make(a, pairs, count, 0, &sa, &out->values[0], why);
    THEN(code, side_make(b, pairs, count, 1, &sb, &out->values[1], why));
    if (code == STATUS_OK && count > 0) {
        leave_out_small(&sa, &sb);
        out->processes[0] = sa.processes;
        out->processes[1] = sb.processes;
        out->fewest = lesser(fewest_of(&sa), fewest_of(&sb));
        out->fewest_values = lesser(fewest_values_of(a, pairs, count, 0), fewest_values_of(b, pairs, count, 1));
        out->alternate = alternate(&sa, &sb);
        if (sa.strata == 1 && sb.strata == 1)
            out->deviation =
                out->alternate ? deviation_of(&sa, &sb) : hypot(deviation_of(&sa, NULL), deviation_of(&sb, NULL));
        code = estimate(&sa, &sb, out, why);
    }
    side_free(&sa);
    side_free(&sb);
    return code;
}
