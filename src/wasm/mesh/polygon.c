/* Divides polygons into triangles: a quadrilateral at its reflex corner, others by cutting off ears (Meisters,
 * "Polygons have ears", 1975) in the coordinate plane most nearly perpendicular to their normal. Single precision, and
 * the order of the ears, are as in the program's importer. */
#include "wasm/mesh/mesh.h"

#include <math.h>
#include <string.h>

typedef struct point {
    float x, y;
} point;

static float length(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The angle at a between the directions to b and c. */
static float angle(const float a[3], const float b[3], const float c[3])
{
    float u[3], v[3], dot = 0.0F;
    for (int k = 0; k < 3; k++)
        u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    const float size_u = length(u), size_v = length(v);
    for (int k = 0; k < 3; k++)
        dot += (size_u > 0.0F ? u[k] / size_u : u[k]) * (size_v > 0.0F ? v[k] / size_v : v[k]);
    return acosf(dot);
}

static void divide_four(const float (*p)[3], uint32_t (*triangles)[3])
{
    uint32_t from = 0;
    for (uint32_t i = 0; i < 4; i++) {
        const float *opposite = p[(i + 2) % 4];
        if (angle(p[i], p[(i + 3) % 4], opposite) + angle(p[i], p[(i + 1) % 4], opposite) > (float)M_PI) {
            from = i;
            break;
        }
    }
    for (uint32_t t = 0; t < 2; t++) {
        triangles[t][0] = from;
        triangles[t][1] = (from + t + 1) % 4;
        triangles[t][2] = (from + t + 2) % 4;
    }
}

/* Newell's normal: twice the signed areas of the polygon's projections onto the coordinate planes. */
static void normal_of(const float (*p)[3], size_t count, float n[3])
{
    memset(n, 0, 3 * sizeof *n);
    for (size_t i = 0; i < count; i++) {
        const float *before = p[(i + count - 1) % count], *here = p[i], *after = p[(i + 1) % count];
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] += here[a] * (after[b] - before[b]);
        }
    }
}

/* Projects the polygon along the axis of its normal's largest component, counterclockwise. */
static void project(const float (*p)[3], size_t count, point *flat)
{
    float n[3];
    normal_of(p, count, n);
    const float x = fabsf(n[0]), y = fabsf(n[1]), z = fabsf(n[2]);
    const int k = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    for (size_t i = 0; i < count; i++)
        flat[i] = n[k] < 0.0F ? (point){p[i][b], p[i][a]} : (point){p[i][a], p[i][b]};
}

/* Twice the signed area. */
static float area(point a, point b, point c)
{
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

static bool equal(point a, point b)
{
    return a.x == b.x && a.y == b.y;
}

static bool is_ear(const point *flat, size_t count, const size_t at[3])
{
    const point a = flat[at[0]], b = flat[at[1]], c = flat[at[2]];
    if (!(area(a, b, c) > 0.0F))
        return false;
    for (size_t i = 0; i < count; i++) {
        const point q = flat[i];
        if (!equal(q, a) && !equal(q, b) && !equal(q, c) && area(a, b, q) >= 0.0F && area(b, c, q) >= 0.0F &&
            area(c, a, q) >= 0.0F)
            return false;
    }
    return true;
}

size_t polygon_divide(const float (*places)[3], size_t count, uint32_t (*triangles)[3])
{
    if (count == 4) {
        divide_four(places, triangles);
        return 2;
    }
    point flat[POLYGON_MAX];
    uint16_t after[POLYGON_MAX]; /* the next corner that is not yet cut off */
    project(places, count, flat);
    for (size_t i = 0; i < count; i++)
        after[i] = (uint16_t)((i + 1) % count);
    size_t divided = 0, before = count - 1, ear = 0, left = count;
    for (size_t tries = 0; left > 3 && tries < 2 * left; tries++) {
        const size_t next = after[ear];
        if (is_ear(flat, count, (size_t[3]){before, ear, next})) {
            memcpy(triangles[divided++], (uint32_t[3]){(uint32_t)before, (uint32_t)ear, (uint32_t)next},
                   sizeof *triangles);
            after[before] = (uint16_t)next;
            left--;
            tries = 0;
        } else {
            before = ear;
        }
        ear = next;
    }
    if (left > 3) /* the polygon is not simple: returns the ears so far */
        return divided;
    size_t last[3] = {ear, after[ear], after[after[ear]]}; /* in the polygon's order, beginning at the lowest index */
    while (last[0] > last[1] || last[0] > last[2])
        memcpy(last, (size_t[3]){last[1], last[2], last[0]}, sizeof last);
    memcpy(triangles[divided++], (uint32_t[3]){(uint32_t)last[0], (uint32_t)last[1], (uint32_t)last[2]},
           sizeof *triangles);
    return divided;
}
