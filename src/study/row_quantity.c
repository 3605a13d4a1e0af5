#include "study/row_quantity.h"
#include "measure/statistics.h"
#include "study/level_rows.h"
#include <math.h>
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
    /* what waiting, idling and unequal shares of work cost: nothing, at best */
    static const char *const may_be_zero[] = {"imbalance", "waiting_s",          "waiting_s_mean",       "runnable_s",
                                              "blocked_s", "voluntary_switches", "involuntary_switches", "start_s"};
    if (!column.below && (ends_with(column.name, "_share") || strcmp(column.name, "frequency_drop") == 0))
        return LEVEL_FRACTION;
    for (size_t i = 0; i < sizeof may_be_zero / sizeof *may_be_zero; i++)
        if (strcmp(column.name, may_be_zero[i]) == 0)
            return LEVEL_NOT_NEGATIVE;
    return LEVEL_POSITIVE;
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
    return level_rows_median(rows, values, count, row_quantity_range(column), &out->median, why);
}
