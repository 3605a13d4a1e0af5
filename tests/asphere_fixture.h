/* Random lenses with even aspheres, and their sides from the definition alone, for tests: z = c q / (1 + sqrt(1 - (1 +
 * k) c^2 q)) + A4 q^2 + A6 q^3 + A8 q^4 with q = x^2 + z^2 (ISO 10110-12). Pure. */
#pragma once

#include "geometry/shapes/shape.h"
#include "quad.h"
#include "room_fixture.h"

static inline bool has_asphere(const solid_shape *s)
{
    bool any = false;
    for (int i = 0; i < 3; i++)
        any |= s->kind == SHAPE_LENS && (s->even_1[i] != 0.0 || s->even_2[i] != 0.0);
    return any;
}

static inline quad asphere_height(const solid_shape *s, int k, quad q)
{
    const quad radius = k == 0 ? s->radius_1 : s->radius_2, stretch = 1 + (quad)(k == 0 ? s->conic_1 : s->conic_2);
    const double *even = k == 0 ? s->even_1 : s->even_2;
    const quad c = radius == 0 ? 0 : 1 / radius, conic = c * q / (1 + quad_sqrt(1 - stretch * c * c * q));
    return (k == 0 ? 0 : (quad)s->thickness) + conic + q * q * even[0] + q * q * q * even[1] + q * q * q * q * even[2];
}

/* The same in double precision, for many points. */
static inline double asphere_height_near(const solid_shape *s, int k, double q)
{
    const double radius = k == 0 ? s->radius_1 : s->radius_2, stretch = 1.0 + (k == 0 ? s->conic_1 : s->conic_2);
    const double *even = k == 0 ? s->even_1 : s->even_2, c = radius == 0.0 ? 0.0 : 1.0 / radius;
    return (k == 0 ? 0.0 : s->thickness) + c * q / (1.0 + sqrt(1.0 - stretch * c * c * q)) +
           q * q * (even[0] + q * even[1] + q * q * even[2]);
}

/* d height / d rho, by Richardson's extrapolation of central differences: an error of order step^4. */
static inline quad asphere_rise(const solid_shape *s, int k, quad rho)
{
    const quad h = (quad)1e-5 * s->diameter;
    quad d[2];
    for (int i = 0; i < 2; i++) {
        const quad step = h / (i + 1), a = rho - step, b = rho + step;
        d[i] = (asphere_height(s, k, b * b) - asphere_height(s, k, a * a)) / (2 * step);
    }
    return d[1] + (d[1] - d[0]) / 3;
}

/* Adds to one or both sides terms that change their height at the rim by up to a third of its radius, until the lens is
 * one that passes its check. s: passes it without. */
static inline void make_aspheric(solid_shape *s, uint64_t *seed)
{
    const solid_shape plain = *s;
    for (int trial = 0; trial < 400; trial++) {
        *s = plain;
        const double q = 0.25 * s->diameter * s->diameter, size = 0.5 * s->diameter;
        const int sides = 1 + random_below(seed, 3);
        for (int k = 0; k < 2; k++) {
            double *even = k == 0 ? s->even_1 : s->even_2, power = q * q;
            for (int i = 0; i < 3 && (sides >> k & 1); i++, power *= q)
                if (random_below(seed, 3))
                    even[i] = random_real(seed, -0.35, 0.35) * exp(random_real(seed, -4.0, 0.0)) * size / power;
        }
        s->thickness = plain.thickness + random_real(seed, 0.0, 0.7) * size;
        if (has_asphere(s) && solid_shape_check(s, NULL) == STATUS_OK)
            return;
    }
    *s = plain;
    s->even_1[0] = 1e-3 / (s->diameter * s->diameter * s->diameter);
}

/* Any size, any sides, half of them thin, in any place and half of them rotated. */
static inline solid_shape random_asphere(uint64_t *seed)
{
    solid_shape s = {.kind = SHAPE_LENS};
    random_lens(&s, seed);
    const double size = exp(random_real(seed, -3.0, 3.0)); /* a power of a length in every coefficient */
    s.radius_1 *= size, s.radius_2 *= size, s.thickness *= size, s.diameter *= size;
    make_aspheric(&s, seed);
    if (random_below(seed, 2)) /* thin where its sides are nearest */
        s.thickness -= 0.98 * shape_of(&s)->thickness(&s);
    s.position = random_point(seed, random_below(seed, 4) ? 1.0 : 100.0);
    if (random_below(seed, 2))
        s.rotation_deg = random_point(seed, 180.0);
    return s;
}
