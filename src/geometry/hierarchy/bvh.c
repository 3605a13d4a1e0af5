/* The builder of the hierarchy `bvh`: triangles become primitive references (PrimRef of Embree), references a binary
 * tree, and the tree nodes of eight children (bvh_collapse.c). Also the refit after the mesh has moved, and the
 * cost. */
#include "geometry/hierarchy/bvh.h"
#include "base/array.h"
#include "base/cancel.h"
#include "base/isa.h"
#include <stdlib.h>

/* --- references --- */

enum { PIECE = 16384 }; /* triangles per task when references are computed */

static double least(double a, double b, double c)
{
    double ab = a < b ? a : b;
    return ab < c ? ab : c;
}

static double most(double a, double b, double c)
{
    double ab = a > b ? a : b;
    return ab > c ? ab : c;
}

static bool same_place(const vec3 *a, const vec3 *b)
{
    return a->x == b->x && a->y == b->y && a->z == b->z;
}

/* A triangle with two corners at one position can never be hit and is left out. */
static bool make_reference(const mesh *m, uint32_t triangle, prim_ref *r)
{
    const uint32_t *corner = m->triangles[triangle].corner;
    const vec3 *a = &m->vertices[corner[0]], *b = &m->vertices[corner[1]], *c = &m->vertices[corner[2]];
    if (same_place(a, b) || same_place(b, c) || same_place(c, a))
        return false;
    r->low[0] = bvh_float_below(least(a->x, b->x, c->x));
    r->low[1] = bvh_float_below(least(a->y, b->y, c->y));
    r->low[2] = bvh_float_below(least(a->z, b->z, c->z));
    r->low[3] = bvh_lane_of(triangle);
    r->high[0] = bvh_float_above(most(a->x, b->x, c->x));
    r->high[1] = bvh_float_above(most(a->y, b->y, c->y));
    r->high[2] = bvh_float_above(most(a->z, b->z, c->z));
    r->high[3] = 0.0f;
    return true;
}

typedef struct reference_job {
    const mesh *m;
    prim_ref *refs;
    prim_range *pieces; /* the references of each PIECE triangles; first is their position */
} reference_job;

static void read_piece(void *context, size_t index, int member)
{
    (void)member;
    const reference_job *r = context;
    if (cancel_asked())
        return;
    size_t first = index * PIECE, end = first + PIECE < r->m->triangle_count ? first + PIECE : r->m->triangle_count;
    prim_range piece = {.bounds = bvh_box_empty(), .centroid_bounds = bvh_box_empty(), .first = (uint32_t)first};
    for (size_t i = first; i < end; i++)
        if (make_reference(r->m, (uint32_t)i, &r->refs[first + piece.count]))
            prim_range_extend(&piece, &r->refs[first + piece.count++]);
    r->pieces[index] = piece;
}

static status read_triangles(const mesh *m, thread_team *t, prim_ref *refs, prim_range *all, diagnostic *why)
{
    size_t count = (m->triangle_count + PIECE - 1) / PIECE;
    reference_job r = {m, refs, aligned_alloc(64, (count + 1) * 64 * ((sizeof(prim_range) + 63) / 64))};
    if (!r.pieces)
        return out_of_memory(why);
    thread_team_run(t, read_piece, &r, count);
    const status code = cancel_check(why); /* pieces may be missing */
    if (code != STATUS_OK)
        count = 0;
    *all = (prim_range){.bounds = bvh_box_empty(), .centroid_bounds = bvh_box_empty()};
    for (size_t i = 0; i < count; i++) {
        const prim_range *piece = &r.pieces[i];
        if (all->count != piece->first)
            memmove(&refs[all->count], &refs[piece->first], piece->count * sizeof *refs);
        all->count += piece->count;
        bvh_box_extend(&all->bounds, piece->bounds.low, piece->bounds.high);
        bvh_box_extend(&all->centroid_bounds, piece->centroid_bounds.low, piece->centroid_bounds.high);
    }
    free(r.pieces);
    return code;
}

/* --- the binary tree: its top is split by all threads, its subtrees by one thread each --- */

/* Ranges of at most this many triangles are not split: they fill one block. */
enum { UNSPLIT = BLOCK, NODES_AT_FIRST = 256, NODES_AT_ONCE = 65536 };

/* A binary tree, and the memory of its nodes, one arena per member of the thread team. */
typedef struct node_arena node_arena;
typedef struct bvh_tree {
    bvh_build_node *root; /* NULL: no triangles */
    node_arena **arenas;
    int arena_count;
} bvh_tree;

