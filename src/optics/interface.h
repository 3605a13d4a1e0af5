/* A smooth interface between two media: Snell, Fresnel, reflection and refraction of a direction. All functions are
 * inline and branch-free, so that kernels and tests share one formula. Pure; cannot fail. Signs: the normal faces the
 * incoming ray, so cos_i = -d.n >= 0; directions are unit vectors; n_from and n_to are the indices on the ray's side
 * and on the other side. */
#pragma once

#include "base/lanes.h"
#include "base/vec3.h"
#include <math.h>

/* Power reflectances, for the two polarisations and for unpolarised light; all in [0, 1]; the transmittance is 1 -
 * R. */
typedef struct fresnel {
    double eta;         /* n_from / n_to */
    double cos_t;       /* cosine of the angle of refraction; 0 under total internal reflection */
    double R_s, R_p, R; /* R = (R_s + R_p) / 2 */
    int64_t total;      /* -1: total internal reflection; 0: none */
} fresnel;

/* Fresnel's equations for dielectrics; Hecht, Optics, 5th ed., 4.6.2 (eqs. 4.34 and 4.40, squared). */
static inline fresnel fresnel_dielectric(double cos_i, double n_from, double n_to)
{
    fresnel f;
    f.eta = n_from / n_to;
    double cos2_t = 1.0 - f.eta * f.eta * (1.0 - cos_i * cos_i); /* Snell: sin_t = eta sin_i */
    f.total = mask_less_equal(cos2_t, 0.0);
    f.cos_t = sqrt(greater(cos2_t, 0.0));
    double r_s = (n_from * cos_i - n_to * f.cos_t) / (n_from * cos_i + n_to * f.cos_t);
    double r_p = (n_to * cos_i - n_from * f.cos_t) / (n_to * cos_i + n_from * f.cos_t);
    f.R_s = blend(f.total, 1.0, r_s * r_s);
    f.R_p = blend(f.total, 1.0, r_p * r_p);
    f.R = 0.5 * (f.R_s + f.R_p);
    return f;
}

/* One Newton step towards unit length: exact to the last place for a vector that is a unit vector up to rounding. It
 * prevents drift over a long chain of bounces. */
static inline vec3 direction_tidy(vec3 d)
{
    return vec3_scale(d, 1.5 - 0.5 * vec3_dot(d, d));
}

/* Mirror direction d + 2 cos_i n: Phong's R = 2(N.L)N - L with L = -d. */
static inline vec3 direction_reflect(vec3 d, vec3 n, double cos_i)
{
    return direction_tidy(vec3_add(d, vec3_scale(n, 2.0 * cos_i)));
}

/* Refracted direction, Snell in vector form: Lengyel, Mathematics for 3D Game Programming, 3rd ed., eq. 6.30 (with
 * the direction along the ray). Meaningless under total internal reflection. */
static inline vec3 direction_refract(vec3 d, vec3 n, double cos_i, double eta, double cos_t)
{
    return direction_tidy(vec3_add(vec3_scale(d, eta), vec3_scale(n, eta * cos_i - cos_t)));
}
