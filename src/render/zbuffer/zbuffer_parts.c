/* The rasterised parts: meshes as they are, analytic primitives as triangles on their surface. Shading uses the
 * primitive itself, so that the triangles show only in outlines. */
#include "render/zbuffer/zbuffer_private.h"

#include "base/elementary.h"
#include "geometry/primitives/primitive.h"
#include "geometry/shapes/shape.h"

/* --- layers --- */

/* Solids that are drawn as layers: clear ones, through which the view continues, and opaque ones that a clear one of
 * higher priority may overlap, and there displace. For all others only the nearest surface is visible. */

/* True if the box extends below the half-space's plane. */
static bool dips_into(const primitive *half, bounds3 b)
{
    const vec3 n = vec3_make(half->rotation.row[0].y, half->rotation.row[1].y, half->rotation.row[2].y);
    const vec3 lowest =
        vec3_make(n.x > 0.0 ? b.low.x : b.high.x, n.y > 0.0 ? b.low.y : b.high.y, n.z > 0.0 ? b.low.z : b.high.z);
    return vec3_dot(n, vec3_sub(lowest, half->origin)) <= 0.0;
}

static bool may_touch(const scene_geometry *g, int priority_index, int other)
{
    const solid_shape s = scene_geometry_shape(g, priority_index), t = scene_geometry_shape(g, other);
    const bool endless = shape_of(&s)->unbounded, other_endless = shape_of(&t)->unbounded;
    if (endless && other_endless)
        return true;
    if (endless || other_endless)
        return dips_into(&g->primitives[g->regions[endless ? priority_index : other].outside],
                         shape_world_box(endless ? &t : &s));
    const bounds3 b = shape_world_box(&s), c = shape_world_box(&t);
    return b.low.x <= c.high.x && c.low.x <= b.high.x && b.low.y <= c.high.y && c.low.y <= b.high.y &&
           b.low.z <= c.high.z && c.low.z <= b.high.z;
}

static bool is_layered(const scene_geometry *g, int priority_index)
{
    const region *b = &g->regions[priority_index];
    bool layered = !b->opaque;
    for (int r = priority_index + 1; r <= g->region_count && !layered; r++)
        layered = !g->regions[r].opaque && may_touch(g, priority_index, r);
    return layered;
}

/* True if the camera is in one of the mesh's instances: the triangles' solid angle (van Oosterom and Strackee, "The
 * solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30(2), 1983) is then the full sphere, otherwise 0. A
 * rasterised frame has no hierarchy for this query. */
static bool eye_in_mesh(const instanced_mesh *p, vec3 eye)
{
    for (uint32_t copy = 0; copy < p->copies[0] * p->copies[1] * p->copies[2]; copy++) {
        const vec3 o = vec3_sub(instance_set_origin(p, copy), eye);
        const vec3 far = vec3_make(fabs(o.x), fabs(o.y), fabs(o.z));
        const double reach = 1.8 * p->reach;
        if (far.x > reach || far.y > reach || far.z > reach)
            continue;
        double turns = 0.0;
        for (size_t k = 0; k < p->triangles->triangle_count; k++) {
            const mesh_triangle tri = p->triangles->triangles[k];
            const vec3 a = zbuffer_vertex(p, o, tri.corner[0]), b = zbuffer_vertex(p, o, tri.corner[1]),
                       c = zbuffer_vertex(p, o, tri.corner[2]);
            const double la = vec3_length(a), lb = vec3_length(b), lc = vec3_length(c);
            const double below = la * lb * lc + vec3_dot(a, b) * lc + vec3_dot(b, c) * la + vec3_dot(c, a) * lb;
            turns += elementary_atan2_deg(vec3_dot(a, vec3_cross(b, c)), below) / 360.0;
        }
        if (fabs(turns) > 0.5)
            return true;
    }
    return false;
}

static bool eye_in(const scene_geometry *g, const region *b, vec3 eye)
{
    const primitive *p = &g->primitives[b->outside];
    if (p->rule)
        return primitive_contains(p, eye) && !(b->hollow >= 0 && primitive_contains(&g->primitives[b->hollow], eye));
    const instanced_mesh *part = &g->meshes->parts[g->meshes->by_primitive[b->outside]];
    return part->closed && eye_in_mesh(part, eye);
}

