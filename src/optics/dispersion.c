/* The formulas of the dispersion laws, the Abbe number, and the check of a law. */
#include "optics/dispersion.h"

#include "base/elementary.h"
#include "base/number.h"
#include <math.h>
#include <stdio.h>

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
    [DISPERSION_CURVE] = {"curve", "a monotone cubic through pairs of a wavelength in nm and its n"},
    [DISPERSION_SELLMEIER_FROM] = {"sellmeier-from", "n^2 = 1 + a0 + sum of B L^2 / (L^2 - C), L in um, C in um^2"},
    [DISPERSION_GAS_FROM] = {"gas-from", "n - 1 = a0 + sum of B / (C - L^-2), L in um, B and C in um^-2"},
    [DISPERSION_TWO_RESONANCES] = {"two-resonances", "n^2 = a0 + two of a L^p / (L^2 - b^q) + sum of a L^p, L in um"},
    [DISPERSION_HERZBERGER] = {"herzberger",
                               "n = A + B M + C M^2 + D L^2 + E L^4 + F L^6, M = 1 / (L^2 - 0.028), L in um"},
    [DISPERSION_RETRO] = {"retro", "(n^2 - 1) / (n^2 + 2) = a0 + a1 L^2 / (L^2 - a2) + a3 L^2, L in um"},
    [DISPERSION_EXOTIC] = {"exotic", "n^2 = a0 + a1 / (L^2 - a2) + a3 (L - a4) / ((L - a4)^2 + a5), L in um"},
};

const char *dispersion_name(dispersion_kind kind)
{
    return kinds[kind].name;
}

const char *dispersion_formula(dispersion_kind kind)
{
    return kinds[kind].formula;
}

/* x^p: libm's pow may differ in the last place between platforms; an integer p is exact, by multiplication. x > 0. */
static double power(double x, double p)
{
    double result = 1.0;
    if (p != floor(p))
        return elementary_pow(x, p);
    for (int left = (int)fabs(p); left > 0; left--)
        result *= x;
    return p < 0.0 ? 1.0 / result : result;
}

/* Sellmeier, Ann. Phys. 219, 272 (1871), in the form of glass catalogues. */
static double sellmeier_squared(const dispersion *law, double L2, bool lengths, double from)
{
    double n2 = 1.0 + from;
    for (int i = law->count % 2; i + 1 < law->count; i += 2) {
        const double B = law->coefficient[i], C = law->coefficient[i + 1];
        n2 += B * L2 / (L2 - (lengths ? C * C : C));
    }
    return n2;
}

static double power_sum(const dispersion *law, double L)
{
    double sum = law->coefficient[0];
    for (int i = 1; i + 1 < law->count; i += 2)
        sum += law->coefficient[i] * power(L, law->coefficient[i + 1]);
    return sum;
}

/* Horner's rule in 1 / L^2. */
static double cauchy(const dispersion *law, double L2)
{
    double n = 0.0;
    for (int i = law->count - 1; i >= 0; i--)
        n = n / L2 + law->coefficient[i];
    return n;
}

static double gas(const dispersion *law, double L2, double from)
{
    double less_one = from;
    for (int i = law->count % 2; i + 1 < law->count; i += 2)
        less_one += law->coefficient[i] / (law->coefficient[i + 1] - 1.0 / L2);
    return 1.0 + less_one;
}

/* Formulas 4, 7, 8 and 9 of M. N. Polyanskiy, "Refractiveindex.info database of optical constants", Sci. Data 11, 94
 * (2024); a glass catalogue's formulas are special cases (scene/data/optical_files.c). */
static double two_resonances(const dispersion *law, double L)
{
    const double *a = law->coefficient;
    double n2 = a[0];
    for (int i = 1; i + 3 < law->count && i < 9; i += 4)
        if (a[i] != 0.0)
            n2 += a[i] * power(L, a[i + 1]) / (L * L - (a[i + 2] != 0.0 ? power(a[i + 2], a[i + 3]) : 0.0));
    for (int i = 9; i + 1 < law->count; i += 2)
        n2 += a[i] * power(L, a[i + 1]);
    return n2;
}

