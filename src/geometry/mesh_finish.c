/* The checks, normals and bounds of a mesh at mesh_finish. */
#include "base/cancel.h"
#include "base/lanes.h"
#include "geometry/mesh.h"
#include "geometry/mesh_parts.h"

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
    }
    return STATUS_OK;
}

status mesh_check(const mesh *m, diagnostic *why)
{
    if (m->slot_count < 1 || m->slot_count > MESH_SLOTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 256", "a mesh cannot have %d material slots", m->slot_count);
    for (size_t t = 0; t < m->triangle_count; t++) {
        if (cancel_asked_at(t))
            return cancel_check(why);
        for (int k = 0; k < 3; k++) {
            if (m->triangles[t].corner[k] >= m->vertex_count)
                return diagnose(why, STATUS_BAD_INPUT, "number vertices from 0",
                                "triangle %zu refers to vertex %lu of %zu", t, (unsigned long)m->triangles[t].corner[k],
                                m->vertex_count);
        }
        if (m->slots && m->slots[t] >= m->slot_count)
            return diagnose(why, STATUS_BAD_INPUT, "the slots of materials must be numbered from 0",
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
    m->bounds = b;
    m->single = single;
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
