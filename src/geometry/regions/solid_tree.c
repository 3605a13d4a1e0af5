/* The solid tree: its build, and sets of primitives in a geometry that has one. */
#include "geometry/regions/solid_tree.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>

_Static_assert(SET_PRIMITIVES_MAX <= 1 << 3 * BOXES_DEPTH_MAX, "a node has an eighth of the items of the one above");

/* --- the hierarchy of boxes --- */

typedef struct boxes_build {
    const bounds3 *items;
    int *order; /* of the items */
    solid_boxes *out;
} boxes_build;

static double component(vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static double middle(const boxes_build *b, int item, int axis)
{
    return component(b->items[item].low, axis) + component(b->items[item].high, axis);
}

static bounds3 around(const boxes_build *b, int first, int count)
{
    bounds3 all = {vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL), vec3_make(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL)};
    for (int k = first; k < first + count; k++) {
        const bounds3 one = b->items[b->order[k]];
        all.low = vec3_make(fmin(all.low.x, one.low.x), fmin(all.low.y, one.low.y), fmin(all.low.z, one.low.z));
        all.high = vec3_make(fmax(all.high.x, one.high.x), fmax(all.high.y, one.high.y), fmax(all.high.z, one.high.z));
    }
    return all;
}

static int longest_axis(const boxes_build *b, int first, int count)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int k = first; k < first + count; k++) {
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = fmin(low[axis], middle(b, b->order[k], axis));
            high[axis] = fmax(high[axis], middle(b, b->order[k], axis));
        }
    }
    const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

static bool precedes(const boxes_build *b, int axis, int one, int other)
{
    const double p = middle(b, one, axis), q = middle(b, other, axis);
    return p < q || (p == q && one < other);
}

/* Moves the `part` first items along the axis to the front of the range (Hoare's selection). */
static void select_first(boxes_build *b, int axis, int first, int count, int part)
{
    int low = first, high = first + count - 1;
    const int wanted = first + part;
    while (low < high) {
        const int pivot = b->order[low + (high - low) / 2];
        int i = low, k = high;
        while (i <= k) {
            while (precedes(b, axis, b->order[i], pivot))
                i++;
            while (precedes(b, axis, pivot, b->order[k]))
                k--;
            if (i <= k) {
                const int swapped = b->order[i];
                b->order[i++] = b->order[k];
                b->order[k--] = swapped;
            }
        }
        if (wanted <= k)
            high = k;
        else if (wanted >= i)
            low = i;
        else
            return;
    }
}

typedef struct range {
    int first, count;
} range;

/* The number of items below a full child of a node over `items` items. A few items more than eight full children have
 * are shared among eight: that was measured to be faster than another level above them. */
static int full_child(int items)
{
    int full = items > BOXES_WIDE ? BOXES_WIDE : 1;
    while (2 * items > 3 * full * BOXES_WIDE)
        full *= BOXES_WIDE;
    return full;
}

/* Halves the largest of the ranges until there are eight, or each fits below a full child, so that the lowest nodes are
 * nearly full; returns their number. */
static int split(boxes_build *b, range ranges[BOXES_WIDE])
{
    const int full = full_child(ranges[0].count);
    int count = 1;
    while (count < BOXES_WIDE) {
        int largest = 0;
        for (int k = 1; k < count; k++)
            largest = ranges[k].count > ranges[largest].count ? k : largest;
        range *r = &ranges[largest];
        if (r->count <= full)
            break;
        const int half = r->count / 2;
        select_first(b, longest_axis(b, r->first, r->count), r->first, r->count, half);
        ranges[count++] = (range){r->first + half, r->count - half};
        r->count = half;
    }
    return count;
}

static float outwards(double v, float direction)
{
    const float f = (float)v;
    return (direction < 0.0f ? (double)f > v : (double)f < v) ? nextafterf(f, direction) : f;
}

static void set_box(boxes_node *n, int child, const bounds3 *box)
{
    for (int axis = 0; axis < 3; axis++) {
        n->low[axis][child] = outwards(component(box->low, axis), -HUGE_VALF);
        n->high[axis][child] = outwards(component(box->high, axis), HUGE_VALF);
    }
}

/* Builds the node over a range of at least one item; returns its number. */
static int build_node(boxes_build *b, range all)
{
    const int number = b->out->node_count++;
    range ranges[BOXES_WIDE] = {all};
    const int count = split(b, ranges);
    b->out->nodes[number] = (boxes_node){.used = {0}};
    for (int k = 0; k < count; k++) {
        boxes_node *n = &b->out->nodes[number];
        const bounds3 box = around(b, ranges[k].first, ranges[k].count);
        set_box(n, k, &box);
        n->used[k] = -1;
        n->child[k] = ranges[k].count == 1 ? ~b->order[ranges[k].first] : build_node(b, ranges[k]);
    }
    return number;
}

