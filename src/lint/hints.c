/* Hints: what a valid scene seems to lack, and settings that have no effect, found without rendering. */
#include "lint/lint.h"
#include "scene/model/camera.h"
#include "scene/model/cover.h"
#include "scene/model/face_materials.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <string.h>

static bool is_lit(const material *m)
{
    return m->diffuse > 0.0 || m->specular > 0.0;
}

/* Whether the solid is a bubble: its centre or base is inside another medium. */
static bool is_inside_medium(const scene *s, const solid *bubble)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (other != bubble && other->visible && !other->points[0] && other->surface.transparency > 0.0 &&
            !material_matches_surroundings(s, &other->surface) &&
            solid_shape_contains(&other->shape, bubble->shape.position))
            return true;
    }
    return false;
}

/* Whether the solid displaces a visible one, and so appears as a cavity even with the index of the surroundings. */
static bool cuts_another(const scene *s, const solid *cutter)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        const bool seen = other->surface.transparency == 0.0 || !material_matches_surroundings(s, &other->surface);
        if (other->visible && seen && scene_has_precedence(cutter, other) && !scene_disjoint(s, cutter, other))
            return true;
    }
    return false;
}

/* Notes properties that a transparent solid seems to lack. */
static void hint_at_clear(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    if (integrator_traits_of(&s->render)->drawn && s->render.lighting != LIGHTING_WHITTED) {
        if (m->ambient == 0.0 && m->diffuse == 0.0 && m->emission == 0.0)
            note_report(taker, "render", "lighting", "set render.lighting to whitted",
                        "%s is transparent: without reflected and refracted rays its surface is black except for "
                        "highlights",
                        owner->name);
    } else if (!scene_has_constant_weights(&s->render) && material_matches_surroundings(s, m) && !material_tints(m) &&
               m->reflectivity == 0.0 && m->emission == 0.0 && !material_is_layered(m, &s->render) &&
               m->sheet == SHEET_NONE && m->extraordinary_ior == 0.0 && !material_scatters(m, &s->render) &&
               !is_inside_medium(s, owner) && !cuts_another(s, owner)) {
        note_report(taker, owner->name, "ior", "set its ior",
                    "%s is transparent with the refractive index of the surrounding medium: it %s", owner->name,
                    material_absorbs(m) ? "refracts no light" : "is invisible");
    }
}

/* No material is transparent with a higher index for visible light; even germanium and silicon have only 4 to 5. */
#define INDEX_MOST 5.0

/* Notes a refractive index that seems meant to make a mirror, on a solid with reflectivity 0. No note above MIRROR_IOR,
 * where a transparent solid really is a mirror. True if there is a note. */
static bool hint_at_index(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    index_law law;
    if (m->reflectivity > 0.0 || material_is_mirror(m) || material_is_layered(m, &s->render) ||
        material_index_law(m, "", &law, NULL) != STATUS_OK)
        return false;
    const double index = index_law_at(&law, s->render.lambda_nm);
    if (!(index > INDEX_MOST))
        return false;
    note_report(taker, owner->name, m->medium == MEDIUM_IOR ? "ior" : "medium",
                m->transparency > 0.0
                    ? "set its ior between 1 and 5; for a mirror set its reflectivity, and its transparency to 0"
                    : "for a mirror set its reflectivity; the index of an opaque solid has no effect",
                "%s has a refractive index of %.4g, higher than any transparent material, and a "
                "reflectivity of 0",
                owner->name, index);
    return true;
}

/* Notes properties that the solid seems to lack. */
static void hint_at_solid(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    if (hint_at_index(s, owner, taker))
        return;
    if (m->transparency > 0.0) {
        hint_at_clear(s, owner, taker);
    } else if (material_is_layered(m, &s->render)) {
        return; /* it shows reflections */
    } else if ((m->medium != MEDIUM_IOR || m->ior != 1.0) && !has_face_materials(s, owner)) {
        note_report(taker, owner->name, m->medium == MEDIUM_IOR ? "ior" : "medium", "set its transparency",
                    "%s has a refractive index but is opaque", owner->name);
    } else if (m->ambient == 0.0 && m->emission == 0.0 && m->reflectivity == 0.0 && !is_lit(m) &&
               !has_face_materials(s, owner) &&
               !scene_is_behind_camera(s, owner)) { /* a black board behind the camera keeps reflections dark */
        note_report(taker, owner->name, "diffuse", "set its diffuse",
                    "%s is black: it is neither transparent, nor diffuse, nor ambient, nor emitting", owner->name);
    }
}

