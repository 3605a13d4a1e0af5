/* The catalogues of media, metals and coatings as tables, one entry in detail, or JSON. at_nm is a further wavelength;
 * 0: none. Ownership: the JSON is a new reference. Errors of the stream stay in the stream, where the caller checks
 * them. */
#pragma once

#include "optics/coating.h"
#include "optics/media.h"
#include "optics/optical_data.h"
#include <jansson.h>
#include <stdio.h>

enum { MEDIA_RANGE_MAX = 72 };

/* "210..3710"; "589.3" for a single wavelength; "-" if the range is unknown. Returns text. */
char *media_range_text(const medium *m, char text[MEDIA_RANGE_MAX]);

/* columns: width of the terminal to which lines are wrapped; 0: no wrapping. */
void media_rows_table(FILE *stream, double at_nm, int columns);
void media_rows_details(FILE *stream, const medium *m, double at_nm, int columns);

/* Whether the table of the metal covers the wavelength. */
bool metal_covers(const metal *m, double lambda_nm);
/* "367.9..821.1"; returns text. */
enum { METAL_RANGE_MAX = 72 };
char *metal_range_text(const metal *m, char text[METAL_RANGE_MAX]);

void metal_rows_table(FILE *stream, double at_nm, int columns);
void metal_rows_details(FILE *stream, const metal *m, double at_nm, int columns);

/* Designs of coatings, with their reflectance in air on bk7. */
void coating_rows_table(FILE *stream, double at_nm, int columns);
void coating_rows_details(FILE *stream, const coating_design *d, double at_nm, int columns);

/* An entry of a catalogue; the other pointers are NULL. */
typedef struct media_choice {
    const medium *clear;
    const metal *opaque;
    const coating_design *coated;
} media_choice;

/* The given entry, or all catalogues if there is none. Returns NULL when out of memory. */
json_t *media_rows_json(media_choice only, double at_nm);

/* Data from a file in detail, or as JSON, with the law of n, or NULL. */
void data_rows_details(FILE *stream, const char *file, const optical_data *d, double at_nm, int columns);
json_t *data_rows_json(const char *file, const optical_data *d, double at_nm);
