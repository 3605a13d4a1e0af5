/* Whether a parameter has an effect: asks the table (needs.c), for a material on every solid that has it and on every
 * face with a material from a mesh file (see shading_material_of_face); then compares images of first hits. */
#include "lint/inert.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- surfaces --- */

/* Whether the parameter belongs to the surface of a transparent solid, but to each face of an opaque one. */
static bool is_of_mirror(const inert_case *c)
{
    return is_named(c, "reflectivity") || is_named(c, "roughness");
}

/* Whether the parameter describes the interior of a solid. */
static bool is_of_region(const inert_case *c)
{
    static const char *const interior[] = {"extraordinary_ior",
                                           "optic_axis",
                                           "ior",
                                           "medium",
                                           "coefficients",
                                           "medium_data",
                                           "absorb_per_m",
                                           "absorb_spectrum",
                                           "absorb_data",
                                           "scatter_per_m",
                                           "scatter_data",
                                           "asymmetry",
                                           "tint_distance",
                                           "extinction",
                                           "film_thickness_nm",
                                           "film_ior",
                                           "coating",
                                           "coating_data",
                                           "sheet",
                                           "sheet_axis",
                                           "sheet_pass",
                                           "sheet_block",
                                           "retardance_deg",
                                           "birefringence",
                                           NULL};
    return is_among(c, interior);
}

static bool is_straight(const inert_case *c)
{
    return c->s->render.transmission == TRANSMISSION_SIMPLE;
}

/* Whether the solid's own surface determines the parameter on faces whose other properties come from a material of the
 * scene (`named`) or of the mesh file (`given`). */
static bool is_from_solid(const inert_case *c, const material *named, const face_material *given)
{
    static const char *const never_given[] = {"ambient", "reflectivity", "roughness", "checker", "checker_color", NULL};
    const bool clear = !material_is_opaque(&c->owner->surface);
    if (!named && !given)
        return true;
    if (is_named(c, "transparency"))
        return !is_straight(c) || (!named && given->opacity == 1.0);
    if (named)
        return is_of_mirror(c) && !is_straight(c) && clear;
    return is_among(c, never_given) || (is_named(c, "emission") && given->emission == 0.0) ||
           (is_named(c, "color") && clear);
}

/* Applies the rules of a uniform surface to the faces of one slot. */
static bool inert_on_slot(const inert_case *c, int slot)
{
    const shading_material mat = shading_material_of_face(c->s, c->owner, &c->owner->surface, slot);
    inert_case face = *c;
    face.m = &mat.surface;
    return needs_ask(&face, PARAM_MATERIAL);
}

static bool say_by_face(const inert_case *c)
{
    return inert_say(c, "by-face",
                     "assign a material to the solid, or give a material of the scene the name of the faces' "
                     "material",
                     "the materials of the faces of %s come from the mesh file", c->owner->name);
}

/* Before the mesh is loaded, its faces are unknown: false. */
static bool inert_faces(const inert_case *c)
{
    if (!has_face_materials(c->s, c->owner))
        return false;
    if (is_of_region(c)) { /* the solid is transparent if any face is */
        material clear = *c->m;
        clear.transparency = 1.0;
        inert_case of_region = *c;
        of_region.m = !solid_is_opaque(c->s, c->owner) && !is_named(c, "tint_distance") ? &clear : c->m;
        return needs_ask(&of_region, PARAM_MATERIAL);
    }
    bool some = false;
    for (int slot = 0; slot < face_material_slots(c->s, c->owner); slot++) {
        const material *named;
        const face_material *given;
        face_material_source(c->s, c->owner, slot, &named, &given);
        if (!is_from_solid(c, named, given))
            continue;
        some = true;
        if (!inert_on_slot(c, slot))
            return false;
    }
    return some || say_by_face(c);
}

/* Whether the parameter of a material of the scene applies to faces whose material has the same name. */
static bool applies_to_named_faces(const inert_case *c)
{
    if (is_of_region(c))
        return false;
    if (is_named(c, "transparency"))
        return is_straight(c);
    return !is_of_mirror(c) || is_straight(c) || material_is_opaque(&c->owner->surface);
}

static bool say_of_solid(const inert_case *c)
{
    const inert_remedy remedy = inert_set("%s.%s", c->owner->name, c->at.row->name);
    return inert_say(c, "of-solid", remedy.text, "the face uses the value of its solid, %s", c->owner->name);
}

static bool inert_named_faces(const inert_case *c)
{
    if (!has_face_materials(c->s, c->owner))
        return false;
    for (int slot = 0; slot < face_material_slots(c->s, c->owner); slot++) {
        const material *named;
        const face_material *given;
        face_material_source(c->s, c->owner, slot, &named, &given);
        if (named != &c->s->materials[c->at.index].value)
            continue;
        if (applies_to_named_faces(c) ? !inert_on_slot(c, slot) : !say_of_solid(c))
            return false;
    }
    return true; /* if no face has the name, there is no note, and inert_material ignores this result */
}

static bool inert_surface(const inert_case *c)
{
    return may_have_face_materials(c->s, c->owner) ? inert_faces(c) : needs_ask(c, PARAM_MATERIAL);
}

