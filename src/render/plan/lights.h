/* The directions and shapes of a frame's lights.
 *
 * Cones: a `cone` emits all its light within the half-angle a from the axis, a `soft_cone` a fraction that falls from 1
 * on the axis to 0 at the half-angle, linear in the cosine: (cos t - cos a) / (1 - cos a). A flat lamp as a point is a
 * soft cone of 90 degrees: Lambert's law. The cone of a sun contains the directions of its light at any point.
 *
 * Flat lamps: discs and rectangles that emit by Lambert's law, only on the side of their target, and block no light. A
 * distant surface that faces the lamp on its axis, at the light's reach, is as bright as in Phong's model with the same
 * intensity I: a sphere of radius r has radiance I (reach / r)^2, which times its cross-section pi r^2 is pi I reach^2,
 * and this divided by the lamp's area is the lamp's radiance. Pure; plain values. */
#pragma once

#include "base/elementary.h"
#include "base/lanes.h"
#include "base/vec3.h"
#include "scene/model/lights.h"
#include <math.h>
#include <stdbool.h>

/* --- cones --- */

typedef struct light_cone {
    vec3 axis;      /* unit vector, from the light */
    double opening; /* 1 - cos a */
} light_cone;

/* The cone of a light other than a point, which must not be at its own target. 1 - cos a = 2 sin^2(a / 2) avoids
 * cancellation. */
static inline light_cone light_cone_of(const light *l)
{
    double sine, cosine;
    const double half_deg = light_is_flat(l)       ? 90.0
                            : l->kind == LIGHT_SUN ? 0.5 * l->angular_diameter_deg
                                                   : l->half_angle_deg;
    elementary_sincos_deg(0.5 * half_deg, &sine, &cosine);
    const bool all_around = l->kind == LIGHT_CONE && l->half_angle_deg == 180.0; /* rounding may exclude no direction */
    return (light_cone){vec3_normalize(vec3_sub(l->target, l->position)), all_around ? 3.0 : 2.0 * sine * sine};
}

/* 1 - cos t of a direction from the light, a unit vector: half the squared distance from the axis, which avoids
 * cancellation. */
static inline double light_cone_off(const light_cone *c, vec3 direction)
{
    const vec3 off = vec3_sub(direction, c->axis);
    return 0.5 * vec3_dot(off, off);
}

/* The fraction of the light that is emitted in a direction, 0..1. */
static inline double light_cone_fraction(const light_cone *c, bool soft, vec3 direction)
{
    const double off = light_cone_off(c, direction);
    const double hard = blend(mask_less(c->opening, off), 0.0, 1.0), linear = greater(1.0 - off / c->opening, 0.0);
    return soft ? linear : hard;
}

/* Whether the light's intensity depends on the direction. */
static inline bool light_has_cone(const light *l)
{
    return l->kind != LIGHT_POINT && l->kind != LIGHT_SUN;
}

/* The fraction of any light's intensity that is emitted in a direction, 0..1. */
static inline double light_fraction(const light *l, const light_cone *c, vec3 direction)
{
    return light_has_cone(l) ? light_cone_fraction(c, l->kind != LIGHT_CONE, direction) : 1.0;
}

/* --- a frame's lights, see plan.h --- */

/* Squared sine of a sun's angular radius a: 1 - cos^2 a, computed from 1 - cos a. */
static inline double light_sun_sine2(const light_cone *c)
{
    return c->opening * (2.0 - c->opening);
}

/* The vector from a point to the light; to a sun, it is the same at every point. */
static inline vec3 light_towards(const light *l, vec3 point)
{
    return l->kind == LIGHT_SUN ? l->position : vec3_sub(l->position, point);
}

/* --- flat lamps --- */

#define LAMP_PI 3.14159265358979323846

typedef struct lamp_shape {
    bool round;
    vec3 axis, right, up;           /* unit vectors; axis: the side that emits */
    double half_width, half_height; /* of a disc: both the radius */
    double area;
} lamp_shape;

/* The horizontal unit vector across an axis: x for an axis straight up or down. */
static inline vec3 lamp_right(vec3 axis)
{
    const bool vertical = axis.x * axis.x + axis.z * axis.z < 1e-12;
    return vertical ? vec3_make(1.0, 0.0, 0.0) : vec3_normalize(vec3_make(axis.z, 0.0, -axis.x));
}

/* The shape of a disc or rectangle light, which must not be at its own target. Its width is horizontal, or along x if
 * it emits straight up or down; roll_deg turns it about the axis, from right to up. */
static inline lamp_shape lamp_shape_of(const light *l)
{
    const vec3 axis = vec3_normalize(vec3_sub(l->target, l->position));
    const vec3 right = lamp_right(axis), up = vec3_cross(axis, right);
    double sine, cosine;
    elementary_sincos_deg(l->kind == LIGHT_DISC ? 0.0 : l->roll_deg, &sine, &cosine);
    const bool round = l->kind == LIGHT_DISC;
    const double half_width = round ? l->radius : 0.5 * l->width, half_height = round ? l->radius : 0.5 * l->height;
    return (lamp_shape){.round = round,
                        .axis = axis,
                        .right = vec3_add(vec3_scale(right, cosine), vec3_scale(up, sine)),
                        .up = vec3_sub(vec3_scale(up, cosine), vec3_scale(right, sine)),
                        .half_width = half_width,
                        .half_height = half_height,
                        .area = (round ? LAMP_PI : 4.0) * half_width * half_height};
}

/* A uniform point for random numbers u and v in (0, 1). */
static inline vec3 lamp_shape_point(const lamp_shape *s, vec3 centre, double u, double v)
{
    double x = 2.0 * u - 1.0, y = 2.0 * v - 1.0;
    if (s->round) {
        double sine, cosine;
        elementary_sincos_deg(360.0 * v, &sine, &cosine);
        x = sqrt(u) * cosine, y = sqrt(u) * sine;
    }
    return vec3_add(centre, vec3_add(vec3_scale(s->right, x * s->half_width), vec3_scale(s->up, y * s->half_height)));
}

/* The distance at which a ray along a unit vector hits the side that emits, or HUGE_VAL. */
static inline double lamp_shape_hit(const lamp_shape *s, vec3 centre, vec3 origin, vec3 direction)
{
    const double towards = -vec3_dot(direction, s->axis), above = vec3_dot(vec3_sub(origin, centre), s->axis);
    if (!(towards > 0.0 && above > 0.0))
        return (double)HUGE_VAL;
    const double t = above / towards;
    const vec3 at = vec3_sub(vec3_add(origin, vec3_scale(direction, t)), centre);
    const double x = vec3_dot(at, s->right) / s->half_width, y = vec3_dot(at, s->up) / s->half_height;
    const bool inside = s->round ? x * x + y * y <= 1.0 : fabs(x) <= 1.0 && fabs(y) <= 1.0;
    return inside ? t : (double)HUGE_VAL;
}

/* The lamp's radiance for an intensity of 1 and a colour of 1. */
static inline double lamp_shape_radiance(const lamp_shape *s, double reach)
{
    return LAMP_PI * reach * reach / s->area;
}