/* Notes an image with alpha that the material does not use. */
static void hint_at_alpha(const scene *s, const solid *owner, const note_sink *taker)
{
    const int slots = face_material_slots(s, owner);
    for (int slot = 0; slot < (slots > 0 ? slots : 1); slot++) {
        const shading_material m = slots > 0 ? shading_material_of_face(s, owner, &owner->surface, slot)
                                             : shading_material_of_solid(s, owner, &owner->surface);
        if (!m.img || m.surface.alpha != ALPHA_OPAQUE || m.surface.transparency > 0.0 || !texture_covered(m.img))
            continue;
        note_report(taker, owner->name, "alpha",
                    slots > 0 ? "name a material of the scene like the faces' material, with alpha: mask or blend"
                              : "set its alpha to mask or blend",
                    "the image on %s has alpha, which is ignored", owner->name);
        return;
    }
}

static void hint_at_cover(const scene *s, const solid *hidden, const note_sink *taker)
{
    const solid *cover = scene_cover(s, hidden);
    char remedy[NOTE_TEXT_MAX];
    if (cover) {
        snprintf(remedy, sizeof remedy, "give %s the higher priority", hidden->name);
        note_report(taker, hidden->name, "priority", remedy,
                    "%s is entirely inside %s, which has precedence there and hides it", hidden->name, cover->name);
    }
}

/* Parameters that are set only to see their effect. If one has none, param_is_inert explains why, as for --set. */
static const struct {
    const char *name;
    size_t offset;
} expected[] = {{"extinction", offsetof(material, extinction)},
                {"film_thickness_nm", offsetof(material, film_thickness_nm)},
                {"roughness", offsetof(material, roughness)}};

static double expected_value(const material *m, size_t i)
{
    double value;
    memcpy(&value, (const char *)m + expected[i].offset, sizeof value);
    return value;
}

static void hint_if_inert(const scene *s, const char *owner, const char *name, const note_sink *taker)
{
    char path[2 * SCENE_NAME_MAX + 2];
    inert_answer answer;
    snprintf(path, sizeof path, "%s.%s", owner, name);
    if (param_is_inert(s, path, NULL, &answer) && strcmp(answer.rule, "unused-material") != 0 &&
        strcmp(answer.rule, "covered") != 0)
        taker->take(taker->context, &answer.note);
}

static void hint_at_unseen(const scene *s, const char *owner, const material *m, const material *same_as,
                           const note_sink *taker)
{
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const double value = expected_value(m, i);
        if (value > 0.0 && !(same_as && value == expected_value(same_as, i)))
            hint_if_inert(s, owner, expected[i].name, taker);
    }
    if (m->coating[0] && !(same_as && strcmp(m->coating, same_as->coating) == 0))
        hint_if_inert(s, owner, "coating", taker);
}

/* Materials first, then solids with other values than their material. Layers show no light, so there is no hint. */
static void hint_at_all_unseen(const scene *s, const note_sink *taker)
{
    if (integrator_traits_of(&s->render)->unlit)
        return;
    for (size_t i = 0; i < s->material_count; i++)
        hint_at_unseen(s, s->materials[i].name, &s->materials[i].value, NULL, taker);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one->visible)
            hint_at_unseen(s, one->name, &one->surface,
                           one->material_index < 0 ? NULL : &s->materials[one->material_index].value, taker);
    }
}

/* Notes settings of a solid that have no effect. */
static void hint_at_idle(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    if (m->transparency == 0.0 && material_absorbs(m) && solid_is_opaque(s, owner))
        note_report(taker, owner->name, m->absorb_spectrum.count > 0 ? "absorb_spectrum" : "absorb_per_m",
                    "set its transparency", "%s absorbs but is opaque", owner->name);
    const char *row = m->scatter_data[0] ? "scatter_data" : "scatter_per_m";
    if (material_is_turbid(m) && solid_is_opaque(s, owner))
        note_report(taker, owner->name, row, "set its transparency", "%s scatters light but is opaque", owner->name);
    else if (material_is_turbid(m) && !integrator_traits_of(&s->render)->by_chance)
        note_report(taker, owner->name, row, "set render.integrator to path",
                    "%s is treated as clear: only the path integrator shows scattering", owner->name);
    else if (material_scatters(m, &s->render) && s->render.polarisation)
        note_report(taker, owner->name, row, "",
                    "the light that %s scatters is unpolarised: its phase function does not polarise", owner->name);
    if (m->coefficients.count > 0 && (m->medium == MEDIUM_IOR || m->medium >= MEDIUM_DATA))
        note_report(taker, owner->name, "coefficients", "set its medium to cauchy, sellmeier or table",
                    "%s has coefficients but no dispersion law", owner->name);
    if (ignores_face_transparency(s, owner))
        note_report(taker, owner->name, "transparency",
                    "set it for the whole solid, or set render.transmission to simple",
                    "the transparency and reflectivity of the faces of %s have no effect: with refraction they "
                    "are properties of the solid",
                    owner->name);
}

