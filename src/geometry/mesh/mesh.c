/* Triangle meshes: creation and owners, the checks, normals and bounds of mesh_finish, and mesh_move. */
#include "geometry/mesh/mesh.h"
#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "base/lanes.h"
#include "geometry/mesh/mesh_private.h"
#include <stdlib.h>
#include <string.h>

static status no_room(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "use fewer triangles", "out of memory for a mesh");
}

void mesh_forget_operands(mesh *m)
{
    struct mesh_shared *shared = m->shared;
    for (int i = 0; i < shared->operand_count; i++)
        if (shared->operands[i] != m)
            mesh_release(shared->operands[i]);
    free(shared->operands);
    shared->operands = NULL;
    shared->operand_count = 0;
}

static void mesh_free(mesh *m)
{
    struct mesh_shared *shared = m->shared;
    if (shared) {
        for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++)
            if (shared->hierarchies[kind])
                shared->destroy(shared->hierarchies[kind]);
        mesh_forget_operands(m);
        pthread_mutex_destroy(&shared->mutex);
        free(shared);
    }
    for (int i = 0; i < MESH_SLOTS_MAX; i++)
        free(m->slot_names[i]);
    free(m->vertices);
    free(m->triangles);
    free(m->normals);
    free(m->uvs);
    free(m->colors);
    free(m->slots);
    free(m->numbers);
    free(m);
}

static struct mesh_shared *shared_create(void)
{
    struct mesh_shared *shared = calloc(1, sizeof *shared);
    if (shared && pthread_mutex_init(&shared->mutex, NULL) != 0) {
        free(shared);
        shared = NULL;
    }
    if (shared)
        shared->owners = 1;
    return shared;
}

/* Bytes of a mesh's arrays, and of the larger of the temporary arrays of mesh_weld and mesh_close. */
static uint64_t bytes_of(uint64_t vertices, uint64_t triangles, bool with_normals, bool with_uvs, bool with_slots,
                         bool with_colors)
{
    uint64_t table = 16;
    while (table < 2 * vertices)
        table *= 2;
    const uint64_t weld = sizeof(uint32_t) * (table + vertices),
                   close = 2 * sizeof(uint32_t) * vertices + 7 * sizeof(uint32_t) * triangles;
    return vertices * (sizeof(vec3) * (with_normals ? 2 : 1) + (with_uvs ? sizeof(mesh_uv) : 0) +
                       (with_colors ? sizeof(float[3]) : 0)) +
           triangles * (sizeof(mesh_triangle) + (with_slots ? 1 : 0)) + (weld > close ? weld : close);
}

status mesh_check_size(size_t vertex_count, size_t triangle_count, bool with_normals, bool with_uvs, bool with_slots,
                       diagnostic *why)
{
    if (triangle_count > MESH_TRIANGLES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 268435456 triangles",
                        "a mesh of %zu triangles is too large", triangle_count);
    if (vertex_count > MESH_VERTICES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 536870912 vertices", "a mesh of %zu vertices is too large",
                        vertex_count);
    return memory_budget_check(bytes_of(vertex_count, triangle_count, with_normals, with_uvs, with_slots, false),
                               "use fewer triangles", why, "a mesh of %zu triangles", triangle_count);
}

status mesh_create(size_t vertex_count, size_t triangle_count, bool with_normals, bool with_uvs, bool with_slots,
                   mesh **out, diagnostic *why)
{
    TRY(mesh_check_size(vertex_count, triangle_count, with_normals, with_uvs, with_slots, why));
    mesh *m = calloc(1, sizeof *m);
    if (!m)
        return no_room(why);
    const size_t vertices = vertex_count ? vertex_count : 1, triangles = triangle_count ? triangle_count : 1;
    m->vertex_count = vertex_count;
    m->triangle_count = triangle_count;
    m->slot_count = 1;
    m->shared = shared_create();
    m->vertices = large_calloc(vertices, sizeof *m->vertices);
    m->triangles = large_calloc(triangles, sizeof *m->triangles);
    m->normals = with_normals ? large_calloc(vertices, sizeof *m->normals) : NULL;
    m->uvs = with_uvs ? large_calloc(vertices, sizeof *m->uvs) : NULL;
    m->slots = with_slots ? large_calloc(triangles, sizeof *m->slots) : NULL;
    if (!m->shared || !m->vertices || !m->triangles || (with_normals && !m->normals) || (with_uvs && !m->uvs) ||
        (with_slots && !m->slots)) {
        mesh_free(m);
        return no_room(why);
    }
    *out = m;
    return STATUS_OK;
}