static double herzberger(const double *a, double L2)
{
    const double M = 1.0 / (L2 - 0.028);
    return a[0] + a[1] * M + a[2] * M * M + a[3] * L2 + a[4] * L2 * L2 + a[5] * L2 * L2 * L2;
}

static double retro_squared(const double *a, double L2)
{
    const double q = a[0] + a[1] * L2 / (L2 - a[2]) + a[3] * L2;
    return (1.0 + 2.0 * q) / (1.0 - q);
}

static double exotic_squared(const double *a, double L)
{
    const double off = L - a[4];
    return a[0] + a[1] / (L * L - a[2]) + a[3] * off / (off * off + a[5]);
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
    const double part = (lambda_nm - point[0]) / (point[2] - point[0]);
    return point[1] * (1.0 - part) + point[3] * part;
}

/* --- a curve through points --- */

static double secant(const double *point, size_t i)
{
    return (point[2 * i + 3] - point[2 * i + 1]) / (point[2 * i + 2] - point[2 * i]);
}

/* The slope that keeps the sides with secants a and b monotone: of their sign and at most three times each; 0 where the
 * values turn. */
static double limited(double slope, double a, double b)
{
    const double most = 3.0 * fmin(fabs(a), fabs(b));
    if (!(a * b > 0.0))
        return 0.0;
    return a > 0.0 ? fmin(fmax(slope, 0.0), most) : fmax(fmin(slope, 0.0), -most);
}

static double slope_at(const double *point, size_t count, size_t i)
{
    if (count == 2)
        return secant(point, 0);
    const size_t left = i == 0 ? 0 : i == count - 1 ? count - 3 : i - 1; /* of the parabola's three points */
    const double a = secant(point, left), b = secant(point, left + 1),
                 bend = (b - a) / (point[2 * left + 4] - point[2 * left]);
    const double slope = a + bend * (2.0 * point[2 * i] - point[2 * left] - point[2 * left + 2]);
    if (i > 0 && i < count - 1)
        return limited(slope, a, b);
    const double last = i == 0 ? a : b;
    return limited(slope, last, last);
}

double curve_at(const double *point, size_t count, double x)
{
    size_t low = 0, high = count - 1;
    if (!(x > point[0]))
        return point[1];
    if (!(x < point[2 * high]))
        return point[2 * high + 1];
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        *(x < point[2 * middle] ? &high : &low) = middle;
    }
    const double *p = point + 2 * low, width = p[2] - p[0], t = (x - p[0]) / width, u = 1.0 - t;
    const double first = slope_at(point, count, low), last = slope_at(point, count, high);
    return u * u * ((1.0 + 2.0 * t) * p[1] + t * width * first) + t * t * ((1.0 + 2.0 * u) * p[3] - u * width * last);
}

/* --- laws --- */

double dispersion_index(const dispersion *law, double lambda_nm)
{
    const double L = lambda_nm / 1000.0, L2 = L * L;
    switch (law->kind) {
    case DISPERSION_CONSTANT: return law->coefficient[0];
    case DISPERSION_SELLMEIER: return sqrt(sellmeier_squared(law, L2, false, 0.0));
    case DISPERSION_SELLMEIER_FROM: return sqrt(sellmeier_squared(law, L2, false, law->coefficient[0]));
    case DISPERSION_SELLMEIER_LENGTHS: return sqrt(sellmeier_squared(law, L2, true, 0.0));
    case DISPERSION_POLYNOMIAL: return sqrt(power_sum(law, L));
    case DISPERSION_CAUCHY_POWERS: return power_sum(law, L);
    case DISPERSION_CAUCHY: return cauchy(law, L2);
    case DISPERSION_GAS: return gas(law, L2, 0.0);
    case DISPERSION_GAS_FROM: return gas(law, L2, law->coefficient[0]);
    case DISPERSION_TABLE: return table(law, lambda_nm);
    case DISPERSION_CURVE: return curve_at(law->coefficient, (size_t)law->count / 2, lambda_nm);
    case DISPERSION_TWO_RESONANCES: return sqrt(two_resonances(law, L));
    case DISPERSION_HERZBERGER: return herzberger(law->coefficient, L2);
    case DISPERSION_RETRO: return sqrt(retro_squared(law->coefficient, L2));
    case DISPERSION_EXOTIC: return sqrt(exotic_squared(law->coefficient, L));
    }
    return 1.0;
}

