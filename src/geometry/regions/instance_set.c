/* The instance set: its build, the bounds of its instances, the frames of their copies, and texture coordinates. */
#include "geometry/regions/instance_set.h"
#include "base/budget.h"
#include "base/lanes.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

vec3 instance_set_origin(const instanced_mesh *p, uint32_t copy)
{
    if (copy == 0)
        return p->origin;
    const uint32_t nx = p->copies[0], ny = p->copies[1];
    const vec3 steps = vec3_make((double)(copy % nx), (double)(copy / nx % ny), (double)(copy / nx / ny));
    const vec3 offset = vec3_make(steps.x * p->spacing.x, steps.y * p->spacing.y, steps.z * p->spacing.z);
    return vec3_add(p->origin, mat3_apply(p->rotation, offset));
}

double instance_set_extent(const instance_set *f, int64_t face)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(face)]];
    const vec3 o = instance_set_origin(p, mesh_face_copy(face));
    return fmax(fabs(o.x), fmax(fabs(o.y), fabs(o.z))) + p->reach;
}

vec3 instance_set_vertex_point(const instanced_mesh *p, uint32_t copy, uint32_t vertex)
{
    return vec3_add(instance_set_origin(p, copy), instance_set_vertex_offset(p, vertex));
}

/* Normals transform by the inverse transpose: R S^-1. */
vec3 instance_set_vertex_normal(const instanced_mesh *p, uint32_t vertex)
{
    if (!p->triangles->normals)
        return vec3_make(0.0, 0.0, 0.0);
    const vec3 n = p->triangles->normals[vertex];
    if (!p->scaled)
        return p->turned ? mat3_apply(p->rotation, n) : n;
    return vec3_normalize(mat3_apply(p->rotation, vec3_make(n.x / p->scale.x, n.y / p->scale.y, n.z / p->scale.z)));
}

static double largest_coordinate(const mesh *m, vec3 scale)
{
    if (m->triangle_count == 0)
        return 0.0;
    const double x = fmax(fabs(m->bounds.low.x), fabs(m->bounds.high.x)) * fabs(scale.x);
    const double y = fmax(fabs(m->bounds.low.y), fabs(m->bounds.high.y)) * fabs(scale.y);
    const double z = fmax(fabs(m->bounds.low.z), fabs(m->bounds.high.z)) * fabs(scale.z);
    return fmax(x, fmax(y, z));
}

static instanced_mesh part_of(const instance_source *source, size_t first_instance)
{
    const solid_shape *shape = source->shape;
    const vec3 turn = shape->rotation_deg, scale = shape->scale, copies = shape->copies;
    return (instanced_mesh){.triangles = shape->mesh,
                            .tree = source->tree,
                            .primitive = source->primitive,
                            .priority_index = source->priority_index,
                            .closed = shape->mesh->closed && !source->partial,
                            .turned = turn.x != 0.0 || turn.y != 0.0 || turn.z != 0.0,
                            .scaled = scale.x != 1.0 || scale.y != 1.0 || scale.z != 1.0,
                            .rotation = rotation_from_deg(turn),
                            .scale = scale,
                            .origin = shape->position,
                            .spacing = shape->spacing,
                            .copies = {(uint32_t)copies.x, (uint32_t)copies.y, (uint32_t)copies.z},
                            .first_instance = first_instance,
                            .reach = largest_coordinate(shape->mesh, scale)};
}

static size_t instances_of(const instanced_mesh *p)
{
    return (size_t)p->copies[0] * p->copies[1] * p->copies[2];
}

/* gcc 12 fails at this function's loop when it vectorises it for aarch64 ("internal compiler error: in
 * vect_transform_reduction"); clang 14 compiles it. A loop of eight corners per mesh needs no vectors. */
#if defined __aarch64__ && defined __GNUC__ && !defined __clang__ && __GNUC__ < 14
#define WITHOUT_VECTORS __attribute__((optimize("no-tree-vectorize")))
#else
#define WITHOUT_VECTORS
#endif

