/* Creation, ownership, volume and area of triangle meshes. */
#include "base/array.h"
#include "base/budget.h"
#include "geometry/mesh.h"
#include "geometry/mesh_parts.h"
#include "geometry/mesh_share.h"

#include <stdlib.h>

static status no_room(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "use fewer triangles", "out of memory for a mesh");
}

static void mesh_free(mesh *m)
{
    struct mesh_share *share = m->share;
    if (share) {
        for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++)
            if (share->hierarchies[kind])
                share->destroy(share->hierarchies[kind]);
        pthread_mutex_destroy(&share->mutex);
        free(share);
    }
    for (int i = 0; i < MESH_SLOTS_MAX; i++)
        free(m->slot_names[i]);
    free(m->vertices);
    free(m->triangles);
    free(m->normals);
    free(m->uvs);
    free(m->slots);
    free(m);
}

static struct mesh_share *share_create(void)
{
    struct mesh_share *share = calloc(1, sizeof *share);
    if (share && pthread_mutex_init(&share->mutex, NULL) != 0) {
        free(share);
        share = NULL;
    }
    if (share)
        share->owners = 1;
    return share;
}

/* Its arrays, and the larger of what mesh_weld and mesh_close hold at a time. */
static uint64_t bytes_of(uint64_t vertices, uint64_t triangles, bool with_normals, bool with_uvs, bool with_slots)
{
    uint64_t table = 16;
    while (table < 2 * vertices)
        table *= 2;
    const uint64_t weld = sizeof(uint32_t) * (table + vertices),
                   close = 2 * sizeof(uint32_t) * vertices + 3 * 2 * sizeof(uint32_t) * triangles;
    return vertices * (sizeof(vec3) * (with_normals ? 2 : 1) + (with_uvs ? sizeof(mesh_uv) : 0)) +
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
    return memory_budget_check(bytes_of(vertex_count, triangle_count, with_normals, with_uvs, with_slots),
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
    m->share = share_create();
    m->vertices = large_calloc(vertices, sizeof *m->vertices);
    m->triangles = large_calloc(triangles, sizeof *m->triangles);
    m->normals = with_normals ? large_calloc(vertices, sizeof *m->normals) : NULL;
    m->uvs = with_uvs ? large_calloc(vertices, sizeof *m->uvs) : NULL;
    m->slots = with_slots ? large_calloc(triangles, sizeof *m->slots) : NULL;
    if (!m->share || !m->vertices || !m->triangles || (with_normals && !m->normals) || (with_uvs && !m->uvs) ||
        (with_slots && !m->slots)) {
        mesh_free(m);
        return no_room(why);
    }
    *out = m;
    return STATUS_OK;
}

void mesh_retain(const mesh *m)
{
    __atomic_fetch_add(&m->share->owners, 1, __ATOMIC_RELAXED);
}

void mesh_release(const mesh *m)
{
    if (m && __atomic_fetch_sub(&m->share->owners, 1, __ATOMIC_ACQ_REL) == 1)
        mesh_free((mesh *)m);
}

long mesh_owners(const mesh *m)
{
    return __atomic_load_n(&m->share->owners, __ATOMIC_ACQUIRE);
}

double mesh_triangle_volume6(const mesh *m, size_t triangle, vec3 origin)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    vec3 a = vec3_sub(m->vertices[corner[0]], origin), b = vec3_sub(m->vertices[corner[1]], origin);
    return vec3_dot(a, vec3_cross(b, vec3_sub(m->vertices[corner[2]], origin)));
}

/* Sum of the signed tetrahedra over the triangles (divergence theorem), from the centre of the bounds, where
 * cancellation is least. */
double mesh_volume(const mesh *m)
{
    const vec3 middle =
        m->triangle_count ? vec3_scale(vec3_add(m->bounds.low, m->bounds.high), 0.5) : vec3_make(0, 0, 0);
    double sum = 0.0;
    for (size_t t = 0; t < m->triangle_count; t++)
        sum += mesh_triangle_volume6(m, t, middle);
    return sum / 6.0;
}

double mesh_area(const mesh *m)
{
    double sum = 0.0;
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *corner = m->triangles[t].corner;
        const vec3 a = m->vertices[corner[0]];
        sum += vec3_length(vec3_cross(vec3_sub(m->vertices[corner[1]], a), vec3_sub(m->vertices[corner[2]], a)));
    }
    return 0.5 * sum;
}
