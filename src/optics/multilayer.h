/* Smooth interfaces by wave optics: metals, and stacks of homogeneous thin films between two media, for s and p light,
 * any wavelength and angle. The method is the characteristic matrix: Born and Wolf, Principles of Optics, 7th
 * ed., 1.6.2 to 1.6.4; metals: 14.2; Macleod, Thin-Film Optical Filters, 4th ed., chapter 2. Inline and branch-free, so
 * that kernels and tests share one formula; only + - * / sqrt and base/lanes.h, so that every platform gives the same
 * bits. Pure; cannot fail; all values, nothing is owned.
 *
 * Signs are those of optics/mueller.h: amplitudes with exp(-i omega t), so that an absorbing medium has the index n + i
 * k with k >= 0 (the same n and k as in n - i k of books that write exp(+i omega t)); at normal incidence r_p = -r_s.
 * Films are plane, their faces parallel, and light is coherent across the stack. The medium on the ray's side does not
 * absorb. */
#pragma once

#include "base/lanes.h"
#include "optics/complex_pair.h"
#include "optics/mueller.h"
#include <stdbool.h>

/* The square root with both parts >= 0, of z with z.im >= 0; without cancellation. */
static inline complex_pair complex_sqrt_upper(complex_pair z)
{
    const double length = sqrt(complex_norm2(z)), large = sqrt(0.5 * (length + magnitude(z.re)));
    const int64_t zero = mask_less_equal(large, 0.0), left = mask_less(z.re, 0.0);
    const double small = blend(zero, 0.0, z.im / blend(zero, 1.0, 2.0 * large));
    return complex_of(blend(left, small, large), blend(left, large, small));
}

static inline complex_pair complex_blend(int64_t mask, complex_pair a, complex_pair b)
{
    return complex_of(blend(mask, a.re, b.re), blend(mask, a.im, b.im));
}

typedef struct thin_film {
    complex_pair index; /* n + i k; n > 0, k >= 0 */
    double thickness_nm;
} thin_film;

/* Amplitudes of reflection and transmission, scaled so that |t|^2 is the transmittance of power and t is the same from
 * either side. */
typedef struct sp_amplitudes {
    complex_pair r_s, r_p, t_s, t_p;
} sp_amplitudes;

/* The product of the characteristic matrices of one polarisation, times e^-fade (see film_phase): its determinant is
 * e^(-2 fade). */
typedef struct characteristic {
    complex_pair a, b, c, d;
} characteristic;

static inline characteristic characteristic_product(characteristic l, characteristic r)
{
    const characteristic m = {
        complex_add(complex_multiply(l.a, r.a), complex_multiply(l.b, r.c)),
        complex_add(complex_multiply(l.a, r.b), complex_multiply(l.b, r.d)),
        complex_add(complex_multiply(l.c, r.a), complex_multiply(l.d, r.c)),
        complex_add(complex_multiply(l.c, r.b), complex_multiply(l.d, r.d)),
    };
    return m;
}

/* cos(delta) and sin(delta) / beta of a film, delta = 2 pi thickness beta / lambda, both times e^-fade with fade = Im
 * delta, so that nothing overflows; both are even in beta, so that the sign of the root does not matter. */
typedef struct film_phase {
    complex_pair cosine, sine_over_beta;
    double fade;
} film_phase;

static inline film_phase film_phase_of(complex_pair beta2, double thickness_nm, double lambda_nm)
{
    const double two_pi = 6.2831853071795864769, log2_e = 1.4426950408889634074;
    const complex_pair beta = complex_sqrt_upper(beta2);
    const double wave = thickness_nm / lambda_nm, turns = beta.re * wave, fade = two_pi * beta.im * wave;
    double sine, cosine;
    elementary_sincos_turn_inline(turns - floor(turns), &sine, &cosine);
    const double once = elementary_exp2_inline(-log2_e * fade), twice = once * once;
    const double cosh = 0.5 * (1.0 + twice), sinh = 0.5 * (1.0 - twice);
    const complex_pair c = complex_of(cosine * cosh, -sine * sinh), s = complex_of(sine * cosh, cosine * sinh);
    /* If |delta|^2 is small, sin(delta) / beta would lose digits: the series of both. */
    const double k = two_pi * wave;
    const complex_pair w = complex_scale(beta2, -k * k);
    const int64_t small = mask_less(complex_norm2(w), 0x1p-8);
    complex_pair cosine_series = complex_of(1.0 / 3628800.0, 0.0), sine_series = complex_of(1.0 / 39916800.0, 0.0);
    const double of_cosine[] = {1.0 / 40320.0, 1.0 / 720.0, 1.0 / 24.0, 0.5, 1.0},
                 of_sine[] = {1.0 / 362880.0, 1.0 / 5040.0, 1.0 / 120.0, 1.0 / 6.0, 1.0};
    for (int i = 0; i < 5; i++) {
        cosine_series = complex_add(complex_multiply(cosine_series, w), complex_of(of_cosine[i], 0.0));
        sine_series = complex_add(complex_multiply(sine_series, w), complex_of(of_sine[i], 0.0));
    }
    const film_phase p = {
        complex_blend(small, complex_scale(cosine_series, once), c),
        complex_blend(small, complex_scale(sine_series, k * once),
                      complex_divide(s, complex_blend(small, complex_of(1.0, 0.0), beta))),
        fade,
    };
    return p;
}

