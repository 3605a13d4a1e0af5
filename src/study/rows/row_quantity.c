/* Reads values of rows, computes their medians by process, and judges the noise of rows. */
#include "study/rows/row_quantity.h"
#include "measure/statistics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), rest = strlen(end);
    return length >= rest && strcmp(text + length - rest, end) == 0;
}

void row_quantity_values(const row_ref *const *rows, size_t count, row_quantity quantity, double *values)
{
    const csv *table = NULL;
    const bool is_time = ends_with(quantity.name, "_s");
    int dividend = -1, divisor = -1;
    for (size_t i = 0; i < count; i++) {
        if (rows[i]->table != table) {
            table = rows[i]->table;
            dividend = csv_column(table, quantity.name);
            divisor = quantity.divisor ? csv_column(table, quantity.divisor) : -1;
        }
        values[i] = csv_field_real(table, rows[i]->row, dividend);
        if (quantity.divisor)
            values[i] /= csv_field_real(table, rows[i]->row, divisor);
        /* a time is negative if the monotonic clock went back */
        const bool wrong = !isfinite(values[i]) || (is_time && values[i] < 0);
        values[i] = wrong ? NAN : values[i];
    }
}

size_t row_quantity_known(const row_ref *const *rows, size_t count, row_quantity quantity, double *values)
{
    size_t known = 0;
    row_quantity_values(rows, count, quantity, values);
    for (size_t i = 0; i < count; i++)
        if (!isnan(values[i]))
            values[known++] = values[i];
    return known;
}

level_range row_quantity_range(row_quantity quantity)
{
    /* costs of waiting, idling and uneven work, which are 0 in the best case */
    static const char *const may_be_zero[] = {"imbalance", "waiting_s",          "waiting_s_mean",       "runnable_s",
                                              "blocked_s", "voluntary_switches", "involuntary_switches", "start_s"};
    if (!quantity.divisor && (ends_with(quantity.name, "_fraction") || strcmp(quantity.name, "frequency_drop") == 0))
        return LEVEL_FRACTION;
    for (size_t i = 0; i < sizeof may_be_zero / sizeof *may_be_zero; i++)
        if (strcmp(quantity.name, may_be_zero[i]) == 0)
            return LEVEL_NOT_NEGATIVE;
    return LEVEL_POSITIVE;
}

typedef struct run_value {
    long run;
    size_t order; /* keeps the values of one run in their order */
    double value;
} run_value;

static int by_run(const void *a, const void *b)
{
    const run_value *x = a, *y = b;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    return (x->order > y->order) - (x->order < y->order);
}

status row_quantity_median(const row_ref *const *rows, const double *values, size_t count, level_range range,
                           level_interval *out, diagnostic *why)
{
    run_value *sorted = malloc((count + 1) * sizeof *sorted);
    double *ordered = malloc((count + 1) * sizeof *ordered);
    size_t *start = malloc((count + 2) * sizeof *start), known = 0;
    status code = sorted && ordered && start ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        level_sample sample = {ordered, start, 0};
        for (size_t i = 0; i < count; i++)
            if (!isnan(values[i])) {
                sorted[known] = (run_value){rows[i]->run, known, values[i]};
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

status row_quantity_spread(const row_ref *const *rows, size_t count, row_quantity quantity, double *values,
                           row_spread *out, diagnostic *why)
{
    *out = (row_spread){0, {NAN, NAN, NAN}, NAN, NAN, NAN};
    out->known = row_quantity_known(rows, count, quantity, values);
    if (out->known == 0)
        return STATUS_OK;
    const summary all = summarize(values, out->known);
    out->mean = all.mean;
    out->minimum = all.minimum;
    out->maximum = all.maximum;
    row_quantity_values(rows, count, quantity, values);
    return row_quantity_median(rows, values, count, row_quantity_range(quantity), &out->median, why);
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
