/* Lamps that emit lines, in a spectral film: a line falls on one of the film's wavelengths, which evenly spaced ones
 * would meet once in thousands. Where there are such lamps, half of a pixel's wavelengths are drawn from the lines, by
 * the brightness of each, or all if nothing in the scene emits other light. The observer's weights are divided by the
 * density, so that the mean stays the same (importance sampling with one sample from a mixture, Veach, Robust Monte
 * Carlo Methods for Light Transport Simulation, 1997, section 9.2.4). The density is exact, not only on average: each
 * line has a whole number of LINE_SLOTS, which divides the number of offsets. Plain values; nothing fails. */
#pragma once

#include "scene/model/scene.h"

/* At most as many different lines, which check.c ensures. */
enum { LINE_SLOTS = 128 };

typedef struct line_table {
    int count;                /* of different lines; 0: no lamp emits lines */
    bool alone;               /* nothing emits other light */
    int16_t slot[LINE_SLOTS]; /* wavelength numbers, in order */
} line_table;

/* The lines of a lamp. bright: how much the line adds to a film, X + Y + Z, by which lines are chosen. */
typedef struct lamp_line {
    int wavelength;  /* its number */
    double radiance; /* there; the mean over all SPECTRA_COUNT wavelengths is their share of it */
    double bright;
} lamp_line;
int spectral_lines_of(const light *l, lamp_line lines[LAMP_LINES_MAX]);

line_table line_table_of(const scene *s);

/* The wavelength number for a number u in [0, 1), in a scene with lines; *of_line: whether it is drawn from these. */
int64_t line_table_choose(const line_table *t, double u, bool *of_line);

/* The density of that choice at a wavelength over that of an even one; 1 without lines. */
double line_table_density(const line_table *t, int64_t wavelength);
