/* The surface of a liquid in a tube (capillary.h), and the meniscus of a cylinder.
 *
 * In units of the capillary length, with s = r^2 and w = sin(psi) / r, the equation is
 *   s w' + w = u / 2,   u' = w / (2 sqrt(1 - s w^2)),
 * with w = u / 2 on the axis. Both are analytic in s, and their Taylor coefficients follow from each other. Each step
 * is such a polynomial, and is as long as its last terms are negligible. The height on the axis is found by shooting,
 * for the slope at the wall, which increases with this height. A solution grows outwards, so that errors do not grow
 * relative to it. */
#include "geometry/shapes/meniscus.h"
#include "base/elementary.h"
#include "geometry/primitives/capillary.h"
#include "geometry/shapes/parts.h"
#include <stdio.h>

enum { TERMS = CAPILLARY_DEGREE + 1 };
#define TRUNCATION 0x1p-57 /* last terms of a step, relative to the height */
#define NEGLIGIBLE 0x1p-60 /* height, in capillary lengths */
#define STEEPEST 1e-5      /* least cos(psi)^2 of a shot; at the steepest wall it is sin(1 deg)^2 = 3e-4 */

typedef struct taylor {
    double u[TERMS], w[TERMS];
} taylor;

/* The series at s, where the height is u and sin(psi) / r is w; false if the surface is too steep. */
static bool expand(double s, double u, double w, taylor *e)
{
    double square[TERMS], g[TERMS], v[TERMS]; /* w^2; g = 1 - s w^2 = cos(psi)^2; v = g^(-1/2) */
    e->u[0] = u;
    e->w[0] = s == 0.0 ? 0.5 * u : w;
    for (int k = 0; k < TERMS; k++) {
        square[k] = 0.0;
        for (int j = 0; j <= k; j++)
            square[k] += e->w[j] * e->w[k - j];
        g[k] = -(s * square[k] + (k > 0 ? square[k - 1] : -1.0));
        if (k == 0 && !(g[0] > STEEPEST))
            return false;
        double sum = k == 0 ? 1.0 / sqrt(g[0]) : 0.0; /* the series of a power: Knuth, TAOCP 2, 4.7 */
        for (int j = 1; j <= k; j++)
            sum += (0.5 * j - k) * g[j] * v[k - j] / (k * g[0]);
        v[k] = sum;
        if (k + 1 == TERMS)
            break;
        double slope = 0.0;
        for (int j = 0; j <= k; j++)
            slope += e->w[j] * v[k - j];
        e->u[k + 1] = 0.5 * slope / (k + 1);
        e->w[k + 1] = s == 0.0 ? 0.5 * e->u[k + 1] / (k + 2) : (0.5 * e->u[k] - (k + 1) * e->w[k]) / (s * (k + 1));
    }
    return true;
}

static double sum_at(const double c[TERMS], double x)
{
    double sum = c[TERMS - 1];
    for (int k = TERMS - 2; k >= 0; k--)
        sum = sum * x + c[k];
    return sum;
}

/* The longest step whose last two terms, of either series, are negligible; away from the axis, at most s / 2,
 * because the recurrence of w divides by s. */
static double longest_step(const taylor *e, double s)
{
    double step = s > 0.0 ? 0.5 * s : 1.0;
    for (int k = TERMS - 2; k < TERMS; k++) {
        const double of_u = fabs(e->u[k]) / e->u[0] / TRUNCATION, of_w = fabs(e->w[k]) / e->w[0] / TRUNCATION;
        const double most = of_u > of_w ? of_u : of_w;
        if (most > 0.0)
            step = fmin(step, 1.0 / elementary_pow(most, 1.0 / k));
    }
    return step;
}

/* Appends the step to the table. */
static void keep_step(capillary_profile *out, double s, double step, const taylor *e)
{
    capillary_piece piece = {.from = s, .width = step};
    double power = 1.0;
    for (int k = 0; k < TERMS; k++, power *= step)
        piece.c[k] = e->u[k] * power;
    out->piece[out->count++] = piece;
}

