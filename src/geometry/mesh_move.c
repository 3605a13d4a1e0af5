/* The motion of a finished mesh's vertices, once per frame. One pass checks the new positions and computes their
 * bounds; only then are they copied, so that a failure leaves the mesh unchanged. */
#include "base/lanes.h"
#include "geometry/mesh.h"
#include "geometry/mesh_parts.h"
#include "geometry/mesh_share.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 512 }; /* vertices per block, processed while in the first-level cache */

typedef struct extent {
    double low[3], high[3];
    bool within; /* finite and within MESH_FAR */
    bool single;
} extent;

/* The bits of a double below a float's last bit, and the smallest normal float: a larger double without these bits is
 * exactly a float. */
#define BELOW_SINGLE 0x1fffffffu
#define SINGLE_NORMAL 0x1p-126

static bool all_single(const double *values, size_t count)
{
    uint64_t below = 0, tiny = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        below |= bits & BELOW_SINGLE;
        tiny |= (uint64_t)(fabs(values[i]) < SINGLE_NORMAL);
    }
    if (below)
        return false;
    for (size_t i = 0; tiny && i < count; i++)
        if (single_round(values[i]) != values[i])
            return false;
    return true;
}

static void extend(extent *e, const vec3 *v, size_t count)
{
    double low[3], high[3];
    memcpy(low, e->low, sizeof low);
    memcpy(high, e->high, sizeof high);
    bool within = true;
    for (size_t i = 0; i < count; i++) {
        const double at[3] = {v[i].x, v[i].y, v[i].z};
        for (int k = 0; k < 3; k++) {
            low[k] = at[k] < low[k] ? at[k] : low[k];
            high[k] = at[k] > high[k] ? at[k] : high[k];
            within &= fabs(at[k]) <= MESH_FAR; /* false for NaN */
        }
    }
    memcpy(e->low, low, sizeof low);
    memcpy(e->high, high, sizeof high);
    e->within &= within;
    e->single = e->single && within && all_single(&v[0].x, 3 * count);
}

static bool all_finite(const vec3 *v, size_t count)
{
    bool finite = true;
    for (size_t i = 0; i < count; i++)
        finite &= fabs(v[i].x) <= 0x1.fffffffffffffp1023 && fabs(v[i].y) <= 0x1.fffffffffffffp1023 &&
                  fabs(v[i].z) <= 0x1.fffffffffffffp1023;
    return finite;
}

/* Bounds are those of the vertices that triangles use. If triangles use all vertices, which is determined once, the
 * triangles need not be read. */
static bool uses_every_vertex(mesh *m)
{
    if (m->share->used == MESH_USED_UNKNOWN) {
        uint8_t *used = calloc(m->vertex_count + 1, 1);
        size_t count = 0;
        for (size_t t = 0; used && t < m->triangle_count; t++)
            for (int k = 0; k < 3; k++) {
                uint8_t *one = &used[m->triangles[t].corner[k]];
                count += !*one;
                *one = 1;
            }
        free(used);
        if (!used)
            return false; /* correct too, but slower */
        m->share->used = count == m->vertex_count ? MESH_USED_ALL : MESH_USED_SOME;
    }
    return m->share->used == MESH_USED_ALL;
}

status mesh_move(mesh *m, const vec3 *vertices, const vec3 *normals, diagnostic *why)
{
    const bool turns = normals && m->normals;
    extent e = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, true, true};
    for (size_t first = 0; first < m->vertex_count; first += PIECE)
        extend(&e, vertices + first, m->vertex_count - first < PIECE ? m->vertex_count - first : PIECE);
    if (!e.within || (turns && !all_finite(normals, m->vertex_count))) {
        mesh moved = *m; /* for the error message about the vertex */
        moved.vertices = (vec3 *)vertices;
        moved.normals = turns ? (vec3 *)normals : NULL;
        return mesh_check(&moved, why);
    }
    memmove(m->vertices, vertices, m->vertex_count * sizeof *vertices);
    if (uses_every_vertex(m)) {
        m->bounds = (bounds3){{e.low[0], e.low[1], e.low[2]}, {e.high[0], e.high[1], e.high[2]}};
        m->single = e.single;
    } else {
        mesh_find_bounds(m);
    }
    if (turns) {
        memmove(m->normals, normals, m->vertex_count * sizeof *normals);
        mesh_normalize(m);
    }
    return STATUS_OK;
}
