/* Dispersion: the refractive index as a function of the wavelength, by the formulas in which measurements and glass
 * catalogues are published, and by curves through points. Ownership: a law is a plain value. Errors: only
 * dispersion_check reports errors; the other functions are pure, cannot fail, and require a law that passes
 * dispersion_check. Wavelengths are in nm; L in the formulas is the wavelength in um. It is the wavelength in air, as
 * in a catalogue; the wavelength in vacuum, 0.03% longer, would change no index of the catalogue by more than 1e-4. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

/* Fraunhofer's lines in air, nm: of helium, of hydrogen, and the mean of the two sodium lines. Schott, TIE-29,
 * Refractive Index and Dispersion. */
#define LINE_HELIUM_D_NM 587.5618
#define LINE_HYDROGEN_F_NM 486.1327
#define LINE_HYDROGEN_C_NM 656.2725
#define LINE_SODIUM_D_NM 589.3

/* The visible range, over which a law must give an index. */
#define VISIBLE_LOW_NM 380.0
#define VISIBLE_HIGH_NM 780.0

/* The formula of each kind; after the semicolon, the order of its coefficients. */
typedef enum dispersion_kind {
    DISPERSION_CONSTANT,          /* n = a; a */
    DISPERSION_SELLMEIER,         /* n^2 = 1 + sum B L^2 / (L^2 - C), C in um^2; B C B C ... */
    DISPERSION_SELLMEIER_LENGTHS, /* n^2 = 1 + sum B L^2 / (L^2 - C^2), C in um; B C B C ... */
    DISPERSION_POLYNOMIAL,        /* n^2 = a0 + sum a L^p; a0 a p a p ... */
    DISPERSION_CAUCHY_POWERS,     /* n = a0 + sum a L^p; a0 a p a p ... */
    DISPERSION_CAUCHY,            /* n = A + B / L^2 + C / L^4 + ...; A B C ... */
    DISPERSION_GAS,               /* n - 1 = sum B / (C - L^-2), both in um^-2; B C B C ... */
    DISPERSION_TABLE,             /* linear, constant beyond the ends; lambda_nm n lambda_nm n ... */
    DISPERSION_CURVE,             /* the same by curve_at */
    DISPERSION_SELLMEIER_FROM,    /* n^2 = 1 + a0 + sum B L^2 / (L^2 - C), C in um^2; a0 B C B C ... */
    DISPERSION_GAS_FROM,          /* n - 1 = a0 + sum B / (C - L^-2), both in um^-2; a0 B C B C ... */
    DISPERSION_TWO_RESONANCES,    /* n^2 = a0 + two of a L^p / (L^2 - b^q) + sum a L^p; a0 a p b q a p b q a p ... */
    DISPERSION_HERZBERGER,        /* n = A + B M + C M^2 + D L^2 + E L^4 + F L^6, M = 1 / (L^2 - 0.028); A B C ... */
    DISPERSION_RETRO,             /* (n^2 - 1) / (n^2 + 2) = a0 + a1 L^2 / (L^2 - a2) + a3 L^2; a0 a1 a2 a3 */
    DISPERSION_EXOTIC             /* n^2 = a0 + a1 / (L^2 - a2) + a3 (L - a4) / ((L - a4)^2 + a5); a0 ... a5 */
} dispersion_kind;

enum { DISPERSION_KIND_COUNT = DISPERSION_EXOTIC + 1, DISPERSION_TERMS_MAX = 32, DISPERSION_POWER_MAX = 16 };

typedef struct dispersion {
    dispersion_kind kind;
    int count; /* number of coefficients */
    double coefficient[DISPERSION_TERMS_MAX];
    double low_nm, high_nm; /* range of the measurement; both 0: not stated */
} dispersion;

/* "constant", "sellmeier", "sellmeier-lengths", ...; and the formula as text. */
const char *dispersion_name(dispersion_kind kind);
const char *dispersion_formula(dispersion_kind kind);

/* The index at a wavelength above 0, also outside the range of the measurement. Identical bits on every platform. */
double dispersion_index(const dispersion *law, double lambda_nm);

/* Checks a law: the number of coefficients for its kind, all finite, powers at most 16, a table ascending, no resonance
 * in the visible, and an index from 0.1 to 100 there at each integer nanometre. STATUS_BAD_INPUT otherwise. */
status dispersion_check(const dispersion *law, diagnostic *why);
/* The first part of it, what does not depend on the wavelengths: the number of coefficients, and that they, the powers
 * and the range are valid. */
status dispersion_check_numbers(const dispersion *law, diagnostic *why);
/* For a law that passes this and states its range: its index is above 0 and at most 100 there, without a resonance. */
status dispersion_check_range(const dispersion *law, diagnostic *why);

/* Whether the law was measured over all of low_nm..high_nm. If no range is stated, a table covers its wavelengths and a
 * formula everything. */
bool dispersion_covers(const dispersion *law, double low_nm, double high_nm);

/* Abbe number V_d = (n_d - 1) / (n_F - n_C); infinite for a law without dispersion between F and C. */
double dispersion_abbe_number(const dispersion *law);

/* A function of the wavelength by its values at some: a cubic between each two, and constant beyond the first and the
 * last. Its slope at a point is that of the parabola through the point and its neighbours, limited so that the curve
 * is monotone wherever the values are (de Boor and Swartz, Piecewise monotone interpolation, J. Approx. Theory 21, 411
 * (1977)): it never leaves the range of its two values. point: count >= 1 pairs x0 y0 x1 y1 ..., ascending in x. */
double curve_at(const double *point, size_t count, double x);