/* The bounds of a mesh along the world's axes, relative to the origin of its frame; widened beyond the rounding
 * error. */
WITHOUT_VECTORS
static bounds3 bounds_in_world(const instanced_mesh *p)
{
    const bounds3 b = p->triangles->bounds;
    bounds3 world = {vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL), vec3_make(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL)};
    const double slack = p->reach * 0x1p-48;
    for (int k = 0; k < 8; k++) {
        const vec3 corner =
            vec3_make((k & 1 ? b.high.x : b.low.x) * p->scale.x, (k & 2 ? b.high.y : b.low.y) * p->scale.y,
                      (k & 4 ? b.high.z : b.low.z) * p->scale.z);
        const vec3 v = mat3_apply(p->rotation, corner);
        world.low =
            vec3_make(fmin(world.low.x, v.x - slack), fmin(world.low.y, v.y - slack), fmin(world.low.z, v.z - slack));
        world.high = vec3_make(fmax(world.high.x, v.x + slack), fmax(world.high.y, v.y + slack),
                               fmax(world.high.z, v.z + slack));
    }
    return world;
}

/* World bounds of a copy, from those about its frame's origin. */
static bounds3 bounds_at(bounds3 box, vec3 o)
{
    const double slack = (fabs(o.x) + fabs(o.y) + fabs(o.z)) * 0x1p-48;
    const vec3 wider = vec3_make(slack, slack, slack);
    return (bounds3){vec3_sub(vec3_add(box.low, o), wider), vec3_add(vec3_add(box.high, o), wider)};
}

/* Writes one proxy triangle per copy. A mesh without triangles has no bounds; its proxies stay zero, and the hierarchy
 * leaves them out. */
static void span_copies(instance_set *f, const instanced_mesh *p)
{
    const bounds3 box = bounds_in_world(p);
    for (size_t copy = 0; copy < instances_of(p) && p->triangles->triangle_count > 0; copy++) {
        const bounds3 here = bounds_at(box, instance_set_origin(p, (uint32_t)copy));
        const vec3 low = here.low, high = here.high;
        const size_t at = p->first_instance + copy;
        vec3 *corner = &f->proxies->vertices[3 * at];
        corner[0] = low;
        corner[1] = high;
        corner[2] = vec3_make(low.x, high.y, low.z);
        f->proxies->triangles[at] =
            (mesh_triangle){{(uint32_t)(3 * at), (uint32_t)(3 * at + 1), (uint32_t)(3 * at + 2)}};
    }
}

/* Builds the top-level hierarchy over the proxies. */
static status make_top(instance_set *f, diagnostic *why)
{
    const size_t count = f->instance_count;
    TRY(memory_budget_check(count * (3 * sizeof(vec3) + sizeof(mesh_triangle)), "use fewer copies", why,
                            "the bounds of %zu copies of meshes", count));
    TRY(mesh_create(3 * count, count, false, false, false, &f->proxies, why));
    for (int i = 0; i < f->part_count; i++)
        span_copies(f, &f->parts[i]);
    const status code = mesh_finish(f->proxies, why);
    if (code == STATUS_BAD_INPUT)
        return diagnose(why, STATUS_BAD_INPUT, "reduce their scale, or place them nearer to the origin",
                        "meshes extend beyond 1e9 scene units");
    return code == STATUS_OK ? hierarchy_build(f->proxies, HIERARCHY_BVH, 1, &f->top, why) : code;
}

