/* The catalogue of metals (media.h). */
#include "optics/media.h"

#include <assert.h>
#include <string.h>

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
