/* The binary tree of the bvh builder: the top is split by all threads together, the subtrees by one thread each. */
#include "base/cancel.h"
#include "base/array.h"
#include "geometry/hierarchy_bvh.h"

#include <stdlib.h>

/* Ranges of at most this many triangles are not split: they fill one block. */
enum { UNSPLIT = BLOCK, BRANCHES_AT_FIRST = 256, BRANCHES_AT_ONCE = 65536 };

/* Branches, allocated in chunks, each twice as large as the one before, up to some large pages. */
struct bvh_store {
    bvh_store *before;
    size_t used, room;
    bvh_branch branches[];
};

/* A range that a single thread splits completely. */
typedef struct task {
    bvh_range range;
    int depth;
    bvh_branch **out;
} task;

typedef struct tree_build {
    bvh_tree *tree;
    thread_team *t;
    bvh_ref *refs;
    task *tasks;
    size_t task_count, task_room;
} tree_build;

static bvh_branch *new_branch(bvh_store **own, const bvh_range *range)
{
    if (!*own || (*own)->used == (*own)->room) {
        const size_t twice = *own ? 2 * (*own)->room : BRANCHES_AT_FIRST;
        const size_t room = twice < BRANCHES_AT_ONCE ? twice : BRANCHES_AT_ONCE;
        const size_t bytes = sizeof(bvh_store) + room * sizeof(bvh_branch);
        bvh_store *fresh = large_pages(malloc(bytes), bytes);
        if (!fresh)
            return NULL;
        *fresh = (bvh_store){.before = *own, .room = room};
        *own = fresh;
    }
    bvh_branch *b = &(*own)->branches[(*own)->used++];
    memcpy(b->low, range->box.low, sizeof b->low);
    memcpy(b->high, range->box.high, sizeof b->high);
    b->first = range->first;
    b->count = range->count;
    b->half[0] = b->half[1] = NULL;
    return b;
}

/* NULL: out of memory, or cancelled. */
static bvh_branch *build_subtree(bvh_store **own, bvh_ref *refs, const bvh_range *range, int depth)
{
    bvh_branch *b = new_branch(own, range);
    if (!b)
        return NULL;
    if (range->count > UNSPLIT) {
        bvh_range half[2];
        bvh_split(refs, range, depth, half);
        for (int i = 0; i < 2; i++) {
            b->half[i] = build_subtree(own, refs, &half[i], depth + 1);
            if (!b->half[i])
                return NULL;
        }
    }
    bvh_choose(b);
    return b;
}

static void build_task(void *context, size_t index, int member)
{
    tree_build *g = context;
    task *own = &g->tasks[index];
    if (!cancel_asked())
        *own->out = build_subtree(&g->tree->stores[member], g->refs, &own->range, own->depth);
}

static bool add_task(tree_build *g, const bvh_range *range, int depth, bvh_branch **out)
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

/* Splits large ranges with all threads together; the remaining ranges become tasks. */
static status build_top(tree_build *g, const bvh_range *range, int depth, bvh_branch **out, diagnostic *why)
{
    if (range->count <= TASK_TRIANGLES)
        return add_task(g, range, depth, out) ? STATUS_OK : out_of_memory(why);
    bvh_branch *b = *out = new_branch(&g->tree->stores[0], range);
    if (!b)
        return out_of_memory(why);
    bvh_range half[2];
    TRY(cancel_check(why));
    TRY(bvh_split_together(g->t, g->refs, range, depth, half, why));
    for (int i = 0; i < 2; i++)
        TRY(build_top(g, &half[i], depth + 1, &b->half[i], why));
    return STATUS_OK;
}

static void choose_top(bvh_branch *b)
{
    if (b->count <= TASK_TRIANGLES)
        return;
    choose_top(b->half[0]);
    choose_top(b->half[1]);
    bvh_choose(b);
}

static status build_all(tree_build *g, const bvh_range *all, diagnostic *why)
{
    TRY(build_top(g, all, 0, &g->tree->root, why));
    thread_team_run(g->t, build_task, g, g->task_count);
    for (size_t i = 0; i < g->task_count; i++)
        if (!*g->tasks[i].out)
            return cancelled_or_out_of_memory(why);
    choose_top(g->tree->root);
    return STATUS_OK;
}

status bvh_build_tree(bvh_tree *tree, thread_team *t, bvh_ref *refs, const bvh_range *all, diagnostic *why)
{
    *tree = (bvh_tree){.store_count = thread_team_size(t)};
    if (all->count == 0)
        return STATUS_OK;
    tree->stores = calloc((size_t)tree->store_count, sizeof(bvh_store *));
    if (!tree->stores)
        return out_of_memory(why);
    tree_build g = {.tree = tree, .t = t, .refs = refs};
    status code = build_all(&g, all, why);
    free(g.tasks);
    return code;
}

void bvh_free(bvh_tree *tree)
{
    for (int i = 0; tree->stores && i < tree->store_count; i++)
        while (tree->stores[i]) {
            bvh_store *s = tree->stores[i];
            tree->stores[i] = s->before;
            free(s);
        }
    free(tree->stores);
}