status instance_set_build(const instance_source *sources, int count, int region_count, instance_set **out,
                          diagnostic *why)
{
    instance_set *f = calloc(1, sizeof *f);
    instanced_mesh *parts = calloc((size_t)count, sizeof *parts);
    uint64_t *closed_under = calloc((size_t)region_count + 1, sizeof *closed_under);
    if (!f || !parts || !closed_under) {
        free(f);
        free(parts);
        free(closed_under);
        return out_of_memory(why);
    }
    f->parts = parts;
    f->closed_under = closed_under;
    f->part_count = count;
    f->lowest = f->lowest_closed = INT_MAX;
    memset(f->by_primitive, -1, sizeof f->by_primitive);
    for (int i = 0; i < count; i++) {
        instanced_mesh *p = &f->parts[i];
        *p = part_of(&sources[i], f->instance_count);
        f->instance_count += instances_of(p);
        const uint64_t bit = (uint64_t)1 << p->primitive;
        f->primitives |= bit;
        *(p->closed ? &f->closed : &f->open_surfaces) |= bit;
        f->by_primitive[p->primitive] = i;
        if (p->priority_index < f->lowest)
            f->lowest = p->priority_index;
        if (p->closed && p->priority_index < f->lowest_closed)
            f->lowest_closed = p->priority_index;
    }
    for (int priority_index = 0; priority_index <= region_count; priority_index++)
        for (int i = 0; i < count; i++)
            if (parts[i].closed && parts[i].priority_index < priority_index)
                f->closed_under[priority_index] |= (uint64_t)1 << parts[i].primitive;
    status code = STATUS_OK;
    if (f->instance_count > COPIES_MAX)
        code = diagnose(why, STATUS_BAD_INPUT, "use fewer copies",
                        "the meshes have %zu copies in all, more than 4194304", f->instance_count);
    if (code == STATUS_OK && f->instance_count > 1)
        code = make_top(f, why);
    if (code == STATUS_OK)
        f->world = f->instance_count > 1 ? f->proxies->bounds : bounds_at(bounds_in_world(parts), parts->origin);
    if (code != STATUS_OK) {
        instance_set_destroy(f);
        return code;
    }
    *out = f;
    return STATUS_OK;
}

void instance_set_destroy(instance_set *f)
{
    if (!f)
        return;
    hierarchy_destroy(f->top);
    mesh_release(f->proxies);
    free(f->parts);
    free(f->closed_under);
    free(f);
}

/* --- texture coordinates where rays hit meshes --- */

/* A triangle's edges from its first corner, its normal, and the length of their cross product. */
typedef struct edge_pair {
    vec3 b, c, n;
    double area2;
} edge_pair;

static edge_pair edges_of(const instanced_mesh *p, mesh_triangle tri)
{
    const vec3 o = instance_set_vertex_offset(p, tri.corner[0]);
    edge_pair e = {.b = vec3_sub(instance_set_vertex_offset(p, tri.corner[1]), o),
                   .c = vec3_sub(instance_set_vertex_offset(p, tri.corner[2]), o)};
    const vec3 across = vec3_cross(e.b, e.c);
    e.area2 = vec3_length(across);
    e.n = e.area2 > 0.0 ? vec3_scale(across, 1.0 / e.area2) : across;
    return e;
}

/* Length of the gradient across the triangle of a value that is 0 at the first corner, and at_b and at_c at the
 * others. */
static double steepness(const edge_pair *e, double at_b, double at_c)
{
    const vec3 along = vec3_add(vec3_scale(vec3_cross(e->c, e->n), at_b), vec3_scale(vec3_cross(e->n, e->b), at_c));
    return vec3_length(along) / e->area2;
}

surface_mapping instance_set_mapping(const instance_set *f, const instance_hit *hit)
{
    const instanced_mesh *p = &f->parts[f->by_primitive[mesh_face_primitive(hit->face)]];
    const mesh *m = p->triangles;
    if (!m->uvs)
        return (surface_mapping){0.0, 0.0, 0.0};
    const mesh_triangle tri = m->triangles[mesh_face_triangle(hit->face)];
    const edge_pair e = edges_of(p, tri);
    const mesh_uv a = m->uvs[tri.corner[0]], b = m->uvs[tri.corner[1]], c = m->uvs[tri.corner[2]];
    const double bu = b.u - a.u, bv = b.v - a.v, cu = c.u - a.u, cv = c.v - a.v;
    return (surface_mapping){a.u + bu * hit->u + cu * hit->v, a.v + bv * hit->u + cv * hit->v,
                             e.area2 > 0.0 ? greater(steepness(&e, bu, cu), steepness(&e, bv, cv)) : 0.0};
}
