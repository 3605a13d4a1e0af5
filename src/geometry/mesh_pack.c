#include "geometry/mesh_pack.h"

#include "geometry/mesh_parts.h"
#include "geometry/mesh_share.h"
#include <math.h>

/* A mesh's numbers. */
typedef struct mesh_head {
    uint64_t vertices, triangles;
    int64_t normals, uvs, slots, slot_count, closed, single; /* the first three: whether there are any */
    bounds3 bounds;
    uint64_t hole_from, hole_to, hole_triangle;
    int64_t hole_sharing;
    uint64_t hierarchies;
} mesh_head;
_Static_assert(sizeof(mesh_head) == 19 * 8, "no padding");

typedef struct mesh_array {
    void *bytes;
    size_t size;
} mesh_array;

enum { MESH_ARRAYS_OF = 5 };

static void list_arrays(const mesh *m, mesh_array out[MESH_ARRAYS_OF])
{
    out[0] = (mesh_array){m->vertices, m->vertex_count * sizeof *m->vertices};
    out[1] = (mesh_array){m->triangles, m->triangle_count * sizeof *m->triangles};
    out[2] = (mesh_array){m->normals, m->normals ? m->vertex_count * sizeof *m->normals : 0};
    out[3] = (mesh_array){m->uvs, m->uvs ? m->vertex_count * sizeof *m->uvs : 0};
    out[4] = (mesh_array){m->slots, m->slots ? m->triangle_count * sizeof *m->slots : 0};
}

static const hierarchy *stored_hierarchy(const mesh *m, int kind)
{
    return __atomic_load_n(&m->share->hierarchies[kind], __ATOMIC_ACQUIRE);
}

static mesh_head head_of(const mesh *m)
{
    mesh_head head = {.vertices = m->vertex_count,
                      .triangles = m->triangle_count,
                      .normals = m->normals != NULL,
                      .uvs = m->uvs != NULL,
                      .slots = m->slots != NULL,
                      .slot_count = m->slot_count,
                      .closed = m->closed,
                      .single = m->single,
                      .bounds = m->bounds,
                      .hole_from = m->hole.from,
                      .hole_to = m->hole.to,
                      .hole_triangle = m->hole.triangle,
                      .hole_sharing = m->hole.sharing};
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++)
        head.hierarchies += stored_hierarchy(m, kind) != NULL;
    return head;
}

status mesh_pack(const mesh *m, pack_writer *to, diagnostic *why)
{
    const mesh_head head = head_of(m);
    mesh_array arrays[MESH_ARRAYS_OF];
    list_arrays(m, arrays);
    TRY(pack_put(to, &head, sizeof head, why));
    for (int i = 0; i < MESH_ARRAYS_OF; i++)
        TRY(pack_put(to, arrays[i].bytes, arrays[i].size, why));
    for (int i = 0; i < m->slot_count; i++)
        TRY(pack_put_text(to, m->slot_names[i], why));
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++)
        if (stored_hierarchy(m, kind))
            TRY(hierarchy_pack(stored_hierarchy(m, kind), to, why));
    return STATUS_OK;
}

static bool within(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(values[i]) <= MESH_FAR)) /* true for NaN */
            return false;
    return true;
}

static status check_head(const mesh_head *h, const pack_reader *from, diagnostic *why)
{
    const uint64_t flags = (uint64_t)(h->normals | h->uvs | h->slots | h->closed | h->single);
    if (flags > 1 || h->slot_count < 1 || h->slot_count > MESH_SLOTS_MAX || h->hierarchies > HIERARCHY_KIND_COUNT)
        return pack_damaged(why, "the head of a mesh");
    if (!pack_holds(from, h->vertices, sizeof(vec3)) || !pack_holds(from, h->triangles, sizeof(mesh_triangle)))
        return pack_damaged(why, "a mesh is larger than the package");
    if (h->triangles && !within(&h->bounds.low.x, 6))
        return pack_damaged(why, "the bounds of a mesh");
    const bool hole = h->hole_from || h->hole_to || h->hole_triangle;
    if (hole && (h->hole_from >= h->vertices || h->hole_to >= h->vertices || h->hole_triangle >= h->triangles))
        return pack_damaged(why, "the hole of a mesh");
    return STATUS_OK;
}

/* Normals are unit vectors; what mesh_check looks at is more general. */
static status check_contents(const mesh *m, diagnostic *why)
{
    bool unit = true;
    for (size_t v = 0; m->normals && v < m->vertex_count; v++)
        unit &= fabs(vec3_dot(m->normals[v], m->normals[v]) - 1.0) < 1e-6; /* false for NaN */
    if (!unit || mesh_check(m, NULL) != STATUS_OK)
        return pack_damaged(why, "the arrays of a mesh");
    return STATUS_OK;
}

static status unpack_hierarchies(mesh *m, uint64_t count, pack_reader *from, diagnostic *why)
{
    for (uint64_t i = 0; i < count; i++) {
        hierarchy *h;
        hierarchy_kind kind;
        TRY(hierarchy_unpack(m, from, &h, &kind, why));
        m->share->destroy = hierarchy_destroy;
        if (m->share->hierarchies[kind]) {
            hierarchy_destroy(h);
            return pack_damaged(why, "a mesh has two hierarchies of a kind");
        }
        __atomic_store_n(&m->share->hierarchies[kind], h, __ATOMIC_RELEASE);
    }
    return STATUS_OK;
}

static status unpack_into(mesh *m, const mesh_head *head, pack_reader *from, diagnostic *why)
{
    mesh_array arrays[MESH_ARRAYS_OF];
    list_arrays(m, arrays);
    m->slot_count = (int)head->slot_count;
    m->closed = head->closed;
    m->single = head->single;
    m->bounds = head->bounds;
    m->hole = (mesh_hole){.from = (uint32_t)head->hole_from,
                          .to = (uint32_t)head->hole_to,
                          .triangle = head->hole_triangle,
                          .sharing = (int)head->hole_sharing};
    for (int i = 0; i < MESH_ARRAYS_OF; i++)
        TRY(pack_get(from, arrays[i].bytes, arrays[i].size, why));
    for (int i = 0; i < m->slot_count; i++)
        TRY(pack_get_text(from, &m->slot_names[i], why));
    TRY(check_contents(m, why));
    return unpack_hierarchies(m, head->hierarchies, from, why);
}

status mesh_unpack(pack_reader *from, const mesh **out, diagnostic *why)
{
    mesh_head head;
    mesh *m;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    TRY(check_head(&head, from, why));
    TRY(mesh_create(head.vertices, head.triangles, head.normals, head.uvs, head.slots, &m, why));
    const status code = unpack_into(m, &head, from, why);
    if (code != STATUS_OK) {
        mesh_release(m);
        return code;
    }
    *out = m;
    return STATUS_OK;
}
