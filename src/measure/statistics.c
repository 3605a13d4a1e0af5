/* Summaries, Student's t quantiles and order-statistic intervals. */
#include "measure/statistics.h"

#include <math.h>
#include <stdlib.h>

static const double normal_975 = 1.959963984540054; /* 97.5% quantile of the normal distribution */
static const double half_pi = 1.5707963267948966;

/* P(|T| <= t) for Student's t with v degrees of freedom, theta = atan(t / sqrt(v)).
 * Abramowitz and Stegun, Handbook of Mathematical Functions, 26.7.3 (odd v) and 26.7.4 (even v). */
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
