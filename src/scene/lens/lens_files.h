/* Files of lens prescriptions, by their ending:
 *   .zmx   sequential lens files of Zemax, in UTF-8 or UTF-16; surfaces STANDARD and EVENASPH
 *   .dat   tables of pbrt: lines of radius, thickness, index and diameter; radius 0 is the stop
 *   .csv   tables with a header (lens_files.c states its keys and columns), which hold everything
 * Ownership: the caller releases the prescription. Errors: STATUS_BAD_INPUT with the file, line, column and remedy. */
#pragma once

#include "scene/lens/lens_prescription.h"
#include <stdio.h>

/* Catalogue files of glasses (.agf), in which names are looked up that the catalogue of media lacks. Borrowed. */
typedef struct lens_glasses {
    const char *const *file; /* relative to the working folder */
    size_t count;
    const char *root; /* folder of all files that may be read (base/file.h); NULL: no restriction */
} lens_glasses;

/* The columns and keys of .csv files (lens_files.c). */
enum { LENS_COLUMNS = 17, LENS_KEYS = 11 };
extern const char *const lens_column_words[LENS_COLUMNS], *const lens_key_words[LENS_KEYS];

/* Whether a path ends as such a file does. */
bool lens_file_named(const char *path);

/* Reads a file below glasses->root and completes it (lens_prescription_complete). */
status lens_file_read(const char *path, const lens_glasses *glasses, lens_prescription *out, diagnostic *why);
/* The same from its text; name is that of the file. */
status lens_file_parse(const char *name, const char *text, size_t size, const lens_glasses *glasses,
                       lens_prescription *out, diagnostic *why);

/* The medium of a word: "" or air; a medium of the catalogue in any usual spelling (N-BK7); a glass of the files; n/V,
 * such as 1.5168/64.2; a six-digit glass code; or a constant index. The remedy of the error has no position. */
status lens_medium_parse(const char *word, const lens_glasses *glasses, lens_medium *out, diagnostic *why);
/* The medium of n_d and V_d; V_d 0: a constant index. */
lens_medium lens_medium_of_numbers(double n_d, double V_d);
/* The same as a word that lens_medium_parse reads; text holds LENS_NAME_MAX bytes; returns text. */
char *lens_medium_text(const lens_medium *m, char *text);

/* Writes a prescription in the format of the path's ending. STATUS_BAD_INPUT if the format cannot hold it. */
status lens_file_write(const lens_prescription *p, const char *path, FILE *out, diagnostic *why);
