/* The rasterised parts: meshes as they are, analytic primitives as triangles on their surface. Shading uses the
 * primitive itself, so that the triangles show only in outlines. */
#include "render/zbuffer/zbuffer_private.h"

#include "geometry/shapes/shape.h"

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

/* The triangles of a primitive: its own, or those of another solid that differs only in scale. */
static status cut(const zbuffer *z, const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    const scene_geometry *a = z->frame_plan->geometry;
    const shape_rule *rule = shape_of(shape);
    for (int k = 0; rule->one_tessellation && k < z->part_count; k++) {
        if (shape_of(&a->shapes[a->primitives[z->parts[k].primitive].priority_index]) == rule) {
            *out = z->parts[k].own;
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
    const scene_geometry *a = z->frame_plan->geometry;
    const primitive *p = &a->primitives[index];
    rasterised_part *part = &z->parts[z->part_count];
    const solid_shape *shape = &a->shapes[p->priority_index];
    const shape_rule *rule = shape_of(shape);
    *part = (rasterised_part){
        .primitive = index, .hollow = index == b->hollow, .nearest = nearest_depth(p, z->frame_plan->view.eye)};
    if (rule->triangles) {
        part->at = a->meshes->parts[a->meshes->by_primitive[index]];
        z->part_count++;
        return STATUS_OK;
    }
    part->plane = rule->unbounded;
    const status code = rule->tessellation ? cut(z, shape, part->hollow, &part->own, why) : STATUS_OK;
    const vec3 scale = rule->tessellation_scale ? rule->tessellation_scale(shape) : vec3_make(1.0, 1.0, 1.0);
    part->at = part_of(p, part->own, scale);
    z->part_count += code == STATUS_OK;
    return code;
}

/* Adds the regions whose priority index's bit is set. */
static status add_regions(zbuffer *z, uint64_t priority_indices, diagnostic *why)
{
    const scene_geometry *a = z->frame_plan->geometry;
    status code = STATUS_OK;
    for (int priority_index = a->region_count; priority_index >= 1 && code == STATUS_OK; priority_index--) {
        const region *b = &a->regions[priority_index];
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
