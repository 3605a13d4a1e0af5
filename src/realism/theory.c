/* Closed forms of textbook optics; theory.h names their sources. */
#include "realism/theory.h"

#include <math.h>

double theory_snell(double angle, double n_from, double n_to)
{
    const double sine = n_from * sin(angle) / n_to;
    return fabs(sine) < 1.0 ? asin(sine) : NAN;
}

double theory_critical_angle(double n_from, double n_to)
{
    return n_to < n_from ? asin(n_to / n_from) : NAN;
}

double theory_fresnel_s(double angle, double n_from, double n_to)
{
    const double t = theory_snell(angle, n_from, n_to);
    if (isnan(t))
        return 1.0;
    if (angle == 0.0) /* 0 / 0 in the form below */
        return pow((n_from - n_to) / (n_from + n_to), 2);
    return pow(sin(angle - t) / sin(angle + t), 2);
}

double theory_fresnel_p(double angle, double n_from, double n_to)
{
    const double t = theory_snell(angle, n_from, n_to);
    if (isnan(t))
        return 1.0;
    if (angle == 0.0)
        return pow((n_from - n_to) / (n_from + n_to), 2);
    return pow(tan(angle - t) / tan(angle + t), 2);
}

double theory_fresnel(double angle, double n_from, double n_to)
{
    return (theory_fresnel_s(angle, n_from, n_to) + theory_fresnel_p(angle, n_from, n_to)) / 2.0;
}

double theory_slab(double R, int passes)
{
    /* The sum of a geometric series of ratio R^2; if R is 1 nothing is transmitted. */
    return passes <= 0 || R >= 1.0 ? 0.0 : pow(1.0 - R, 2) * (1.0 - pow(R, 2.0 * passes)) / (1.0 - R * R);
}

double theory_pile(double R, int interfaces, int depth)
{
    enum { MOST = 16 };
    /* Light towards interface i from its front and from its back, after `met` interfaces. */
    double onwards[MOST + 1] = {1.0}, backwards[MOST + 1] = {0.0}, through = 0.0;
    if (interfaces < 1 || interfaces > MOST)
        return NAN;
    for (int met = 0; met < depth; met++) {
        double on[MOST + 1] = {0.0}, back[MOST + 1] = {0.0};
        for (int i = 0; i < interfaces; i++) {
            on[i + 1] += (1.0 - R) * onwards[i] + R * backwards[i];
            if (i > 0)
                back[i - 1] += R * onwards[i] + (1.0 - R) * backwards[i];
        }
        through += on[interfaces];
        for (int i = 0; i < interfaces; i++)
            onwards[i] = on[i], backwards[i] = back[i];
    }
    return through;
}

double theory_shells_reach(const theory_shells *c)
{
    const double in_wall = c->inner * c->n_wall / c->n_around, in_core = c->inner * c->n_core / c->n_around;
    return fmin(c->outer, fmin(in_wall, in_core));
}

double theory_shells_turn(const theory_shells *c, double offset)
{
    const double invariant = c->n_around * offset;
    return asin(offset / c->outer) - asin(invariant / (c->n_wall * c->outer)) +
           asin(invariant / (c->n_wall * c->inner)) - asin(invariant / (c->n_core * c->inner));
}

double theory_shells_deviation(const theory_shells *c, double offset)
{
    return 2.0 * theory_shells_turn(c, offset);
}

double theory_shells_power(const theory_shells *c)
{
    return 2.0 * ((1.0 - c->n_around / c->n_wall) / c->outer +
                  (c->n_around / c->n_wall - c->n_around / c->n_core) / c->inner);
}

double theory_shells_place(const theory_shells *c, double eye, double behind, double offset)
{
    /* The ray leaves at the offset at which it arrived, turned by the deviation. */
    const double out = asin(offset / eye) - theory_shells_deviation(c, offset);
    return (offset + behind * sin(out)) / cos(out);
}

/* Horizontal distance covered by the ray with n sin(angle) = p. */
static double reach(double p, double height, double depth, double n_above, double n_below)
{
    return height * p / sqrt(n_above * n_above - p * p) + depth * p / sqrt(n_below * n_below - p * p);
}

double theory_apparent_tangent(double height, double depth, double distance, double n_above, double n_below)
{
    /* The distance grows from 0 to infinity, or up to the limit set by the smaller index. */
    double low = 0.0, high = fmin(n_above, n_below);
    if (!(height > 0.0 && depth >= 0.0))
        return NAN;
    for (int i = 0; i < 200; i++) {
        const double p = low + (high - low) / 2.0;
        if (p <= low || p >= high)
            break;
        if (reach(p, height, depth, n_above, n_below) < distance)
            low = p;
        else
            high = p;
    }
    return low / sqrt(n_above * n_above - low * low);
}

double theory_apparent_depth(double angle, double n_above, double n_below)
{
    const double n = n_below / n_above, sine = sin(angle);
    return cos(angle) / sqrt(n * n - sine * sine);
}

double theory_prism_deviation(double incidence, double apex, double n)
{
    const double at_second = apex - asin(sin(incidence) / n);
    return incidence + theory_snell(at_second, n, 1.0) - apex;
}

double theory_drop_angle(double offset, double n)
{
    return 4.0 * asin(offset / n) - 2.0 * asin(offset);
}

double theory_crossed(double between, double plate, double retardance)
{
    const double half = sin(0.5 * retardance), straight = cos(between);
    return 0.5 * (straight * straight - sin(2.0 * plate) * sin(2.0 * (plate - between)) * half * half);
}

double theory_least_depth(double drop, double across, double tangent, double n)
{
    const double below = tan(theory_snell(atan(tangent), 1.0, n));
    return (drop * tangent - across) / (tangent - below);
}

/* The reflectance of two faces with amplitudes r1 and r2, and a phase between them. */
static double airy(double r1, double r2, double phase)
{
    const double both = 2.0 * r1 * r2 * cos(phase);
    return (r1 * r1 + r2 * r2 + both) / (1.0 + r1 * r1 * r2 * r2 + both);
}

double theory_film(double angle, double n_from, double n_film, double n_behind, double thickness)
{
    const double in = theory_snell(angle, n_from, n_film), out = theory_snell(angle, n_from, n_behind);
    const double s[] = {n_from * cos(angle), n_film * cos(in), n_behind * cos(out)},
                 p[] = {cos(angle) / n_from, cos(in) / n_film, cos(out) / n_behind},
                 phase = 4.0 * M_PI * n_film * thickness * cos(in);
    const double R_s = airy((s[0] - s[1]) / (s[0] + s[1]), (s[1] - s[2]) / (s[1] + s[2]), phase),
                 R_p = airy((p[0] - p[1]) / (p[0] + p[1]), (p[1] - p[2]) / (p[1] + p[2]), phase);
    return (R_s + R_p) / 2.0;
}
