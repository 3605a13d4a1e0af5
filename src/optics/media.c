/* The catalogues of media and of metals. */
#include "optics/media.h"

#include <assert.h>
#include <math.h>
#include <string.h>
#include <strings.h>

/* ---- media ---- */

/* Compared with https://github.com/polyanskiy/refractiveindex.info-database (CC0), at commit ff11b58. */
#define IN_DATABASE(path) "refractiveindex.info, " path
#define AND_AS_QUOTED "; also as the literature quotes the original"
#define AIR_ASSUMED \
    "The source states no reference; assumed relative to air, in which refractometers and prisms are used."

static const medium medium_rows[] = {
    {.name = "air",
     .title = "dry air, 15 C, 101325 Pa, 450 ppm CO2",
     .law = {DISPERSION_GAS, 4, {0.05792105, 238.0185, 0.00167917, 57.362}, 230.0, 1690.0},
     .temperature_c = 15.0,
     .source = "Ciddor, Appl. Opt. 35, 1566 (1996)",
     .verified = IN_DATABASE("other/mixed gases/air/nk/Ciddor.yml") AND_AS_QUOTED,
     .note = ""},
    {.name = "water",
     .title = "distilled water",
     .law = {DISPERSION_SELLMEIER,
             8,
             {0.5684027565, 0.005101829712, 0.1726177391, 0.01821153936, 0.02086189578, 0.02620722293, 0.1130748688,
              10.69792721},
             182.0,
             1129.0},
     .temperature_c = 20.0,
     .source = "Daimon and Masumura, Appl. Opt. 46, 3811 (2007)",
     .verified = IN_DATABASE("main/H2O/nk/Daimon-20.0C.yml") AND_AS_QUOTED,
     .note = "Tables that give n_d = 1.3330 are relative to air; this law is relative to vacuum."},
    {.name = "ethanol",
     .title = "ethanol",
     .law = {DISPERSION_CAUCHY_POWERS, 5, {1.35265, 0.00306, -2.0, 0.00002, -4.0}, 476.5, 830.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Rheims, Koeser and Wriedt, Meas. Sci. Technol. 8, 601 (1997)",
     .verified = IN_DATABASE("organic/C2H6O - ethanol/nk/Rheims.yml"),
     .note = "Abbe refractometer. " AIR_ASSUMED},
    {.name = "glycerol",
     .title = "glycerol",
     .law = {DISPERSION_CAUCHY_POWERS, 5, {1.45797, 0.00598, -2.0, -0.00036, -4.0}, 589.3, 1050.0},
     .relative_to_air = true,
     .temperature_c = 25.0,
     .source = "Rheims, Koeser and Wriedt, Meas. Sci. Technol. 8, 601 (1997)",
     .verified = IN_DATABASE("organic/C3H8O3 - glycerol/nk/Rheims.yml"),
     .note = "Measured from 589.3 nm upwards; extrapolated below, at d and F too. Abbe refractometer. " AIR_ASSUMED},
    {.name = "toluene",
     .title = "toluene",
     .law = {DISPERSION_POLYNOMIAL,
             9,
             {2.161659124, 0.000495188, 2.0, 0.02138179, -2.0, 0.000058838, -4.0, 0.000087632, -6.0},
             450.0,
             1551.0},
     .relative_to_air = true,
     .temperature_c = 27.0,
     .source = "Moutzouris et al., Appl. Phys. B 116, 617 (2013)",
     .verified = IN_DATABASE("organic/C7H8 - toluene/nk/Moutzouris.yml"),
     .note = AIR_ASSUMED},
    {.name = "olive-oil",
     .title = "olive oil, at the sodium D line only",
     .law = {DISPERSION_CONSTANT, 1, {1.4691}, 589.3, 589.3},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Codex Alimentarius, CXS 33",
     .verified = "not verified",
     .note = "The middle of the range 1.4677 to 1.4705 that the standard allows at 589.3 nm. No reliable "
             "dispersion law was found; the index is constant, so do not use it to study colours."},
    {.name = "bk7-liquid",
     .title = "index-matching liquid for BK7",
     .law = {DISPERSION_CAUCHY_POWERS, 5, {1.502639, 0.0047089420, -2.0, 0.000063670450, -4.0}, 350.0, 1550.0},
     .relative_to_air = true,
     .temperature_c = 25.0,
     .source = "Cargille, data sheet BK-7 Matching Liquid, 27 March 2023",
     .verified = IN_DATABASE("specs/cargille/index-matching liquids/nk/BK7_matching_liquid.yml"),
     .note = "Its dispersion curve crosses the curve of bk7 near the d line and is steeper. " AIR_ASSUMED},
    {.name = "fused-silica",
     .title = "fused silica",
     .law = {DISPERSION_SELLMEIER_LENGTHS,
             6,
             {0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161},
             210.0,
             3710.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Malitson, J. Opt. Soc. Am. 55, 1205 (1965)",
     .verified = IN_DATABASE("main/SiO2/nk/Malitson.yml") AND_AS_QUOTED,
     .note = ""},
    {.name = "bk7",
     .title = "Schott N-BK7, a borosilicate crown",
     .law = {DISPERSION_SELLMEIER,
             6,
             {1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653},
             300.0,
             2500.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Schott, optical glass catalogue, 20 January 2017",
     .verified = IN_DATABASE("specs/schott/optical/N-BK7.yml") AND_AS_QUOTED,
     .note = ""},
    {.name = "sf11",
     .title = "Schott SF11, a lead flint",
     .law = {DISPERSION_SELLMEIER,
             6,
             {1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711},
             390.0,
             2500.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Schott, optical glass catalogue, 20 January 2017",
     .verified = IN_DATABASE("specs/schott/optical/SF11.yml"),
     .note = ""},
    {.name = "n-sf11",
     .title = "Schott N-SF11, a flint without lead",
     .law = {DISPERSION_SELLMEIER,
             6,
             {1.73759695, 0.013188707, 0.313747346, 0.0623068142, 1.89878101, 155.23629},
             370.0,
             2500.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Schott, optical glass catalogue, 20 January 2017",
     .verified = IN_DATABASE("specs/schott/optical/N-SF11.yml") AND_AS_QUOTED,
     .note = ""},
    {.name = "soda-lime",
     .title = "soda-lime float glass, clear",
     .law = {DISPERSION_CAUCHY_POWERS, 5, {1.5130, -0.003169, 2.0, 0.003962, -2.0}, 310.0, 4600.0},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Rubin, Sol. Energy Mater. 12, 275 (1985)",
     .verified = IN_DATABASE("glass/misc/soda-lime/nk/Rubin-clear.yml"),
     .note = "The index of window glass varies by about 0.005 from batch to batch. " AIR_ASSUMED},
    {.name = "pmma",
     .title = "poly(methyl methacrylate), acrylic glass",
     .law = {DISPERSION_POLYNOMIAL,
             13,
             {2.1778, 0.0061209, 2.0, -0.0015004, 4.0, 0.023678, -2.0, -0.0042137, -4.0, 0.00073417, -6.0, -0.000045042,
              -8.0},
             420.0,
             1620.0},
     .relative_to_air = true,
     .temperature_c = 20.1,
     .source = "Beadie et al., Appl. Opt. 54, F139 (2015)",
     .verified = IN_DATABASE("organic/(C5H8O2)n - poly(methyl methacrylate)/nk/Beadie.yml"),
     .note = "Its authors state an accuracy of 2e-4. " AIR_ASSUMED},
    {.name = "sapphire",
     .title = "sapphire, ordinary ray",
     .law = {DISPERSION_SELLMEIER_LENGTHS,
             6,
             {1.4313493, 0.0726631, 0.65054713, 0.1193242, 5.3414021, 18.028251},
             200.0,
             5000.0},
     .relative_to_air = true,
     .temperature_c = 20.0,
     .source = "Malitson and Dodge, J. Opt. Soc. Am. 62, 1405 (1972); Dodge, CRC Handbook of Laser Science IV (1986)",
     .verified = IN_DATABASE("main/Al2O3/nk/Malitson-o.yml") AND_AS_QUOTED,
     .note = "Birefringent: the extraordinary ray's index is 0.008 lower. " AIR_ASSUMED},
    {.name = "diamond",
     .title = "diamond",
     .law = {DISPERSION_SELLMEIER_LENGTHS, 4, {0.3306, 0.1750, 4.3356, 0.1060}, 226.0, 760.0},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Peter, Z. Phys. 15, 358 (1923)",
     .verified = IN_DATABASE("main/C/nk/Peter.yml") AND_AS_QUOTED,
     .note = AIR_ASSUMED},
    {.name = "mgf2",
     .title = "magnesium fluoride, ordinary ray",
     .law = {DISPERSION_SELLMEIER_LENGTHS,
             6,
             {0.48755108, 0.04338408, 0.39875031, 0.09461442, 2.3120353, 23.793604},
             200.0,
             7000.0},
     .relative_to_air = true,
     .temperature_c = 19.0,
     .source = "Dodge, Appl. Opt. 23, 1980 (1984)",
     .verified = IN_DATABASE("main/MgF2/nk/Dodge-o.yml"),
     .note =
         "Birefringent: the extraordinary ray's index is 0.012 higher. Films are a little less dense. " AIR_ASSUMED},
    {.name = "alumina",
     .title = "aluminium oxide, amorphous film",
     .law = {DISPERSION_CURVE,
             32,
             {380,     1.70652, 400,     1.70185, 420,     1.69791, 440,     1.69454, 460,     1.69164, 480,
              1.68912, 500,     1.68691, 520,     1.68496, 560,     1.68169, 580,     1.68031, 620,     1.67792,
              640,     1.67689, 680,     1.67507, 700,     1.67427, 740,     1.67283, 780,     1.67158},
             380.0,
             780.0},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Boidin et al., Ceram. Int. 42, 1177 (2016)",
     .verified = IN_DATABASE("main/Al2O3/nk/Boidin.yml"),
     .note = "A film by pulsed laser deposition; other films have indices from 1.60 to 1.70. " AIR_ASSUMED},
    {.name = "hfo2",
     .title = "hafnium oxide, evaporated film",
     .law = {DISPERSION_CAUCHY_POWERS, 5, {1.875, 0.00628, -2.0, 0.00058, -4.0}, 200.0, 2000.0},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Al-Kuhaili, Opt. Mater. 27, 383 (2004)",
     .verified = IN_DATABASE("main/HfO2/nk/Al-Kuhaili.yml"),
     .note = AIR_ASSUMED},
    {.name = "ta2o5",
     .title = "tantalum pentoxide, film by ion-assisted evaporation",
     .law = {DISPERSION_CURVE,
             32,
             {380,     2.27042, 400,     2.2469,  420,     2.22762, 440,     2.21159, 460,    2.19809, 480,
              2.18659, 500,     2.17671, 530,     2.16427, 560,     2.15408, 590,     2.1456, 620,     2.13847,
              650,     2.13241, 680,     2.12721, 710,     2.12272, 740,     2.11881, 780,    2.11433},
             380.0,
             780.0},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Gao, Lemarchand and Lequime, Opt. Express 20, 15734 (2012)",
     .verified = IN_DATABASE("main/Ta2O5/nk/Gao.yml"),
     .note = "Its absorption, k below 0.0005, is left out. " AIR_ASSUMED},
    {.name = "tio2",
     .title = "titanium dioxide, film by atomic layer deposition",
     .law = {DISPERSION_CURVE,
             32,
             {380.046, 2.77341, 388.899, 2.72753, 400.255, 2.68012, 414.32,  2.63361, 428.881, 2.5952,  449.093,
              2.55298, 470.258, 2.51832, 500.998, 2.47961, 530.684, 2.45108, 558.903, 2.42952, 588.622, 2.41105,
              619.921, 2.39511, 649.137, 2.38269, 691.57,  2.36786, 728.344, 2.35733, 780.434, 2.34515},
             380.046,
             780.434},
     .relative_to_air = true,
     .temperature_c = NAN,
     .source = "Siefke et al., Adv. Opt. Mater. 4, 1780 (2016)",
     .verified = IN_DATABASE("main/TiO2/nk/Siefke.yml"),
     .note = "Its absorption, k below 0.001 above 395 nm and 0.004 at 380 nm, is left out. " AIR_ASSUMED},
};

static_assert(sizeof medium_rows / sizeof medium_rows[0] == MEDIA_COUNT, "MEDIA_NAMES is the catalogue's first column");

size_t media_count(void)
{
    return sizeof medium_rows / sizeof medium_rows[0];
}

const medium *media_at(size_t i)
{
    return &medium_rows[i];
}

const medium *media_find(const char *name)
{
    for (size_t i = 0; i < media_count(); i++)
        if (strcmp(medium_rows[i].name, name) == 0)
            return &medium_rows[i];
    return NULL;
}

const char *media_usual_name(const char *name)
{
    static const char *const others[][2] = {{"n-bk7", "bk7"},
                                            {"schott n-bk7", "bk7"},
                                            {"silica", "fused-silica"},
                                            {"sio2", "fused-silica"},
                                            {"tantala", "ta2o5"},
                                            {"titania", "tio2"},
                                            {"hafnia", "hfo2"},
                                            {"acrylic", "pmma"},
                                            {"plexiglas", "pmma"},
                                            {"plexiglass", "pmma"},
                                            {"glycerine", "glycerol"},
                                            {"glycerin", "glycerol"},
                                            {"h2o", "water"},
                                            {"window-glass", "soda-lime"},
                                            {"float-glass", "soda-lime"},
                                            {"al2o3", "sapphire"},
                                            {"ag", "silver"},
                                            {"au", "gold"},
                                            {"cu", "copper"},
                                            {"al", "aluminium"},
                                            {"aluminum", "aluminium"}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcasecmp(name, others[i][0]) == 0)
            return others[i][1];
    for (size_t i = 0; i < media_count(); i++)
        if (strcasecmp(name, media_at(i)->name) == 0)
            return media_at(i)->name;
    for (size_t i = 0; i < metals_count(); i++)
        if (strcasecmp(name, metals_at(i)->name) == 0)
            return metals_at(i)->name;
    return name;
}

double medium_index(const medium *m, double lambda_nm)
{
    const double n = dispersion_index(&m->law, lambda_nm);
    return m->relative_to_air ? n * dispersion_index(&medium_rows[0].law, lambda_nm) : n;
}

/* ---- metals ---- */

/* Wavelengths per table; those of Johnson and Christy are at the photon energies 3.37 .. 1.51 eV. */
enum { JOHNSON_POINTS = 16, RAKIC_POINTS = 13 };

#define IN_MAIN(path) "refractiveindex.info, main/" path " at commit ff11b58"
#define JOHNSON "Johnson and Christy, Phys. Rev. B 6, 4370 (1972)"
#define TABLE(points, ...)                                      \
    {                                                           \
        DISPERSION_TABLE, 2 * (points), {__VA_ARGS__}, 0.0, 0.0 \
    }

static const metal metal_rows[] = {
    {.name = "silver",
     .title = "silver, evaporated film",
     .n = TABLE(JOHNSON_POINTS, 367.9, 0.07, 381.5, 0.05, 397.4, 0.05, 413.3, 0.05, 430.5, 0.04, 450.9, 0.04, 471.4,
                0.05, 495.9, 0.05, 520.9, 0.05, 548.6, 0.06, 582.1, 0.05, 616.8, 0.06, 659.5, 0.05, 704.5, 0.04, 756.0,
                0.03, 821.1, 0.04),
     .k = TABLE(JOHNSON_POINTS, 367.9, 1.657, 381.5, 1.864, 397.4, 2.070, 413.3, 2.275, 430.5, 2.462, 450.9, 2.657,
                471.4, 2.869, 495.9, 3.093, 520.9, 3.324, 548.6, 3.586, 582.1, 3.858, 616.8, 4.152, 659.5, 4.483, 704.5,
                4.838, 756.0, 5.242, 821.1, 5.727),
     .source = JOHNSON,
     .verified = IN_MAIN("Ag/nk/Johnson.yml"),
     .note = "n is given to 0.01, and so R to 0.003. Silver in air tarnishes."},
    {.name = "gold",
     .title = "gold, evaporated film",
     .n = TABLE(JOHNSON_POINTS, 367.9, 1.48, 381.5, 1.46, 397.4, 1.47, 413.3, 1.46, 430.5, 1.45, 450.9, 1.38, 471.4,
                1.31, 495.9, 1.04, 520.9, 0.62, 548.6, 0.43, 582.1, 0.29, 616.8, 0.21, 659.5, 0.14, 704.5, 0.13, 756.0,
                0.14, 821.1, 0.16),
     .k = TABLE(JOHNSON_POINTS, 367.9, 1.895, 381.5, 1.933, 397.4, 1.952, 413.3, 1.958, 430.5, 1.948, 450.9, 1.914,
                471.4, 1.849, 495.9, 1.833, 520.9, 2.081, 548.6, 2.455, 582.1, 2.863, 616.8, 3.272, 659.5, 3.697, 704.5,
                4.103, 756.0, 4.542, 821.1, 5.083),
     .source = JOHNSON,
     .verified = IN_MAIN("Au/nk/Johnson.yml"),
     .note = ""},
    {.name = "copper",
     .title = "copper, evaporated film",
     .n = TABLE(JOHNSON_POINTS, 367.9, 1.36, 381.5, 1.33, 397.4, 1.32, 413.3, 1.28, 430.5, 1.25, 450.9, 1.24, 471.4,
                1.25, 495.9, 1.22, 520.9, 1.18, 548.6, 1.02, 582.1, 0.70, 616.8, 0.30, 659.5, 0.22, 704.5, 0.21, 756.0,
                0.24, 821.1, 0.26),
     .k = TABLE(JOHNSON_POINTS, 367.9, 1.975, 381.5, 2.045, 397.4, 2.116, 413.3, 2.207, 430.5, 2.305, 450.9, 2.397,
                471.4, 2.483, 495.9, 2.564, 520.9, 2.608, 548.6, 2.577, 582.1, 2.704, 616.8, 3.205, 659.5, 3.747, 704.5,
                4.205, 756.0, 4.665, 821.1, 5.180),
     .source = JOHNSON,
     .verified = IN_MAIN("Cu/nk/Johnson.yml"),
     .note = "Without oxide: copper in air darkens."},
    {.name = "aluminium",
     .title = "aluminium without oxide",
     .n = TABLE(RAKIC_POINTS, 364.66, 0.39877, 413.28, 0.52135, 442.80, 0.60790, 476.87, 0.72780, 516.60, 0.87340,
                563.57, 1.0728, 619.93, 1.3660, 652.25, 1.5724, 688.81, 1.8301, 729.32, 2.1606, 774.91, 2.6154, 794.78,
                2.7675, 815.69, 2.7668),
     .k = TABLE(RAKIC_POINTS, 364.66, 4.3957, 413.28, 5.0008, 442.80, 5.3676, 476.87, 5.7781, 516.60, 6.2418, 563.57,
                6.7839, 619.93, 7.4052, 652.25, 7.7354, 688.81, 8.0601, 729.32, 8.3565, 774.91, 8.4914, 794.78, 8.3866,
                815.69, 8.2573),
     .source = "Rakic, Appl. Opt. 34, 4755 (1995)",
     .verified = IN_MAIN("Al/nk/Rakic.yml"),
     .note =
         "Derived from many layers by Kramers-Kronig analysis. In air an oxide layer of some nanometres covers it."},
};

#define ONE(name) +1
static_assert(sizeof metal_rows / sizeof metal_rows[0] == 0 METAL_NAMES(ONE),
              "METAL_NAMES is the catalogue's first column");
#undef ONE

size_t metals_count(void)
{
    return sizeof metal_rows / sizeof metal_rows[0];
}

const metal *metals_at(size_t i)
{
    return &metal_rows[i];
}

const metal *metals_find(const char *name)
{
    for (size_t i = 0; i < metals_count(); i++)
        if (strcmp(metal_rows[i].name, name) == 0)
            return &metal_rows[i];
    return NULL;
}

complex_pair metal_index(const metal *m, double lambda_nm)
{
    return complex_of(dispersion_index(&m->n, lambda_nm), dispersion_index(&m->k, lambda_nm));
}

double metal_reflectance(const metal *m, double lambda_nm)
{
    const complex_pair i = metal_index(m, lambda_nm), one = complex_of(1.0, 0.0);
    return complex_norm2(complex_sub(i, one)) / complex_norm2(complex_add(i, one));
}
