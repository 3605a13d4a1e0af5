/* Catalogues of the refractive indices of media and metals, from published measurements. Each row states its source.
 * Ownership: all data are constant. Errors: none; an unknown name gives NULL. */
#pragma once

#include "optics/complex_pair.h"
#include "optics/dispersion.h"

/* ---- media ---- */

/* Refractive indices of a laboratory's liquids, glasses, plastics and crystals, by published dispersion laws, with
 * temperature and range of wavelengths. Refractometers and goniometers measure relative to the surrounding air, and
 * glass catalogues do the same: such a law is relative to air. medium_index is absolute (relative to vacuum) for all
 * media; air itself is a row. */

/* The media's names in the order of the catalogue: MEDIA_NAMES(X) expands X(name) for each, so that the scene's
 * parameters list the same names. */
#define MEDIA_NAMES(X) \
    X("air")           \
    X("water")         \
    X("ethanol")       \
    X("glycerol")      \
    X("toluene")       \
    X("olive-oil")     \
    X("bk7-liquid")    \
    X("fused-silica")  \
    X("bk7")           \
    X("sf11")          \
    X("n-sf11")        \
    X("soda-lime")     \
    X("pmma")          \
    X("sapphire")      \
    X("diamond")       \
    X("mgf2")          \
    X("alumina")       \
    X("hfo2")          \
    X("ta2o5")         \
    X("tio2")          \
    X("n-fk5")         \
    X("n-fk51a")       \
    X("n-fk58")        \
    X("n-pk51")        \
    X("n-psk53a")      \
    X("n-bk10")        \
    X("n-k5")          \
    X("k7")            \
    X("n-bak1")        \
    X("n-bak2")        \
    X("n-bak4")        \
    X("n-sk2")         \
    X("n-sk4")         \
    X("n-sk5")         \
    X("n-sk11")        \
    X("n-sk14")        \
    X("n-sk16")        \
    X("n-ssk2")        \
    X("n-ssk5")        \
    X("n-ssk8")        \
    X("n-balf4")       \
    X("n-baf4")        \
    X("n-baf10")       \
    X("n-lak8")        \
    X("n-lak9")        \
    X("n-lak10")       \
    X("n-lak14")       \
    X("n-lak21")       \
    X("n-lak22")       \
    X("n-lak33b")      \
    X("n-laf2")        \
    X("n-laf21")       \
    X("n-lasf31a")     \
    X("n-lasf40")      \
    X("n-lasf44")      \
    X("n-kzfs4")       \
    X("n-kzfs8")       \
    X("llf1")          \
    X("lf5")           \
    X("f2")            \
    X("n-f2")          \
    X("f5")            \
    X("n-sf1")         \
    X("sf2")           \
    X("n-sf2")         \
    X("sf4")           \
    X("n-sf4")         \
    X("sf5")           \
    X("n-sf5")         \
    X("sf6")           \
    X("n-sf6")         \
    X("n-sf8")         \
    X("sf10")          \
    X("n-sf10")        \
    X("n-sf15")        \
    X("n-sf57")        \
    X("n-sf66")

#define MEDIA_ONE(name) +1
enum { MEDIA_COUNT = 0 MEDIA_NAMES(MEDIA_ONE) };

typedef struct medium {
    const char *name;     /* "fused-silica" */
    const char *title;    /* "fused silica" */
    dispersion law;       /* as published */
    bool relative_to_air; /* the law is relative to air; else to vacuum */
    double temperature_c; /* of the medium; NaN: at room temperature */
    const char *source;   /* who measured or published it */
    const char *verified; /* what the coefficients were compared with */
    const char *note;     /* limits of the data; "" for none */
} medium;

size_t media_count(void);
const medium *media_at(size_t i); /* i < media_count() */
const medium *media_find(const char *name);

/* The catalogue's name, of a medium or a metal, for another that is in use: in any case of letters, the maker's
 * (N-BK7), or a common or chemical one (acrylic, SiO2). The given name if there is none. */
const char *media_usual_name(const char *name);

/* Index relative to vacuum. A law relative to air is multiplied by the index of dry air at 15 C and 101325 Pa; Ciddor,
 * Appl. Opt. 35, 1566 (1996). The warmer and moister air of a laboratory at sea level changes it by less than 4e-5. */
double medium_index(const medium *m, double lambda_nm);

/* ---- metals ---- */

/* Complex refractive indices n + i k (books that write n - i k have the same n and k) over the visible range, as
 * published tables, linear between their points. Relative to vacuum. */

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

/* n + i k; beyond an end of the table, the value at that end. */
complex_pair metal_index(const metal *m, double lambda_nm);

/* Reflectance in vacuum at normal incidence. Hecht, Optics, 5th ed., (4.83). */
double metal_reflectance(const metal *m, double lambda_nm);
