/* Spectra and their colours: the standard observer, daylight, and lamps. Pure; cannot fail; only + - * / and sqrt. */
#pragma once

#include <stddef.h>

/* ---- the standard observer and daylight ---- */

/* The CIE 1931 standard observer (2 degrees; CIE 15:2018 and ISO/CIE 11664-1) and the CIE standard illuminant D65
 * (ISO/CIE 11664-2), both tabulated at 5 nm from 360 to 830 nm and interpolated linearly, as CIE 15 allows; both are 0
 * outside. Wavelengths are in nm, in air (in vacuum they are 0.03% longer; the difference is ignored here). A spectrum
 * is sampled from OBSERVER_LOW_NM to OBSERVER_HIGH_NM: of D65 this omits 6e-5 of X, 3e-6 of Y and 2.2e-4 of Z. Every
 * integral here is over that range, and exact for these tables (their products are quadratic between entries), so that
 * white stays exactly white. Radiance: a light of linear sRGB (1, 1, 1) has the spectrum observer_d65 and Y = 1. */

enum { OBSERVER_LOW_NM = 380, OBSERVER_HIGH_NM = 780 };

/* Colour matching functions xbar, ybar, zbar; ybar(555) = 1. */
void observer_xyz(double lambda_nm, double xyz[3]);

/* D65, scaled so that a white surface (reflectance 1) under it has Y = 1: 1.0112 at 560 nm. */
double observer_d65(double lambda_nm);

/* (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) K cmf(lambda) with K = 1 / integral of ybar: the mean of v(lambda) times these
 * weights over wavelengths distributed evenly from LOW to HIGH is the XYZ of the spectrum v. A constant 1 has Y = 1. */
void observer_weights(double lambda_nm, double xyz[3]);

/* Linear sRGB (IEC 61966-2-1: the primaries of ITU-R BT.709) with the white point of observer_d65 as integrated here (x
 * = 0.312757, y = 0.329072; CIE 15: 0.31272, 0.32903), so that this white is (1, 1, 1) up to the last places. Not
 * clamped: colours outside the gamut have negative components. */
void xyz_to_linear_srgb(const double xyz[3], double rgb[3]);
void linear_srgb_to_xyz(const double rgb[3], double xyz[3]);

/* ---- lamps ---- */

/* Spectra of lamps: a black body by Planck's law, and the lines of discharge lamps and lasers. All have Y = 1 for the
 * standard observer, so that lamps of equal intensity are equally bright, whatever their spectra. Wavelengths in nm, in
 * air (those of black bodies in vacuum: the difference of 0.03 % is ignored). Lines have no width. */

typedef enum lamp_spectrum {
    LAMP_OF_COLOR, /* a smooth spectrum of the lamp's colour (optics/upsample.h): white is D65 */
    LAMP_BLACK_BODY,
    LAMP_SODIUM,
    LAMP_MERCURY,
    LAMP_HYDROGEN,
    LAMP_LINE, /* one line, of a laser */
    LAMP_DATA  /* measured: optics/optical_data.h; it has no lines, and no colour here */
} lamp_spectrum;

/* A spectrum as a function: its value at a wavelength. */
typedef double spectrum_value(const void *context, double lambda_nm);

/* XYZ of a spectrum, with Y = 1 of a constant 1; midpoints of 1 nm. */
void spectrum_xyz(spectrum_value *value, const void *context, double xyz[3]);

/* Linear sRGB with Y = 1 of a light with this XYZ, whose Y is above 0. A colour outside the gamut, as of most lines, is
 * mixed with white of the same Y until it is on the gamut's border. */
void light_rgb(const double xyz[3], double rgb[3]);

enum { LAMP_LINES_MAX = 8 };

typedef struct spectral_line {
    double nm;
    double power; /* radiant; the sum of Y over a lamp's lines is 1 */
} spectral_line;

/* Planck's law: spectral radiance of a black body, B_lambda(T) over its value at 560 nm (CIE 15:2018, section 4.1.1,
 * with c2 = 0.014388 m K), for 300 .. 800 nm and LAMP_COLDEST_K .. LAMP_HOTTEST_K. */
enum { LAMP_COLDEST_K = 500, LAMP_HOTTEST_K = 100000 };
double planck_relative(double lambda_nm, double temperature_k);

/* The factor that makes planck_relative's spectrum have Y = 1 over OBSERVER_LOW_NM .. OBSERVER_HIGH_NM. */
double black_body_scale(double temperature_k);

/* Writes the lines of a lamp in order of wavelength and returns their number; 0 for continuous spectra. line_nm is the
 * wavelength of LAMP_LINE. Sodium: the D lines of a thin vapour, whose powers are as the statistical weights 2 : 1.
 * Mercury and hydrogen: relative intensities of Reader and Corliss, "Line Spectra of the Elements", CRC Handbook of
 * Chemistry and Physics; real lamps differ with pressure and current. */
int lamp_lines(lamp_spectrum kind, double line_nm, spectral_line lines[LAMP_LINES_MAX]);

/* The colour of a lamp other than LAMP_OF_COLOR and LAMP_DATA, by light_rgb. */
void lamp_rgb(lamp_spectrum kind, double temperature_k, double line_nm, double rgb[3]);