/* Nodes, allocated in chunks, each twice as large as the one before, up to a few large pages. */
struct node_arena {
    node_arena *before;
    size_t used, room;
    bvh_build_node nodes[];
};

/* A range that a single thread splits completely. */
typedef struct task {
    prim_range range;
    int depth;
    bvh_build_node **out;
} task;

typedef struct tree_build {
    bvh_tree *tree;
    thread_team *t;
    prim_ref *refs;
    task *tasks;
    size_t task_count, task_room;
} tree_build;

static bvh_build_node *new_node(node_arena **arena, const prim_range *range)
{
    if (!*arena || (*arena)->used == (*arena)->room) {
        const size_t twice = *arena ? 2 * (*arena)->room : NODES_AT_FIRST;
        const size_t room = twice < NODES_AT_ONCE ? twice : NODES_AT_ONCE;
        const size_t bytes = sizeof(node_arena) + room * sizeof(bvh_build_node);
        node_arena *fresh = large_pages(malloc(bytes), bytes);
        if (!fresh)
            return NULL;
        *fresh = (node_arena){.before = *arena, .room = room};
        *arena = fresh;
    }
    bvh_build_node *b = &(*arena)->nodes[(*arena)->used++];
    memcpy(b->low, range->bounds.low, sizeof b->low);
    memcpy(b->high, range->bounds.high, sizeof b->high);
    b->first = range->first;
    b->count = range->count;
    b->child[0] = b->child[1] = NULL;
    return b;
}

/* NULL: out of memory, or cancelled. */
static bvh_build_node *build_subtree(node_arena **arena, prim_ref *refs, const prim_range *range, int depth)
{
    bvh_build_node *b = new_node(arena, range);
    if (!b)
        return NULL;
    if (range->count > UNSPLIT) {
        prim_range half[2];
        bvh_split(refs, range, depth, half);
        for (int i = 0; i < 2; i++) {
            b->child[i] = build_subtree(arena, refs, &half[i], depth + 1);
            if (!b->child[i])
                return NULL;
        }
    }
    bvh_find_costs(b);
    return b;
}

static void build_task(void *context, size_t index, int member)
{
    tree_build *g = context;
    task *next = &g->tasks[index];
    if (!cancel_asked())
        *next->out = build_subtree(&g->tree->arenas[member], g->refs, &next->range, next->depth);
}

static bool add_task(tree_build *g, const prim_range *range, int depth, bvh_build_node **out)
{
    if (g->task_count == g->task_room) {
        size_t room = g->task_room ? 2 * g->task_room : 64;
        task *grown = aligned_alloc(64, room * sizeof *grown / 64 * 64 + 64);
        if (!grown)
            return false;
        if (g->task_count > 0)
            memcpy(grown, g->tasks, g->task_count * sizeof *grown);
        free(g->tasks);
        g->tasks = grown;
        g->task_room = room;
    }
    g->tasks[g->task_count++] = (task){*range, depth, out};
    return true;
}

/* Splits large ranges with all threads; the remaining ranges become tasks. */
static status build_top(tree_build *g, const prim_range *range, int depth, bvh_build_node **out, diagnostic *why)
{
    if (range->count <= TASK_TRIANGLES)
        return add_task(g, range, depth, out) ? STATUS_OK : out_of_memory(why);
    bvh_build_node *b = *out = new_node(&g->tree->arenas[0], range);
    if (!b)
        return out_of_memory(why);
    prim_range half[2];
    TRY(cancel_check(why));
    TRY(bvh_split_parallel(g->t, g->refs, range, depth, half, why));
    for (int i = 0; i < 2; i++)
        TRY(build_top(g, &half[i], depth + 1, &b->child[i], why));
    return STATUS_OK;
}

static void choose_top(bvh_build_node *b)
{
    if (b->count <= TASK_TRIANGLES)
        return;
    choose_top(b->child[0]);
    choose_top(b->child[1]);
    bvh_find_costs(b);
}

static status build_all(tree_build *g, const prim_range *all, diagnostic *why)
{
    TRY(build_top(g, all, 0, &g->tree->root, why));
    thread_team_run(g->t, build_task, g, g->task_count);
    for (size_t i = 0; i < g->task_count; i++)
        if (!*g->tasks[i].out)
            return cancelled_or_out_of_memory(why);
    choose_top(g->tree->root);
    return STATUS_OK;
}

