/* Meshes and their hierarchies as bytes (hierarchy.h). */
#include "base/cancel.h"
#include "geometry/hierarchy/bvh.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh_private.h"
#include <math.h>
#include <stdlib.h>

/* --- hierarchies: the nodes, and the numbers of the triangles in the blocks --- */

typedef struct hierarchy_head {
    int64_t kind, single;
    uint64_t blocks, nodes, referred;
    double built_cost;
    uint64_t bytes, leaves;
    int64_t depth, threads;
    double build_s;
} hierarchy_head;
_Static_assert(sizeof(hierarchy_head) == 11 * 8, "no padding");

/* Blocks whose numbers are written at once. */
enum { CHUNK_BLOCKS = 4096 };
typedef uint32_t chunk[CHUNK_BLOCKS][BLOCK];

static bool is_bvh(const hierarchy *h)
{
    return h->kind == HIERARCHY_BVH;
}

static bool is_spheres(const hierarchy *h)
{
    return h->kind == HIERARCHY_SPHERE || h->kind == HIERARCHY_OCTANT;
}

static size_t chunk_of(const hierarchy *h, size_t first)
{
    return h->block_count - first < CHUNK_BLOCKS ? h->block_count - first : CHUNK_BLOCKS;
}

static const uint32_t *numbers_of(const hierarchy *h, size_t block)
{
    return h->single ? ((const block_single *)h->blocks)[block].triangle
                     : ((const block_double *)h->blocks)[block].triangle;
}

static status pack_blocks(const hierarchy *h, pack_writer *to, diagnostic *why)
{
    chunk *numbers = malloc(sizeof *numbers);
    status code = numbers ? STATUS_OK : out_of_memory(why);
    for (size_t first = 0; first < h->block_count && code == STATUS_OK; first += CHUNK_BLOCKS) {
        const size_t count = chunk_of(h, first);
        for (size_t i = 0; to->write && i < count; i++)
            memcpy((*numbers)[i], numbers_of(h, first + i), sizeof(*numbers)[i]);
        code = pack_put(to, numbers, count * sizeof **numbers, why);
    }
    free(numbers);
    return code;
}

status hierarchy_pack(const hierarchy *h, pack_writer *to, diagnostic *why)
{
    const hierarchy_head head = {.kind = h->kind,
                                 .single = h->single,
                                 .blocks = h->block_count,
                                 .nodes = h->node_count,
                                 .referred = h->referred,
                                 .built_cost = h->built_cost,
                                 .bytes = h->report.bytes,
                                 .leaves = h->report.leaves,
                                 .depth = h->report.depth,
                                 .threads = h->report.threads,
                                 .build_s = h->report.build_s};
    TRY(pack_put(to, &head, sizeof head, why));
    if (is_bvh(h))
        TRY(pack_put(to, h->nodes, h->node_count * sizeof *h->nodes, why));
    if (is_spheres(h))
        TRY(pack_put(to, h->spheres, h->node_count * sizeof *h->spheres, why));
    return pack_blocks(h, to, why);
}

static status check_hierarchy_head(const mesh *m, const hierarchy_head *head, const pack_reader *from, diagnostic *why)
{
    const bool none = head->kind == HIERARCHY_NONE;
    const size_t node = none ? 1 : head->kind == HIERARCHY_BVH ? sizeof(bvh_node) : sizeof(sphere_node);
    if (head->kind < HIERARCHY_NONE || head->kind >= HIERARCHY_KIND_COUNT || (head->single != 0 && head->single != 1) ||
        (head->single && !m->single))
        return pack_damaged(why, "the head of a hierarchy");
    if ((none ? head->nodes != 0 : head->nodes < 1 || head->nodes >= CHILD_LEAF) ||
        head->blocks > child_first_block(UINT32_MAX) || head->referred > m->triangle_count ||
        !pack_holds(from, head->nodes, node) || !pack_holds(from, head->blocks, BLOCK * sizeof(uint32_t)))
        return pack_damaged(why, "the size of a hierarchy");
    return STATUS_OK;
}

/* Marks a node's children with their level, from 1 for the root. false: the node has no parent, or a child is out of
 * range, precedes its parent, has another parent too, or is too deep. */
static bool mark_children(uint8_t *level, size_t count, size_t parent, uint64_t first, uint64_t children, int deepest)
{
    if (level[parent] == 0 || children == 0)
        return level[parent] != 0;
    if (first <= parent || first >= count || children > count - first || level[parent] >= deepest)
        return false;
    for (uint64_t i = first; i < first + children; i++) {
        if (level[i])
            return false;
        level[i] = (uint8_t)(level[parent] + 1);
    }
    return true;
}

/* Children that are unused have empty boxes, which no ray hits. */
static bool is_box(const bvh_node *n, uint32_t slot)
{
    const bool used = slot < n->child_count;
    for (int axis = 0; axis < 3; axis++) {
        const float low = n->low[axis][slot], high = n->high[axis][slot];
        if (used ? !(low <= high && low > -INFINITY && high < INFINITY) : low != INFINITY || high != -INFINITY)
            return false;
    }
    return used || n->child[slot] == 0;
}

