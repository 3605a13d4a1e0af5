/* Whole Mueller matrices in the direction of the light, as a reference; a tracer that works backwards from the eye does
 * not need them. */
#pragma once

#include "optics/mueller.h"

typedef struct mueller {
    double m[4][4];
} mueller; /* row: outgoing light; column: incoming light */

static inline mueller mueller_from(sp_response r)
{
    mueller m = {{{r.mean, r.half, 0.0, 0.0},
                  {r.half, r.mean, 0.0, 0.0},
                  {0.0, 0.0, r.real, -r.imag},
                  {0.0, 0.0, r.imag, r.real}}};
    return m;
}

/* For light incident at cos_i in n_from, from its s/p frame to that of the outgoing light. m[0][0] is the share of
 * unpolarised light. */
static inline mueller mueller_reflect(double cos_i, double n_from, double n_to)
{
    return mueller_from(sp_reflect(fresnel_dielectric(cos_i, n_from, n_to), cos_i));
}

static inline mueller mueller_refract(double cos_i, double n_from, double n_to)
{
    return mueller_from(sp_refract(fresnel_dielectric(cos_i, n_from, n_to)));
}

/* Rotation of the frame by a. */
static inline mueller mueller_rotation(double cos_2a, double sin_2a)
{
    mueller m = {{{1.0, 0.0, 0.0, 0.0}, {0.0, cos_2a, sin_2a, 0.0}, {0.0, -sin_2a, cos_2a, 0.0}, {0.0, 0.0, 0.0, 1.0}}};
    return m;
}

/* a b: light passes b first. */
static inline mueller mueller_multiply(mueller a, mueller b)
{
    mueller product;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += a.m[row][k] * b.m[k][column];
            product.m[row][column] = sum;
        }
    return product;
}

static inline stokes mueller_apply(mueller m, stokes s)
{
    const double in[4] = {s.i, s.q, s.u, s.v};
    double out[4] = {0.0, 0.0, 0.0, 0.0};
    for (int row = 0; row < 4; row++)
        for (int k = 0; k < 4; k++)
            out[row] += m.m[row][k] * in[k];
    stokes result = {out[0], out[1], out[2], out[3]};
    return result;
}
