/* The catalogue of metals: complex refractive indices n + i k (the n and k of n - i k) over the visible range, as
 * published tables, linear between their points. Relative to vacuum. Ownership: all data are constant. Errors: none; an
 * unknown name gives NULL. */
#pragma once

#include "base/complex_pair.h"
#include "optics/dispersion.h"

/* The names in the catalogue's order, for use as words. */
#define METAL_NAMES(X) \
    X("silver")        \
    X("gold")          \
    X("copper")        \
    X("aluminium")

typedef struct metal {
    const char *name;     /* "gold" */
    const char *title;    /* what was measured */
    dispersion n, k;      /* tables with the same wavelengths */
    const char *source;   /* who measured or published it */
    const char *verified; /* what the numbers were compared with */
    const char *note;     /* limits of the data; "" for none */
} metal;

size_t metals_count(void);
const metal *metals_at(size_t i); /* i < metals_count() */
const metal *metals_find(const char *name);

/* n + i k; outside the table that of its end. */
complex_pair metal_index(const metal *m, double lambda_nm);

/* Reflectance in vacuum at normal incidence. Hecht, Optics, 5th ed., (4.83). */
double metal_reflectance(const metal *m, double lambda_nm);
