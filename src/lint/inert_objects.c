/* Facts of solids, meshes and textures that leave their parameters without effect. */
#include "geometry/shapes/shape.h"
#include "lint/inert_facts.h"
#include "scene/model/cover.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>
#include <strings.h>

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

bool overlaps_unseen(const inert_case *c)
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

bool looks_the_same(const inert_case *c)
{
    /* The depth buffer rasterises a sphere as triangles, which rotate with it. */
    if (!shape_of(&c->owner->shape)->isotropic || !is_plain(c->s, c->m) || is_drawn(c->s))
        return false;
    const inert_remedy color = color_remedy(c->s, c->m, c->name);
    const inert_remedy remedy = shows_color(c->s, c->m)
                                    ? inert_set("%s.checker=0.2 and %s.checker_color=0.3,0.5,0.7", c->name, c->name)
                                    : inert_set("%s.checker=0.2 and %s", c->name, color.text + strlen("set "));
    return inert_say(c, "round", remedy.text, "a %s without checker or texture looks the same after this rotation",
                     shape_of(&c->owner->shape)->word);
}

bool unshaded(const inert_case *c)
{
    const scene *s = c->s;
    const bool textured = c->m->texture[0] && shows_color(s, c->m); /* the texture footprint depends on the normal */
    if (textured || is_lit_by_lamps(s, c->m) || may_have_face_materials(s, c->owner) ||
        (follows_rays(s) && sends_rays_on(s, c->owner)))
        return false;
    if (has_layers(s))
        return s->render.layer != LAYER_NORMAL &&
               inert_say(c, "no-normals", "set render.layer=normal", "the shown layer has no normals");
    const inert_remedy remedy = shining_lights(s) > 0 ? inert_set("%s.diffuse=0.7", c->name) : lamp_remedy(s);
    return inert_say(c, "unshaded", remedy.text, "it is not lit by lights and has no secondary rays");
}

bool one_mesh(const inert_case *c)
{
    return c->s->mesh_count == 1 && inert_say(c, "one-mesh", "add another under meshes:", "the scene has one mesh");
}

/* --- meshes and textures --- */

/* Whether a visible solid uses it. If not, a solid that could: a hidden one that does, or a visible mesh. */
bool unused_mesh(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL, *other = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const bool shows = solid_shows(one, c->name);
        if (shows && one->visible)
            return false;
        hidden = shows ? one : hidden;
        other = !shows && one->visible && shape_of(&one->shape)->triangles ? one : other;
    }
    const inert_remedy remedy = hidden  ? inert_set("%s.visible=on", hidden->name)
                                : other ? inert_set("%s.mesh=%s", other->name, c->name)
                                        : (inert_remedy){"add a solid with it"};
    return inert_say(c, "unused-mesh", remedy.text, "no visible solid uses this mesh");
}

/* The motion parameters of a slime have no effect at time 0. */
bool at_rest(const inert_case *c)
{
    static const char *const always[] = {"time_s", "radius", "position", NULL};
    const mesh_entry *m = &c->s->meshes[c->at.index];
    const double steps = is_named(c, "dt_s") ? m->time_s > 0.0 : rint(m->time_s / m->slime.dt_s);
    return c->at.row->makers != 0 && m->source == MESH_SLIME && !is_among(c, always) && steps < 1.0 &&
           inert_say(c, "time-0", inert_set("%s.time_s=0.5", c->name).text, "time_s is %g: the slime has not moved yet",
                     m->time_s);
}

static bool uses_texture(const scene *s, const solid *one, const char *name)
{
    return one->visible && (may_have_face_materials(s, one) ||
                            (strcmp(one->surface.texture, name) == 0 && shows_color(s, &one->surface)));
}

bool unused_texture(const inert_case *c)
{
    const scene *s = c->s;
    const solid *bare = NULL, *dull = NULL;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (uses_texture(s, one, c->name))
            return false;
        const bool has = one->visible && strcmp(one->surface.texture, c->name) == 0;
        dull = has ? one : dull;
        bare = !has && one->visible ? one : bare;
    }
    if (dull)
        return inert_say(c, "unused-texture", color_remedy(s, &dull->surface, dull->name).text,
                         "no light reaches the surfaces that have it");
    const inert_remedy remedy = bare ? inert_set("%s.texture=%s", bare->name, c->name) : inert_set_on(NULL, "");
    return inert_say(c, "unused-texture", remedy.text, "no visible solid has this texture");
}

/* Float images are linear already: image/texture.c. */
bool of_floats(const inert_case *c)
{
    const char *path = c->s->textures[c->at.index].path, *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".pfm") == 0 &&
           inert_say(c, "float-texture", "use a PNG or JPEG file", "the values of a PFM file are linear");
}
