/* The formulas of the dispersion laws, and the Abbe number. */
#include "optics/dispersion.h"
#include <math.h>

static const struct {
    const char *name, *formula;
} kinds[DISPERSION_KIND_COUNT] = {
    [DISPERSION_CONSTANT] = {"constant", "n = a"},
    [DISPERSION_SELLMEIER] = {"sellmeier", "n^2 = 1 + sum of B L^2 / (L^2 - C), L in um, C in um^2"},
    [DISPERSION_SELLMEIER_LENGTHS] = {"sellmeier-lengths", "n^2 = 1 + sum of B L^2 / (L^2 - C^2), L and C in um"},
    [DISPERSION_POLYNOMIAL] = {"polynomial", "n^2 = a0 + sum of a L^p, L in um"},
    [DISPERSION_CAUCHY_POWERS] = {"cauchy-powers", "n = a0 + sum of a L^p, L in um"},
    [DISPERSION_CAUCHY] = {"cauchy", "n = A + B / L^2 + C / L^4 + ..., L in um"},
    [DISPERSION_GAS] = {"gas", "n - 1 = sum of B / (C - L^-2), L in um, B and C in um^-2"},
    [DISPERSION_TABLE] = {"table", "linear between pairs of a wavelength in nm and its n"},
};

const char *dispersion_name(dispersion_kind kind)
{
    return kinds[kind].name;
}

const char *dispersion_formula(dispersion_kind kind)
{
    return kinds[kind].formula;
}

/* x^p for integer p, by multiplication: libm's pow may differ in the last place between platforms. */
static double whole_power(double x, double p)
{
    double result = 1.0;
    for (int left = (int)fabs(p); left > 0; left--)
        result *= x;
    return p < 0.0 ? 1.0 / result : result;
}

/* Sellmeier, Ann. Phys. 219, 272 (1871), in the form of glass catalogues. */
static double sellmeier_squared(const dispersion *law, double L2, bool lengths)
{
    double n2 = 1.0;
    for (int i = 0; i + 1 < law->count; i += 2) {
        const double B = law->coefficient[i], C = law->coefficient[i + 1];
        n2 += B * L2 / (L2 - (lengths ? C * C : C));
    }
    return n2;
}

static double power_sum(const dispersion *law, double L)
{
    double sum = law->coefficient[0];
    for (int i = 1; i + 1 < law->count; i += 2)
        sum += law->coefficient[i] * whole_power(L, law->coefficient[i + 1]);
    return sum;
}

/* By Horner's rule in 1 / L^2. */
static double cauchy(const dispersion *law, double L2)
{
    double n = 0.0;
    for (int i = law->count - 1; i >= 0; i--)
        n = n / L2 + law->coefficient[i];
    return n;
}

static double gas(const dispersion *law, double L2)
{
    double less_one = 0.0;
    for (int i = 0; i + 1 < law->count; i += 2)
        less_one += law->coefficient[i] / (law->coefficient[i + 1] - 1.0 / L2);
    return 1.0 + less_one;
}

static double table(const dispersion *law, double lambda_nm)
{
    const double *point = law->coefficient, *last = law->coefficient + law->count - 2;
    if (!(lambda_nm > point[0]))
        return point[1];
    while (point < last && lambda_nm >= point[2])
        point += 2;
    if (point == last)
        return last[1];
    const double share = (lambda_nm - point[0]) / (point[2] - point[0]);
    return point[1] * (1.0 - share) + point[3] * share;
}

double dispersion_index(const dispersion *law, double lambda_nm)
{
    const double L = lambda_nm / 1000.0, L2 = L * L;
    switch (law->kind) {
    case DISPERSION_CONSTANT: return law->coefficient[0];
    case DISPERSION_SELLMEIER: return sqrt(sellmeier_squared(law, L2, false));
    case DISPERSION_SELLMEIER_LENGTHS: return sqrt(sellmeier_squared(law, L2, true));
    case DISPERSION_POLYNOMIAL: return sqrt(power_sum(law, L));
    case DISPERSION_CAUCHY_POWERS: return power_sum(law, L);
    case DISPERSION_CAUCHY: return cauchy(law, L2);
    case DISPERSION_GAS: return gas(law, L2);
    case DISPERSION_TABLE: return table(law, lambda_nm);
    }
    return 1.0;
}

bool dispersion_covers(const dispersion *law, double low_nm, double high_nm)
{
    if (law->low_nm != 0.0 || law->high_nm != 0.0)
        return law->low_nm <= low_nm && high_nm <= law->high_nm;
    return law->kind != DISPERSION_TABLE ||
           (law->coefficient[0] <= low_nm && high_nm <= law->coefficient[law->count - 2]);
}

/* Abbe number; Born and Wolf, Principles of Optics, 7th ed., 4.7.1. */
double dispersion_abbe_number(const dispersion *law)
{
    const double n_d = dispersion_index(law, LINE_HELIUM_D_NM);
    const double spread = dispersion_index(law, LINE_HYDROGEN_F_NM) - dispersion_index(law, LINE_HYDROGEN_C_NM);
    return spread != 0.0 ? (n_d - 1.0) / spread : (double)INFINITY;
}