bool dispersion_covers(const dispersion *law, double low_nm, double high_nm)
{
    if (law->low_nm != 0.0 || law->high_nm != 0.0)
        return law->low_nm <= low_nm && high_nm <= law->high_nm;
    return (law->kind != DISPERSION_TABLE && law->kind != DISPERSION_CURVE) ||
           (law->coefficient[0] <= low_nm && high_nm <= law->coefficient[law->count - 2]);
}

/* Abbe number; Born and Wolf, Principles of Optics, 7th ed., 4.7.1. */
double dispersion_abbe_number(const dispersion *law)
{
    const double n_d = dispersion_index(law, LINE_HELIUM_D_NM);
    const double spread = dispersion_index(law, LINE_HYDROGEN_F_NM) - dispersion_index(law, LINE_HYDROGEN_C_NM);
    return spread != 0.0 ? (n_d - 1.0) / spread : (double)INFINITY;
}

/* ---- the check of a law ---- */

/* Real media have an index in this range at visible wavelengths; another one is a mistake in the coefficients. */
static const double index_low = 0.1, index_high = 100.0;

#define TABLE_REMEDY "give pairs of a wavelength in nm and an index from 0.1 to 100, by ascending wavelength"
/* The valid numbers of coefficients: from `first` in steps of `step`, up to `most`. */
static const struct {
    const char *remedy;
    int first, step, most;
} numbers[DISPERSION_KIND_COUNT] = {
    [DISPERSION_CONSTANT] = {"give one number, n, from 0.1 to 100", 1, 1, 1},
    [DISPERSION_SELLMEIER] = {"give pairs B C, with C in um^2", 2, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_SELLMEIER_LENGTHS] = {"give pairs B C, with C in um", 2, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_POLYNOMIAL] = {"give a0, then pairs of a coefficient and its power", 1, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_CAUCHY_POWERS] = {"give a0, then pairs of a coefficient and its power", 1, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_CAUCHY] = {"give A, then B in um^2, C in um^4 and so on", 1, 1, DISPERSION_TERMS_MAX},
    [DISPERSION_GAS] = {"give pairs B C, both in um^-2", 2, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_TABLE] = {TABLE_REMEDY, 2, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_CURVE] = {TABLE_REMEDY, 2, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_SELLMEIER_FROM] = {"give a0, then pairs B C, with C in um^2", 1, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_GAS_FROM] = {"give a0, then pairs B C, both in um^-2", 1, 2, DISPERSION_TERMS_MAX},
    [DISPERSION_TWO_RESONANCES] = {"give 9 numbers, then pairs of a coefficient and its power", 9, 2,
                                   DISPERSION_TERMS_MAX},
    [DISPERSION_HERZBERGER] = {"give 6 numbers", 6, 1, 6},
    [DISPERSION_RETRO] = {"give 4 numbers", 4, 1, 4},
    [DISPERSION_EXOTIC] = {"give 6 numbers", 6, 1, 6},
};

static const char *remedy_for(dispersion_kind kind)
{
    return numbers[kind].remedy;
}

static bool count_fits(dispersion_kind kind, int count)
{
    const int first = numbers[kind].first;
    return count >= first && count <= numbers[kind].most && (count - first) % numbers[kind].step == 0;
}

