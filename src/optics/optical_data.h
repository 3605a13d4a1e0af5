/* Measured data of a medium, a surface or a lamp by wavelength, as a file has them: a dispersion law or a curve of the
 * refractive index and a curve of the extinction index; or one curve of any other quantity. Beyond its range each keeps
 * the value of its end. Ownership: counted references (optical_data_retain, optical_data_release); the data do not
 * change, and threads may share them. Wavelengths are in nm. */
#pragma once

#include "base/pack.h"
#include "optics/dispersion.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct optical_data optical_data;

/* Points of a curve (curve_at, optics/dispersion.h): pairs of a wavelength and a value. */
typedef struct optical_curve {
    const double *point; /* NULL: none */
    size_t count;
} optical_curve;

/* The first curve is n, or the quantity; a law of n replaces it. The second is k, the extinction index of n + i k, not
 * negative. All is copied. law: passes dispersion_check_numbers and states its range; NULL: none.
 * STATUS_BAD_INPUT, without a file: there is neither a law nor a first curve and no second one, wavelengths are not
 * above 0 and ascending, values are not finite, k is below 0, or a law gives no index above 0 somewhere in its
 * range. */
status optical_data_create(const dispersion *law, optical_curve first, optical_curve second, const optical_data **out,
                           diagnostic *why);
void optical_data_retain(const optical_data *d);
void optical_data_release(const optical_data *d); /* NULL is allowed */

/* Whether the first curve, or a law, is there; and the range of its wavelengths. */
bool optical_data_has_first(const optical_data *d);
void optical_data_range(const optical_data *d, double *low_nm, double *high_nm);
/* Whether k is there and above 0 somewhere. */
bool optical_data_has_k(const optical_data *d);

/* The law of n, or NULL; and the number of points of the first curve and of k. */
const dispersion *optical_data_law(const optical_data *d);
size_t optical_data_points(const optical_data *d, bool of_k);

/* n, or the quantity; requires optical_data_has_first. */
double optical_data_at(const optical_data *d, double lambda_nm);
/* k; 0 if there is none. */
double optical_data_k(const optical_data *d, double lambda_nm);
/* The least and the largest value of the points of the first curve; of a law at the ends of its range. */
void optical_data_extremes(const optical_data *d, double *least, double *most);

/* The same as spectra of optics/spectrum.h; the context is the data. A reflectance or transmittance: from 0 to 1. An
 * emission: 0 beyond the range, and not negative. An absorption coefficient: not negative. */
double optical_data_fraction(const void *d, double lambda_nm);
double optical_data_emission(const void *d, double lambda_nm);
double optical_data_coefficient(const void *d, double lambda_nm);
/* The colour of a surface of this reflectance in daylight (D65), in linear sRGB within the gamut; a constant has its
 * value in all channels. */
void optical_data_rgb(const optical_data *d, double rgb[3]);

uint64_t optical_data_hash(const optical_data *d, uint64_t hash);
status optical_data_pack(const optical_data *d, pack_writer *to, diagnostic *why);
status optical_data_unpack(pack_reader *from, const optical_data **out, diagnostic *why);
