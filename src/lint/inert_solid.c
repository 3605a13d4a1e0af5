/* Parameters of a solid without effect. */
#include "lint/inert_private.h"
#include "geometry/shapes/shape.h"
#include "geometry/shared_faces.h"
#include "scene/model/cover.h"
#include "scene/model/scene.h"

#include <string.h>

static bool is_opaque_pair(const solid *a, const solid *b)
{
    return a->surface.transparency == 0.0 && b->surface.transparency == 0.0;
}

/* The intersection of two opaque solids is invisible: from outside only their union matters, and each point of its
 * surface has one owner, unless faces coincide. A camera inside would see it. */
static bool meets_unseen(const scene *s, const solid *a, const solid *b)
{
    const solid_shape of_a = scene_loaded_shape(s, a), of_b = scene_loaded_shape(s, b);
    return scene_apart_from_eye(s, a) && scene_apart_from_eye(s, b) && !solid_shapes_may_share_faces(&of_a, &of_b);
}

static bool priority_rule(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one == c->owner || !one->visible || scene_apart(s, c->owner, one))
            continue;
        if (!is_opaque_pair(c->owner, one) || !meets_unseen(s, c->owner, one))
            return false;
        hidden = one;
    }
    if (hidden)
        return inert_say(c, "both-opaque",
                         inert_set("%s.transparency=0.9 and %s.ior=1.3", hidden->name, hidden->name).text,
                         "%s overlaps %s, but both are opaque: the overlap is invisible", c->name, hidden->name);
    return inert_say(c, "apart", "move it into another solid", "no other visible solid overlaps %s", c->name);
}

/* Its surface is rotationally symmetric and uniform. */
static bool is_plain(const scene *s, const material *m)
{
    const bool checkered = m->checker > 0.0 && memcmp(&m->color, &m->checker_color, sizeof m->color) != 0;
    return !shows_color(s, m) || !(checkered || m->texture[0]);
}

static bool rotation_rule(const inert_case *c)
{
    /* The depth buffer rasterises a sphere as triangles, which rotate with it. */
    if (!shape_of(&c->owner->shape)->isotropic || !is_plain(c->s, c->m) || integrator_traits_of(&c->s->render)->drawn)
        return false;
    const inert_remedy color = color_remedy(c->s, c->m, c->name);
    const inert_remedy remedy = shows_color(c->s, c->m)
                                    ? inert_set("%s.checker=0.2 and %s.checker_color=0.3,0.5,0.7", c->name, c->name)
                                    : inert_set("%s.checker=0.2 and %s", c->name, color.text + strlen("set "));
    return inert_say(c, "round", remedy.text, "a %s without checker or texture looks the same after this rotation",
                     shape_of(&c->owner->shape)->word);
}

static bool spacing_rule(const inert_case *c)
{
    const vec3 n = c->owner->shape.copies;
    return n.x == 1.0 && n.y == 1.0 && n.z == 1.0 &&
           inert_say(c, "one-copy", inert_set("%s.copies=2,1,1", c->name).text, "the mesh has a single copy");
}

static bool mesh_shading(const inert_case *c)
{
    const scene *s = c->s;
    const bool textured = c->m->texture[0] && shows_color(s, c->m); /* the texture footprint depends on the normal */
    if (textured || is_lit_by_lamps(s, c->m) || may_have_face_materials(s, c->owner) ||
        (follows_rays(s) && sends_rays_on(s, c->owner)))
        return false;
    if (integrator_traits_of(&s->render)->layers)
        return s->render.layer != LAYER_NORMAL &&
               inert_say(c, "no-normals", "set render.layer=normal", "the shown layer has no normals");
    const inert_remedy remedy = shining_lights(s) > 0 ? inert_set("%s.diffuse=0.7", c->name) : lamp_remedy(s);
    return inert_say(c, "unshaded", remedy.text, "it is not lit by lights and has no secondary rays");
}

static bool conic_rule(const inert_case *c)
{
    const solid_shape *shape = &c->owner->shape;
    const bool first = strcmp(c->at.row->name, "conic_1") == 0;
    return (first ? shape->radius_1 : shape->radius_2) == 0.0 &&
           inert_say(c, "flat-side", inert_set("%s.radius_%d=%s", c->name, first ? 1 : 2, first ? "2" : "-2").text,
                     "side %d of the lens is flat", first ? 1 : 2);
}

/* Of the contact angle and radius of a cylinder. */
static bool meniscus_rule(const inert_case *c)
{
    return c->owner->shape.capillary_length == 0.0 &&
           inert_say(c, "no-meniscus", inert_set("%s.capillary_length=0.1", c->name).text,
                     "the cylinder has no meniscus");
}

/* Of the capillary length and the contact radius. */
static bool level_rule(const inert_case *c)
{
    return c->owner->shape.contact_angle_deg == 90.0 &&
           inert_say(c, "level", inert_set("%s.contact_angle_deg=20", c->name).text,
                     "a liquid with a contact angle of 90 degrees is level");
}

static bool contact_radius_rule(const inert_case *c)
{
    return meniscus_rule(c) || level_rule(c);
}

static bool mesh_name(const inert_case *c)
{
    return c->s->mesh_count == 1 && inert_say(c, "one-mesh", "add another under meshes:", "the scene has one mesh");
}

bool inert_solid(const inert_case *c)
{
    static const inert_row rows[] = {
        {"priority", priority_rule},
        {"rotation", rotation_rule},
        {"spacing", spacing_rule},
        {"shading", mesh_shading},
        {"mesh", mesh_name},
        {"conic_1", conic_rule},
        {"conic_2", conic_rule},
        {"contact_angle_deg", meniscus_rule},
        {"capillary_length", level_rule},
        {"contact_radius", contact_radius_rule},
        {NULL, NULL},
    };
    inert_case own = *c;
    own.owner = &c->s->solids[c->at.index], own.m = &own.owner->surface;
    if (!own.owner->visible)
        return strcmp(c->at.row->name, "visible") != 0 &&
               inert_say(c, "invisible", inert_set("%s.visible=on", c->name).text, "the solid is not visible");
    return c->at.row->group == PARAM_MATERIAL ? inert_surface(&own) : inert_by_name(rows, &own);
}
