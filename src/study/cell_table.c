#include "study/cell_table.h"

#include "base/number.h"
#include "study/grid.h"
#include "study/rows.h"
#include <math.h>

void cell_table_header(const study *s, const char *rest, FILE *out)
{
    const char *path;
    fputs("study\tcell", out);
    for (size_t i = 0; (path = study_grid_path(s, i)); i++)
        fprintf(out, "\t%s", path);
    fprintf(out, "\t%s\n", rest);
}

void cell_table_begin(const study *s, size_t cell, FILE *out)
{
    fprintf(out, "%s\t%zu", s->name, cell);
    grid_put_values(s, cell, out);
}

void cell_table_number(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "\t%s", isfinite(value) ? number_format(value, text) : "NA");
}
