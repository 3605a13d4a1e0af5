/* Files of optical data: those of refractiveindex.info (YAML), glass catalogues of Schott and Zemax (AGF), and tables
 * of numbers (CSV and the like), by the file's ending. Ownership: the caller releases what was read. Errors:
 * STATUS_BAD_INPUT with the file, its line and the reason. */
#pragma once

#include "optics/optical_data.h"

typedef struct optical_file_choice {
    const char *glass;  /* of a catalogue, in any case of letters; "" if it has only one */
    const char *column; /* of a table: its name in the header, or its number from 2; "": the second */
    double scale;       /* multiplies the quantity, not k: 0.01 for percent */
} optical_file_choice;

/* Reads a file below root (base/file.h; NULL or "": no restriction).
 *   .yml, .yaml   formulas 1 to 9 and tabulated n, k and nk of refractiveindex.info; wavelengths in um
 *   .agf          formulas 1 to 13; k from the internal transmittances of the thickest sample at each wavelength
 *   others        lines of numbers, separated by commas, semicolons, tabs or blanks; a decimal comma is allowed where
 *                 commas do not separate. The first column is the wavelength in nm, or in um if its header says so or
 *                 all are below 100; the second is the quantity or n; a third with the header k, or without any header,
 *                 is k. A further header begins the table of k. Other lines are skipped before the first numbers.
 * Values at equal wavelengths become their mean; a negative k, the noise of a measurement, becomes 0. */
status optical_file_read(const char *path, const char *root, const optical_file_choice *of, const optical_data **out,
                         diagnostic *why);
/* The same from its text; name is that of the file, and is copied into diagnostics. */
status optical_file_parse(const char *name, const char *text, size_t size, const optical_file_choice *of,
                          const optical_data **out, diagnostic *why);