/* The matrices of one film for both polarisations; Born and Wolf, 1.6.2 (39) with n cos theta = beta, for p with cos
 * theta / n = beta / n^2. */
typedef struct film_matrices {
    characteristic s, p;
    double fade;
} film_matrices;

static inline film_matrices film_matrices_of(thin_film one, double sine2, double lambda_nm)
{
    const complex_pair n2 = complex_multiply(one.index, one.index), beta2 = complex_sub(n2, complex_of(sine2, 0.0));
    const film_phase f = film_phase_of(beta2, one.thickness_nm, lambda_nm);
    const complex_pair across = complex_minus_i(f.sine_over_beta), back = complex_multiply(across, beta2);
    const film_matrices m = {{f.cosine, across, back, f.cosine},
                             {f.cosine, complex_multiply(across, n2), complex_divide(back, n2), f.cosine},
                             f.fade};
    return m;
}

static inline bool films_equal(thin_film a, thin_film b)
{
    return a.index.re == b.index.re && a.index.im == b.index.im && a.thickness_nm == b.thickness_nm;
}

/* The amplitudes of a stack with matrix m, Born and Wolf, 1.6.2 (47) to (50): q is n cos theta for s, cos theta / n for
 * p; left is e^-fade. */
static inline void multilayer_ends(characteristic m, double q_from, complex_pair q_to, double left, complex_pair *r,
                                   complex_pair *t)
{
    const complex_pair first = complex_scale(complex_add(m.a, complex_multiply(m.b, q_to)), q_from),
                       second = complex_add(m.c, complex_multiply(m.d, q_to)), sum = complex_add(first, second);
    *r = complex_divide(complex_sub(first, second), sum);
    *t = complex_divide(complex_of(2.0 * sqrt(q_from * q_to.re) * left, 0.0), sum);
}

/* The amplitudes of light from a medium of index n_from, at an angle of incidence with cosine cos_i, through films[0 ..
 * count - 1] in the order of the ray, into a medium of index `to`. */
static inline sp_amplitudes multilayer_amplitudes(double cos_i, double n_from, const thin_film *films, int count,
                                                  complex_pair to, double lambda_nm)
{
    const double log2_e = 1.4426950408889634074;
    const double sine2 = n_from * n_from * (1.0 - cos_i * cos_i); /* (n sin theta)^2, the same in all media: Snell */
    const characteristic none = {complex_of(1.0, 0.0), complex_of(0.0, 0.0), complex_of(0.0, 0.0),
                                 complex_of(1.0, 0.0)};
    characteristic s = none, p = none;
    double fade = 0.0;
    film_matrices pair[2]; /* of the last two films: in a periodic stack they are those of all */
    for (int i = 0; i < count; i++) {
        film_matrices *m = &pair[i % 2];
        if (i < 2 || !films_equal(films[i], films[i - 2]))
            *m = film_matrices_of(films[i], sine2, lambda_nm);
        s = characteristic_product(s, m->s);
        p = characteristic_product(p, m->p);
        fade += m->fade;
    }
    const complex_pair n2 = complex_multiply(to, to),
                       beta = complex_sqrt_upper(complex_sub(n2, complex_of(sine2, 0.0)));
    const double left = elementary_exp2_inline(-log2_e * fade);
    sp_amplitudes out;
    multilayer_ends(s, n_from * cos_i, beta, left, &out.r_s, &out.t_s);
    multilayer_ends(p, cos_i / n_from, complex_divide(beta, n2), left, &out.r_p, &out.t_p);
    return out;
}

/* A metal's surface, or any interface between two media: the stack without films. Born and Wolf, 1.5.2 and 14.2. */
static inline sp_amplitudes conductor_amplitudes(double cos_i, double n_from, complex_pair to)
{
    return multilayer_amplitudes(cos_i, n_from, (const thin_film *)0, 0, to, 1.0);
}

/* The Mueller matrix of a reflection or a transmission, from its amplitudes. Its mean is the reflectance or the
 * transmittance of power for unpolarised light. */
static inline sp_response sp_response_of(complex_pair s, complex_pair p)
{
    const double of_s = complex_norm2(s), of_p = complex_norm2(p);
    const complex_pair between = complex_conj_multiply(s, p);
    const sp_response r = {0.5 * (of_s + of_p), 0.5 * (of_s - of_p), between.re, between.im};
    return r;
}
