/* Makes a solid view for a batch, and translates sets and hits between it and the whole scene. */
#include "geometry/regions/box_tests.h"
#include "geometry/regions/kernels.h"

#include <string.h>

/* --- the bounds of a batch --- */

/* Intervals that contain the rays' origins and the inverses of their directions, by axis. An axis along which the
 * directions have both signs excludes nothing. */
typedef struct batch_bounds {
    float origin_low[3], origin_high[3], inverse_low[3], inverse_high[3];
    bool both_signs[3];
    float t_max;
} batch_bounds;

static void bounds_of_axis(const double *origin, const double *direction, int count, float margin, int axis,
                           batch_bounds *b)
{
    double low = origin[0], high = origin[0], least = direction[0], most = direction[0];
    for (int i = 1; i < count; i++) {
        low = lesser(low, origin[i]), high = greater(high, origin[i]);
        least = lesser(least, direction[i]), most = greater(most, direction[i]);
    }
    b->origin_low[axis] = (float)low - margin;
    b->origin_high[axis] = (float)high + margin;
    b->both_signs[axis] = !(least > 0.0 || most < 0.0);
    b->inverse_low[axis] = boxes_less(boxes_inverse(most));
    b->inverse_high[axis] = boxes_more(boxes_inverse(least));
}

static bool is_coherent(const ray_batch *rays, const solid_boxes *boxes, double t_max, batch_bounds *b)
{
    double far = 0.0;
    for (int i = 0; i < rays->count; i++)
        far = greater(far, greater(magnitude(rays->ox[i]), greater(magnitude(rays->oy[i]), magnitude(rays->oz[i]))));
    const float margin = boxes_margin(boxes->reach, far, 0.0, 0.0);
    bounds_of_axis(rays->ox, rays->dx, rays->count, margin, 0, b);
    bounds_of_axis(rays->oy, rays->dy, rays->count, margin, 1, b);
    bounds_of_axis(rays->oz, rays->dz, rays->count, margin, 2, b);
    b->t_max = boxes_more((float)t_max);
    return b->both_signs[0] + b->both_signs[1] + b->both_signs[2] <= 1;
}

/* The children of a node, as bits, that some ray of the batch may enter: by interval arithmetic. */
static unsigned entered_by_some(const boxes_node *n, const batch_bounds *b)
{
    float near[BOXES_WIDE], far[BOXES_WIDE];
    for (int i = 0; i < BOXES_WIDE; i++)
        near[i] = 0.0f, far[i] = b->t_max;
    for (int axis = 0; axis < 3; axis++) {
        if (b->both_signs[axis])
            continue;
        const bool down = b->inverse_high[axis] < 0.0f;
        const float *in = down ? n->high[axis] : n->low[axis], *out = down ? n->low[axis] : n->high[axis];
        const float from_in = down ? b->origin_low[axis] : b->origin_high[axis],
                    from_out = down ? b->origin_high[axis] : b->origin_low[axis];
        const float low = b->inverse_low[axis], high = b->inverse_high[axis];
        for (int i = 0; i < BOXES_WIDE; i++) {
            const float enter = in[i] - from_in, leave = out[i] - from_out;
            near[i] = boxes_max(near[i], boxes_less(boxes_min(enter * low, enter * high)));
            far[i] = boxes_min(far[i], boxes_more(boxes_max(leave * low, leave * high)));
        }
    }
    unsigned set = 0;
    for (int i = 0; i < BOXES_WIDE; i++)
        set |= (unsigned)((near[i] <= far[i]) & n->used[i]) << i;
    return set;
}

/* --- the solids --- */

/* The priority indices of the view's regions, as long as their primitives fit. */
typedef struct view_list {
    int count, primitives;
    int region[VIEW_PRIMITIVES_MAX];
} view_list;

static int places_of(const scene_geometry *g, int r)
{
    const region *b = &g->regions[r];
    return g->primitives[b->outside].rows + (b->hollow >= 0 ? g->primitives[b->hollow].rows : 0);
}