static bool is_node(const hierarchy *h, size_t number, uint8_t *level)
{
    const bvh_node *n = &h->nodes[number];
    bool sound = n->child_count <= WIDTH;
    for (uint32_t i = 0; i < WIDTH && sound; i++) {
        const uint32_t child = n->child[i];
        sound = is_box(n, i);
        if (!sound || i >= n->child_count)
            continue;
        if (child & CHILD_LEAF)
            sound = child_first_block(child) + child_blocks(child) <= h->block_count;
        else
            sound = mark_children(level, h->node_count, number, child, 1, BVH_DEPTH_MAX);
    }
    return sound && level[number];
}

static bool is_sphere(const hierarchy *h, size_t number, uint8_t *level)
{
    const sphere_node *s = &h->spheres[number];
    bool sound = s->children <= 8 && (uint64_t)s->first_block + s->blocks <= h->block_count && s->radius >= 0.0F &&
                 s->radius < INFINITY;
    for (int k = 0; k < 3; k++)
        sound &= fabsf(s->center[k]) < INFINITY;
    return sound && mark_children(level, h->node_count, number, s->first_child, s->children, SPHERES_DEPTH_MAX);
}

/* Checks that the nodes are a tree, no deeper than the traversals' stacks allow. */
static status check_tree(const hierarchy *h, diagnostic *why)
{
    uint8_t *level = calloc(h->node_count + 1, 1);
    if (!level)
        return out_of_memory(why);
    level[0] = 1;
    bool sound = true;
    for (size_t i = 0; i < h->node_count && sound; i++)
        sound = is_bvh(h) ? is_node(h, i, level) : is_sphere(h, i, level);
    free(level);
    return sound ? STATUS_OK : pack_damaged(why, "the nodes of a hierarchy");
}

static status unpack_nodes(hierarchy *h, pack_reader *from, diagnostic *why)
{
    if (is_bvh(h)) {
        h->nodes = hierarchy_allocate(h->node_count * sizeof *h->nodes);
        TRY(h->nodes ? pack_get(from, h->nodes, h->node_count * sizeof *h->nodes, why) : out_of_memory(why));
    } else if (is_spheres(h)) {
        h->spheres = malloc(h->node_count * sizeof *h->spheres);
        TRY(h->spheres ? pack_get(from, h->spheres, h->node_count * sizeof *h->spheres, why) : out_of_memory(why));
    }
    TRY(check_tree(h, why));
    if (is_bvh(h))
        bvh_find_reach(h);
    return STATUS_OK;
}

static status fill_chunk(hierarchy *h, size_t first, size_t count, chunk *numbers, pack_reader *from, diagnostic *why)
{
    TRY(pack_get(from, numbers, count * sizeof **numbers, why));
    const uint32_t *order = (*numbers)[0];
    uint32_t beyond = 0;
    for (size_t i = 0; i < BLOCK * count; i++)
        beyond |= order[i] >= h->of->triangle_count;
    if (beyond)
        return pack_damaged(why, "a triangle of a hierarchy");
    hierarchy_fill_blocks(h, order, BLOCK * count, first);
    return cancel_check(why);
}

static status unpack_blocks(hierarchy *h, pack_reader *from, diagnostic *why)
{
    chunk *numbers = malloc(sizeof *numbers);
    status code = numbers && hierarchy_make_blocks(h, h->block_count) ? STATUS_OK : out_of_memory(why);
    for (size_t first = 0; first < h->block_count && code == STATUS_OK; first += CHUNK_BLOCKS)
        code = fill_chunk(h, first, chunk_of(h, first), numbers, from, why);
    free(numbers);
    return code;
}

status hierarchy_unpack(const mesh *m, pack_reader *from, hierarchy **out, hierarchy_kind *kind, diagnostic *why)
{
    hierarchy_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    TRY(check_hierarchy_head(m, &head, from, why));
    hierarchy *h = malloc(sizeof *h);
    if (!h)
        return out_of_memory(why);
    *kind = (hierarchy_kind)head.kind;
    *h = (hierarchy){.of = m,
                     .kind = *kind,
                     .single = head.single,
                     .block_count = head.blocks,
                     .node_count = head.nodes,
                     .referred = head.referred,
                     .built_cost = head.built_cost,
                     .report = {.bytes = head.bytes,
                                .nodes = head.nodes,
                                .leaves = head.leaves,
                                .depth = (int)head.depth,
                                .build_s = head.build_s,
                                .threads = (int)head.threads}};
    status code = unpack_nodes(h, from, why);
    THEN(code, unpack_blocks(h, from, why));
    if (code != STATUS_OK) {
        hierarchy_destroy(h);
        return code;
    }
    *out = h;
    return STATUS_OK;
}

/* --- meshes --- */

/* The head of a packed mesh. */
typedef struct mesh_head {
    uint64_t vertices, triangles;
    /* the first four: whether there are any */
    int64_t normals, uvs, colors, slots, slot_count, closed, crowded, single;
    bounds3 bounds;
    uint64_t hole_from, hole_to, hole_triangle;
    int64_t hole_sharing, hole_fault;
    uint64_t shells, hierarchies;
} mesh_head;
_Static_assert(sizeof(mesh_head) == 23 * 8, "no padding");

