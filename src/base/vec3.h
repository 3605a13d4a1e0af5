/* Three-dimensional vectors and rotations in double precision. Pure inline functions; cannot fail. */
#pragma once

#include <math.h>
#include <stdbool.h>

typedef struct vec3 {
    double x, y, z;
} vec3;
typedef struct mat3 {
    vec3 row[3];
} mat3;

static inline vec3 vec3_make(double x, double y, double z)
{
    vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
static inline vec3 vec3_add(vec3 a, vec3 b)
{
    return vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline vec3 vec3_sub(vec3 a, vec3 b)
{
    return vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline vec3 vec3_scale(vec3 a, double k)
{
    return vec3_make(a.x * k, a.y * k, a.z * k);
}
static inline double vec3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double vec3_length(vec3 a)
{
    return sqrt(vec3_dot(a, a));
}
static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
/* a / |a|; a must not be zero. */
static inline vec3 vec3_normalize(vec3 a)
{
    double l = vec3_length(a);
    return vec3_make(a.x / l, a.y / l, a.z / l);
}
static inline bool vec3_is_finite(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

/* m v, and the transpose of m times v (the inverse, for a rotation). */
static inline vec3 mat3_apply(mat3 m, vec3 v)
{
    return vec3_make(vec3_dot(m.row[0], v), vec3_dot(m.row[1], v), vec3_dot(m.row[2], v));
}
static inline vec3 mat3_apply_transposed(mat3 m, vec3 v)
{
    return vec3_make(m.row[0].x * v.x + m.row[1].x * v.y + m.row[2].x * v.z,
                     m.row[0].y * v.x + m.row[1].y * v.y + m.row[2].y * v.z,
                     m.row[0].z * v.x + m.row[1].z * v.y + m.row[2].z * v.z);
}