static bool unused(const inert_case *c, const solid *hidden)
{
    const inert_remedy remedy =
        hidden ? inert_set("%s.visible=on", hidden->name) : (inert_remedy){"assign it to a visible solid"};
    return inert_say(c, "unused-material", remedy.text, "no visible solid has this material");
}

/* Asks about each visible solid with the material, and each face with its name; reports the first note. */
static bool inert_material(const inert_case *c)
{
    const scene *s = c->s;
    const solid *hidden = NULL;
    inert_answer first = {.rule = ""}, other;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        for (int slot = 1; one->visible && solid_has_ends(one) && slot < END_SLOTS; slot++)
            if (solid_end_material(s, one, slot) == &s->materials[c->at.index].value)
                return false; /* not examined */
        const bool by_face = may_have_face_materials(s, one);
        if (one->material_index != (int)c->at.index && !by_face)
            continue;
        hidden = one->visible || by_face ? hidden : one;
        inert_case user = *c;
        user.owner = one, user.m = &one->surface, user.out = first.rule[0] ? &other : &first;
        if (one->visible && !(by_face ? inert_named_faces(&user) : needs_ask(&user, PARAM_MATERIAL)))
            return false;
    }
    if (!first.rule[0])
        return unused(c, hidden);
    *c->out = first;
    return true;
}

/* --- what the first hits show --- */

/* Whether the film is unchanged if the parameter is scaled by this factor. */
static bool unchanged_scaled(const inert_case *c, const char *path, double factor)
{
    char *now = NULL;
    if (scene_get(c->s, path, &now, NULL) != STATUS_OK)
        return false;
    double value = strtod(now, NULL);
    free(now);
    if (value == 0.0 && c->at.row->group == PARAM_SOLID) /* a contact_radius of 0 is the solid's radius */
        value = c->s->solids[c->at.index].shape.radius;
    return inert_unchanged(c, "%s=%.6g", path, value * factor);
}

/* In an image of a layer, some parameters matter only if they create, remove or move a first hit: the witness tries
 * other values. */
static bool is_unmet_by_camera(const inert_case *c, const char *path)
{
    static const struct {
        const char *name, *values[3];
    } rows[] = {
        {"emission", {"0", "1", NULL}},
        {"transparency", {"0", "0.5", "1"}},
        {"ior", {"1.1", "1.9", NULL}},
        {"film_thickness_nm", {"0", "300", NULL}},
        {"coating", {"none", "ar-550", NULL}},
        {"medium", {"water", "diamond", "bk7"}},
        {"priority", {"-1000", "0", "1000"}},
        {"visible", {"on", "off", NULL}},
        {"color", {"0,0,0", "1,1,1", NULL}},
        {"capillary_length", {"0", "0.05", "0.2"}},
        {"contact_angle_deg", {"20", "90", "150"}},
        {"contact_radius", {"0", NULL}}, /* 0: the radius of the solid, the largest value */
        {"inner_radius", {NULL}},
        {"floor", {NULL}},
    };
    if (!is_unlit(c->s) || !c->witness->same)
        return false;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!is_named(c, rows[i].name))
            continue;
        const bool is_contact = strcmp(rows[i].name, "contact_radius") == 0;
        bool same = (rows[i].values[0] && !is_contact) ||
                    (unchanged_scaled(c, path, 0.5) && unchanged_scaled(c, path, is_contact ? 0.9 : 1.05));
        for (size_t k = 0; k < 3 && rows[i].values[k] && same; k++)
            same = inert_unchanged(c, "%s=%s", path, rows[i].values[k]);
        return same &&
               inert_say(c, "met-first", "set render.integrator=whitted", "the first hits of this image do not change");
    }
    return false;
}

/* --- the question --- */

static bool ask_solid(const inert_case *c)
{
    inert_case of_solid = *c;
    of_solid.owner = &c->s->solids[c->at.index], of_solid.m = &of_solid.owner->surface;
    return needs_ask(&of_solid, PARAM_SOLID) || (c->at.row->group == PARAM_MATERIAL && inert_surface(&of_solid));
}

static bool ask_group(const inert_case *c)
{
    if (c->at.object_group == PARAM_MATERIAL)
        return inert_material(c);
    return c->at.object_group == PARAM_SOLID ? ask_solid(c) : needs_ask(c, c->at.object_group);
}

bool param_is_inert(const scene *s, const char *path, const inert_witness *witness, inert_answer *out)
{
    static const inert_witness no_witness = {.frame = NULL};
    inert_case c = {.s = s, .witness = witness ? witness : &no_witness, .out = out};
    c.frame = c.witness->frame && c.witness->frame->camera > 0 ? c.witness->frame : NULL;
    *out = (inert_answer){.rule = ""};
    if (param_place_find(s, path, &c.at, NULL) != STATUS_OK || !scene_film_depends_on(s, path))
        return false;
    c.name = param_place_group_name(s, c.at.object_group, c.at.index);
    if (!needs_light(&c) && !ask_group(&c) && !is_unmet_by_camera(&c, path))
        return false;
    snprintf(out->note.place, sizeof out->note.place, "%s", path);
    return true;
}
