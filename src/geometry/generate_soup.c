/* The random triangle sets of the speed studies. */
#include "base/cancel.h"
#include "base/lanes.h"
#include "geometry/mesh_generators_parts.h"

#include <string.h>

/* Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; constants of Vigna's
 * splitmix64.c. */
static uint64_t splitmix64(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* A uniform number in [0, 1), a multiple of 2^-24: exactly a float. */
static double draw(uint64_t *state)
{
    return (double)(splitmix64(state) >> 40) * 0x1p-24;
}

/* c + e x of floats, rounded once to a float like a fused multiply-add. The product is exact in a double; the sum is
 * rounded to odd, after which rounding to a float is correct (Boldo and Melquiond, "Emulation of a FMA and correctly
 * rounded sums", IEEE TC 57(4), 2008). */
static double fused(double c, double e, double x)
{
    const double product = e * x;
    double sum = c + product;
    const double part = sum - c, error = (c - (sum - part)) + (product - part);
    uint64_t bits;
    memcpy(&bits, &sum, sizeof bits);
    if (error != 0.0 && (bits & 1) == 0) {
        bits += (error > 0.0) == (sum > 0.0) ? 1 : UINT64_MAX;
        memcpy(&sum, &bits, sizeof bits);
    }
    return single_round(sum);
}

/* Cube root of a float, rounded to the nearest float, by Newton's iteration from above. */
static float cube_root(float x)
{
    double root = x, next = x;
    do {
        root = next;
        next = (2.0 * root + (double)x / (root * root)) / 3.0;
    } while (next < root);
    return (float)root;
}

static status soup(size_t count, double edge, mesh **out, diagnostic *why)
{
    mesh *m;
    TRY(mesh_create(3 * count, count, false, false, false, &m, why));
    uint64_t state = 20240101;
    for (size_t t = 0; t < count && !cancel_asked_at(t); t++) {
        double center[3], corner[3][3];
        for (int axis = 0; axis < 3; axis++)
            center[axis] = 2.0 * draw(&state) - 1.0; /* exact */
        for (int k = 0; k < 9; k++)
            corner[k / 3][k % 3] = fused(center[k % 3], edge, draw(&state) - 0.5);
        for (int k = 0; k < 3; k++) {
            m->vertices[3 * t + (size_t)k] = vec3_make(corner[k][0], corner[k][1], corner[k][2]);
            m->triangles[t].corner[k] = (uint32_t)(3 * t) + (uint32_t)k;
        }
    }
    return generate_finish(m, false, out, why);
}

static status check_count(size_t count, diagnostic *why)
{
    if (count >= 1 && count <= MESH_TRIANGLES_MAX)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use 1 to 268435456", "%zu triangles are out of range", count);
}

status generate_sparse_soup(size_t count, mesh **out, diagnostic *why)
{
    status result = check_count(count, why);
    /* in single precision at every step */
    return result == STATUS_OK ? soup(count, (double)(2.0f / cube_root((float)count) / 4.0f), out, why) : result;
}

status generate_dense_soup(size_t count, mesh **out, diagnostic *why)
{
    TRY(check_count(count, why));
    return soup(count, 0.5, out, why);
}