/* Builds a tree over refs, which it reorders. free_tree releases the tree, also after an error (out of memory, or
 * cancelled). */
static status build_tree(bvh_tree *tree, thread_team *t, prim_ref *refs, const prim_range *all, diagnostic *why)
{
    *tree = (bvh_tree){.arena_count = thread_team_size(t)};
    if (all->count == 0)
        return STATUS_OK;
    tree->arenas = calloc((size_t)tree->arena_count, sizeof(node_arena *));
    if (!tree->arenas)
        return out_of_memory(why);
    tree_build g = {.tree = tree, .t = t, .refs = refs};
    status code = build_all(&g, all, why);
    free(g.tasks);
    return code;
}

static void free_tree(bvh_tree *tree)
{
    for (int i = 0; tree->arenas && i < tree->arena_count; i++)
        while (tree->arenas[i]) {
            node_arena *s = tree->arenas[i];
            tree->arenas[i] = s->before;
            free(s);
        }
    free(tree->arenas);
}

/* --- the build --- */

static status build(hierarchy *h, thread_team *t, prim_ref *refs, diagnostic *why)
{
    prim_range all;
    TRY(read_triangles(h->of, t, refs, &all, why));
    h->referred = all.count;
    bvh_tree tree;
    status code = build_tree(&tree, t, refs, &all, why);
    THEN(code, bvh_collapse(h, tree.root, refs, t, why));
    free_tree(&tree);
    if (code == STATUS_OK)
        bvh_find_reach(h);
    return code;
}

/* The number of threads for a build: at most one per task. */
static int useful(int threads, size_t triangles)
{
    size_t most = triangles / TASK_TRIANGLES + 1;
    return (size_t)threads < most ? threads : (int)most;
}

status hierarchy_build_bvh(hierarchy *h, int threads, diagnostic *why)
{
    const mesh *m = h->of;
    h->single = m->single;
    const size_t bytes = (m->triangle_count + 2) / 2 * 2 * sizeof(prim_ref);
    prim_ref *refs = large_pages(aligned_alloc(64, bytes), bytes);
    thread_team *t = thread_team_create(useful(threads, m->triangle_count));
    status code = refs && t ? build(h, t, refs, why) : out_of_memory(why);
    h->report.threads = t ? thread_team_size(t) : 1;
    thread_team_destroy(t);
    free(refs);
    size_t block = h->single ? sizeof(block_single) : sizeof(block_double);
    h->report.bytes = sizeof *h + h->node_count * sizeof *h->nodes + h->block_count * block;
    return code;
}

/* --- refit and cost --- */

bool hierarchy_refit(hierarchy *h)
{
    static hierarchy_refitter *const refit[ISA_COUNT] = ISA_ARRAY(hierarchy_refit_nodes);
    if (h->kind != HIERARCHY_BVH || h->referred != h->of->triangle_count || (h->single && !h->of->single))
        return false;
    refit[isa_best()](h); /* all kernels give identical bits */
    bvh_find_reach(h);
    return true;
}

void bvh_find_reach(hierarchy *h)
{
    for (int axis = 0; axis < 3; axis++) {
        float low, high;
        bvh_around(&h->nodes[0], axis, &low, &high);
        const float reach = -low > high ? -low : high;
        h->reach[axis] = reach > 0.0f ? reach : 0.0f; /* without triangles it is -inf */
    }
}

static double half_area(const bvh_node *n, int slot)
{
    const double x = (double)n->high[0][slot] - (double)n->low[0][slot],
                 y = (double)n->high[1][slot] - (double)n->low[1][slot],
                 z = (double)n->high[2][slot] - (double)n->low[2][slot];
    return x * y + y * z + z * x;
}

double hierarchy_cost(const hierarchy *h)
{
    if (h->kind != HIERARCHY_BVH || h->block_count == 0)
        return 0.0;
    bvh_node root;
    for (int axis = 0; axis < 3; axis++)
        bvh_around(&h->nodes[0], axis, &root.low[axis][0], &root.high[axis][0]);
    const double root_area = half_area(&root, 0);
    double sum = root_area * (double)COST_NODE;
    for (size_t i = 0; i < h->node_count; i++) {
        const bvh_node *n = &h->nodes[i];
        for (int slot = 0; slot < (int)n->child_count; slot++) {
            const uint32_t child = n->child[slot];
            sum += half_area(n, slot) * (child & CHILD_LEAF ? (double)child_blocks(child) : (double)COST_NODE);
        }
    }
    return root_area > 0.0 ? sum / root_area : 0.0;
}