static bool list_region(const scene_geometry *g, int r, view_list *l)
{
    l->primitives += places_of(g, r);
    if (l->primitives > VIEW_PRIMITIVES_MAX)
        return false;
    int at = l->count++;
    for (; at > 0 && l->region[at - 1] > r; at--)
        l->region[at] = l->region[at - 1];
    l->region[at] = r;
    return true;
}

static bool has_region(const view_list *l, int r)
{
    for (int k = 0; k < l->count; k++)
        if (l->region[k] == r)
            return true;
    return false;
}

/* The items of the tree that the batch may enter, or one more than fit into a view. Reads no other data of theirs, for
 * which a large scene would wait, before it is known that they are few. */
static int find_entered(const scene_geometry *g, const batch_bounds *b, int items[VIEW_PRIMITIVES_MAX])
{
    const solid_boxes *boxes = &g->tree->boxes;
    int32_t stack[BOXES_DEPTH_MAX * BOXES_WIDE];
    int size = 0, count = 0;
    stack[size++] = 0;
    while (size > 0) {
        const boxes_node *n = &boxes->nodes[stack[--size]];
        for (unsigned set = entered_by_some(n, b); set; set &= set - 1) {
            const int32_t child = n->child[__builtin_ctz(set)];
            if (child >= 0) {
                stack[size++] = child;
                boxes_fetch_node(boxes, child);
            } else if (count == VIEW_PRIMITIVES_MAX) {
                return count + 1;
            } else {
                items[count++] = ~child;
            }
        }
    }
    return count;
}

static bool list_entered(const scene_geometry *g, const batch_bounds *b, view_list *l)
{
    int items[VIEW_PRIMITIVES_MAX];
    const int count = find_entered(g, b, items);
    if (l->primitives + count > VIEW_PRIMITIVES_MAX)
        return false;
    for (int k = 0; k < count; k++)
        solid_tree_fetch(g->tree, items[k]);
    for (int k = 0; k < count; k++)
        if (!list_region(g, g->tree->solids[items[k]].region, l))
            return false;
    return true;
}

/* Lists the solids that contain the start of a ray; rounding may have left out their boxes. */
static bool list_containing(const scene_geometry *g, const ray_batch *rays, view_list *l)
{
    uint64_t last = 0;
    for (int i = 0; i < rays->count; i++) {
        set_members m;
        if (rays->inside[i] == last)
            continue;
        last = rays->inside[i];
        set_table_members(g->tree->sets, last, &m);
        for (int k = 0; k < m.count; k++) {
            const int r = g->primitives[m.primitive[k]].priority_index;
            if (!has_region(l, r) && !list_region(g, r, l))
                return false;
        }
    }
    return true;
}

/* --- the view --- */

static int add_primitive(solid_view *v, const scene_geometry *g, int p, int r)
{
    const int first = v->inner.primitive_count;
    for (int row = 0; row < g->primitives[p].rows; row++) {
        const int at = v->inner.primitive_count++;
        v->primitives[at] = g->primitives[p + row];
        v->primitives[at].priority_index = r;
        v->outer_primitive[at] = p + row;
        v->inner.further |= row > 0 ? (uint64_t)1 << at : 0;
    }
    return first;
}

static void add_region(solid_view *v, const scene_geometry *g, int outer)
{
    const int r = ++v->inner.region_count;
    const region *b = &g->regions[outer];
    v->outer_region[r] = outer;
    v->direct_regions[r - 1] = r;
    v->regions[r] = *b;
    v->regions[r].outside = add_primitive(v, g, b->outside, r);
    v->regions[r].hollow = b->hollow >= 0 ? add_primitive(v, g, b->hollow, r) : -1;
    v->inner.opaque_regions |= (uint64_t)b->opaque << (r - 1);
    v->inner.highest_transparent = b->opaque ? v->inner.highest_transparent : r;
}

static bool are_distinct(const solid_view *v)
{
    for (int r = 1; r <= v->inner.region_count; r++)
        for (int q = 0; q < r; q++)
            if (v->regions[q].medium == v->regions[r].medium)
                return false;
    return true;
}

