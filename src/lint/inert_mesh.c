/* Parameters of meshes and textures without effect. */
#include "lint/inert_private.h"
#include "geometry/shapes/shape.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* The generators that use a parameter, and one of them as a remedy. Rows for slimes only (param.makers) belong to no
 * other. */
typedef struct maker_row {
    const char *name;
    unsigned makers;
    const char *remedy;
} maker_row;
#define MAKES(maker) (1u << (maker))
static const maker_row maker_rows[] = {
    {"count", MAKES(MESH_SPARSE) | MAKES(MESH_DENSE) | MAKES(MESH_SPHERE), "sparse"},
    {"level", MAKES(MESH_ICOSPHERE) | MAKES(MESH_SLIME), "icosphere"},
    {"major", MAKES(MESH_TORUS), "torus"},
    {"minor", MAKES(MESH_TORUS), "torus"},
    {"around", MAKES(MESH_TORUS) | MAKES(MESH_LATHE) | MAKES(MESH_TERRAIN), "torus"},
    {"tube", MAKES(MESH_TORUS) | MAKES(MESH_TERRAIN), "torus"},
    {"profile", MAKES(MESH_LATHE), "lathe"},
    {"crease_deg", MAKES(MESH_LATHE), "lathe"},
    {"size", MAKES(MESH_BOX) | MAKES(MESH_TERRAIN), "box"},
    {"depth", MAKES(MESH_TERRAIN), "terrain"},
    {"seed", MAKES(MESH_TERRAIN), "terrain"},
};

static const char *maker_word(int64_t maker)
{
    return param_find(PARAM_MESH, "generate")->choices[maker];
}

static bool other_maker(const inert_case *c, const mesh_entry *m)
{
    for (size_t i = 0; i < sizeof maker_rows / sizeof *maker_rows; i++) {
        const maker_row *r = &maker_rows[i];
        if (strcmp(r->name, c->at.row->name) == 0 && !(r->makers & MAKES(m->source)))
            return inert_say(c, "other-body", inert_set("%s.generate=%s", c->name, r->remedy).text, "%s %s has no %s",
                             m->source == MESH_FILE ? "a mesh of a" : "generate:", maker_word(m->source), r->name);
    }
    return false;
}

/* Whether a visible solid uses it. If not, a solid that could: a hidden one that does, or a visible mesh. */
static bool unused_mesh(const inert_case *c)
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
static bool at_rest(const inert_case *c, const mesh_entry *m)
{
    static const char *const always[] = {"time_s", "radius", "position", "dt_s", NULL};
    return !is_among(c, always) && rint(m->time_s / m->slime.dt_s) < 1.0 &&
           inert_say(c, "time-0", inert_set("%s.time_s=0.5", c->name).text, "time_s is %g: the slime has not moved yet",
                     m->time_s);
}

static bool no_floor(const inert_case *c, const mesh_entry *m)
{
    static const char *const of_floor[] = {"ground_y", "restitution", "friction", NULL};
    return !m->slime.ground && is_among(c, of_floor) &&
           inert_say(c, "no-floor", inert_set("%s.ground=on", c->name).text, "the slime has no floor");
}

bool inert_mesh(const inert_case *c)
{
    const mesh_entry *m = &c->s->meshes[c->at.index];
    if (unused_mesh(c) || other_maker(c, m))
        return true;
    const bool of_slimes = c->at.row->makers != 0 && m->source == MESH_SLIME;
    return of_slimes && ((strcmp(c->at.row->name, "dt_s") == 0 && m->time_s == 0.0 &&
                          inert_say(c, "time-0", inert_set("%s.time_s=0.5", c->name).text,
                                    "time_s is 0: the slime has not moved yet")) ||
                         at_rest(c, m) || no_floor(c, m));
}

static bool uses_texture(const scene *s, const solid *one, const char *name)
{
    return one->visible && (may_have_face_materials(s, one) ||
                            (strcmp(one->surface.texture, name) == 0 && shows_color(s, &one->surface)));
}

static bool unused_texture(const inert_case *c)
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
static bool of_floats(const inert_case *c)
{
    const char *path = c->s->textures[c->at.index].path, *dot = strrchr(path, '.');
    return strcmp(c->at.row->name, "space") == 0 && dot && strcasecmp(dot, ".pfm") == 0 &&
           inert_say(c, "float-texture", "use a PNG or JPEG file", "the values of a PFM file are linear");
}

bool inert_texture(const inert_case *c)
{
    return unused_texture(c) || of_floats(c);
}
