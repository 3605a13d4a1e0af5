/* Walter, Marschner, Li and Torrance, "Microfacet models for refraction through rough surfaces" (EGSR 2007), as
 * printed, with angles and libm: what src/optics/microfacet.h is compared with. Vectors are unit vectors, z is the
 * surface's normal; i and o lead away from the surface. */
#pragma once

#include "base/vec3.h"
#include "optics/interface.h"
#include <math.h>

#define WALTER_PI 3.14159265358979323846

static inline vec3 at_angles(double theta, double phi)
{
    return vec3_make(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

/* (33) */
static inline double walter_D(double alpha, vec3 m)
{
    const double theta = acos(fmin(m.z, 1.0)), c = cos(theta), t = tan(theta);
    return m.z > 0.0 ? alpha * alpha / (WALTER_PI * pow(c, 4.0) * pow(alpha * alpha + t * t, 2.0)) : 0.0;
}

/* (34), with its chi+((v.m)/(v.n)). */
static inline double walter_G1(double alpha, vec3 v, vec3 m)
{
    const double t = hypot(v.x, v.y) / v.z;
    return vec3_dot(v, m) / v.z > 0.0 ? 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * t * t)) : 0.0;
}

/* A facet's reflectance by the cosine of the angle of incidence. */
typedef double facet_reflectance(double cos_i, const void *of);
static inline double perfect_mirror(double cos_i, const void *of)
{
    (void)cos_i, (void)of;
    return 1.0;
}
typedef struct two_media {
    double n_i, n_o;
} two_media;
static inline double dielectric(double cos_i, const void *of)
{
    const two_media *n = of;
    return fresnel_dielectric(cos_i, n->n_i, n->n_o).R;
}

/* (20) */
static inline double walter_reflection(double alpha, facet_reflectance *F, const void *of, vec3 i, vec3 o)
{
    const vec3 h = vec3_normalize(vec3_add(i, o));
    return F(fabs(vec3_dot(i, h)), of) * walter_G1(alpha, i, h) * walter_G1(alpha, o, h) * walter_D(alpha, h) /
           (4.0 * fabs(i.z) * fabs(o.z));
}

/* (21), for light from the side of o to that of i; without its n_i^2 / n_o^2, as L / n^2 is. (16): h turned to i. */
static inline double walter_refraction(double alpha, two_media n, vec3 i, vec3 o)
{
    vec3 h = vec3_normalize(vec3_add(vec3_scale(i, n.n_i), vec3_scale(o, n.n_o)));
    h = h.z < 0.0 ? vec3_scale(h, -1.0) : h;
    const double i_h = vec3_dot(i, h), o_h = vec3_dot(o, h), sum = n.n_i * i_h + n.n_o * o_h;
    if (!(i_h > 0.0 && o_h < 0.0))
        return 0.0;
    return i_h * -o_h / (fabs(i.z) * fabs(o.z)) * n.n_o * n.n_o * (1.0 - dielectric(i_h, &n)) * walter_G1(alpha, i, h) *
           walter_G1(alpha, o, h) * walter_D(alpha, h) / (sum * sum);
}

/* The integral of f over the normals of a hemisphere: trapezoids in log tan theta, in which GGX of any alpha has the
 * same width, and in phi. */
typedef double of_direction(vec3 m, const void *context);
static inline double over_normals(of_direction *f, const void *context, int rings, int sectors)
{
    const double low = -16.0, high = 16.0, step = (high - low) / rings;
    double sum = 0.0;
    for (int k = 0; k <= rings; k++) {
        const double theta = atan(exp(low + k * step)); /* d theta = sin cos d log tan */
        for (int j = 0; j < sectors; j++)
            sum += f(at_angles(theta, 2.0 * WALTER_PI * (j + 0.5) / sectors), context) * sin(theta) * sin(theta) *
                   cos(theta);
    }
    return sum * step * 2.0 * WALTER_PI / sectors;
}
