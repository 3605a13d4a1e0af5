/* What is drawn: meshes as they are, analytic primitives as triangles on their surface. Light falls on the primitive
 * itself, so that the triangles show in outlines alone. */
#include "render/zbuffer/zbuffer_private.h"

#include "geometry/bodies.h"

/* A round edge stays within 8e-5 of its radius of the circle (1 - cos(180 deg / 256)), a sphere's outline within 2e-4
 * (20 4^5 triangles). */
enum { AROUND = 256, SPHERE_LEVEL = 5 };

static forest_part part_of(const primitive *p, const mesh *triangles, vec3 scale)
{
    return (forest_part){.triangles = triangles,
                         .primitive = (int)(p->first_face / FACES_MAX),
                         .rank = p->rank,
                         .turned = p->turned,
                         .scaled = scale.x != 1.0 || scale.y != 1.0 || scale.z != 1.0,
                         .rotation = p->rotation,
                         .scale = scale,
                         .origin = p->origin,
                         .copies = {1, 1, 1}};
}

/* A cylinder from its base to its top, or a cup's outside, whose top is a ring. */
static status cut_cylinder(const primitive *p, double inner_radius, mesh **out, diagnostic *why)
{
    const profile_point profile[4] = {
        {0.0, p->bottom}, {p->radius, p->bottom}, {p->radius, p->top}, {inner_radius, p->top}};
    return body_lathe(profile, 4, AROUND, 30.0, out, why);
}

/* The wall and the floor of a cup's hollow. */
static status cut_hollow(const primitive *p, double top, mesh **out, diagnostic *why)
{
    const profile_point profile[3] = {{0.0, p->bottom}, {p->radius, p->bottom}, {p->radius, top}};
    return body_lathe(profile, 3, AROUND, 30.0, out, why);
}

static status cut_sphere(const zbuffer *z, mesh **out, diagnostic *why)
{
    const primitive *all = z->scene->solids->primitives;
    for (int k = 0; k < z->part_count; k++) {
        if (all[z->parts[k].met].kind == PRIMITIVE_SPHERE) {
            *out = z->parts[k].own;
            mesh_retain(*out);
            return STATUS_OK;
        }
    }
    return body_icosphere(SPHERE_LEVEL, out, why);
}

static double nearest_depth(const primitive *p, vec3 eye)
{
    const double nearest = 0x1p-30 * (p->extent + fabs(eye.x) + fabs(eye.y) + fabs(eye.z));
    return nearest > 0.0 ? nearest : 0x1p-30;
}

static status add(zbuffer *z, const body *b, int met, diagnostic *why)
{
    const arrangement *a = z->scene->solids;
    const primitive *p = &a->primitives[met];
    drawn_part *part = &z->parts[z->part_count];
    vec3 scale = vec3_make(1.0, 1.0, 1.0);
    *part = (drawn_part){.met = met, .hollow = met == b->hollow, .nearest = nearest_depth(p, z->scene->view.eye)};
    status code = STATUS_OK;
    switch (p->kind) {
    case PRIMITIVE_HALFSPACE: part->plane = true; break;
    case PRIMITIVE_BOX: code = body_box(vec3_scale(p->half, 2.0), &part->own, why); break;
    case PRIMITIVE_SPHERE:
        scale = vec3_make(p->radius, p->radius, p->radius);
        code = cut_sphere(z, &part->own, why);
        break;
    case PRIMITIVE_CYLINDER:
        scale.z = 1.0 / sqrt(p->m2);
        if (met == b->hollow)
            code = cut_hollow(p, a->primitives[b->outside].top, &part->own, why);
        else
            code = cut_cylinder(p, b->hollow < 0 ? 0.0 : a->primitives[b->hollow].radius, &part->own, why);
        break;
    case PRIMITIVE_MESH:
        part->at = a->meshes->parts[a->meshes->by_primitive[met]];
        z->part_count++;
        return STATUS_OK;
    }
    part->at = part_of(p, part->own, scale);
    z->part_count += code == STATUS_OK;
    return code;
}

/* Those whose rank's bit is set. */
static status add_bodies(zbuffer *z, uint64_t ranks, diagnostic *why)
{
    const arrangement *a = z->scene->solids;
    status code = STATUS_OK;
    for (int rank = a->body_count; rank >= 1 && code == STATUS_OK; rank--) {
        const body *b = &a->bodies[rank];
        if (!(ranks >> (rank - 1) & 1))
            continue;
        code = add(z, b, b->outside, why);
        if (code == STATUS_OK && b->hollow >= 0)
            code = add(z, b, b->hollow, why);
    }
    return code;
}

status zbuffer_cut(zbuffer *z, diagnostic *why)
{
    status code = add_bodies(z, ~z->layered, why);
    z->first_layered_part = z->part_count;
    if (code == STATUS_OK)
        code = add_bodies(z, z->layered, why);
    return code;
}
