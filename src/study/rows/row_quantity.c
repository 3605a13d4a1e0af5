/* Values of rows: quantities, their medians by process, and noise. */
#include "measure/statistics.h"
#include "study/rows/row_quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), rest = strlen(end);
    return length >= rest && strcmp(text + length - rest, end) == 0;
}

void row_quantity_values(const row_ref *const *rows, size_t count, row_quantity column, double *values)
{
    const csv *table = NULL;
    const bool is_time = ends_with(column.name, "_s");
    int name = -1, below = -1;
    for (size_t i = 0; i < count; i++) {
        if (rows[i]->table != table) {
            table = rows[i]->table;
            name = csv_column(table, column.name);
            below = column.below ? csv_column(table, column.below) : -1;
        }
        values[i] = csv_field_real(table, rows[i]->row, name);
        if (column.below)
            values[i] /= csv_field_real(table, rows[i]->row, below);
        /* a time is negative where the monotonic clock went back */
        const bool wrong = !isfinite(values[i]) || (is_time && values[i] < 0);
        values[i] = wrong ? NAN : values[i];
    }
}

size_t row_quantity_known(const row_ref *const *rows, size_t count, row_quantity column, double *values)
{
    size_t known = 0;
    row_quantity_values(rows, count, column, values);
    for (size_t i = 0; i < count; i++)
        if (!isnan(values[i]))
            values[known++] = values[i];
    return known;
}

level_range row_quantity_range(row_quantity column)
{
    /* costs of waiting, idling and uneven work, which are 0 in the best case */
    static const char *const may_be_zero[] = {"imbalance", "waiting_s",          "waiting_s_mean",       "runnable_s",
                                              "blocked_s", "voluntary_switches", "involuntary_switches", "start_s"};
    if (!column.below && (ends_with(column.name, "_share") || strcmp(column.name, "frequency_drop") == 0))
        return LEVEL_FRACTION;
    for (size_t i = 0; i < sizeof may_be_zero / sizeof *may_be_zero; i++)
        if (strcmp(column.name, may_be_zero[i]) == 0)
            return LEVEL_NOT_NEGATIVE;
    return LEVEL_POSITIVE;
}

typedef struct of_run {
    long run;
    size_t order; /* keeps equal runs in their order */
    double value;
} of_run;

static int by_run(const void *a, const void *b)
{
    const of_run *x = a, *y = b;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    return (x->order > y->order) - (x->order < y->order);
}

status row_quantity_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                           level_interval *out, diagnostic *why)
{
    of_run *sorted = malloc((count + 1) * sizeof *sorted);
    double *ordered = malloc((count + 1) * sizeof *ordered);
    size_t *start = malloc((count + 2) * sizeof *start), known = 0;
    status code = sorted && ordered && start ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        level_sample sample = {ordered, start, 0};
        for (size_t i = 0; i < count; i++)
            if (!isnan(values[i])) {
                sorted[known] = (of_run){rows[i]->run, known, values[i]};
                known++;
            }
        qsort(sorted, known, sizeof *sorted, by_run);
        for (size_t i = 0; i < known; i++) {
            if (i == 0 || sorted[i].run != sorted[i - 1].run)
                start[sample.processes++] = i;
            ordered[i] = sorted[i].value;
        }
        start[sample.processes] = known;
        code = level_median(&sample, range, 1, out, why);
    }
    free(start);
    free(ordered);
    free(sorted);
    return code;
}

status row_quantity_spread(const row_ref *const *rows, size_t count, row_quantity column, double *values,
                           row_spread *out, diagnostic *why)
{
    *out = (row_spread){0, {NAN, NAN, NAN}, NAN, NAN, NAN};
    out->known = row_quantity_known(rows, count, column, values);
    if (out->known == 0)
        return STATUS_OK;
    const summary of = summarize(values, out->known);
    out->mean = of.mean;
    out->minimum = of.minimum;
    out->maximum = of.maximum;
    row_quantity_values(rows, count, column, values);
    return row_quantity_median(rows, values, count, row_quantity_range(column), &out->median, why);
}

noise_verdict row_noise_judge(const noise_rule *rule, row_noise_columns *at, const row_ref *ref)
{
    if (ref->table != at->table)
        *at = (row_noise_columns){ref->table, csv_column(ref->table, "others_fraction"),
                                  csv_column(ref->table, "steal_fraction"), csv_column(ref->table, "frequency_drop"),
                                  csv_column(ref->table, "stalled_fraction")};
    const machine_noise noise = {
        csv_field_real(ref->table, ref->row, at->others), csv_field_real(ref->table, ref->row, at->steal), NAN,
        csv_field_real(ref->table, ref->row, at->drop), csv_field_real(ref->table, ref->row, at->stalled)};
    return noise_judge(rule, &noise, NULL);
}
