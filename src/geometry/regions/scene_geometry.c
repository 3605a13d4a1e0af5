/* The build of the scene geometry, and its queries for points. */
#include "geometry/scene_geometry.h"
#include "base/array.h"
#include "base/elementary.h"
#include "geometry/primitives/capillary.h"
#include "geometry/primitives/primitive.h"
#include "geometry/regions/instance_set.h"
#include "geometry/regions/solid_tree.h"
#include "geometry/shapes/shape.h"

#include <stdlib.h>

typedef struct ordered_source {
    int64_t priority;
    int index; /* of the source */
} ordered_source;

static int compare_priorities(const void *one, const void *other)
{
    const ordered_source *first = one, *second = other;
    if (first->priority != second->priority)
        return first->priority < second->priority ? -1 : 1;
    return first->index > second->index ? -1 : 1;
}

/* Sets the origins in the order of priority indices: ascending priority, and of equal priorities the later source, or
 * copy, first. order: room for one per source. */
static void order_by_priority(const region_source *sources, int count, ordered_source *order, region_origin *origins)
{
    for (int i = 0; i < count; i++)
        order[i] = (ordered_source){sources[i].priority, i};
    qsort(order, (size_t)count, sizeof *order, compare_priorities);
    for (int i = 0, r = 1; i < count; i++)
        for (size_t copy = solid_shape_count(sources[order[i].index].shape); copy-- > 0;)
            origins[r++] = (region_origin){(uint32_t)order[i].index, (uint32_t)copy};
}

/* Outward unit normals; the corner before the first side is in front, at -z, the next ones follow to its right as seen
 * from outside. */
static const vec3 *add_normals(scene_geometry *g, int sides)
{
    vec3 *normals = g->normals + g->normal_count;
    for (int k = 0; k < sides; k++) {
        double sine, cosine;
        elementary_sincos_deg(180.0 * (2 * k + 1) / sides, &sine, &cosine);
        normals[k] = vec3_make(sine, 0.0, -cosine);
    }
    g->normal_count += sides;
    return normals;
}

static int rows_of(const primitive *p)
{
    return p->rule ? p->rule->ISA_BASELINE->intervals : 1;
}

static void add_primitive(scene_geometry *g, int priority_index, const primitive *part)
{
    primitive *p = &g->primitives[g->primitive_count];
    *p = *part;
    p->priority_index = priority_index;
    p->first_face = (int64_t)g->primitive_count++ * FACES_MAX;
    p->rows = rows_of(p);
    p->normals = p->sides > 0 ? add_normals(g, p->sides) : NULL;
    if (p->extent > g->extent)
        g->extent = p->extent;
    for (int row = 1; row < p->rows; row++)
        g->primitives[g->primitive_count++] = (primitive){.priority_index = priority_index, .rows = 1};
}

/* The bytes of the details of a shape's primitive, in units that keep the next ones aligned. */
static size_t detail_space(const solid_shape *s, int k)
{
    const size_t unit = _Alignof(max_align_t);
    return (shape_details(s, k, NULL) + unit - 1) / unit * unit;
}

/* The details of a shape's primitive, number k; NULL for none. */
static void *add_details(scene_geometry *g, const solid_shape *s, int k)
{
    const size_t space = detail_space(s, k);
    if (space == 0)
        return NULL;
    char *out = g->details + g->detail_bytes;
    shape_details(s, k, out);
    g->detail_bytes += space;
    return out;
}

static void add_region(scene_geometry *g, int priority_index, const region_source *source)
{
    primitive parts[SHAPE_PRIMITIVES];
    const shape_rule *shape = shape_of(source->shape);
    const int n = shape->primitive_count;
    const solid_shape placed = scene_geometry_shape(g, priority_index);
    const uint32_t copy = g->origins[priority_index].copy;
    shape_primitives(&placed, parts);
    if (!source->opaque && priority_index > g->highest_transparent)
        g->highest_transparent = priority_index;
    region *b = &g->regions[priority_index];
    *b = (region){.outside = g->primitive_count,
                  .hollow = n == 2 ? g->primitive_count + rows_of(&parts[0]) : -1,
                  .medium = copy > 0 && source->further_media ? source->further_media + copy : source->medium,
                  .opaque = source->opaque,
                  .shadow_transmittance = source->opaque ? 0.0 : source->shadow_transmittance,
                  .face_shadow_transmittance = source->opaque ? NULL : source->face_shadow_transmittance,
                  .face_slots = source->face_slots,
                  .attenuates = source->attenuates && !source->opaque,
                  .reflects = source->reflects && !source->opaque,
                  .partial = source->partial,
                  .solid = source->solid};
    g->attenuates |= b->attenuates;
    g->partial |= b->partial;
    for (int k = 0; k < n; k++) {
        void *const details = add_details(g, &placed, k);
        const int at = g->primitive_count;
        parts[k].details = details;
        add_primitive(g, priority_index, &parts[k]);
        if (shape_is_scaled(&placed))
            ((scaled_primitive *)details)->inner.normals = g->primitives[at].normals;
    }
}

