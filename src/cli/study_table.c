/* Tables with aligned columns for a terminal, and the summary of a study as one. */
#include "base/number.h"
#include "base/text.h"
#include "cli/study.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

status aligned_table_print(FILE *out, char *const *text, size_t rows, size_t columns, diagnostic *why)
{
    int *width = calloc(columns + 1, sizeof *width);
    if (!width)
        return out_of_memory(why);
    for (size_t i = 0; i < rows * columns; i++) {
        const int length = (int)strlen(text[i]);
        width[i % columns] = length > width[i % columns] ? length : width[i % columns];
    }
    for (size_t i = 0; i < rows * columns; i++)
        fprintf(out, "%*s%s", width[i % columns], text[i], (i + 1) % columns ? "  " : "\n");
    free(width);
    return STATUS_OK;
}

/* The fields of the summary, by rows; row 0 is the header. */
typedef struct fields {
    char **field;
    size_t rows, columns;
    const char *extra[2]; /* columns that are shown after marked, because a row is excluded or disturbed */
    size_t extra_count;
} fields;

static size_t count_of(const char *text, const char *end, char wanted)
{
    size_t count = 0;
    for (; text < end; text++)
        count += *text == wanted;
    return count;
}

static bool split(char *tsv, fields *out)
{
    out->columns = count_of(tsv, tsv + strcspn(tsv, "\n"), '\t') + 1;
    out->rows = count_of(tsv, tsv + strlen(tsv), '\n');
    out->field = calloc(out->rows * out->columns + 1, sizeof *out->field);
    for (size_t row = 0; out->field && row < out->rows; row++) {
        char *line = strsep(&tsv, "\n");
        for (size_t column = 0; column < out->columns; column++)
            out->field[row * out->columns + column] = strsep(&line, "\t");
    }
    return out->field != NULL;
}

static size_t column_of(const fields *f, const char *name)
{
    size_t column = 0;
    while (column + 1 < f->columns && strcmp(f->field[column], name) != 0)
        column++;
    return column;
}

static double real_of(const fields *f, size_t row, const char *name)
{
    double value;
    return number_parse_real(f->field[row * f->columns + column_of(f, name)], &value) ? value : NAN;
}

/* Returns a number of the summary with the digits that the interval INTERVAL_low, INTERVAL_high allows. interval "":
 * none. */
static const char *rounded(const fields *f, size_t row, const char *name, const char *interval,
                           char text[NUMBER_TEXT_MAX])
{
    char low[64], high[64];
    const double value = real_of(f, row, name);
    snprintf(low, sizeof low, "%s_low", interval);
    snprintf(high, sizeof high, "%s_high", interval);
    const double half = *interval ? 0.5 * (real_of(f, row, high) - real_of(f, row, low)) : NAN;
    return isnan(value) ? f->field[row * f->columns + column_of(f, name)] : number_format_within(value, half, text);
}

static bool has_column(const fields *f, const char *name)
{
    return strcmp(f->field[column_of(f, name)], name) == 0;
}

/* Whether a column has other values than 0 and NA. */
static bool has_any(const fields *f, const char *name)
{
    const size_t column = column_of(f, name);
    for (size_t row = 1; has_column(f, name) && row < f->rows; row++)
        if (strcmp(f->field[row * f->columns + column], "0") != 0 &&
            strcmp(f->field[row * f->columns + column], "NA") != 0)
            return true;
    return false;
}

/* The text of a field of the table: the columns from cell to n unchanged, then wall_s, cpu_s, rays and marked, the
 * extra ones, and the image difference of a study with a reference. Allocated. */
static char *shown(const fields *f, size_t row, size_t column)
{
    size_t plain = column_of(f, "n") + 1;
    if (column >= plain + 4 && column < plain + 4 + f->extra_count)
        return strdup(f->field[row * f->columns + column_of(f, f->extra[column - plain - 4])]);
    column -= column >= plain + 4 ? f->extra_count : 0;
    char median[NUMBER_TEXT_MAX], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    if (column < plain)
        return strdup(f->field[row * f->columns + column]);
    switch (column - plain) {
    case 0:
        return row == 0 ? strdup("wall_s [95% interval]")
                        : text_format("%s [%s, %s]", rounded(f, row, "wall_s_median", "wall_s", median),
                                      rounded(f, row, "wall_s_low", "wall_s", low),
                                      rounded(f, row, "wall_s_high", "wall_s", high));
    case 1: return strdup(row == 0 ? "cpu_s" : rounded(f, row, "cpu_s_median", "cpu_s", median));
    case 2: return strdup(row == 0 ? "rays" : f->field[row * f->columns + column_of(f, "rays_total")]);
    case 3: return strdup(f->field[row * f->columns + column_of(f, "marked")]);
    case 4: return strdup(row == 0 ? "flip" : rounded(f, row, "flip", "", median));
    default: return strdup(row == 0 ? "error_rms" : rounded(f, row, "error_rms", "", median));
    }
}

status study_table_print(FILE *out, char *tsv, diagnostic *why)
{
    fields f = {0};
    bool good = split(tsv, &f);
    static const char *const extra[] = {"excluded", "disturbed"};
    for (size_t i = 0; good && i < sizeof extra / sizeof *extra; i++)
        if (has_any(&f, extra[i]))
            f.extra[f.extra_count++] = extra[i];
    size_t columns = good ? column_of(&f, "n") + 1 + (has_column(&f, "flip") ? 6 : 4) + f.extra_count : 0;
    const size_t cells = f.rows * columns;
    char **text = calloc(cells + 1, sizeof *text);
    good = good && text;
    for (size_t i = 0; good && i < cells; i++)
        good = (text[i] = shown(&f, i / columns, i % columns)) != NULL;
    const status printed = good ? aligned_table_print(out, text, f.rows, columns, why) : out_of_memory(why);
    for (size_t i = 0; text && i < cells; i++)
        free(text[i]);
    free(text);
    free(f.field);
    return printed;
}
