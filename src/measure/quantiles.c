#include "measure/quantiles.h"
#include <math.h>

/* The value in low .. high where the increasing function reaches p. 200 halvings reach a double's last place. */
typedef double rising(double x, double parameter);
static double invert(rising *f, double parameter, double p, double low, double high)
{
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        if (f(middle, parameter) < p)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

double normal_below(double x)
{
    return 0.5 * erfc(-x / sqrt(2.0));
}

static double normal_rising(double x, double unused)
{
    (void)unused;
    return normal_below(x);
}

double normal_quantile(double p)
{
    return p > 0.5 ? -normal_quantile(1.0 - p) : invert(normal_rising, 0, p, -40.0, 0.0);
}

/* The continued fraction of the incomplete beta function by Lentz' method: Press and others, Numerical Recipes, 6.4. */
static double beta_fraction(double a, double b, double x)
{
    const double tiny = 1e-300;
    double c = 1.0, d = 1.0 / fmax(fabs(1.0 - (a + b) * x / (a + 1.0)), tiny), h = d;
    if (1.0 - (a + b) * x / (a + 1.0) < 0)
        d = -d, h = d;
    for (int m = 1; m < 500; m++) {
        const double k = m, even = k * (b - k) * x / ((a + 2 * k - 1) * (a + 2 * k));
        const double odd = -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 2 * k + 1));
        for (int half = 0; half < 2; half++) {
            const double term = half ? odd : even;
            d = 1.0 + term * d;
            c = 1.0 + term / c;
            d = 1.0 / (fabs(d) < tiny ? tiny : d);
            c = fabs(c) < tiny ? tiny : c;
            h *= c * d;
        }
        if (fabs(c * d - 1.0) < 1e-16)
            break;
    }
    return h;
}

/* The regularised incomplete beta function: Abramowitz and Stegun 26.5.8. */
static double beta_below(double a, double b, double x)
{
    if (x <= 0.0 || x >= 1.0)
        return x <= 0.0 ? 0.0 : 1.0;
    const double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x));
    return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                         : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

/* Abramowitz and Stegun 26.7.1 with 26.5.27. */
static double student_rising(double t, double v)
{
    const double tail = 0.5 * beta_below(0.5 * v, 0.5, v / (v + t * t));
    return t > 0 ? 1.0 - tail : tail;
}

double student_quantile(double p, double degrees_of_freedom)
{
    return p > 0.5 ? -student_quantile(1.0 - p, degrees_of_freedom)
                   : invert(student_rising, degrees_of_freedom, p, -1e6, 0.0);
}

/* The regularised lower incomplete gamma function by its series: Abramowitz and Stegun 6.5.29. */
static double gamma_below(double x, double a)
{
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < 100000 && term > sum * 1e-17; n++)
        sum += term *= x / (a + n);
    return x > 0 ? sum * exp(a * log(x) - x - lgamma(a)) : 0.0;
}

static double chi_squared_rising(double x, double v)
{
    return gamma_below(0.5 * x, 0.5 * v);
}

double chi_squared_quantile(double p, double degrees_of_freedom)
{
    const double v = degrees_of_freedom;
    return invert(chi_squared_rising, v, p, 0.0, v + 20.0 * sqrt(2.0 * v) + 60.0);
}

double beta_quantile(double p, double a, double b)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (beta_below(a, b, middle) < p)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

share_interval binomial_interval(double hits, double count)
{
    if (!(count > 0))
        return (share_interval){NAN, NAN, NAN};
    return (share_interval){hits / count, hits > 0 ? beta_quantile(0.025, hits, count - hits + 1) : 0.0,
                            hits < count ? beta_quantile(0.975, hits + 1, count - hits) : 1.0};
}