/* sin(psi) at the wall, r = wide, for the height `axis` on the axis; 2 if the surface becomes vertical before the wall.
 * Stores the heights in `out` unless it is NULL. */
static double shoot(double wide, double axis, capillary_profile *out)
{
    double s = 0.0, u = axis, w = 0.5 * axis;
    const double end = wide * wide;
    while (s < end) {
        taylor e;
        if (!expand(s, u, w, &e))
            return 2.0;
        double step = longest_step(&e, s);
        const bool is_last = s + step >= end * (1.0 - 0x1p-40);
        if (is_last)
            step = end - s;
        const double next_u = sum_at(e.u, step);
        if (out && (next_u > NEGLIGIBLE || is_last) && out->count < CAPILLARY_PIECES - 1)
            keep_step(out, s, step, &e);
        u = next_u;
        w = sum_at(e.w, step);
        s = is_last ? end : s + step;
    }
    return w * wide;
}

/* The height on the axis for sin(psi) = slope at the wall. sin(psi) >= wide u(0) / 2, as u is least on the axis. */
static double axis_height(double wide, double slope)
{
    double high = 2.0 * slope / wide, at_high = shoot(wide, high, NULL) - slope;
    double low = high, at_low = at_high;
    for (double factor = 0.5; at_low > 0.0 && low > 0x1p-900; factor = fmax(factor * factor, 0x1p-64))
        low *= factor, at_low = shoot(wide, low, NULL) - slope;
    while (high > 2.0 * low) {
        const double middle = sqrt(low) * sqrt(high), at = shoot(wide, middle, NULL) - slope;
        if (at > 0.0)
            high = middle, at_high = at;
        else
            low = middle, at_low = at;
    }
    int retained = 0; /* the Illinois variant of false position (Dowell and Jarratt, BIT 11, 1971), and bisection */
    for (int k = 1; k < 100 && high - low > 0x1p-52 * low && at_low < 0.0; k++) {
        double middle = k % 4 ? low + (high - low) * (at_low / (at_low - at_high)) : 0.5 * (low + high);
        if (!(middle > low && middle < high))
            middle = 0.5 * (low + high);
        const double at = shoot(wide, middle, NULL) - slope;
        if (at > 0.0) {
            high = middle, at_high = at;
            at_low *= retained == 1 ? 0.5 : 1.0;
            retained = 1;
        } else {
            low = middle, at_low = at;
            at_high *= retained == -1 ? 0.5 : 1.0;
            retained = -1;
        }
        if (at == 0.0)
            break;
    }
    return low;
}

void capillary_solve(double radius, double capillary_length, double contact_angle_deg, double height,
                     capillary_profile *out)
{
    double sine, slope;
    elementary_sincos_deg(contact_angle_deg, &sine, &slope);
    const double a = capillary_length, wide = radius / a, up = slope < 0.0 ? -1.0 : 1.0;
    *out = (capillary_profile){.radius = radius, .rises = up > 0.0};
    shoot(wide, axis_height(wide, fabs(slope)), out);
    out->level = height - 2.0 * a * a * slope / radius;
    for (int i = 0; i < out->count; i++) {
        capillary_piece *e = &out->piece[i];
        e->from *= a * a;
        e->width *= a * a;
        for (int k = 0; k < TERMS; k++)
            e->c[k] *= up * a;
    }
    /* The part whose height is negligible is flat. */
    if (out->piece[0].from > 0.0) {
        for (int i = out->count; i > 0; i--)
            out->piece[i] = out->piece[i - 1];
        out->piece[0] = (capillary_piece){.width = out->piece[1].from, .c = {out->piece[1].c[0]}};
        out->count++;
    }
    out->axis = capillary_height(out, 0.0);
    out->wall = capillary_height(out, radius * radius);
    out->low = fmin(out->axis, out->wall);
    out->high = fmax(out->axis, out->wall);
}

/* --- the meniscus of a cylinder --- */

bool has_meniscus(const solid_shape *shape)
{
    return shape->kind == SHAPE_CYLINDER && shape->capillary_length > 0.0 && shape->contact_angle_deg != 90.0;
}

