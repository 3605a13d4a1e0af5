/* The cone of a spotlight: a `cone` emits all its light within the half-angle a from the axis, a `soft_cone` a share
 * that falls from 1 on the axis to 0 at the half-angle, linear in the cosine: (cos t - cos a) / (1 - cos a). A flat
 * lamp as a point is a soft cone of 90 degrees: Lambert's law. A sun's is the cone of its light's directions at any
 * point. Pure. */
#pragma once

#include "base/elementary.h"
#include "base/lanes.h"
#include "base/vec3.h"
#include "scene/model/lights.h"
#include <stdbool.h>

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
    const bool all_around = l->kind == LIGHT_CONE && l->half_angle_deg == 180.0; /* whatever the rounding */
    return (light_cone){vec3_normalize(vec3_sub(l->target, l->position)), all_around ? 3.0 : 2.0 * sine * sine};
}

/* 1 - cos t of a direction from the light, a unit vector: half the squared distance from the axis, which avoids
 * cancellation. */
static inline double light_cone_off(const light_cone *c, vec3 direction)
{
    const vec3 off = vec3_sub(direction, c->axis);
    return 0.5 * vec3_dot(off, off);
}

/* The share of the light that is emitted in a direction, 0..1. */
static inline double light_cone_share(const light_cone *c, bool soft, vec3 direction)
{
    const double off = light_cone_off(c, direction);
    const double hard = blend(mask_less(c->opening, off), 0.0, 1.0), linear = greater(1.0 - off / c->opening, 0.0);
    return soft ? linear : hard;
}

/* Does its light depend on the direction? */
static inline bool light_has_cone(const light *l)
{
    return l->kind != LIGHT_POINT && l->kind != LIGHT_SUN;
}

/* The same for any light. */
static inline double light_share(const light *l, const light_cone *c, vec3 direction)
{
    return light_has_cone(l) ? light_cone_share(c, l->kind != LIGHT_CONE, direction) : 1.0;
}

/* --- of a frame's lights, see plan.h --- */

/* Sine of a sun's angular radius, squared: 1 - cos^2, of 1 - cos. */
static inline double light_sun_sine2(const light_cone *c)
{
    return c->opening * (2.0 - c->opening);
}

/* The vector from a point to the light's position; to a sun, as far away from any point. */
static inline vec3 light_towards(const light *l, vec3 point)
{
    return l->kind == LIGHT_SUN ? l->position : vec3_sub(l->position, point);
}