status solid_boxes_build(const bounds3 *items, int count, solid_boxes *out, diagnostic *why)
{
    boxes_build b = {.items = items, .order = malloc((size_t)count * sizeof *b.order), .out = out};
    /* A node has at least two children, or is the only one, so that there are at most as many nodes as items. */
    const size_t bytes = ((size_t)count + 1) * sizeof *out->nodes;
    *out = (solid_boxes){.nodes = aligned_alloc(64, (bytes + 63) / 64 * 64)};
    if (!b.order || !out->nodes) {
        free(b.order);
        solid_boxes_destroy(out);
        return out_of_memory(why);
    }
    for (int i = 0; i < count; i++)
        b.order[i] = i;
    const bounds3 all = around(&b, 0, count);
    out->reach = (float)fmax(fmax(fmax(fabs(all.low.x), fabs(all.low.y)), fmax(fabs(all.low.z), fabs(all.high.x))),
                             fmax(fabs(all.high.y), fabs(all.high.z)));
    build_node(&b, (range){0, count});
    free(b.order);
    return STATUS_OK;
}

void solid_boxes_destroy(solid_boxes *b)
{
    free(b->nodes);
    b->nodes = NULL;
}

/* --- the tree --- */

/* The bounds of a solid, widened beyond the rounding errors of its crossings (POINT_ERROR of the magnitudes that enter
 * them). */
static bounds3 bounds_of(const solid_tree *t, int i)
{
    const scene_geometry *g = t->geometry;
    const solid_shape shape = scene_geometry_shape(g, t->solids[i].region);
    const bounds3 box = shape_world_box(&shape);
    const double slack = 0x1p-40 * g->primitives[t->solids[i].outside].extent;
    const vec3 wider = vec3_make(slack, slack, slack);
    return (bounds3){vec3_sub(box.low, wider), vec3_add(box.high, wider)};
}

static status build_boxes(solid_tree *t, diagnostic *why)
{
    bounds3 *bounds = calloc((size_t)t->count, sizeof *bounds);
    if (!bounds)
        return out_of_memory(why);
    for (int i = 0; i < t->count; i++)
        bounds[i] = bounds_of(t, i);
    const status code = solid_boxes_build(bounds, t->count, &t->boxes, why);
    free(bounds);
    return code;
}

status solid_tree_build(const scene_geometry *g, solid_tree **out, diagnostic *why)
{
    solid_tree *t = calloc(1, sizeof *t);
    if (!t)
        return out_of_memory(why);
    t->geometry = g;
    t->sets = set_table_create();
    t->solids = calloc((size_t)g->region_count + 1, sizeof *t->solids);
    status code = t->sets && t->solids ? STATUS_OK : out_of_memory(why);
    for (int r = 1; code == STATUS_OK && r <= g->region_count; r++)
        if (g->regions[r].outside >= g->direct_count)
            t->solids[t->count++] = (tree_solid){r, g->regions[r].outside};
    THEN(code, build_boxes(t, why));
    if (code != STATUS_OK) {
        solid_tree_destroy(t);
        return code;
    }
    *out = t;
    return STATUS_OK;
}

void solid_tree_destroy(solid_tree *t)
{
    if (!t)
        return;
    solid_boxes_destroy(&t->boxes);
    set_table_destroy(t->sets);
    free(t->solids);
    free(t);
}

uint64_t solid_tree_inside(const solid_tree *t, uint64_t direct, vec3 point)
{
    uint64_t set = solid_tree_join(t, (split_set){direct, 0});
    for (int p = t->geometry->direct_count; p < t->geometry->primitive_count; p++)
        if (primitive_contains(&t->geometry->primitives[p], point))
            set = set_table_put(t->sets, set, p, true);
    return set;
}

int solid_tree_priority_index(const solid_tree *t, uint64_t set)
{
    const scene_geometry *g = t->geometry;
    int highest = 0;
    set_members m;
    set_table_members(t->sets, set, &m);
    for (int k = 0; k < m.count; k++) {
        const int r = g->primitives[m.primitive[k]].priority_index;
        if (r > highest && g->regions[r].outside == (int)m.primitive[k] &&
            !(g->regions[r].hollow >= 0 && set_table_has(t->sets, set, g->regions[r].hollow)))
            highest = r;
    }
    return highest;
}

split_set solid_tree_split(const solid_tree *t, uint64_t set)
{
    set_members m;
    split_set parts = {0, set};
    if (set == 0)
        return parts;
    set_table_members(t->sets, set, &m);
    int k = 0;
    for (; k < m.count && m.primitive[k] < (uint32_t)t->geometry->direct_count; k++)
        parts.direct |= (uint64_t)1 << m.primitive[k];
    if (k > 0)
        parts.others = set_table_of(t->sets, m.primitive + k, m.count - k);
    return parts;
}

uint64_t solid_tree_join(const solid_tree *t, split_set parts)
{
    uint64_t set = parts.others;
    for (uint64_t left = parts.direct; left; left &= left - 1)
        set = set_table_put(t->sets, set, __builtin_ctzll(left), true);
    return set;
}
