/* Surface parameters without effect on faces with materials from a mesh file: see shading_material_of_face. */
#include "lint/inert_private.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <string.h>

static bool is_row(const inert_case *c, const char *name)
{
    return strcmp(c->at.row->name, name) == 0;
}

/* Of the surface of a transparent solid, and of each face of an opaque one. */
static bool is_of_mirror(const inert_case *c)
{
    return is_row(c, "reflectivity") || is_row(c, "roughness");
}

/* Parameters of the interior. */
static bool is_of_region(const inert_case *c)
{
    static const char *const of_body[] = {"extraordinary_ior",
                                          "optic_axis",
                                          "ior",
                                          "medium",
                                          "coefficients",
                                          "absorb_per_m",
                                          "absorb_spectrum",
                                          "scatter_per_m",
                                          "asymmetry",
                                          "tint_distance",
                                          "extinction",
                                          "film_thickness_nm",
                                          "film_ior",
                                          "sheet",
                                          "sheet_axis",
                                          "sheet_pass",
                                          "sheet_block",
                                          "retardance_deg",
                                          "birefringence",
                                          NULL};
    return is_among(c, of_body);
}

static bool is_straight(const inert_case *c)
{
    return c->s->render.transmission == TRANSMISSION_SIMPLE;
}

/* Whether the solid's own surface determines it on faces whose other properties come from a material of the scene or
 * the file. */
static bool is_own(const inert_case *c, const material *named, const face_material *given)
{
    static const char *const never_given[] = {"ambient", "reflectivity", "roughness", "checker", "checker_color", NULL};
    const bool clear = !material_is_opaque(&c->owner->surface);
    if (!named && !given)
        return true;
    if (is_row(c, "transparency"))
        return !is_straight(c) || (!named && given->opacity == 1.0);
    if (named)
        return is_of_mirror(c) && !is_straight(c) && clear;
    return is_among(c, never_given) || (is_row(c, "emission") && given->emission == 0.0) ||
           (is_row(c, "color") && clear);
}

/* The rules of a uniform surface, applied to one kind of face. */
static bool inert_on_slot(const inert_case *c, int slot)
{
    const shading_material mat = shading_material_of_face(c->s, c->owner, &c->owner->surface, slot);
    inert_case face = *c;
    face.m = &mat.surface;
    return inert_appearance(&face);
}

static bool say_by_face(const inert_case *c)
{
    return inert_say(c, "by-face",
                     "assign a material to the solid, or give a material of the scene the name of the faces' "
                     "material",
                     "the materials of the faces of %s come from the mesh file", c->owner->name);
}

/* Unknown until the mesh is loaded. */
bool inert_faces(const inert_case *c)
{
    if (!has_face_materials(c->s, c->owner))
        return false;
    if (is_of_region(c)) { /* transparent if any face is */
        material clear = *c->m;
        clear.transparency = 1.0;
        inert_case region = *c;
        region.m = !solid_is_opaque(c->s, c->owner) && !is_row(c, "tint_distance") ? &clear : c->m;
        return inert_appearance(&region);
    }
    bool some = false;
    for (int slot = 0; slot < face_material_slots(c->s, c->owner); slot++) {
        const material *named;
        const face_material *given;
        face_material_source(c->s, c->owner, slot, &named, &given);
        if (!is_own(c, named, given))
            continue;
        some = true;
        if (!inert_on_slot(c, slot))
            return false;
    }
    return some || say_by_face(c);
}

/* For the scene's material of c: whether it applies to a face with its name. */
static bool is_named_ones(const inert_case *c)
{
    if (is_of_region(c))
        return false;
    if (is_row(c, "transparency"))
        return is_straight(c);
    return !is_of_mirror(c) || is_straight(c) || material_is_opaque(&c->owner->surface);
}

static bool say_of_solid(const inert_case *c)
{
    const inert_remedy remedy = inert_set("%s.%s", c->owner->name, c->at.row->name);
    return inert_say(c, "of-solid", remedy.text, "the face uses the value of its solid, %s", c->owner->name);
}

bool inert_named_faces(const inert_case *c)
{
    if (!has_face_materials(c->s, c->owner))
        return false;
    for (int slot = 0; slot < face_material_slots(c->s, c->owner); slot++) {
        const material *named;
        const face_material *given;
        face_material_source(c->s, c->owner, slot, &named, &given);
        if (named != &c->s->materials[c->at.index].value)
            continue;
        if (is_named_ones(c) ? !inert_on_slot(c, slot) : !say_of_solid(c))
            return false;
    }
    return true; /* no result if no face has that name */
}
