/* Reading a summary back. */
#include "study/plot_table.h"
#include "base/number.h"
#include "base/text.h"
#include "study/summary.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t count_of(const char *text, char end, char wanted)
{
    size_t count = 0;
    for (; *text && *text != end; text++)
        count += *text == wanted;
    return count;
}

/* Splits a line into at most `columns` fields; absent ones are NA. */
static void split_line(char *line, const char **fields, size_t columns)
{
    for (size_t i = 0; i < columns; i++) {
        const char *field = strsep(&line, "\t");
        fields[i] = field ? field : "NA";
    }
}

status plot_table_split(char *text, plot_table *out, diagnostic *why)
{
    *out = (plot_table){.text = text, .columns = count_of(text, '\n', '\t') + 1};
    const size_t lines = count_of(text, '\0', '\n');
    out->rows = lines ? lines - 1 : 0;
    out->names = calloc(out->columns, sizeof *out->names);
    out->fields = calloc(out->rows * out->columns + 1, sizeof *out->fields);
    if (!out->names || !out->fields) {
        plot_table_free(out);
        return out_of_memory(why);
    }
    split_line(strsep(&text, "\n"), out->names, out->columns);
    for (size_t row = 0; row < out->rows; row++)
        split_line(strsep(&text, "\n"), &out->fields[row * out->columns], out->columns);
    return STATUS_OK;
}

status plot_table_of_study(const study *s, const char *results, plot_table *out, diagnostic *why)
{
    char *text = NULL;
    text_writer writer;
    *out = (plot_table){0};
    TRY(text_writer_open(&writer, why));
    const status code = study_summary(s, results, writer.stream, why);
    TRY(text_writer_end(&writer, code, &text, NULL, why));
    return plot_table_split(text, out, why);
}

void plot_table_free(plot_table *t)
{
    free(t->names);
    free(t->fields);
    free(t->text);
    *t = (plot_table){0};
}

long plot_table_column(const plot_table *t, const char *name)
{
    for (size_t i = 0; i < t->columns; i++)
        if (strcmp(t->names[i], name) == 0)
            return (long)i;
    return -1;
}

const char *plot_table_text(const plot_table *t, size_t row, long column)
{
    return column < 0 ? "NA" : t->fields[row * t->columns + (size_t)column];
}

double plot_table_real(const plot_table *t, size_t row, long column)
{
    double value;
    return number_parse_real(plot_table_text(t, row, column), &value) ? value : NAN;
}