typedef struct mesh_array {
    void *bytes;
    size_t size;
} mesh_array;

enum { MESH_ARRAYS = 6 };

static void list_arrays(const mesh *m, mesh_array out[MESH_ARRAYS])
{
    out[0] = (mesh_array){m->vertices, m->vertex_count * sizeof *m->vertices};
    out[1] = (mesh_array){m->triangles, m->triangle_count * sizeof *m->triangles};
    out[2] = (mesh_array){m->normals, m->normals ? m->vertex_count * sizeof *m->normals : 0};
    out[3] = (mesh_array){m->uvs, m->uvs ? m->vertex_count * sizeof *m->uvs : 0};
    out[4] = (mesh_array){m->slots, m->slots ? m->triangle_count * sizeof *m->slots : 0};
    out[5] = (mesh_array){m->colors, m->colors ? m->vertex_count * sizeof *m->colors : 0};
}

static const hierarchy *stored_hierarchy(const mesh *m, int kind)
{
    return __atomic_load_n(&m->shared->hierarchies[kind], __ATOMIC_ACQUIRE);
}

static mesh_head head_of(const mesh *m)
{
    mesh_head head = {.vertices = m->vertex_count,
                      .triangles = m->triangle_count,
                      .normals = m->normals != NULL,
                      .uvs = m->uvs != NULL,
                      .colors = m->colors != NULL,
                      .slots = m->slots != NULL,
                      .slot_count = m->slot_count,
                      .closed = m->closed,
                      .crowded = m->crowded,
                      .single = m->single,
                      .bounds = m->bounds,
                      .hole_from = m->hole.from,
                      .hole_to = m->hole.to,
                      .hole_triangle = m->hole.triangle,
                      .hole_sharing = m->hole.sharing,
                      .hole_fault = m->hole.fault,
                      .shells = m->shell_count};
    for (int kind = 0; kind < HIERARCHY_KIND_COUNT; kind++)
        head.hierarchies += stored_hierarchy(m, kind) != NULL;
    return head;
}

status mesh_pack(const mesh *m, pack_writer *to, diagnostic *why)
{
    const mesh_head head = head_of(m);
    mesh_array arrays[MESH_ARRAYS];
    list_arrays(m, arrays);
    TRY(pack_put(to, &head, sizeof head, why));
    for (int i = 0; i < MESH_ARRAYS; i++)
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
    const uint64_t flags = (uint64_t)(h->normals | h->uvs | h->colors | h->slots | h->closed | h->crowded | h->single);
    if (flags > 1 || h->slot_count < 1 || h->slot_count > MESH_SLOTS_MAX || h->hierarchies > HIERARCHY_KIND_COUNT)
        return pack_damaged(why, "the head of a mesh");
    if (!pack_holds(from, h->vertices, sizeof(vec3)) || !pack_holds(from, h->triangles, sizeof(mesh_triangle)))
        return pack_damaged(why, "a mesh is larger than the package");
    if ((h->triangles || h->vertices) && !within(&h->bounds.low.x, 6))
        return pack_damaged(why, "the bounds of a mesh");
    if (h->shells > h->triangles)
        return pack_damaged(why, "the shells of a mesh");
    const bool hole = h->hole_from || h->hole_to || h->hole_triangle;
    if (h->hole_fault < 0 || h->hole_fault >= MESH_FAULT_COUNT ||
        (hole && (h->hole_from >= h->vertices || h->hole_to >= h->vertices || h->hole_triangle >= h->triangles)))
        return pack_damaged(why, "the hole of a mesh");
    return STATUS_OK;
}

/* Normals must be unit vectors, which mesh_check does not require. */
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
        m->shared->destroy = hierarchy_destroy;
        if (m->shared->hierarchies[kind]) {
            hierarchy_destroy(h);
            return pack_damaged(why, "a mesh has two hierarchies of a kind");
        }
        __atomic_store_n(&m->shared->hierarchies[kind], h, __ATOMIC_RELEASE);
    }
    return STATUS_OK;
}

static status unpack_into(mesh *m, const mesh_head *head, pack_reader *from, diagnostic *why)
{
    mesh_array arrays[MESH_ARRAYS];
    list_arrays(m, arrays);
    m->slot_count = (int)head->slot_count;
    m->closed = head->closed;
    m->crowded = head->crowded;
    m->single = head->single;
    m->shell_count = head->shells;
    m->bounds = head->bounds;
    m->hole = (mesh_hole){.from = (uint32_t)head->hole_from,
                          .to = (uint32_t)head->hole_to,
                          .triangle = head->hole_triangle,
                          .sharing = (int)head->hole_sharing,
                          .fault = (mesh_fault)head->hole_fault};
    for (int i = 0; i < MESH_ARRAYS; i++)
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
    status code = head.colors ? mesh_add_colors(m, why) : STATUS_OK;
    THEN(code, unpack_into(m, &head, from, why));
    if (code != STATUS_OK) {
        mesh_release(m);
        return code;
    }
    *out = m;
    return STATUS_OK;
}
