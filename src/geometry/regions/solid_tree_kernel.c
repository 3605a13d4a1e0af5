/* The solid tree in the second pass over a batch (nearest_interface_kernel.c): finds the next change of medium by the
 * tree's solids, one ray at a time, and the tree's primitives that contain the ray on both sides of its crossing. The
 * intervals of a primitive are computed from the ray's start each time, by the functions of the first pass. */
#include "geometry/regions/solid_tree.h"

#include "geometry/primitives/primitive.h"
#include "geometry/regions/box_tests.h"
#include "geometry/regions/kernels.h"

void KERNEL(tree_split)(const scene_geometry *g, const ray_batch *rays, ray_scratch *s, uint64_t *direct)
{
    for (int i = 0; i < rays->count; i++) {
        const split_set start = solid_tree_split(g->tree, rays->inside[i]);
        direct[i] = start.direct;
        s->tree.start[i] = start.others;
    }
}

void KERNEL(tree_begin)(int i, int k, ray_scratch *s)
{
    s->tree.within[k] = s->tree.start[i];
    s->tree.from[k] = -HUGE_VAL;
}

void KERNEL(tree_advance)(int k, int m, double t, ray_scratch *s)
{
    s->tree.within[m] = s->tree.after[k];
    s->tree.from[m] = t;
}

/* A hollow reaches beyond its solid, but its bit is kept up to date only in the region's outer primitive. */
static bool is_set_without_outside(const scene_geometry *g, uint64_t set, int p)
{
    const region *b = &g->regions[g->primitives[p].priority_index];
    return p == b->hollow && !set_table_has(g->tree->sets, set, b->outside);
}

static bool contains_start_of(const scene_geometry *g, const ray_batch *rays, int i, const ray_scratch *s, int p)
{
    if (is_set_without_outside(g, s->tree.start[i], p))
        return primitive_contains(&g->primitives[p], vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]));
    return set_table_has(g->tree->sets, s->tree.start[i], p);
}

int KERNEL(tree_intervals)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, int p,
                           interval found[CHORDS_MAX])
{
    const primitive *one = &g->primitives[p];
    const int i = s->ray[k];
    const double from = s->tree.from[k];
    one->rule->KERNEL_ISA->one(one, rays, i, contains_start_of(g, rays, i, s, p), s, found);
    if (from > -HUGE_VAL) {
        const bool within = is_set_without_outside(g, s->tree.within[k], p)
                                ? found[0].in <= from && from < found[0].out
                                : set_table_has(g->tree->sets, s->tree.within[k], p);
        intervals_advance(found, one->rows, within, from);
    }
    return one->rows;
}

/* A primitive and its intervals. */
typedef struct listed_primitive {
    int primitive;
    interval found[CHORDS_MAX];
} listed_primitive;

enum { LISTED_MAX = 64 };

/* The search of one column. */
typedef struct tree_search {
    const scene_geometry *g;
    const ray_batch *rays;
    const ray_scratch *s;
    int column, priority_index; /* of the medium that the ray is in */
    double t;                   /* of the nearest change so far */
    int64_t hit_primitive;
    int64_t hit_priority_index; /* of the region whose boundary it is; INT64_MAX for a mesh, so that a solid wins */
    int listed;
    bool complete; /* the list holds every primitive that matters at the nearest change */
    listed_primitive list[LISTED_MAX];
} tree_search;

static double window(const tree_search *w, double t)
{
    return BOUNDARY_CLOSE * (t + w->s->slack[w->column]);
}

/* Removes the primitives that begin beyond the nearest change so far. */
static void shorten_list(tree_search *w)
{
    const double high = w->t + window(w, w->t);
    int remaining = 0;
    for (int k = 0; k < w->listed; k++)
        if (w->list[k].found[0].in <= high)
            w->list[remaining++] = w->list[k];
    w->listed = remaining;
}

static const interval *list_primitive(tree_search *w, int p, interval *spare)
{
    if (w->listed == LISTED_MAX)
        shorten_list(w);
    w->complete &= w->listed < LISTED_MAX;
    listed_primitive *one = w->listed < LISTED_MAX ? &w->list[w->listed] : NULL;
    interval *found = one ? one->found : spare;
    KERNEL(tree_intervals)(w->g, w->rays, w->column, w->s, p, found);
    if (one && found[0].in < HUGE_VAL) {
        one->primitive = p;
        w->listed++;
    }
    return found;
}