static status check_numbers(const dispersion *law, diagnostic *why)
{
    if ((unsigned)law->kind >= DISPERSION_KIND_COUNT)
        return diagnose(why, STATUS_BAD_INPUT, "", "unknown dispersion law %d", (int)law->kind);
    const char *remedy = remedy_for(law->kind), *name = dispersion_name(law->kind);
    if (law->count > DISPERSION_TERMS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, remedy, "a dispersion law has at most %d numbers, not %d",
                        DISPERSION_TERMS_MAX, law->count);
    if (!count_fits(law->kind, law->count))
        return diagnose(why, STATUS_BAD_INPUT, remedy, "%d numbers do not fit the dispersion law '%s'", law->count,
                        name);
    for (int i = 0; i < law->count; i++)
        if (!isfinite(law->coefficient[i]))
            return diagnose(why, STATUS_BAD_INPUT, "use finite numbers",
                            "number %d of the dispersion law '%s' is not finite", i + 1, name);
    const double low = law->low_nm, high = law->high_nm;
    if ((low != 0.0 || high != 0.0) && !(low > 0.0 && low <= high && isfinite(high)))
        return diagnose(why, STATUS_BAD_INPUT, "use a lower and a higher wavelength in nm, both above 0",
                        "%g..%g nm is not a range of wavelengths", low, high);
    return STATUS_OK;
}

static status check_powers(const dispersion *law, diagnostic *why)
{
    char remedy[64];
    snprintf(remedy, sizeof remedy, "use a power from %d to %d", -DISPERSION_POWER_MAX, DISPERSION_POWER_MAX);
    for (int i = 2; i < law->count; i += 2) {
        const double p = law->coefficient[i];
        if (fabs(p) > DISPERSION_POWER_MAX)
            return diagnose(why, STATUS_BAD_INPUT, remedy,
                            "the exponent %g of the wavelength is not valid in a dispersion law", p);
    }
    return STATUS_OK;
}

static status check_table(const dispersion *law, diagnostic *why)
{
    char n[NUMBER_TEXT_MAX], before[NUMBER_TEXT_MAX], after[NUMBER_TEXT_MAX];
    for (int i = 0; i < law->count; i += 2) {
        const double lambda_nm = law->coefficient[i], previous = i ? law->coefficient[i - 2] : 0.0;
        if (lambda_nm > previous && lambda_nm < 100.0)
            return diagnose(why, STATUS_BAD_INPUT, "write wavelengths in nm, such as 589.3",
                            "a table of indices has the wavelength %s nm", number_format(lambda_nm, after));
        if (!(lambda_nm > previous))
            return diagnose(why, STATUS_BAD_INPUT, "give wavelengths above 0 in ascending order",
                            "a table of indices has %s nm after %s nm", number_format(lambda_nm, after),
                            number_format(previous, before));
        if (!(law->coefficient[i + 1] >= index_low && law->coefficient[i + 1] <= index_high))
            return diagnose(why, STATUS_BAD_INPUT, remedy_for(law->kind), "a table of indices has the index %s",
                            number_format(law->coefficient[i + 1], n));
    }
    return STATUS_OK;
}

/* Wavelengths at which a denominator is 0; their number. */
static int resonances_of(const dispersion *law, double at_nm[DISPERSION_TERMS_MAX])
{
    const double *a = law->coefficient;
    int count = 0;
    switch (law->kind) {
    case DISPERSION_SELLMEIER:
    case DISPERSION_SELLMEIER_FROM:
        for (int i = 1 + law->count % 2; i < law->count; i += 2)
            at_nm[count++] = 1000.0 * sqrt(a[i] > 0.0 ? a[i] : 0.0);
        break;
    case DISPERSION_SELLMEIER_LENGTHS:
        for (int i = 1; i < law->count; i += 2)
            at_nm[count++] = 1000.0 * fabs(a[i]);
        break;
    case DISPERSION_GAS:
    case DISPERSION_GAS_FROM:
        for (int i = 1 + law->count % 2; i < law->count; i += 2)
            at_nm[count++] = a[i] > 0.0 ? 1000.0 / sqrt(a[i]) : 0.0;
        break;
    case DISPERSION_TWO_RESONANCES:
        for (int i = 1; i < 9; i += 4) {
            const double squared = a[i] != 0.0 && a[i + 2] != 0.0 ? power(a[i + 2], a[i + 3]) : 0.0;
            at_nm[count++] = 1000.0 * sqrt(squared > 0.0 ? squared : 0.0);
        }
        break;
    case DISPERSION_HERZBERGER: at_nm[count++] = 1000.0 * sqrt(0.028); break;
    case DISPERSION_RETRO:
    case DISPERSION_EXOTIC: at_nm[count++] = 1000.0 * sqrt(a[2] > 0.0 ? a[2] : 0.0); break;
    case DISPERSION_CONSTANT:
    case DISPERSION_POLYNOMIAL:
    case DISPERSION_CAUCHY_POWERS:
    case DISPERSION_CAUCHY:
    case DISPERSION_TABLE:
    case DISPERSION_CURVE: break;
    }
    return count;
}

