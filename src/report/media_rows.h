/* The catalogue of media as a person and a program read it: one line each, all about one, or JSON. Ownership: the JSON
 * is a new reference. Errors of the stream are left in the stream. at_nm is a further wavelength, 0 for none. */
#pragma once

#include "optics/media.h"
#include <jansson.h>
#include <stdio.h>

enum { MEDIA_RANGE_MAX = 72 };

/* "210..3710"; "589.3" for a single wavelength; "-" where none is stated; returns text. */
char *media_range_text(const medium *m, char text[MEDIA_RANGE_MAX]);

void media_rows_table(FILE *stream, double at_nm);
void media_rows_details(FILE *stream, const medium *m, double at_nm);

/* All media, or only one when it is not NULL; NULL without memory. */
json_t *media_rows_json(const medium *only, double at_nm);