static void keep_nearer(tree_search *w, double t, int p, int priority_index)
{
    if (!(t < w->t || (t == w->t && w->t < NEVER && priority_index < w->hit_priority_index)))
        return;
    w->t = t;
    w->hit_primitive = p;
    w->hit_priority_index = priority_index;
}

/* Considers the next change by a region, as next_changes does for the direct regions. */
static void consider(tree_search *w, int r)
{
    const region *b = &w->g->regions[r];
    const set_table *sets = w->g->tree->sets;
    const uint64_t within = w->s->tree.within[w->column];
    interval spare[CHORDS_MAX], hollow_spare[CHORDS_MAX];
    const bool in_outside = set_table_has(sets, within, b->outside);
    const interval outer = list_primitive(w, b->outside, spare)[0];
    if (b->hollow < 0) {
        if (r >= w->priority_index)
            keep_nearer(w, next_of_convex(mask_of(in_outside), outer.in, outer.out), b->outside, r);
        return;
    }
    const bool in_region = in_outside && !set_table_has(sets, within, b->hollow);
    const interval hollow = list_primitive(w, b->hollow, hollow_spare)[0];
    const next_change next = next_of_hollowed(mask_of(in_region), outer.in, outer.out, hollow.in, hollow.out);
    if (r >= w->priority_index)
        keep_nearer(w, next.t, next.through_hollow ? b->hollow : b->outside, r);
}

static bool contains_start(const tree_search *w, const region *b)
{
    const set_table *sets = w->g->tree->sets;
    const uint64_t within = w->s->tree.within[w->column];
    return within &&
           (set_table_has(sets, within, b->outside) || (b->hollow >= 0 && set_table_has(sets, within, b->hollow)));
}

static double visit_solid(void *context, int item, double t_max)
{
    tree_search *w = context;
    const int r = w->g->tree->solids[item].region;
    if (contains_start(w, &w->g->regions[r])) /* considered already */
        return t_max;
    if (r < w->priority_index) { /* hidden: it matters only where the medium changes */
        w->complete = false;
        return t_max;
    }
    consider(w, r);
    return lesser(t_max, w->t + window(w, w->t));
}

/* Considers the regions of the primitives that contain the ray, each once. */
static void consider_containing(tree_search *w)
{
    set_members m;
    if (w->s->tree.within[w->column] == 0)
        return;
    set_table_members(w->g->tree->sets, w->s->tree.within[w->column], &m);
    for (int k = 0; k < m.count; k++) {
        const int p = (int)m.primitive[k], r = w->g->primitives[p].priority_index;
        const bool again = p == w->g->regions[r].hollow &&
                           set_table_has(w->g->tree->sets, w->s->tree.within[w->column], w->g->regions[r].outside);
        if (!again)
            consider(w, r);
    }
}

static void fetch_solid(void *context, int item)
{
    const tree_search *w = context;
    solid_tree_fetch(w->g->tree, item);
}

ALWAYS_INLINE void traverse(const tree_search *w, double t_min, double t_max, boxes_visit *visit, boxes_fetch *fetch,
                            void *context)
{
    const int i = w->s->ray[w->column];
    const ray_batch *r = w->rays;
    boxes_traverse(&w->g->tree->boxes, vec3_make(r->ox[i], r->oy[i], r->oz[i]), vec3_make(r->dx[i], r->dy[i], r->dz[i]),
                   t_min, t_max, visit, fetch, context);
}

/* The tree's primitives on both sides of a crossing, and which of them have a boundary near it. */
typedef struct tree_sides {
    const tree_search *w;
    double low, high;
    uint64_t before, after;
    int near, changed; /* how many primitives have a boundary near the crossing, and how many of these change */
    bool hit_changes;  /* the primitive of the crossing changes */
} tree_sides;

