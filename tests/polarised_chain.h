/* Random chains of interfaces for the tests of polarised light: the ray from the eye step by step, and the light's
 * field in the opposite direction, as complex vectors in space that need no Stokes frame. Pure except for the seed. */
#pragma once

#include "optics/mueller.h"
#include "random_stream.h"
#include <complex.h>

typedef struct field {
    double complex x, y, z;
} field;

static inline field field_from(vec3 a, double complex k)
{
    field f = {a.x * k, a.y * k, a.z * k};
    return f;
}
static inline field field_add(field a, field b)
{
    field f = {a.x + b.x, a.y + b.y, a.z + b.z};
    return f;
}
static inline field field_scale(field a, double complex k)
{
    field f = {a.x * k, a.y * k, a.z * k};
    return f;
}
static inline double complex field_dot(field a, field b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double complex field_along(field a, vec3 e)
{
    return a.x * e.x + a.y * e.y + a.z * e.z;
}
static inline double field_power(field a)
{
    return creal(a.x * conj(a.x)) + creal(a.y * conj(a.y)) + creal(a.z * conj(a.z));
}
static inline field field_cross(field a, field b)
{
    field f = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return f;
}

/* Stokes parameters of the field E exp(-i omega t) in the frame (x, y), from their definition: u compares the powers
 * along the two diagonals; v is twice E_x dE_y/dt - E_y dE_x/dt (per omega), positive when the field rotates from x to
 * y. */
static inline stokes field_stokes(field e, vec3 x, vec3 y)
{
    const double complex ex = field_along(e, x), ey = field_along(e, y), up = (ex + ey) / sqrt(2.0),
                         down = (ex - ey) / sqrt(2.0);
    const double px = cabs(ex) * cabs(ex), py = cabs(ey) * cabs(ey);
    /* at t = 0 the field is the amplitude's real part, its time derivative (per omega) the imaginary part */
    stokes s = {px + py, px - py, cabs(up) * cabs(up) - cabs(down) * cabs(down),
                2.0 * (creal(ex) * cimag(ey) - creal(ey) * cimag(ex))};
    return s;
}

/* Power reflectances, by Fresnel's sine and tangent laws (Born and Wolf, 1.5.2, (21a)). */
typedef struct reflectances {
    double s, p;
} reflectances;

static inline reflectances reflectances_at(double incidence, double n)
{
    const double refraction = asin(sin(incidence) / n);
    const double s = sin(incidence - refraction) / sin(incidence + refraction),
                 p = tan(incidence - refraction) / tan(incidence + refraction);
    return (reflectances){s * s, p * p};
}

/* Amplitudes by Fresnel's formulas with a complex angle of refraction; with exp(-i omega t) the evanescent wave beyond
 * total reflection decays for a positive imaginary cos_t. Born and Wolf, 7th ed., 1.5.2 and 1.5.4. */
typedef struct amplitudes {
    double complex cos_t, r_s, r_p, t_s, t_p;
} amplitudes;

static inline amplitudes amplitudes_at(double cos_i, double n1, double n2)
{
    const double sin_t = sqrt(1.0 - cos_i * cos_i) * n1 / n2;
    amplitudes a;
    a.cos_t = sin_t < 1.0 ? sqrt(1.0 - sin_t * sin_t) : I * sqrt(sin_t * sin_t - 1.0);
    a.r_s = (n1 * cos_i - n2 * a.cos_t) / (n1 * cos_i + n2 * a.cos_t);
    a.r_p = (n2 * cos_i - n1 * a.cos_t) / (n2 * cos_i + n1 * a.cos_t);
    a.t_s = 2.0 * n1 * cos_i / (n1 * cos_i + n2 * a.cos_t);
    a.t_p = 2.0 * n1 * cos_i / (n2 * cos_i + n1 * a.cos_t);
    return a;
}

enum chain_kind { CHAIN_REFLECT, CHAIN_REFRACT, CHAIN_MIRROR, CHAIN_KINDS };
typedef struct chain_step {
    enum chain_kind kind;
    vec3 d, n, child;
    double cos_i, n_from, n_to;
} chain_step;

/* A ray d in n_from hits a random plane. */
static inline chain_step chain_step_random(uint64_t *seed, vec3 d, double n_from)
{
    chain_step c = {(enum chain_kind)random_below(seed, CHAIN_KINDS), d, random_direction(seed), d, 0.0, n_from, 1.0};
    c.n_to = random_real(seed, 1.0, 2.5);
    c.cos_i = -vec3_dot(c.d, c.n);
    if (c.cos_i < 0.0) {
        c.n = vec3_scale(c.n, -1.0);
        c.cos_i = -c.cos_i;
    }
    fresnel f = fresnel_dielectric(c.cos_i, c.n_from, c.n_to);
    if (c.kind == CHAIN_REFRACT && f.total)
        c.kind = CHAIN_REFLECT;
    c.child = c.kind == CHAIN_REFRACT ? direction_refract(c.d, c.n, c.cos_i, f.eta, f.cos_t)
                                      : direction_reflect(c.d, c.n, c.cos_i);
    return c;
}

static inline void chain_random(uint64_t *seed, chain_step *steps, int count)
{
    vec3 d = random_direction(seed);
    double n_from = 1.0;
    for (int k = 0; k < count; k++) {
        steps[k] = chain_step_random(seed, d, n_from);
        d = steps[k].child;
        n_from = steps[k].kind == CHAIN_REFRACT ? steps[k].n_to : n_from;
    }
}

static inline stokes chain_analyser(const chain_step *c, stokes row)
{
    switch (c->kind) {
    case CHAIN_REFLECT: return analyser_reflect(row, c->d, c->n, c->cos_i, c->n_from, c->n_to, c->child);
    case CHAIN_REFRACT: return analyser_refract(row, c->d, c->n, c->cos_i, c->n_from, c->n_to, c->child);
    case CHAIN_MIRROR: return analyser_mirror(row, c->d, c->n, c->child);
    default: return row;
    }
}

/* The outgoing field along -d for a field incoming along -child, in units of the square root of power. */
static inline field chain_field(const chain_step *c, field e)
{
    const vec3 s = vec3_normalize(vec3_cross(c->d, c->n));
    const double complex along_s = field_along(e, s), along_p = field_along(e, vec3_cross(c->child, s));
    double complex a_s = -1.0, a_p = 1.0;
    if (c->kind == CHAIN_REFLECT) {
        amplitudes a = amplitudes_at(c->cos_i, c->n_from, c->n_to);
        a_s = a.r_s, a_p = a.r_p;
    } else if (c->kind == CHAIN_REFRACT) { /* seen from n_to, where the angle is that of refraction */
        const double cos_t = -vec3_dot(c->child, c->n);
        amplitudes a = amplitudes_at(cos_t, c->n_to, c->n_from);
        const double root = sqrt(c->n_from * creal(a.cos_t) / (c->n_to * cos_t));
        a_s = a.t_s * root, a_p = a.t_p * root;
    }
    return field_add(field_from(s, a_s * along_s), field_from(vec3_cross(c->d, s), a_p * along_p));
}