/* The other arrays count as well: their pages are not in use before they are written. */
status mesh_add_colors(mesh *m, diagnostic *why)
{
    const uint64_t bytes = bytes_of(m->vertex_count, m->triangle_count, m->normals, m->uvs, m->slots, true);
    TRY(memory_budget_check(bytes, "use fewer triangles", why, "a mesh of %zu triangles", m->triangle_count));
    m->colors = large_calloc(m->vertex_count ? m->vertex_count : 1, sizeof *m->colors);
    return m->colors ? STATUS_OK : no_room(why);
}

void mesh_retain(const mesh *m)
{
    __atomic_fetch_add(&m->shared->owners, 1, __ATOMIC_RELAXED);
}

void mesh_release(const mesh *m)
{
    if (m && __atomic_fetch_sub(&m->shared->owners, 1, __ATOMIC_ACQ_REL) == 1)
        mesh_free((mesh *)m);
}

long mesh_reference_count(const mesh *m)
{
    return __atomic_load_n(&m->shared->owners, __ATOMIC_ACQUIRE);
}

/* --- mesh_finish --- */

static bool within(vec3 v, double limit)
{
    return fabs(v.x) <= limit && fabs(v.y) <= limit && fabs(v.z) <= limit; /* false for NaN */
}

static status check_vertices(const mesh *m, diagnostic *why)
{
    for (size_t v = 0; v < m->vertex_count; v++) {
        const vec3 p = m->vertices[v];
        if (cancel_asked_at(v))
            return cancel_check(why);
        if (!within(p, MESH_FAR))
            return diagnose(why, STATUS_BAD_INPUT, "use finite coordinates of at most 1e9",
                            "vertex %zu has the coordinates %g, %g, %g", v, p.x, p.y, p.z);
        if (m->normals && !within(m->normals[v], 0x1.fffffffffffffp1023))
            return diagnose(why, STATUS_BAD_INPUT, "use finite normals", "vertex %zu has a normal that is not finite",
                            v);
        if (m->uvs && !(fabs(m->uvs[v].u) <= MESH_FAR && fabs(m->uvs[v].v) <= MESH_FAR))
            return diagnose(why, STATUS_BAD_INPUT, "use finite texture coordinates of at most 1e9",
                            "vertex %zu has texture coordinates %g, %g", v, m->uvs[v].u, m->uvs[v].v);
        for (int c = 0; m->colors && c < 3; c++)
            if (!(m->colors[v][c] >= 0.0f && m->colors[v][c] <= 1.0f)) /* true for NaN */
                return diagnose(why, STATUS_BAD_INPUT, "use colours from 0 to 1", "vertex %zu has a colour of %g", v,
                                (double)m->colors[v][c]);
    }
    return STATUS_OK;
}

status mesh_check(const mesh *m, diagnostic *why)
{
    if (m->slot_count < 1 || m->slot_count > MESH_SLOTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 256 material slots", "a mesh cannot have %d material slots",
                        m->slot_count);
    for (size_t t = 0; t < m->triangle_count; t++) {
        if (cancel_asked_at(t))
            return cancel_check(why);
        for (int k = 0; k < 3; k++) {
            if (m->triangles[t].corner[k] >= m->vertex_count)
                return diagnose(why, STATUS_BAD_INPUT, "number vertices from 0 to one less than their number",
                                "triangle %zu refers to vertex %lu of %zu", t, (unsigned long)m->triangles[t].corner[k],
                                m->vertex_count);
        }
        if (m->slots && m->slots[t] >= m->slot_count)
            return diagnose(why, STATUS_BAD_INPUT, "number material slots from 0 to one less than their number",
                            "triangle %zu refers to material slot %d of %d", t, m->slots[t], m->slot_count);
    }
    return check_vertices(m, why);
}