static void add_side(tree_sides *x, int p, const interval *found)
{
    bool before = false, after = false, near = false;
    for (int row = 0; row < x->w->g->primitives[p].rows; row++) {
        const bool at_low = found[row].in <= x->low && x->low < found[row].out,
                   at_high = found[row].in <= x->high && x->high < found[row].out;
        before |= at_low;
        after |= at_high;
        near |= found[row].in <= x->high && x->low < found[row].out && !(at_low && at_high);
    }
    set_table *sets = x->w->g->tree->sets;
    if (before)
        x->before = set_table_put(sets, x->before, p, true);
    if (after)
        x->after = set_table_put(sets, x->after, p, true);
    x->near += near;
    x->changed += before != after;
    x->hit_changes |= before != after && p == x->w->hit_primitive;
}

static void note_side(void *context, int p, const interval *found)
{
    add_side(context, p, found);
}

/* Reports primitives to `found`. */
typedef struct tree_visit {
    const tree_search *w;
    tree_found *found;
    void *context;
} tree_visit;

static void report(const tree_visit *v, int p)
{
    interval found[CHORDS_MAX];
    KERNEL(tree_intervals)(v->w->g, v->w->rays, v->w->column, v->w->s, p, found);
    v->found(v->context, p, found);
}

static void fetch_near(void *context, int item)
{
    const tree_visit *v = context;
    solid_tree_fetch(v->w->g->tree, item);
}

static double visit_near(void *context, int item, double t_max)
{
    const tree_visit *v = context;
    const region *b = &v->w->g->regions[v->w->g->tree->solids[item].region];
    if (!contains_start(v->w, b)) {
        report(v, b->outside);
        if (b->hollow >= 0)
            report(v, b->hollow);
    }
    return t_max;
}

/* Reports every primitive of the tree that may have a boundary in low <= t <= high or contain the ray there, each
 * once. */
static void each_between(const tree_search *w, double low, double high, tree_found *found, void *context)
{
    const tree_visit v = {w, found, context};
    const uint64_t within = w->s->tree.within[w->column];
    set_members m;
    set_table_members(w->g->tree->sets, within, &m);
    for (int k = 0; k < m.count; k++) {
        const int p = (int)m.primitive[k];
        const region *b = &w->g->regions[w->g->primitives[p].priority_index];
        const int other = b->hollow == p ? b->outside : b->hollow;
        report(&v, p);
        if (other >= 0 && !set_table_has(w->g->tree->sets, within, other))
            report(&v, other);
    }
    traverse(w, greater(low, 0.0), high, visit_near, fetch_near, (void *)(uintptr_t)&v);
}

static void sides_of(const tree_search *w, tree_sides *x)
{
    const double close = window(w, w->t);
    *x = (tree_sides){.w = w, .low = w->t - close, .high = w->t + close};
    if (!w->complete) {
        each_between(w, x->low, x->high, note_side, x);
        return;
    }
    for (int k = 0; k < w->listed; k++)
        if (w->list[k].found[0].in <= x->high)
            add_side(x, w->list[k].primitive, w->list[k].found);
}

static void begin_search(tree_search *w, const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s,
                         const hit_batch *c)
{
    const int64_t p = c->hit_primitive[k];
    w->g = g, w->rays = rays, w->s = s, w->column = k;
    w->priority_index = (int)c->before[k];
    w->t = c->t[k];
    w->hit_primitive = p;
    w->hit_priority_index = p < 0 || is_mesh(g, (int)p) ? INT64_MAX : g->primitives[p].priority_index;
    w->listed = 0;
    w->complete = true;
}

/* Finds the nearest change of column k, and the sets on both sides of it. */
static void search(const scene_geometry *g, const ray_batch *rays, int k, ray_scratch *s, hit_batch *c,
                   const instance_hit *mesh_hits)
{
    tree_search w;
    begin_search(&w, g, rays, k, s, c);
    consider_containing(&w);
    traverse(&w, greater(s->tree.from[k], 0.0), w.t + window(&w, w.t), visit_solid, fetch_solid, &w);
    s->tree.before[k] = s->tree.after[k] = s->tree.within[k];
    s->tree.simple[k] = true;
    if (w.hit_primitive != c->hit_primitive[k] && g->meshes) {
        const bool close = mesh_hits[k].face != FACE_NONE && fabs(w.t - mesh_hits[k].t) <= window(&w, mesh_hits[k].t);
        s->meshes->near[k] = close ? (uint64_t)1 << mesh_face_primitive(mesh_hits[k].face) : 0;
    }
    c->t[k] = w.t;
    c->hit_primitive[k] = w.hit_primitive;
    if (w.hit_primitive < 0)
        return;
    tree_sides x;
    sides_of(&w, &x);
    s->tree.before[k] = x.before;
    s->tree.after[k] = x.after;
    s->tree.simple[k] =
        w.hit_primitive < g->direct_count ? x.near == 0 : x.near == 1 && x.changed == 1 && x.hit_changes;
}

