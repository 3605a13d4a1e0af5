/* Quadruple precision (113 bits) as a reference for tests: the arithmetic for roots, rotations and Fresnel angles,
 * written here because libquadmath exists only for gcc, and long double is a double under valgrind. Elsewhere than on
 * x86, long double itself has them. Pure. */
#pragma once

#include "base/vec3.h"
#include <float.h>
#include <math.h>

#if LDBL_MANT_DIG == 113
typedef long double quad;
#else
__extension__ typedef __float128 quad;
#endif
typedef struct quad3 {
    quad x, y, z;
} quad3;

static inline quad quad_abs(quad a)
{
    return a < 0 ? -a : a;
}
static inline quad quad_min(quad a, quad b)
{
    return a < b ? a : b;
}
static inline quad quad_max(quad a, quad b)
{
    return a > b ? a : b;
}

/* Newton steps from the root in double precision: 53, 106, 113 bits. */
static inline quad quad_sqrt(quad a)
{
    if (a <= 0)
        return 0;
    quad scale = 1; /* scale into the range of doubles */
    for (; a > (quad)0x1p900; a *= (quad)0x1p-1000)
        scale *= (quad)0x1p500;
    for (; a < (quad)0x1p-900; a *= (quad)0x1p1000)
        scale *= (quad)0x1p-500;
    quad y = sqrt((double)a);
    for (int i = 0; i < 3; i++)
        y = (y + a / y) / 2;
    return y * scale;
}

static inline quad quad_pi(void)
{
    return (quad)3.141592653589793 + (quad)1.2246467991473532e-16 - (quad)2.9947698097183397e-33; /* exact doubles */
}

/* Taylor series after removing whole quarter turns. */
static inline void quad_sincos_deg(quad degrees, quad *sine, quad *cosine)
{
    int quarter = (int)floor((double)degrees / 90.0 + 0.5);
    quad x = (degrees - (quad)90 * quarter) * quad_pi() / 180, s = x, c = 1, term_s = x, term_c = 1;
    for (int k = 1; k < 18; k++) {
        term_s *= -x * x / ((2 * k) * (2 * k + 1));
        term_c *= -x * x / ((2 * k - 1) * (2 * k));
        s += term_s;
        c += term_c;
    }
    switch ((quarter % 4 + 4) % 4) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
    }
}

static inline quad3 quad3_make(quad x, quad y, quad z)
{
    quad3 v = {x, y, z};
    return v;
}
static inline quad3 quad3_from(vec3 v)
{
    return quad3_make(v.x, v.y, v.z);
}
static inline quad3 quad3_add(quad3 a, quad3 b)
{
    return quad3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline quad3 quad3_sub(quad3 a, quad3 b)
{
    return quad3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline quad3 quad3_scale(quad3 a, quad k)
{
    return quad3_make(a.x * k, a.y * k, a.z * k);
}
static inline quad quad3_dot(quad3 a, quad3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline quad quad3_length(quad3 a)
{
    return quad_sqrt(quad3_dot(a, a));
}
static inline quad3 quad3_cross(quad3 a, quad3 b)
{
    return quad3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

typedef struct quad_rotation {
    vec3 degrees;
    quad3 row[3];
} quad_rotation;

/* Rotation about x (y to z), then y (z to x), then z (x to y). */
static inline quad_rotation quad_rotation_make(vec3 degrees)
{
    const double angles[3] = {degrees.x, degrees.y, degrees.z};
    quad3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        for (int axis = 0; axis < 3; axis++) {
            quad3 v = axes[k];
            quad s, c;
            quad_sincos_deg(angles[axis], &s, &c);
            axes[k] = axis == 0   ? quad3_make(v.x, c * v.y - s * v.z, s * v.y + c * v.z)
                      : axis == 1 ? quad3_make(c * v.x + s * v.z, v.y, c * v.z - s * v.x)
                                  : quad3_make(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
        }
    }
    quad_rotation r = {
        degrees,
        {{axes[0].x, axes[1].x, axes[2].x}, {axes[0].y, axes[1].y, axes[2].y}, {axes[0].z, axes[1].z, axes[2].z}}};
    return r;
}

/* Caches the last few rotations, because their sines cost much more than applying them. */
static inline const quad_rotation *quad_rotation_of(vec3 degrees)
{
    enum { CACHE_SIZE = 16 };
    static _Thread_local quad_rotation cache[CACHE_SIZE];
    static _Thread_local int count;
    const int known = count < CACHE_SIZE ? count : CACHE_SIZE;
    for (int k = 0; k < known; k++)
        if (cache[k].degrees.x == degrees.x && cache[k].degrees.y == degrees.y && cache[k].degrees.z == degrees.z)
            return &cache[k];
    quad_rotation *next = &cache[count % CACHE_SIZE];
    count = count < 2 * CACHE_SIZE - 1 ? count + 1 : CACHE_SIZE;
    *next = quad_rotation_make(degrees);
    return next;
}

/* v rotated; backwards: by the inverse. */
static inline quad3 quad3_turn(quad3 v, vec3 degrees, int backwards)
{
    const quad3 *r = quad_rotation_of(degrees)->row;
    if (!backwards)
        return quad3_make(quad3_dot(r[0], v), quad3_dot(r[1], v), quad3_dot(r[2], v));
    return quad3_add(quad3_add(quad3_scale(r[0], v.x), quad3_scale(r[1], v.y)), quad3_scale(r[2], v.z));
}