static double tube_radius(const solid_shape *shape)
{
    return shape->contact_radius > 0.0 ? shape->contact_radius : shape->radius;
}

/* Solving takes about a millisecond, and the same shape is needed many times: so each thread caches its last
 * solution. */
const capillary_profile *meniscus_of(const solid_shape *shape)
{
    static _Thread_local capillary_profile solution;
    static _Thread_local double solved_for[4];
    const double key[4] = {tube_radius(shape), shape->capillary_length, shape->contact_angle_deg, shape->height};
    if (key[0] != solved_for[0] || key[1] != solved_for[1] || key[2] != solved_for[2] || key[3] != solved_for[3]) {
        capillary_solve(key[0], key[1], key[2], key[3], &solution);
        for (int k = 0; k < 4; k++)
            solved_for[k] = key[k];
    }
    return &solution;
}

status meniscus_check(const solid_shape *s, diagnostic *why)
{
    if (!has_meniscus(s))
        return STATUS_OK;
    if (!isfinite(s->capillary_length) || !(s->contact_angle_deg >= 1.0 && s->contact_angle_deg <= 179.0))
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 179 degrees, and a finite length",
                        "contact_angle_deg %g or capillary_length %g is out of range", s->contact_angle_deg,
                        s->capillary_length);
    if (s->m != 1.0)
        return diagnose(why, STATUS_BAD_INPUT, "set m to 1, or capillary_length to 0",
                        "a meniscus requires a round cylinder, but m is %g", s->m);
    char remedy[160];
    if (!(s->contact_radius >= 0.0 && s->contact_radius <= s->radius)) {
        snprintf(remedy, sizeof remedy, "use 0 to %g, the radius; 0 stands for the radius", s->radius);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "contact_radius is %g", s->contact_radius);
    }
    if (tube_radius(s) > CAPILLARY_WIDEST * s->capillary_length) {
        snprintf(remedy, sizeof remedy, "use at least %g, or 0 for no meniscus", tube_radius(s) / CAPILLARY_WIDEST);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "capillary_length %g is less than 1/%g of the radius",
                        s->capillary_length, CAPILLARY_WIDEST);
    }
    const capillary_profile *p = meniscus_of(s);
    if (p->low > 0.0)
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "use a height above %.9g, or a smaller capillary_length", s->height - p->low);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "the meniscus reaches the bottom: height %g is too small",
                    s->height);
}

double meniscus_wall(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->wall : shape->height;
}

double meniscus_low(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->low : shape->height;
}

double meniscus_high(const solid_shape *shape)
{
    return has_meniscus(shape) ? meniscus_of(shape)->high : shape->height;
}

/* The maximum is at the point of a falling surface whose normal is d; otherwise at the wall. */
double meniscus_farthest(const solid_shape *shape, vec3 d)
{
    const capillary_profile *p = meniscus_of(shape);
    const double out = hypot(d.x, d.z);
    double low = 0.0, high = p->radius;
    for (int step = 0; step < 60 && !p->rises && d.y > 0.0; step++) {
        const double rho = 0.5 * (low + high);
        double slope;
        capillary_rise(p, rho * rho, &slope);
        if (out + 2.0 * rho * slope * d.y > 0.0)
            low = rho;
        else
            high = rho;
    }
    return high * out + capillary_height(p, high * high) * d.y;
}

void meniscus_points(const solid_shape *shape, int count, profile_point *out)
{
    const capillary_profile *p = meniscus_of(shape);
    for (int i = 0; i < count; i++) {
        double sine, cosine;
        elementary_sincos_deg(90.0 * i / (count - 1), &sine, &cosine);
        /* for small i the distance from the wall grows about as the cube of i: the surface bends most near the wall */
        const double fraction = (1.0 - cosine) * (i + 1.0) / count,
                     rho = i == count - 1 ? 0.0 : p->radius * (1.0 - fraction);
        out[i] = (profile_point){rho, capillary_height(p, rho * rho)};
    }
}