/* Notes values that another parameter of the solid leaves without effect. */
static void hint_at_vain(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    if (m->asymmetry != 0.0 && !material_is_turbid(m))
        note_report(taker, owner->name, "asymmetry", "set its scatter_per_m",
                    "%s does not scatter light: its asymmetry has no effect", owner->name);
    if (m->sheet != SHEET_RETARDER && (m->retardance_deg != 0.0 || m->birefringence != 0.0))
        note_report(taker, owner->name, m->retardance_deg != 0.0 ? "retardance_deg" : "birefringence",
                    "set its sheet to retarder", "%s is not a retarder and retards no light", owner->name);
    if (m->extraordinary_ior > 0.0 && solid_is_opaque(s, owner))
        note_report(taker, owner->name, "extraordinary_ior", "set its transparency",
                    "%s has an extraordinary index but is opaque", owner->name);
    if (m->absorb_spectrum.count > 0 && (m->absorb_per_m.x > 0.0 || m->absorb_per_m.y > 0.0 || m->absorb_per_m.z > 0.0))
        note_report(taker, owner->name, "absorb_per_m", "remove it, or absorb_spectrum",
                    "the absorb_spectrum of %s replaces its absorb_per_m", owner->name);
    if (m->reflectivity > 0.0 && m->transparency == 0.0 && material_is_layered(m, &s->render))
        note_report(taker, owner->name, "reflectivity", "remove it",
                    "the %s of %s determines what it reflects: its reflectivity has no effect",
                    m->coating[0]          ? "coating"
                    : material_has_film(m) ? "film"
                                           : "complex index",
                    owner->name);
}

/* With fewer samples per pixel, noise in soft shadows is obvious. */
enum { SOFT_SAMPLES = 9 };

static void hint_at_lights(const scene *s, const note_sink *taker)
{
    const bool path = integrator_traits_of(&s->render)->by_chance;
    bool clear = false, scatters = false;
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        clear |= one->visible && one->surface.transparency > 0.0;
        scatters |= one->visible && material_scatters(&one->surface, &s->render);
    }
    for (size_t i = 0; i < s->light_count; i++) {
        const light *lamp = &s->lights[i];
        if (lamp->spectrum >= LAMP_SODIUM && lamp->spectrum != LAMP_DATA && lamp->intensity > 0.0 &&
            s->render.spectrum != SPECTRUM_SPECTRAL)
            note_report(taker, lamp->name, "spectrum", "set render.spectrum=spectral, which renders each line",
                        "%s emits spectral lines, and an rgb image shows only their colour", lamp->name);
        if (lamp->polarised > 0.0 && !s->render.polarisation)
            note_report(taker, lamp->name, "polarised", "set render.polarisation to on",
                        "light is traced without its polarisation: the polarisation of %s has no effect", lamp->name);
        const bool soft = scene_has_soft_shadows(&s->render);
        const char *size = lamp->kind == LIGHT_RECTANGLE ? "width"
                           : lamp->kind == LIGHT_SUN     ? "angular_diameter_deg"
                                                         : "radius";
        if (lamp->kind == LIGHT_SUN && path && clear && !scatters && lamp->intensity > 0.0 &&
            !scene_has_caustics(&s->render))
            note_report(taker, lamp->name, size, "set render.caustics=photons",
                        "random paths through transparent solids rarely hit %s, which is small: caustics are noise",
                        lamp->name);
        else if (soft && light_has_size(lamp) && s->render.samples < SOFT_SAMPLES)
            note_report(taker, lamp->name, size, "set render.samples=16",
                        "each pixel samples %lld points of %s: its shadows are grainy", (long long)s->render.samples,
                        lamp->name);
        else if (light_has_size(lamp) && !path && !soft)
            note_report(taker, lamp->name, size, "set render.soft_shadows=on, or render.integrator=path",
                        lamp->kind == LIGHT_SUN ? "all light of %s is parallel" : "%s acts as a point light",
                        lamp->name);
        else if (!light_has_size(lamp) && path && clear && lamp->intensity > 0.0 && !scene_has_caustics(&s->render))
            note_report(taker, lamp->name, "radius",
                        scatters ? "set its radius and its reach"
                                 : "set render.caustics=photons, or its radius and its reach",
                        "%s is a point light, which random paths cannot hit through transparent solids: no caustics",
                        lamp->name);
    }
}

