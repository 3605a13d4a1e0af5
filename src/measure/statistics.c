/* Quantiles of distributions, summaries with their intervals, and the numbers of pairs of a comparison. */
#include "measure/statistics.h"

#include <math.h>
#include <stdlib.h>

/* ---- quantiles ---- */

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

/* ---- Student's t at 97.5 % ---- */

static const double normal_975 = 1.959963984540054; /* 97.5% quantile of the normal distribution */
static const double half_pi = 1.5707963267948966;

/* P(|T| <= t) for Student's t with v degrees of freedom, theta = atan(t / sqrt(v)). Abramowitz and Stegun, Handbook of
 * Mathematical Functions, 26.7.3 (odd v) and 26.7.4 (even v). */
static double student_two_sided(double theta, size_t v)
{
    double c = cos(theta), s = sin(theta);
    double term = v % 2 == 1 ? c : 1.0, sum = 0.0;
    for (size_t power = v % 2 == 1 ? 1 : 0; power + 2 <= v; power += 2) {
        sum += term;
        term *= c * c * (double)(power + 1) / (double)(power + 2);
    }
    return v % 2 == 1 ? (theta + s * sum) / half_pi : s * sum;
}

/* Expansion around the normal quantile; Abramowitz and Stegun 26.7.5. The first omitted term is of order v^-5. */
static double student_expanded(double v)
{
    double x = normal_975, x2 = x * x;
    double g1 = x * (x2 + 1.0) / 4.0;
    double g2 = x * ((5.0 * x2 + 16.0) * x2 + 3.0) / 96.0;
    double g3 = x * (((3.0 * x2 + 19.0) * x2 + 17.0) * x2 - 15.0) / 384.0;
    double g4 = x * ((((79.0 * x2 + 776.0) * x2 + 1482.0) * x2 - 1920.0) * x2 - 945.0) / 92160.0;
    return x + (g1 + (g2 + (g3 + g4 / v) / v) / v) / v;
}

double student_t_975(size_t degrees_of_freedom)
{
    /* From 200 degrees of freedom on the omitted terms are of the order of 200^-5 = 3e-12; 60 halvings of 0 .. pi/2
     * reach a double's last place. */
    enum { EXPANDED_FROM = 200, BISECTIONS = 60 };
    if (degrees_of_freedom == 0)
        return NAN;
    if (degrees_of_freedom >= EXPANDED_FROM)
        return student_expanded((double)degrees_of_freedom);

    double low = 0.0, high = half_pi;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = 0.5 * (low + high);
        if (student_two_sided(middle, degrees_of_freedom) < 0.95)
            low = middle;
        else
            high = middle;
    }
    return sqrt((double)degrees_of_freedom) * tan(0.5 * (low + high));
}

/* ---- summaries ---- */

/* The largest rank k (from 1) for which the k-th smallest and the k-th largest of n values enclose the median with a
 * probability of at least 95%: P(B < k) <= 2.5% for B binomial(n, 1/2); 0 if there is none. David and Nagaraja, Order
 * Statistics, 7.1. The binomial weights are relative to the central one, so that nothing underflows for large n. */
static size_t median_rank(size_t n)
{
    const double negligible = 1e-30;
    size_t first = n / 2;
    double weight = 1.0, total = 0.0;
    for (; first > 0 && weight > negligible; first--)
        weight *= (double)first / (double)(n - first + 1);

    double w = weight;
    for (size_t j = first; j <= n - first; j++) {
        total += w;
        w *= (double)(n - j) / (double)(j + 1);
    }

    double below = 0.0;
    size_t k = first;
    for (w = weight; k < n; k++) {
        below += w;
        if (below > 0.025 * total)
            break;
        w *= (double)(n - k) / (double)(k + 1);
    }
    return k;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void spread_of(summary *s, const double *values)
{
    double squares = 0.0;
    for (size_t i = 0; i < s->count; i++)
        squares += (values[i] - s->mean) * (values[i] - s->mean);
    s->deviation = sqrt(squares / (double)(s->count - 1));
    double half = student_t_975(s->count - 1) * s->deviation / sqrt((double)s->count);
    s->mean_low = s->mean - half;
    s->mean_high = s->mean + half;
}

summary summarize(double *values, size_t count)
{
    summary s = {count, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    for (size_t i = 0; i < count; i++)
        if (isnan(values[i]))
            return s;
    if (count == 0)
        return s;

    qsort(values, count, sizeof values[0], by_value);
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    s.mean = sum / (double)count;
    s.median = count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
    s.minimum = values[0];
    s.maximum = values[count - 1];
    if (count >= 2)
        spread_of(&s, values);
    size_t k = median_rank(count);
    if (k > 0) {
        s.median_low = values[k - 1];
        s.median_high = values[count - k];
    }
    return s;
}

double summary_relative_width(const summary *s)
{
    if (!(fabs(s->mean) > 0.0))
        return NAN;
    return (s->mean_high - s->mean_low) / fabs(s->mean);
}

fraction_interval binomial_interval(double hits, double count)
{
    if (!(count > 0))
        return (fraction_interval){NAN, NAN, NAN};
    return (fraction_interval){hits / count, hits > 0 ? beta_quantile(0.025, hits, count - hits + 1) : 0.0,
                               hits < count ? beta_quantile(0.975, hits + 1, count - hits) : 1.0};
}

/* ---- numbers of pairs ---- */

enum { PAIRS_LEAST = 3, PAIRS_MOST = 10000 };

/* The sufficient number of pairs, with the quantiles for n pairs. */
static double needed(double n, double ratio, double power)
{
    const double sum = student_quantile(0.975, n - 1) + student_quantile(power, n - 1);
    return sum * sum * ratio * ratio;
}

size_t power_pairs(double deviation, double difference, double power)
{
    const double ratio = deviation / fabs(difference);
    if (!(ratio >= 0) || needed(PAIRS_MOST, ratio, power) > PAIRS_MOST)
        return 0;
    size_t low = PAIRS_LEAST, high = PAIRS_MOST; /* needed(n) falls with n */
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (needed((double)middle, ratio, power) <= (double)middle)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

double power_upper_deviation(double deviation, size_t count, double probability)
{
    const double freedom = (double)count - 1;
    return count > 1 ? deviation * sqrt(freedom / chi_squared_quantile(1.0 - probability, freedom)) : NAN;
}
