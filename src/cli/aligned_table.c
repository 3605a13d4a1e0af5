/* Printing a table with aligned columns. */
#include "cli/aligned_table.h"
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
