/* Writes the report of a lens (lens/lens.h): its sections as tables of text, as CSV with a row for each number, and as
 * JSON with a list for each column. Ownership: lens_table_make allocates, lens_table_release frees; a report is
 * borrowed, and texts are its constants. Errors of streams stay in the stream. */
#pragma once

#include "lens/lens.h"
#include <jansson.h>
#include <stdio.h>

enum { LENS_COLUMNS_MAX = 32 };

/* The rows of a section that agree in their keys, as records. */
typedef struct lens_table {
    const lens_section *section;
    const char *quantity[LENS_COLUMNS_MAX], *unit[LENS_COLUMNS_MAX];
    int columns;
    size_t count;
    lens_row *key; /* of each record */
    double *value; /* record by record, LENS_COLUMNS_MAX each; NaN where a record lacks the quantity */
    bool has_surface, has_field, has_lambda, has_x;
} lens_table;

status lens_table_make(const lens_report *r, const lens_section *section, lens_table *out, diagnostic *why);
void lens_table_release(lens_table *t);

/* columns: of the terminal, 0 for none. */
status lens_write_text(const lens_report *r, const char *title, int columns, FILE *out, diagnostic *why);
void lens_write_csv(const lens_report *r, FILE *out);
/* NULL when out of memory. */
json_t *lens_json(const lens_report *r, const char *title);
