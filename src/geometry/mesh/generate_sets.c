/* The triangle sets of the speed studies: random triangles, and spheres from the icosahedron. */
#include "base/cancel.h"
#include "base/lanes.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/mesh/mesh_private.h"
#include <string.h>

/* --- random triangles --- */

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
    /* every step in single precision */
    return result == STATUS_OK ? soup(count, (double)(2.0f / cube_root((float)count) / 4.0f), out, why) : result;
}

status generate_dense_soup(size_t count, mesh **out, diagnostic *why)
{
    TRY(check_count(count, why));
    return soup(count, 0.5, out, why);
}

/* --- spheres ---
 *
 * Each of the icosahedron's 20 faces has its own triangular grid of vertices, row i of f + 1 holding i + 1 of them, so
 * that texture coordinates may be discontinuous at an edge; positions on a common edge are bit-identical. */

static const uint8_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

static vec3 icosahedron(int vertex)
{
    const double g = 0.5 * (1.0 + sqrt(5.0)); /* golden ratio */
    const vec3 at[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    return at[vertex];
}

static size_t row_start(size_t row)
{
    return row * (row + 1) / 2;
}

/* A mesh of 20 f f triangles without vertex positions. */
static status make_grids(size_t f, mesh **out, diagnostic *why)
{
    const size_t per_face = row_start(f + 1);
    status result = mesh_create(20 * per_face, 20 * f * f, true, true, false, out, why);
    mesh_triangle *triangle = result == STATUS_OK ? (*out)->triangles : NULL;
    for (size_t face = 0; triangle && face < 20; face++) {
        for (size_t i = 0; i < f && !cancel_asked(); i++) {
            for (size_t j = 0; j <= i; j++) {
                const uint32_t here = (uint32_t)(face * per_face + row_start(i) + j),
                               below = (uint32_t)(face * per_face + row_start(i + 1) + j);
                *triangle++ = (mesh_triangle){{here, below, below + 1}};
                if (j < i)
                    *triangle++ = (mesh_triangle){{here, below + 1, here + 1}};
            }
        }
    }
    return result;
}

/* Normals and texture coordinates of a face; longitudes are chosen near the longitude of the face's centre. */
static void set_attributes(mesh *m, size_t face, size_t per_face)
{
    const vec3 sum =
        vec3_add(vec3_add(icosahedron(faces[face][0]), icosahedron(faces[face][1])), icosahedron(faces[face][2]));
    const double middle_deg = generate_longitude_deg(sum);
    for (size_t v = face * per_face; v < (face + 1) * per_face; v++) {
        const vec3 p = m->vertices[v];
        if (cancel_asked_at(v))
            return;
        double away_deg =
            p.x == 0.0 && p.z == 0.0 ? 0.0 : generate_longitude_deg(p) - middle_deg; /* a pole has no longitude */
        away_deg += away_deg > 180.0 ? -360.0 : away_deg < -180.0 ? 360.0 : 0.0;
        m->normals[v] = p;
        m->uvs[v] = (mesh_uv){0.5 + (middle_deg + away_deg) / 360.0, generate_latitude_v(p)};
    }
}

static vec3 to_single(vec3 p)
{
    return vec3_make(single_round(p.x), single_round(p.y), single_round(p.z));
}

/* Projects the points of the flat face onto the sphere. The order of the sum is part of the definition. */
static void place_flat(mesh *m, size_t face, size_t f)
{
    const vec3 a = icosahedron(faces[face][0]), b = icosahedron(faces[face][1]), c = icosahedron(faces[face][2]);
    vec3 *vertex = m->vertices + face * row_start(f + 1);
    for (size_t i = 0; i <= f && !cancel_asked(); i++) {
        for (size_t j = 0; j <= i; j++) {
            const vec3 sum = vec3_add(vec3_add(vec3_scale(a, (double)(f - i)), vec3_scale(b, (double)(i - j))),
                                      vec3_scale(c, (double)j));
            const vec3 p = vec3_make(sum.x / (double)f, sum.y / (double)f, sum.z / (double)f);
            *vertex++ = to_single(vec3_normalize(p));
        }
    }
}

/* Places the corners, then repeatedly the vertices midway between neighbours, until all f + 1 rows exist. */
static void place_bisected(mesh *m, size_t face, size_t f)
{
    vec3 *grid = m->vertices + face * row_start(f + 1);
    grid[0] = vec3_normalize(icosahedron(faces[face][0]));
    grid[row_start(f)] = vec3_normalize(icosahedron(faces[face][1]));
    grid[row_start(f) + f] = vec3_normalize(icosahedron(faces[face][2]));
    for (size_t half = f / 2; half > 0; half /= 2) {
        for (size_t i = 0; i <= f && !cancel_asked(); i += half) {
            const size_t up = i % (2 * half) ? half : 0; /* a new row: neighbours above and below */
            for (size_t j = 0; j <= i; j += half) {
                const size_t left = j % (2 * half) ? half : 0; /* a new column: left and right */
                if (up || left)
                    grid[row_start(i) + j] = vec3_normalize(
                        vec3_add(grid[row_start(i - up) + j - left], grid[row_start(i + up) + j + left]));
            }
        }
    }
}

static status make_sphere(size_t f, void (*place)(mesh *m, size_t face, size_t f), mesh **out, diagnostic *why)
{
    mesh *m;
    TRY(make_grids(f, &m, why));
    for (size_t face = 0; face < 20 && !cancel_asked(); face++) {
        place(m, face, f);
        set_attributes(m, face, row_start(f + 1));
    }
    return generate_finish(m, true, out, why);
}

status generate_sphere(size_t count, mesh **out, diagnostic *why)
{
    if (count < 1 || count > MESH_TRIANGLES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 268435456", "a sphere cannot have %zu triangles", count);
    const size_t f = (size_t)floor(sqrt((double)count / 20.0) + 0.5);
    return make_sphere(f < 1 ? 1 : f, place_flat, out, why);
}

status generate_icosphere(int level, mesh **out, diagnostic *why)
{
    if (level < 0 || level > ICOSPHERE_LEVEL_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 0 to 11", "icosphere level %d is out of range", level);
    return make_sphere((size_t)1 << level, place_bisected, out, why);
}