/* A resonance, where the index is infinite, could fall between the samples of the visible range. */
static status check_resonances(const dispersion *law, double low_nm, double high_nm, diagnostic *why)
{
    double at_nm[DISPERSION_TERMS_MAX];
    const int count = resonances_of(law, at_nm);
    for (int i = 0; i < count; i++)
        if (at_nm[i] >= low_nm && at_nm[i] <= high_nm)
            return diagnose(why, STATUS_BAD_INPUT, remedy_for(law->kind),
                            "the dispersion law '%s' has a resonance at %.6g nm, %s", dispersion_name(law->kind),
                            at_nm[i], low_nm == VISIBLE_LOW_NM ? "in the visible" : "within its range");
    return STATUS_OK;
}

status dispersion_check_numbers(const dispersion *law, diagnostic *why)
{
    TRY(check_numbers(law, why));
    if (law->kind == DISPERSION_POLYNOMIAL || law->kind == DISPERSION_CAUCHY_POWERS ||
        law->kind == DISPERSION_TWO_RESONANCES)
        return check_powers(law, why);
    return law->kind == DISPERSION_TABLE || law->kind == DISPERSION_CURVE ? check_table(law, why) : STATUS_OK;
}

static status check_visible(const dispersion *law, diagnostic *why)
{
    for (double lambda_nm = VISIBLE_LOW_NM; lambda_nm <= VISIBLE_HIGH_NM; lambda_nm += 1.0) {
        const double n = dispersion_index(law, lambda_nm);
        if (n >= index_low && n <= index_high)
            continue;
        if (isnan(n))
            return diagnose(why, STATUS_BAD_INPUT, remedy_for(law->kind),
                            "the dispersion law '%s' gives no real index at %g nm", dispersion_name(law->kind),
                            lambda_nm);
        return diagnose(why, STATUS_BAD_INPUT, remedy_for(law->kind),
                        "the dispersion law '%s' gives the index %.6g at %g nm, which is not from 0.1 to 100",
                        dispersion_name(law->kind), n, lambda_nm);
    }
    return STATUS_OK;
}

status dispersion_check(const dispersion *law, diagnostic *why)
{
    TRY(dispersion_check_numbers(law, why));
    TRY(check_resonances(law, VISIBLE_LOW_NM, VISIBLE_HIGH_NM, why));
    return check_visible(law, why);
}

static status check_index_at(const dispersion *law, double lambda_nm, diagnostic *why)
{
    const double n = dispersion_index(law, lambda_nm);
    return n > 0.0 && n <= index_high
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "check its coefficients and its range of wavelengths",
                          "its formula (%s) gives the index %g at %.6g nm", dispersion_formula(law->kind), n,
                          lambda_nm);
}

/* At each nanometre where light is measured, and at 1000 wavelengths in equal ratios. */
status dispersion_check_range(const dispersion *law, diagnostic *why)
{
    enum { STEPS = 1000, FIRST_NM = 100, LAST_NM = 3000 };
    const double low = law->low_nm, high = law->high_nm;
    if (!(low > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "give its lowest and its highest wavelength",
                        "its range of wavelengths begins at %g nm", low);
    TRY(check_resonances(law, low, high, why));
    for (int nm = FIRST_NM; nm <= LAST_NM; nm++)
        if (nm >= low && nm <= high)
            TRY(check_index_at(law, nm, why));
    for (int i = 0; i <= STEPS; i++)
        TRY(check_index_at(law, fmin(low * elementary_pow(high / low, (double)i / STEPS), high), why));
    return STATUS_OK;
}