static double largest(vec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

/* The direction as a unit vector, for any length; false for the zero vector. */
static bool direction_of(vec3 v, vec3 *unit)
{
    const double scale = largest(v);
    *unit = vec3_make(0.0, 0.0, 0.0);
    if (!(scale > 0.0))
        return false;
    *unit = vec3_normalize(vec3_make(v.x / scale, v.y / scale, v.z / scale));
    return true;
}

/* Unit normal of a triangle's front; a zero vector if it has none. */
static vec3 front_of(const mesh *m, mesh_triangle triangle)
{
    const vec3 *at = m->vertices, a = at[triangle.corner[0]];
    vec3 b, c, normal = vec3_make(0.0, 0.0, 0.0);
    /* edges as unit vectors: the product of small ones would underflow */
    if (direction_of(vec3_sub(at[triangle.corner[1]], a), &b) && direction_of(vec3_sub(at[triangle.corner[2]], a), &c))
        direction_of(vec3_cross(b, c), &normal);
    return normal;
}

void mesh_normalize(mesh *m)
{
    bool missing = false;
    for (size_t v = 0; v < m->vertex_count && !cancel_asked_at(v); v++)
        missing |= !direction_of(m->normals[v], &m->normals[v]);
    for (size_t t = 0; missing && t < m->triangle_count && !cancel_asked_at(t); t++) {
        for (int k = 0; k < 3; k++) {
            vec3 *normal = &m->normals[m->triangles[t].corner[k]];
            if (largest(*normal) == 0.0)
                *normal = front_of(m, m->triangles[t]);
        }
    }
    for (size_t v = 0; missing && v < m->vertex_count; v++)
        if (largest(m->normals[v]) == 0.0)
            m->normals[v] = vec3_make(0.0, 1.0, 0.0); /* no adjacent triangle has an area */
}

void mesh_find_bounds(mesh *m)
{
    bounds3 b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    bool single = true;
    for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
        for (int k = 0; k < 3; k++) {
            const vec3 p = m->vertices[m->triangles[t].corner[k]];
            b.low = vec3_make(fmin(b.low.x, p.x), fmin(b.low.y, p.y), fmin(b.low.z, p.z));
            b.high = vec3_make(fmax(b.high.x, p.x), fmax(b.high.y, p.y), fmax(b.high.z, p.z));
            single &= single_round(p.x) == p.x && single_round(p.y) == p.y && single_round(p.z) == p.z;
        }
    }
    for (size_t v = 0; m->triangle_count == 0 && v < m->vertex_count && !cancel_asked_at(v); v++) {
        const vec3 p = m->vertices[v];
        b.low = vec3_make(fmin(b.low.x, p.x), fmin(b.low.y, p.y), fmin(b.low.z, p.z));
        b.high = vec3_make(fmax(b.high.x, p.x), fmax(b.high.y, p.y), fmax(b.high.z, p.z));
    }
    m->bounds = b;
    m->single = single;
}

void mesh_mirror(mesh *m)
{
    for (size_t v = 0; v < m->vertex_count && !cancel_asked_at(v); v++)
        m->vertices[v].z = 0.0 - m->vertices[v].z;
    for (size_t v = 0; m->normals && v < m->vertex_count && !cancel_asked_at(v); v++)
        m->normals[v].z = 0.0 - m->normals[v].z;
    for (size_t t = 0; t < m->triangle_count && !cancel_asked_at(t); t++) {
        uint32_t *corner = m->triangles[t].corner;
        const uint32_t swapped = corner[1];
        corner[1] = corner[2];
        corner[2] = swapped;
    }
}

status mesh_finish(mesh *m, diagnostic *why)
{
    TRY(mesh_check(m, why));
    mesh_find_bounds(m);
    status result = cancel_check(why);
    THEN(result, mesh_close(m, why));
    if (result == STATUS_OK && m->normals)
        mesh_normalize(m);
    THEN(result, cancel_check(why));
    m->distinct = false; /* the caller may move vertices */
    return result;
}

/* --- mesh_move ---
 *
 * One pass checks the new positions and computes their bounds; only then are they copied, so that a failure leaves the
 * mesh unchanged. */

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

/* Bounds cover only the vertices that triangles use. If triangles use all vertices, which is determined once, mesh_move
 * need not read the triangles. */
static bool uses_every_vertex(mesh *m)
{
    if (m->shared->used == MESH_USED_UNKNOWN) {
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
        m->shared->used = count == m->vertex_count ? MESH_USED_ALL : MESH_USED_SOME;
    }
    return m->shared->used == MESH_USED_ALL;
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
    mesh_forget_operands(m);
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
