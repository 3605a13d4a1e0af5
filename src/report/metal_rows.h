/* The catalogue of metals as a table, one metal in detail, or JSON; like report/media_rows.h. at_nm is a further
 * wavelength, 0 for none. Ownership: the JSON is a new reference. Errors of the stream stay in the stream. */
#pragma once

#include "optics/media.h"
#include <jansson.h>
#include <stdio.h>

/* Whether its table covers the wavelength. */
bool metal_covers(const metal *m, double lambda_nm);
/* "367.9..821.1"; returns text. */
enum { METAL_RANGE_MAX = 72 };
char *metal_range_text(const metal *m, char text[METAL_RANGE_MAX]);

/* columns: width of the terminal to which lines are wrapped; 0: no wrapping. */
void metal_rows_table(FILE *stream, double at_nm, int columns);
void metal_rows_details(FILE *stream, const metal *m, double at_nm, int columns);

/* One metal, or NULL when memory is out. */
json_t *metal_json(const metal *m, double at_nm);
