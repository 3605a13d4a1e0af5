/* Divides polygons into triangles: a quadrilateral at its reflex corner, others by cutting off ears (Meisters,
 * "Polygons have ears", 1975) in the coordinate plane most nearly perpendicular to their normal. A polygon of n corners
 * always gives n - 2 triangles that use each of its edges once, so that a closed mesh stays closed. */
#include "base/array.h"
#include "import/plain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct polygon_corner {
    double x, y;    /* projected, counterclockwise */
    uint32_t after; /* the next corner that is not yet cut off */
} corner;

static bool reserve(polygon *p, size_t count)
{
    if (count <= p->room)
        return true;
    polygon_release(p);
    p->room = 2 * count;
    p->corners = malloc(p->room * sizeof *p->corners);
    p->reflex = malloc(p->room * sizeof *p->reflex);
    p->triangles = malloc(p->room * sizeof *p->triangles);
    return p->corners && p->reflex && p->triangles;
}

void polygon_release(polygon *p)
{
    free(p->corners), free(p->reflex), free(p->triangles);
    *p = (polygon){0};
}

/* Newell's normal: twice the signed areas of the polygon's projections onto the coordinate planes, relative to the
 * first corner, so that a small polygon far from the origin keeps its digits. */
static vec3 normal_of(const vec3 *all, const uint32_t *indices, size_t count)
{
    vec3 n = vec3_make(0, 0, 0), before = n;
    for (size_t i = 1; i < count; i++) {
        const vec3 here = vec3_sub(all[indices[i]], all[indices[0]]);
        n = vec3_add(n, vec3_cross(before, here));
        before = here;
    }
    return n;
}

/* Projects the polygon along the axis of its normal's largest component, counterclockwise. */
static void project(const vec3 *all, const uint32_t *indices, size_t count, corner *flat)
{
    const vec3 n = normal_of(all, indices, count);
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    const int axis = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
    const bool backwards = (axis == 0 ? n.x : axis == 1 ? n.y : n.z) < 0.0;
    for (size_t i = 0; i < count; i++) {
        const vec3 p = vec3_sub(all[indices[i]], all[indices[0]]);
        const double a = axis == 0 ? p.y : axis == 1 ? p.z : p.x, b = axis == 0 ? p.z : axis == 1 ? p.x : p.y;
        flat[i] = (corner){backwards ? b : a, backwards ? a : b, (uint32_t)((i + 1) % count)};
    }
}

/* Twice the signed area. */
static double area(const corner *a, const corner *b, const corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

/* At the diagonal from corner 0, unless the quadrilateral lies better at the other one. */
static void divide_four(const corner *c, uint32_t (*triangles)[3])
{
    const double at_0 = fmin(area(&c[0], &c[1], &c[2]), area(&c[0], &c[2], &c[3])),
                 at_1 = fmin(area(&c[1], &c[2], &c[3]), area(&c[1], &c[3], &c[0]));
    const uint32_t from = at_0 > 0.0 || at_0 >= at_1 ? 0 : 1;
    for (uint32_t t = 0; t < 2; t++)
        memcpy(triangles[t], (uint32_t[3]){from, (from + t + 1) % 4, (from + t + 2) % 4}, sizeof *triangles);
}

static bool equal(const corner *a, const corner *b)
{
    return a->x == b->x && a->y == b->y;
}

/* Only corners that were not convex at the beginning can lie in an ear. */
static bool is_ear(const polygon *p, size_t reflex_count, uint32_t before, uint32_t ear)
{
    const corner *a = &p->corners[before], *b = &p->corners[ear], *c = &p->corners[b->after];
    if (!(area(a, b, c) > 0.0))
        return false;
    for (size_t i = 0; i < reflex_count; i++) {
        const corner *q = &p->corners[p->reflex[i]];
        if (area(a, b, q) >= 0.0 && area(b, c, q) >= 0.0 && area(c, a, q) >= 0.0 && !equal(q, a) && !equal(q, b) &&
            !equal(q, c))
            return false;
    }
    return true;
}

static size_t find_reflex(polygon *p, size_t count)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        if (!(area(&p->corners[(i + count - 1) % count], &p->corners[i], &p->corners[(i + 1) % count]) > 0.0))
            p->reflex[found++] = (uint32_t)i;
    return found;
}

/* Begins at the first corner, from which a convex polygon is divided. When a whole turn finds no ear, the polygon is
 * not simple, and the rest is divided from one corner. */
static void cut_ears(polygon *p, size_t count)
{
    const size_t reflex_count = find_reflex(p, count);
    uint32_t before = 0, ear = 1;
    size_t divided = 0, tries = 0;
    for (bool simple = true; divided < count - 2;) {
        const uint32_t next = p->corners[ear].after;
        simple = simple && tries < count - divided;
        if (!simple || divided == count - 3 || is_ear(p, reflex_count, before, ear)) {
            memcpy(p->triangles[divided++], (uint32_t[3]){before, ear, next}, sizeof *p->triangles);
            p->corners[before].after = next;
            tries = 0;
        } else {
            before = ear;
            tries++;
        }
        ear = next;
    }
}

static void append(flat_mesh *flat, const uint32_t *indices, const uint32_t corners[3], uint8_t slot)
{
    const size_t t = flat->triangle_count++;
    for (int k = 0; k < 3; k++)
        flat->triangles[t][k] = indices[corners[k]];
    flat->slots[t] = slot;
}

status polygon_append(const request *req, polygon *p, const uint32_t *indices, size_t count, uint8_t slot,
                      flat_mesh *flat, diagnostic *why)
{
    if (count == 3) {
        append(flat, indices, (uint32_t[3]){0, 1, 2}, slot);
        return STATUS_OK;
    }
    if (!reserve(p, count))
        return no_memory_for(req, why);
    project(flat->positions, indices, count, p->corners);
    if (count == 4)
        divide_four(p->corners, p->triangles);
    else
        cut_ears(p, count);
    for (size_t t = 0; t < count - 2; t++)
        append(flat, indices, p->triangles[t], slot);
    return STATUS_OK;
}