static void hint_at_beams(const scene *s, const note_sink *taker)
{
    for (size_t i = 0; i < s->beam_count; i++) {
        const beam *b = &s->beams[i];
        if (b->lights && b->visible && !scene_has_caustics(&s->render))
            note_report(taker, b->name, "lights", "set render.caustics=photons",
                        "%s lights nothing: only photons carry the light of beams", b->name);
        else if (!b->lights && b->profile != BEAM_UNIFORM)
            note_report(taker, b->name, "profile", "set its lights to on",
                        "%s does not light the scene: its profile has no effect", b->name);
    }
}

static void hint_at_lens(const scene *s, const note_sink *taker)
{
    const integrator_traits *traits = integrator_traits_of(&s->render);
    if (s->camera.aperture == 0.0 || camera_lens_is_sampled(s))
        return;
    note_report(taker, "camera", "aperture",
                traits->by_chance                ? "set render.paths to 64"
                : traits->drawn || traits->unlit ? "set render.integrator to whitted and render.samples to 16"
                                                 : "set render.samples to 16",
                "nothing is blurred: each pixel has only rays through the centre of the lens");
}

static void hint_at_analyser(const scene *s, const note_sink *taker)
{
    if (s->camera.analyser != ANALYSER_NONE && !s->render.polarisation)
        note_report(taker, "camera", "analyser", "set render.polarisation to on",
                    "light is traced without its polarisation: the analyser has no effect");
}

/* Notes a polariser or a retarder that does less than its name says. */
static void hint_at_sheet(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    const render_settings *r = &s->render;
    if (m->sheet == SHEET_NONE)
        return;
    if (solid_is_opaque(s, owner))
        note_report(taker, owner->name, "sheet", "set its transparency",
                    "%s is opaque: no light passes through its sheet", owner->name);
    else if (integrator_traits_of(r)->drawn)
        note_report(taker, owner->name, "sheet", "set render.integrator to whitted and render.polarisation to on",
                    "the depth buffer does not show what the sheet of %s does", owner->name);
    else if (!r->polarisation)
        note_report(taker, owner->name, "sheet", "set render.polarisation to on",
                    m->sheet == SHEET_RETARDER
                        ? "light is traced without its polarisation: the retarder %s has no effect"
                        : "light is traced without its polarisation: %s is a grey filter",
                    owner->name);
    else if (m->sheet == SHEET_RETARDER && !sheet_retards(m))
        note_report(taker, owner->name, "retardance_deg", "set its retardance_deg, or its birefringence",
                    "the retarder %s has a retardance of 0: it has no effect", owner->name);
    else if (sheet_disperses(m, r) && r->spectrum != SPECTRUM_SPECTRAL)
        note_report(taker, owner->name, "birefringence", "set render.spectrum to spectral",
                    "every channel uses the retardance of %s at render.lambda_nm: there are no interference colours",
                    owner->name);
}

/* Notes double refraction that is rendered only in part, or not at all. */
static void hint_at_crystal(const scene *s, const solid *owner, const note_sink *taker)
{
    const material *m = &owner->surface;
    if (m->extraordinary_ior == 0.0 || solid_is_opaque(s, owner))
        return;
    if (!material_is_crystal(m, &s->render))
        note_report(taker, owner->name, "extraordinary_ior",
                    integrator_traits_of(&s->render)->tree
                        ? "set render.lighting to whitted, render.weights to fresnel, "
                          "and render.transmission to refract"
                        : "set render.integrator to whitted",
                    "the crystal %s gives one image: light is refracted by its ordinary index alone", owner->name);
    else if (scene_has_caustics(&s->render))
        note_report(taker, owner->name, "extraordinary_ior", "set render.caustics to off",
                    "photons are refracted by the ordinary index of the crystal %s alone", owner->name);
    else if (scene_crystals(s) > 1 && !s->render.polarisation)
        note_report(
            taker, owner->name, "extraordinary_ior", "set render.polarisation to on",
            "light is traced without its polarisation: each crystal divides light from another one into halves");
}