/* Only for a geometry without a tree: with many solids there are nearly always equal media. */
static bool media_are_distinct(const scene_geometry *g)
{
    for (int r = 1; r <= g->region_count; r++)
        for (int q = 0; q < r; q++)
            if (g->regions[q].medium == g->regions[r].medium)
                return false;
    return true;
}

static status build_instance_set(scene_geometry *g, const region_source *sources, diagnostic *why)
{
    instance_source mesh_sources[PRIMITIVES_MAX];
    int count = 0;
    for (int k = 0; k < g->direct_region_count; k++) {
        const int r = g->direct_regions[k];
        const region_source *source = &sources[g->origins[r].source];
        if (shape_of(source->shape)->triangles)
            mesh_sources[count++] =
                (instance_source){source->shape, source->tree, g->regions[r].outside, r, source->partial};
    }
    return count > 0 ? instance_set_build(mesh_sources, count, g->region_count, &g->meshes, why) : STATUS_OK;
}

/* Whether a solid tree can hold the solid. */
static bool can_be_in_tree(const region_source *source)
{
    const shape_rule *rule = shape_of(source->shape);
    return !rule->unbounded && !rule->triangles;
}

/* From this number of primitives on, a hierarchy over the bounded ones was measured to be faster; with meshes there are
 * no views (solid_view_kernel.c), and a search for every ray pays later. */
enum { MANY = 10, MANY_WITH_MESHES = 24 };

/* The primitives of a scene, counted by how rays find them. */
typedef struct primitive_counts {
    size_t regions;
    size_t all, findable; /* findable: those that a tree can find */
    size_t normals;       /* of all their sides */
    size_t details;       /* bytes of their details */
    bool meshes;
} primitive_counts;

static primitive_counts count_primitives(const region_source *sources, int count)
{
    primitive_counts n = {.all = 0};
    for (int i = 0; i < count; i++) {
        const size_t copies = solid_shape_count(sources[i].shape),
                     places = copies * (size_t)shape_primitive_slots(sources[i].shape);
        n.regions += copies;
        n.all += places;
        n.findable += can_be_in_tree(&sources[i]) ? places : 0;
        n.normals += copies * (size_t)sources[i].shape->sides;
        for (int k = 0; k < shape_of(sources[i].shape)->primitive_count; k++)
            n.details += copies * detail_space(sources[i].shape, k);
        n.meshes |= shape_of(sources[i].shape)->triangles;
    }
    return n;
}

static bool uses_tree(tree_use use, const primitive_counts *n)
{
    const size_t many = n->meshes ? MANY_WITH_MESHES : MANY;
    return n->findable > 0 &&
           (n->all > PRIMITIVES_MAX || use == TREE_ALWAYS || (use == TREE_IF_MANY && n->findable >= many));
}

/* Adds the regions: first the direct ones, then those for the tree. */
static void add_regions(scene_geometry *g, const region_source *sources, bool with_tree)
{
    for (int r = 1; r <= g->region_count; r++) {
        const region_source *source = &sources[g->origins[r].source];
        if (with_tree && can_be_in_tree(source))
            continue;
        add_region(g, r, source);
        g->opaque_regions |= with_tree ? 0 : (uint64_t)source->opaque << (r - 1);
        g->direct_regions[g->direct_region_count++] = r;
    }
    g->direct_count = g->primitive_count;
    for (int p = 0; p < g->direct_count; p += g->primitives[p].rows)
        for (int row = 1; row < g->primitives[p].rows; row++)
            g->further |= (uint64_t)1 << (p + row);
    for (int r = 1; with_tree && r <= g->region_count; r++)
        if (can_be_in_tree(&sources[g->origins[r].source]))
            add_region(g, r, &sources[g->origins[r].source]);
}

static status check_counts(const primitive_counts *n, bool with_tree, diagnostic *why)
{
    const size_t direct = with_tree ? n->all - n->findable : n->all;
    if (direct > PRIMITIVES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64 planes and meshes",
                        "the visible solids are %zu planes and meshes", direct);
    if (n->all > SET_PRIMITIVES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 2097151 primitives",
                        "the visible solids have %zu primitives", n->all);
    return STATUS_OK;
}

