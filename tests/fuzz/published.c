/* The fuzzer of CSV files of others: the numbers that a figure shows next to the measured ones. */
#include "base/csv.h"
#include "fuzz.h"
#include "study/plot/plot.h"
#include <math.h>

static void read_table(const char *path)
{
    csv *table = NULL;
    diagnostic why = {.what = ""};
    const status code = csv_read_rows(path, NULL, &table, &why);
    if (code != STATUS_OK) {
        must_refuse(code, &why);
        return;
    }
    must(table && table->complete_size <= table->size &&
         (!table->start || table->start[table->row_count] == table->complete_size));
    for (size_t row = 0; row < table->row_count; row++)
        for (size_t k = 0; k < table->column_count; k++)
            csv_field_real(table, row, csv_column(table, table->header[k]));
    csv_destroy(table);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_write("published.csv", data, size);
    char *path = fuzz_path("published.csv");
    read_table(path);
    const plot_request request = {.published = path};
    plot_plan *p = calloc(1, sizeof *p);
    must(p);
    p->request = &request;
    p->kind = PLOT_LINES;
    snprintf(p->x.name, sizeof p->x.name, "render.depth");
    snprintf(p->y.name, sizeof p->y.name, "wall_s");
    diagnostic why = {.what = ""};
    const status code = plot_published_read(p, &why);
    if (code != STATUS_OK)
        must_refuse(code, &why);
    const plot_published *got = &p->published;
    for (size_t i = 0; code == STATUS_OK && i < got->count; i++)
        must(!isnan(got->x[i]) && !isnan(got->y[i]) && got->series[i] < got->series_count);
    for (size_t i = 0; got->names && i < got->series_count; i++)
        free(got->names[i]);
    free(got->names);
    free(got->x);
    free(got->y);
    free(got->series);
    free(p);
    free(path);
    return 0;
}
