/* Rough interfaces: plane facets, each smooth by itself (optics/interface.h, optics/multilayer.h), whose normals m are
 * spread about the surface's normal n by the GGX distribution, and which mask one another by Smith's function. Light
 * that meets a second facet is lost.
 *   [W] Walter, Marschner, Li and Torrance, "Microfacet models for refraction through rough surfaces", EGSR 2007.
 *   [H] Heitz, "Sampling the GGX distribution of visible normals", JCGT 7(4), 2018.
 * Vectors are unit vectors in a frame whose z is n; i points back along the ray, i.z > 0, and o along the scattered
 * ray. alpha, in (0, 1], is the roughness: the slope at which the density of the facets' slopes is a quarter of its
 * peak. Inline; only + - * / sqrt and base/lanes.h, so that every platform gives the same bits. Pure;
 * cannot fail. */
#pragma once

#include "base/lanes.h"
#include "base/vec3.h"
#include <math.h>

/* D(m), [W] (33), without its tangent: the integral of D cos(m) over the hemisphere is 1. */
static inline double ggx_distribution(double alpha, vec3 m)
{
    const double pi = 3.14159265358979323846, a2 = alpha * alpha, s = a2 * m.z * m.z + m.x * m.x + m.y * m.y;
    return a2 / (pi * s * s);
}

/* sqrt(cos^2 + alpha^2 sin^2) of a direction: Smith's function is G_1 = 2 cos / (cos + this). */
static inline double ggx_stretch(double alpha, vec3 v)
{
    return sqrt(v.z * v.z + alpha * alpha * (v.x * v.x + v.y * v.y));
}

/* Smith's G_1: the fraction of facets turned towards v, on either side of the surface, that others do not mask; [W]
 * (34). */
static inline double ggx_masking(double alpha, vec3 v)
{
    const double cosine = magnitude(v.z);
    return 2.0 * cosine / (cosine + ggx_stretch(alpha, v));
}

/* D_i(m), the density of the visible normals from i, per solid angle: G_1 max(0, i.m) D / cos; [H] (3). */
static inline double ggx_visible_distribution(double alpha, vec3 i, vec3 m)
{
    return 2.0 * greater(vec3_dot(i, m), 0.0) * ggx_distribution(alpha, m) / (i.z + ggx_stretch(alpha, i));
}

/* Samples a visible normal, for u and v uniform in (0, 1); [H], listing 1: a point of the half disc and half ellipse
 * that are the stretched hemisphere seen from i. */
static inline vec3 ggx_sample_normal(double alpha, vec3 i, double u, double v)
{
    const vec3 from = vec3_normalize(vec3_make(alpha * i.x, alpha * i.y, i.z));
    const double across2 = from.x * from.x + from.y * from.y, across = across2 > 0.0 ? 1.0 / sqrt(across2) : 0.0;
    const vec3 x = across2 > 0.0 ? vec3_make(-from.y * across, from.x * across, 0.0) : vec3_make(1.0, 0.0, 0.0),
               y = vec3_cross(from, x);
    double sine, cosine;
    elementary_sincos_turn_inline(v, &sine, &cosine);
    const double half = 0.5 * (1.0 + from.z), a = sqrt(u) * cosine,
                 b = (1.0 - half) * sqrt(greater(1.0 - a * a, 0.0)) + half * sqrt(u) * sine;
    const vec3 seen = vec3_add(vec3_add(vec3_scale(x, a), vec3_scale(y, b)),
                               vec3_scale(from, sqrt(greater(1.0 - a * a - b * b, 0.0))));
    return vec3_normalize(vec3_make(alpha * seen.x, alpha * seen.y, greater(seen.z, 1e-30)));
}

/* The facet that sends light between i and o. density, per solid angle of o: of rays from i whose facets are sampled by
 * ggx_visible_distribution; 0 if no facet connects i and o. R or 1 - R of the facet, times density and G_1(o), is f
 * cos(o) with f of [W] (20) and (21). (21) is without its factor (n_o / n_i)^2 of radiance, as for power and for basic
 * radiance L / n^2. */
typedef struct facet {
    vec3 m;
    double density;
} facet;

/* [W] (13) and (14). o.z > 0. */
static inline facet reflecting_facet(double alpha, vec3 i, vec3 o)
{
    const vec3 m = vec3_normalize(vec3_add(i, o));
    return (facet){m, ggx_visible_distribution(alpha, i, m) / (4.0 * vec3_dot(i, m))};
}

/* [W] (16) and (17), for the indices on the sides of i and o. o.z < 0. Between equal indices light is not deflected:
 * there is no density. */
static inline facet refracting_facet(double alpha, vec3 i, vec3 o, double n_i, double n_o)
{
    const vec3 sum = vec3_add(vec3_scale(i, n_i), vec3_scale(o, n_o));
    const double length = vec3_length(sum);
    const facet none = {vec3_make(0.0, 0.0, 1.0), 0.0};
    if (n_i == n_o || !(length > 0.0))
        return none;
    const vec3 m = vec3_scale(sum, (n_o > n_i ? -1.0 : 1.0) / length);
    const double i_m = vec3_dot(i, m), o_m = vec3_dot(o, m);
    if (!(m.z > 0.0 && i_m > 0.0 && o_m < 0.0))
        return none;
    const double change = n_o / length; /* (n_i i.m + n_o o.m)^2 is the square of the sum's length */
    return (facet){m, ggx_visible_distribution(alpha, i, m) * -o_m * change * change};
}