void KERNEL(tree_changes)(const scene_geometry *g, const ray_batch *rays, int n, ray_scratch *s, hit_batch *c,
                          const instance_hit *mesh_hits)
{
    for (int k = 0; k < n; k++)
        search(g, rays, k, s, c, mesh_hits);
}

void KERNEL(tree_each_near)(const scene_geometry *g, const ray_batch *rays, int k, const ray_scratch *s, double t,
                            tree_found *found, void *context)
{
    tree_search w; /* without a list, whose room is large */
    w.g = g, w.rays = rays, w.s = s, w.column = k;
    each_between(&w, t - window(&w, t), t + window(&w, t), found, context);
}

/* --- shadow rays --- */

typedef struct shadow_search {
    const scene_geometry *g;
    const ray_batch *rays;
    ray_scratch *s;
    int solid_shadows;
} shadow_search;

static void start_intervals(const shadow_search *w, int p, int i, bool inside, interval *found)
{
    const primitive *one = &w->g->primitives[p];
    one->rule->KERNEL_ISA->one(one, w->rays, i, inside, w->s, found);
}

/* The quick shadow test of ray i in the range 0..1, as for the direct regions. */
static void test_shadow(const shadow_search *w, const region *b, bool doubtful, int i)
{
    const scene_geometry *g = w->g;
    const double thin = BOUNDARY_CLOSE * (1.0 + g->primitives[b->outside].extent * w->s->low[i]);
    interval outer[CHORDS_MAX], hollow = {HUGE_VAL, -HUGE_VAL};
    start_intervals(w, b->outside, i, set_table_has(g->tree->sets, w->s->tree.start[i], b->outside), outer);
    if (b->hollow >= 0)
        start_intervals(w, b->hollow, i, contains_start_of(g, w->rays, i, w->s, b->hollow), &hollow);
    for (int row = 0; row < g->primitives[b->outside].rows; row++) {
        const overlap o = b->hollow < 0
                              ? overlap_of_convex(outer[row].in, outer[row].out, thin)
                              : overlap_of_hollowed(outer[row].in, outer[row].out, hollow.in, hollow.out, thin);
        w->s->blocked[i] |= o.thick & ~mask_of(doubtful);
        w->s->undecided[i] |= o.any;
    }
}

static void visit_shadows(void *context, int item, const uint16_t *rays, int count)
{
    const shadow_search *w = context;
    const scene_geometry *g = w->g;
    const int r = g->tree->solids[item].region;
    const region *b = &g->regions[r];
    const bool doubtful = !b->opaque || b->partial || r < g->highest_transparent;
    if (!region_casts_shadow(b, w->solid_shadows))
        return;
    for (int k = 0; k < count; k++)
        if (!w->s->blocked[rays[k]])
            test_shadow(w, b, doubtful, rays[k]);
}

static void fetch_shadow(void *context, int item)
{
    const shadow_search *w = context;
    solid_tree_fetch(w->g->tree, item);
}

void KERNEL(tree_shadows)(const scene_geometry *g, const ray_batch *rays, int solid_shadows, ray_scratch *s)
{
    boxes_ray starts[BATCH];
    shadow_search w = {g, rays, s, solid_shadows};
    for (int i = 0; i < rays->count; i++)
        starts[i] = boxes_ray_start(&g->tree->boxes, vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]),
                                    vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]), 0.0, 1.0);
    boxes_traverse_rays(&g->tree->boxes, starts, rays->count, s->blocked, visit_shadows, fetch_shadow, &w);
}
