/* Builds the scene geometry, and answers queries for points. */
#include "geometry/scene_geometry.h"
#include "base/elementary.h"
#include "geometry/instance_set.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"

#include <stdlib.h>

/* Indices of the sources in the order of priority indices: ascending priority, and of equal priorities the later source
 * first. */
static void order_by_priority(const region_source *sources, int count, int *order)
{
    for (int i = 0; i < count; i++) {
        int at = i;
        while (at > 0 && sources[order[at - 1]].priority >= sources[i].priority) {
            order[at] = order[at - 1];
            at--;
        }
        order[at] = i;
    }
}

/* Outward unit normals; the corner before the first side is in front, at -z, the next ones follow to its right as seen
 * from outside. */
static const vec3 *add_normals(scene_geometry *a, int sides)
{
    vec3 *normals = a->normals + a->normal_count;
    for (int k = 0; k < sides; k++) {
        double sine, cosine;
        elementary_sincos_deg(180.0 * (2 * k + 1) / sides, &sine, &cosine);
        normals[k] = vec3_make(sine, 0.0, -cosine);
    }
    a->normal_count += sides;
    return normals;
}

static void add_primitive(scene_geometry *a, int priority_index, const primitive *part)
{
    primitive *p = &a->primitives[a->primitive_count];
    *p = *part;
    p->priority_index = priority_index;
    p->first_face = (int64_t)a->primitive_count++ * FACES_MAX;
    p->rows = p->rule ? p->rule->sse2->intervals : 1;
    p->normals = p->sides > 0 ? add_normals(a, p->sides) : NULL;
    if (p->extent > a->extent)
        a->extent = p->extent;
    for (int row = 1; row < p->rows; row++) {
        a->further |= (uint64_t)1 << a->primitive_count;
        a->primitives[a->primitive_count++] = (primitive){.priority_index = priority_index, .rows = 1};
    }
}

static void add_region(scene_geometry *a, int priority_index, const region_source *source)
{
    primitive parts[SHAPE_PRIMITIVES];
    const shape_rule *shape = shape_of(source->shape);
    const int n = shape->primitive_count;
    shape->primitives(source->shape, parts);
    a->opaque_regions |= (uint64_t)source->opaque << (priority_index - 1);
    region *b = &a->regions[priority_index];
    a->shapes[priority_index] = *source->shape;
    *b = (region){.outside = a->primitive_count,
                  .hollow = n == 2 ? a->primitive_count + 1 : -1,
                  .medium = source->medium,
                  .opaque = source->opaque,
                  .shadow_transmittance = source->opaque ? 0.0 : source->shadow_transmittance,
                  .face_shadow_transmittance = source->opaque ? NULL : source->face_shadow_transmittance,
                  .attenuates = source->attenuates && !source->opaque,
                  .reflects = source->reflects && !source->opaque,
                  .solid = source->solid};
    a->attenuates |= b->attenuates;
    for (int k = 0; k < n; k++)
        add_primitive(a, priority_index, &parts[k]);
}

static bool media_are_distinct(const scene_geometry *a)
{
    for (int r = 1; r <= a->region_count; r++)
        for (int q = 0; q < r; q++)
            if (a->regions[q].medium == a->regions[r].medium)
                return false;
    return true;
}

/* Builds the instance set. order: the sources by priority index. */
static status build_instance_set(scene_geometry *a, const region_source *sources, const int *order, diagnostic *why)
{
    instance_source mesh_sources[PRIMITIVES_MAX];
    int count = 0;
    for (int r = 1; r <= a->region_count; r++) {
        const region_source *source = &sources[order[r - 1]];
        if (shape_of(source->shape)->triangles)
            mesh_sources[count++] = (instance_source){source->shape, source->tree, a->regions[r].outside, r};
    }
    return count > 0 ? instance_set_build(mesh_sources, count, &a->meshes, why) : STATUS_OK;
}

status scene_geometry_build(const region_source *sources, int count, int64_t outside_medium, scene_geometry **out,
                            diagnostic *why)
{
    int primitives = 0;
    for (int i = 0; i < count; i++)
        primitives += shape_places(sources[i].shape);
    if (primitives > PRIMITIVES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 64; a cup and a torus count as two",
                        "the visible solids have %d primitives", primitives);
    scene_geometry *a = calloc(1, sizeof *a);
    int *order = calloc((size_t)count + 1, sizeof *order);
    if (a) {
        a->primitives = calloc((size_t)primitives + 1, sizeof *a->primitives);
        a->regions = calloc((size_t)count + 1, sizeof *a->regions);
        a->shapes = calloc((size_t)count + 1, sizeof *a->shapes);
        a->normals = calloc((size_t)primitives * FACES_MAX + 1, sizeof *a->normals);
    }
    if (!a || !order || !a->primitives || !a->regions || !a->shapes || !a->normals) {
        free(order);
        scene_geometry_destroy(a);
        return out_of_memory(why);
    }
    a->regions[0] =
        (region){.outside = -1, .hollow = -1, .medium = outside_medium, .shadow_transmittance = 1.0, .solid = -1};
    a->region_count = count;
    order_by_priority(sources, count, order);
    for (int r = 0; r < count; r++)
        add_region(a, r + 1, &sources[order[r]]);
    status code = build_instance_set(a, sources, order, why);
    free(order);
    if (code != STATUS_OK) {
        scene_geometry_destroy(a);
        return code;
    }
    a->distinct = media_are_distinct(a);
    *out = a;
    return STATUS_OK;
}

void scene_geometry_destroy(scene_geometry *a)
{
    if (!a)
        return;
    instance_set_destroy(a->meshes);
    free(a->primitives);
    free(a->regions);
    free(a->normals);
    free(a->shapes);
    free(a);
}

void scene_geometry_surroundings_absorb(scene_geometry *a)
{
    a->regions[0].attenuates = a->attenuates = true;
}

uint64_t scene_geometry_inside(const scene_geometry *a, vec3 point)
{
    uint64_t inside = a->meshes ? instance_set_inside(a->meshes, point) : 0;
    for (int i = 0; i < a->primitive_count; i++)
        inside |= (uint64_t)primitive_contains(&a->primitives[i], point) << i;
    return inside;
}

static bool set_has(uint64_t inside, int bit)
{
    return bit >= 0 && (inside >> bit & 1);
}

int scene_geometry_priority_index(const scene_geometry *a, uint64_t inside)
{
    for (int r = a->region_count; r > 0; r--)
        if (set_has(inside, a->regions[r].outside) && !set_has(inside, a->regions[r].hollow))
            return r;
    return 0;
}

int scene_geometry_surface(const scene_geometry *a, int before, int after)
{
    if (a->regions[after].opaque || a->regions[before].opaque)
        return a->regions[after].opaque ? after : before;
    return after > before ? after : before;
}
