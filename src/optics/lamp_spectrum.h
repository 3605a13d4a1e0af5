/* Spectra of lamps: a black body by Planck's law, and the lines of discharge lamps and lasers. All have Y = 1 for the
 * standard observer, so that a lamp's intensity is as bright whatever its spectrum. Wavelengths in nm, in air (those of
 * black bodies in vacuum: the difference of 0.03 % is ignored, as in optics/observer.h). Lines have no width. Values;
 * pure; cannot fail. */
#pragma once

#include "optics/observer.h"
#include <stddef.h>

typedef enum lamp_spectrum {
    LAMP_OF_COLOR, /* a smooth spectrum of the lamp's colour (optics/upsample.h): white is D65 */
    LAMP_BLACK_BODY,
    LAMP_SODIUM,
    LAMP_MERCURY,
    LAMP_HYDROGEN,
    LAMP_LINE /* one line, of a laser */
} lamp_spectrum;

enum { LAMP_LINES_MAX = 8 };

typedef struct spectral_line {
    double nm;
    double power; /* radiant; such that the Y of a lamp's lines together is 1 */
} spectral_line;

/* Planck's law: spectral radiance of a black body, B_lambda(T) over its value at 560 nm (CIE 15:2018, section 4.1.1,
 * with c2 = 0.014388 m K), for 300 .. 800 nm and LAMP_COLDEST_K .. LAMP_HOTTEST_K. */
enum { LAMP_COLDEST_K = 500, LAMP_HOTTEST_K = 100000 };
double planck_relative(double lambda_nm, double temperature_k);

/* The factor that makes planck_relative's spectrum have Y = 1 over OBSERVER_LOW_NM .. OBSERVER_HIGH_NM. */
double black_body_scale(double temperature_k);

/* The lines of a lamp, in order of wavelength; 0 for continuous spectra. line_nm: of LAMP_LINE. Sodium: the D lines of
 * a thin vapour, whose powers are as the statistical weights 2 : 1. Mercury and hydrogen: relative intensities of
 * Reader and Corliss, "Line Spectra of the Elements", CRC Handbook of Chemistry and Physics; real lamps differ with
 * pressure and current. */
int lamp_lines(lamp_spectrum kind, double line_nm, spectral_line lines[LAMP_LINES_MAX]);

/* Linear sRGB of Y = 1 of a lamp other than LAMP_OF_COLOR. Colours outside the gamut, as those of most lines, are mixed
 * with as much white of the same Y as brings them to its border. */
void lamp_rgb(lamp_spectrum kind, double temperature_k, double line_nm, double rgb[3]);