void zbuffer_find_layers(zbuffer *z)
{
    const scene_geometry *g = z->frame_plan->geometry;
    bool clear = false;
    for (int r = 1; r <= g->region_count; r++)
        clear |= !g->regions[r].opaque;
    if (!clear || z->frame_plan->render.lighting != LIGHTING_WHITTED)
        return;
    for (int r = 1; r <= g->region_count; r++) {
        if (!is_layered(g, r))
            continue;
        const uint64_t bit = (uint64_t)1 << (r - 1);
        z->layered |= bit;
        /* Opaque solids are left out: a camera inside one sees its surface, whether the solid is a layer or not. */
        if (!g->regions[r].opaque && eye_in(g, &g->regions[r], z->frame_plan->view.eye))
            z->eye_inside |= bit;
        const bool is_open = g->meshes && g->meshes->open_surfaces >> g->regions[r].outside & 1;
        z->open_surfaces |= is_open ? bit : 0;
    }
    z->eye_index = z->frame_plan->ior[z->eye_inside ? 64 - __builtin_clzll(z->eye_inside) : 0];
}

/* --- triangles --- */

static instanced_mesh part_of(const primitive *p, const mesh *triangles, vec3 scale)
{
    return (instanced_mesh){.triangles = triangles,
                            .primitive = (int)(p->first_face / FACES_MAX),
                            .priority_index = p->priority_index,
                            .turned = p->turned,
                            .scaled = scale.x != 1.0 || scale.y != 1.0 || scale.z != 1.0,
                            .rotation = p->rotation,
                            .scale = scale,
                            .origin = p->origin,
                            .copies = {1, 1, 1}};
}

/* The triangles of a primitive: new ones, or the triangles of another solid that differs only in scale. */
static status cut(const zbuffer *z, const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    const scene_geometry *g = z->frame_plan->geometry;
    const shape_rule *rule = shape_of(shape);
    for (int k = 0; rule->one_tessellation && k < z->part_count; k++) {
        const int other = g->primitives[z->parts[k].primitive].priority_index;
        if (shape_of(&g->shapes[g->origins[other].source]) == rule) {
            *out = z->parts[k].tessellation;
            mesh_retain(*out);
            return STATUS_OK;
        }
    }
    return rule->tessellation(shape, part, out, why);
}

static double nearest_depth(const primitive *p, vec3 eye)
{
    const double nearest = 0x1p-30 * (p->extent + fabs(eye.x) + fabs(eye.y) + fabs(eye.z));
    return nearest > 0.0 ? nearest : 0x1p-30;
}

static status add(zbuffer *z, const region *b, int index, diagnostic *why)
{
    const scene_geometry *g = z->frame_plan->geometry;
    const primitive *p = &g->primitives[index];
    rasterised_part *part = &z->parts[z->part_count];
    const solid_shape placed = scene_geometry_shape(g, p->priority_index), *shape = &placed;
    const shape_rule *rule = shape_of(shape);
    *part = (rasterised_part){
        .primitive = index, .hollow = index == b->hollow, .nearest = nearest_depth(p, z->frame_plan->view.eye)};
    if (rule->triangles) {
        part->at = g->meshes->parts[g->meshes->by_primitive[index]];
        z->part_count++;
        return STATUS_OK;
    }
    part->plane = rule->unbounded;
    const status code = rule->tessellation ? cut(z, shape, part->hollow, &part->tessellation, why) : STATUS_OK;
    part->at = part_of(p, part->tessellation, shape_tessellation_scale(shape));
    z->part_count += code == STATUS_OK;
    return code;
}

/* Adds the regions of a set; bit k is the region with priority index k + 1. */
static status add_regions(zbuffer *z, uint64_t priority_indices, diagnostic *why)
{
    const scene_geometry *g = z->frame_plan->geometry;
    status code = STATUS_OK;
    for (int priority_index = g->region_count; priority_index >= 1 && code == STATUS_OK; priority_index--) {
        const region *b = &g->regions[priority_index];
        if (!(priority_indices >> (priority_index - 1) & 1))
            continue;
        code = add(z, b, b->outside, why);
        if (code == STATUS_OK && b->hollow >= 0)
            code = add(z, b, b->hollow, why);
    }
    return code;
}

status zbuffer_cut(zbuffer *z, diagnostic *why)
{
    status code = add_regions(z, ~z->layered, why);
    z->first_layered_part = z->part_count;
    THEN(code, add_regions(z, z->layered, why));
    return code;
}
