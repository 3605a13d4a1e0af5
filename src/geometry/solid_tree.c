/* The solid tree: its build, and sets of primitives in a geometry that has one. */
#include "geometry/solid_tree.h"

#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"
#include <stdlib.h>

/* The bounds of a solid, widened beyond the rounding errors of its crossings (POINT_ERROR of the magnitudes that enter
 * them). */
static bounds3 bounds_of(const solid_tree *t, int i)
{
    const scene_geometry *a = t->of;
    const bounds3 box = shape_world_box(&a->shapes[t->solids[i].region]);
    const double slack = 0x1p-40 * a->primitives[t->solids[i].outside].extent;
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

status solid_tree_build(const scene_geometry *a, solid_tree **out, diagnostic *why)
{
    solid_tree *t = calloc(1, sizeof *t);
    if (!t)
        return out_of_memory(why);
    t->of = a;
    t->sets = set_table_create();
    t->solids = calloc((size_t)a->region_count + 1, sizeof *t->solids);
    status code = t->sets && t->solids ? STATUS_OK : out_of_memory(why);
    for (int r = 1; code == STATUS_OK && r <= a->region_count; r++)
        if (a->regions[r].outside >= a->direct_count)
            t->solids[t->count++] = (tree_solid){r, a->regions[r].outside};
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
    for (int p = t->of->direct_count; p < t->of->primitive_count; p++)
        if (primitive_contains(&t->of->primitives[p], point))
            set = set_table_put(t->sets, set, p, true);
    return set;
}

int solid_tree_priority_index(const solid_tree *t, uint64_t set)
{
    const scene_geometry *a = t->of;
    int highest = 0;
    set_members m;
    set_table_members(t->sets, set, &m);
    for (int k = 0; k < m.count; k++) {
        const int r = a->primitives[m.primitive[k]].priority_index;
        if (r > highest && a->regions[r].outside == (int)m.primitive[k] &&
            !(a->regions[r].hollow >= 0 && set_table_has(t->sets, set, a->regions[r].hollow)))
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
    for (; k < m.count && m.primitive[k] < (uint32_t)t->of->direct_count; k++)
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