/* Exposure and tone do not change the film, so lint/needs.c has no rows for them. */
static void hint_at_tone(const scene *s, const note_sink *taker)
{
    const camera *c = &s->camera;
    if (integrator_traits_of(&s->render)->unlit && (c->exposure != 0.0 || c->tone != TONE_NONE))
        note_report(taker, "camera", c->exposure != 0.0 ? "exposure" : "tone", "set render.integrator to whitted",
                    "layers show no light: exposure and tone do not apply to them");
    else if (c->white != 4.0 && c->tone != TONE_REINHARD)
        note_report(taker, "camera", "white", "set camera.tone to reinhard", "this tone curve has no white point");
}

static void hint_at_image(const char *object, const char *parameter, const char *note, const note_sink *taker)
{
    if (*note)
        note_report(taker, object, parameter, NULL, "%s", note);
}

/* Notes what mesh files name or have, and their meshes lack; and what reading images ignored or changed. */
static void hint_at_files(const scene *s, const note_sink *taker)
{
    if (s->background.kind == BACKGROUND_IMAGE && s->background.img)
        hint_at_image("background", "image", s->background.img->note, taker);
    for (size_t i = 0; i < s->texture_count; i++)
        if (s->textures[i].data)
            hint_at_image(s->textures[i].name, "file", texture_note(s->textures[i].data), taker);
    for (size_t i = 0; i < s->mesh_count; i++) {
        const face_materials *list = s->meshes[i].shading_materials;
        hint_at_image(s->meshes[i].name, "file", face_materials_note(list), taker);
        for (int k = 0; k < face_materials_count(list); k++) {
            const texture *img = face_materials_at(list, k)->img;
            if (img && (k == 0 || img != face_materials_at(list, k - 1)->img))
                hint_at_image(s->meshes[i].name, "file", texture_note(img), taker);
        }
    }
}

/* What readers of lens files have told. */
static void report_remarks(const scene *s, const note_sink *taker)
{
    for (const char *at = s->remarks; at && *at; at = strchr(at, '\n') + 1) {
        const int name = (int)strcspn(at, ":"), length = (int)strcspn(at + name + 2, "\n");
        char system[SCENE_NAME_MAX + 1];
        snprintf(system, sizeof system, "%.*s", name, at);
        note_report(taker, system, NULL, length > 240 ? "`cuvette lens FILE` tells all" : "", "%.*s", length,
                    at + name + 2);
    }
}

void scene_hints(const scene *s, const note_sink *taker)
{
    report_remarks(s, taker);
    size_t visible = 0, lit = 0, shining = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        visible += s->solids[i].visible != 0;
        lit += s->solids[i].visible && is_lit(&s->solids[i].surface);
        shining += s->solids[i].visible && s->solids[i].surface.emission > 0.0;
    }
    if (visible == 0)
        note_report(taker, "solids", NULL, "add solids:", "no visible solids: the image shows only the background");
    bool beams = false;
    for (size_t i = 0; i < s->beam_count; i++)
        beams |= beam_lights_scene(&s->beams[i], &s->render);
    const bool emitters_light = beams || (shining > 0 && integrator_traits_of(&s->render)->by_chance);
    if (lit > 0 && s->light_count == 0 && !emitters_light)
        note_report(taker, "lights", NULL,
                    "add lights:", "no lights: opaque surfaces show only ambient and emitted light");
    hint_at_lights(s, taker);
    hint_at_beams(s, taker);
    hint_at_lens(s, taker);
    hint_at_analyser(s, taker);
    hint_at_tone(s, taker);
    for (size_t i = 0; i < s->solid_count; i++) {
        if (s->solids[i].visible) {
            hint_at_solid(s, &s->solids[i], taker);
            hint_at_idle(s, &s->solids[i], taker);
            hint_at_vain(s, &s->solids[i], taker);
            hint_at_sheet(s, &s->solids[i], taker);
            hint_at_crystal(s, &s->solids[i], taker);
            hint_at_cover(s, &s->solids[i], taker);
            hint_at_alpha(s, &s->solids[i], taker);
        }
    }
    hint_at_all_unseen(s, taker);
    hint_at_files(s, taker);
    scene_range_hints(s, taker);
}
