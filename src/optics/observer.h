/* The standard observer and daylight: the colour of a spectrum. The CIE 1931 standard observer (2 degrees; CIE 15:2018
 * and ISO/CIE 11664-1) and the CIE standard illuminant D65 (ISO/CIE 11664-2), both tabulated at 5 nm from 360 to 830 nm
 * and interpolated linearly, as CIE 15 allows; both are 0 outside. Wavelengths are in nm, in air (in vacuum they are
 * 0.03% longer; the difference is ignored here). A spectrum is sampled from OBSERVER_LOW_NM to OBSERVER_HIGH_NM: of D65
 * this omits 6e-5 of X, 3e-6 of Y and 2.2e-4 of Z. Every integral here is over that range, and exact for these tables
 * (their products are quadratic between entries), so that white stays exactly white. Radiance: a light of linear sRGB
 * (1, 1, 1) has the spectrum observer_d65 and Y = 1. Pure; cannot fail; only + - * / and sqrt. */
#pragma once

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