status scene_geometry_build(const region_source *sources, int count, int64_t outside_medium, tree_use use,
                            scene_geometry **out, diagnostic *why)
{
    const primitive_counts n = count_primitives(sources, count);
    const bool with_tree = uses_tree(use, &n);
    status code = check_counts(&n, with_tree, why);
    if (code != STATUS_OK)
        return code;
    scene_geometry *g = calloc(1, sizeof *g);
    ordered_source *order = calloc((size_t)count + 1, sizeof *order);
    if (g) {
        g->primitives = large_calloc(n.all + 1, sizeof *g->primitives);
        g->regions = large_calloc(n.regions + 1, sizeof *g->regions);
        g->origins = large_calloc(n.regions + 1, sizeof *g->origins);
        g->shapes = calloc((size_t)count + 1, sizeof *g->shapes);
        g->normals = large_calloc(n.normals + 1, sizeof *g->normals);
        g->details = calloc(n.details + 1, 1);
        g->direct_regions = calloc(n.regions + 1, sizeof *g->direct_regions);
    }
    if (!g || !order || !g->primitives || !g->regions || !g->origins || !g->shapes || !g->normals || !g->details ||
        !g->direct_regions) {
        free(order);
        scene_geometry_destroy(g);
        return out_of_memory(why);
    }
    g->regions[0] =
        (region){.outside = -1, .hollow = -1, .medium = outside_medium, .shadow_transmittance = 1.0, .solid = -1};
    g->region_count = (int)n.regions;
    for (int i = 0; i < count; i++)
        g->shapes[i] = *sources[i].shape;
    order_by_priority(sources, count, order, g->origins);
    add_regions(g, sources, with_tree);
    code = build_instance_set(g, sources, why);
    if (code == STATUS_OK && with_tree)
        code = solid_tree_build(g, &g->tree, why);
    free(order);
    if (code != STATUS_OK) {
        scene_geometry_destroy(g);
        return code;
    }
    g->distinct = !g->tree && media_are_distinct(g);
    *out = g;
    return STATUS_OK;
}

void scene_geometry_destroy(scene_geometry *g)
{
    if (!g)
        return;
    instance_set_destroy(g->meshes);
    solid_tree_destroy(g->tree);
    free(g->direct_regions);
    free(g->primitives);
    free(g->regions);
    free(g->normals);
    free(g->details);
    free(g->shapes);
    free(g->origins);
    free(g);
}

void scene_geometry_surroundings_absorb(scene_geometry *g)
{
    g->regions[0].attenuates = g->attenuates = true;
}

/* True if the point is inside the mesh: the first hit along a fixed direction is a back and not a front. The direction
 * is neither an axis nor a diagonal, so that a ray seldom hits an edge of a regular mesh. Where a back and a front
 * coincide (copies that touch, or an edge), within the tolerance of mesh_changes_kernel.c, the hits after them
 * decide. */
static bool is_inside_mesh(const instance_set *f, uint64_t bit, double reach, vec3 point)
{
    instance_ray ray = {.origin = point,
                        .direction = vec3_make(0.5396, 0.6180, 0.5716),
                        .t_max = HUGE_VAL,
                        .start = FACE_NONE,
                        .wanted = bit};
    for (;;) {
        instance_hit back, front;
        ray.inside = bit; /* look for backs */
        ISA_BASE_OF(instance_kernels).nearest(f, &ray, 1, &back);
        ray.inside = 0;
        ISA_BASE_OF(instance_kernels).nearest(f, &ray, 1, &front);
        const double first = fmin(back.t, front.t), tie = 0x1p-40 * (first + reach);
        if (first == HUGE_VAL || fabs(back.t - front.t) > tie)
            return back.t < front.t;
        ray.t_min = first + tie;
    }
}

/* The set of meshes that contain a point, by the side of the nearest surface in a fixed direction. */
static uint64_t meshes_around(const instance_set *f, vec3 point)
{
    uint64_t inside = 0;
    for (int i = 0; i < f->part_count; i++) {
        const instanced_mesh *p = &f->parts[i];
        const uint64_t bit = (uint64_t)1 << p->primitive;
        const double reach = p->reach + fabs(p->origin.x) + fabs(p->origin.y) + fabs(p->origin.z);
        inside |= p->closed && is_inside_mesh(f, bit, reach, point) ? bit : 0;
    }
    return inside;
}

uint64_t scene_geometry_inside(const scene_geometry *g, vec3 point)
{
    uint64_t inside = g->meshes ? meshes_around(g->meshes, point) : 0;
    for (int i = 0; i < g->direct_count; i++)
        inside |= (uint64_t)primitive_contains(&g->primitives[i], point) << i;
    return g->tree ? solid_tree_inside(g->tree, inside, point) : inside;
}

bool scene_geometry_set_has(const scene_geometry *g, uint64_t set, int p)
{
    if (g->tree && p >= 0)
        return set_table_has(g->tree->sets, set, p);
    return p >= 0 && (set >> p & 1);
}

bool scene_geometry_failed(const scene_geometry *g)
{
    return g->tree && set_table_failed(g->tree->sets);
}

int scene_geometry_priority_index(const scene_geometry *g, uint64_t inside)
{
    if (g->tree)
        return solid_tree_priority_index(g->tree, inside);
    for (int r = g->region_count; r > 0; r--)
        if (scene_geometry_set_has(g, inside, g->regions[r].outside) &&
            !scene_geometry_set_has(g, inside, g->regions[r].hollow))
            return r;
    return 0;
}

int scene_geometry_surface(const scene_geometry *g, int before, int after)
{
    if (g->regions[after].opaque || g->regions[before].opaque)
        return g->regions[after].opaque ? after : before;
    return after > before ? after : before;
}