static void fill(solid_view *v, const scene_geometry *g, const view_list *l)
{
    v->inner = (scene_geometry){.primitives = v->primitives,
                                .regions = v->regions,
                                .direct_regions = v->direct_regions,
                                .extent = g->extent,
                                .attenuates = g->attenuates,
                                .partial = g->partial,
                                .outer = v};
    v->scene = g;
    v->regions[0] = g->regions[0];
    v->outer_region[0] = 0;
    for (int k = 0; k < l->count; k++)
        add_region(v, g, l->region[k]);
    v->inner.direct_count = v->inner.primitive_count;
    v->inner.direct_region_count = v->inner.region_count;
    v->inner.distinct = are_distinct(v);
}

bool KERNEL(view_make)(const scene_geometry *g, const ray_batch *rays, double t_max, solid_view *v)
{
    batch_bounds b;
    view_list l = {0, 0, {0}};
    if (g->meshes || rays->count < LANES_MAX || !is_coherent(rays, &g->tree->boxes, t_max, &b))
        return false;
    for (int k = 0; k < g->direct_region_count; k++)
        if (!list_region(g, g->direct_regions[k], &l))
            return false;
    if (!list_entered(g, &b, &l) || !list_containing(g, rays, &l))
        return false;
    fill(v, g, &l);
    return true;
}

/* --- sets and hits --- */

/* The bits of a set's primitives. A hollow's bit is kept up to date only in the region's outer primitive; elsewhere it
 * follows from the ray's start. */
static uint64_t inner_set(const solid_view *v, uint64_t set, vec3 start)
{
    const set_table *sets = v->scene->tree->sets;
    uint64_t bits = 0;
    for (int r = 1; r <= v->inner.region_count; r++) {
        const region *b = &v->regions[r];
        const bool in = set && set_table_has(sets, set, v->outer_primitive[b->outside]);
        bits |= (uint64_t)in << b->outside;
        if (b->hollow >= 0)
            bits |= (uint64_t)(in ? set_table_has(sets, set, v->outer_primitive[b->hollow])
                                  : primitive_contains(&v->primitives[b->hollow], start))
                    << b->hollow;
    }
    return bits;
}

static bool has_hollows(const solid_view *v)
{
    for (int r = 1; r <= v->inner.region_count; r++)
        if (v->regions[r].hollow >= 0)
            return true;
    return false;
}

void KERNEL(view_sets)(const solid_view *v, const ray_batch *rays, uint64_t *inside)
{
    const bool hollows = has_hollows(v);
    for (int i = 0; i < rays->count; i++)
        inside[i] = rays->inside[i] == 0 && !hollows
                        ? 0
                        : inner_set(v, rays->inside[i], vec3_make(rays->ox[i], rays->oy[i], rays->oz[i]));
}

uint64_t KERNEL(view_outer_set)(const solid_view *v, uint64_t bits)
{
    uint64_t set = 0;
    for (int r = 1; bits && r <= v->inner.region_count; r++)
        if (v->regions[r].hollow >= 0 && !(bits >> v->regions[r].outside & 1))
            bits &= ~((uint64_t)1 << v->regions[r].hollow);
    for (; bits; bits &= bits - 1)
        set = set_table_put(v->scene->tree->sets, set, v->outer_primitive[__builtin_ctzll(bits)], true);
    return set;
}

void KERNEL(view_hits)(const solid_view *v, int count, hit_batch *hits)
{
    for (int i = 0; i < count; i++) {
        const int64_t p = hits->hit_primitive[i];
        hits->hit_primitive[i] = p < 0 ? p : v->outer_primitive[p];
        hits->before[i] = v->outer_region[hits->before[i]];
        hits->after[i] = v->outer_region[hits->after[i]];
        hits->surface[i] = v->outer_region[hits->surface[i]];
        hits->inside_before[i] = KERNEL(view_outer_set)(v, hits->inside_before[i]);
        hits->inside_after[i] = KERNEL(view_outer_set)(v, hits->inside_after[i]);
    }
}
