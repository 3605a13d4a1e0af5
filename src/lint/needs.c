/* The table of what each parameter needs to have an effect (inert.h), and its interpreter. */
#include "lint/inert.h"
#include "scene/model/names.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NEEDS(of, on, what)                             \
    {                                                   \
        .group = PARAM_##of, .names = on, .needs = what \
    }
#define NEEDS_SET(of, on, what, set)                                   \
    {                                                                  \
        .group = PARAM_##of, .names = on, .needs = what, .remedy = set \
    }
#define FACT(of, on, rule)                             \
    {                                                  \
        .group = PARAM_##of, .names = on, .fact = rule \
    }
#define ACTS_WHERE(of, on, rule)                                     \
    {                                                                \
        .group = PARAM_##of, .names = on, .fact = rule, .acts = true \
    }
#define NEEDS_LIGHT(of, on) NEEDS_SET(of, on, "render.integrator!=aov", "render.integrator=whitted")
#define NEEDS_RAYS(of, on) NEEDS_SET(of, on, "render.integrator!=zbuffer", "render.integrator=whitted")
#define NEEDS_SHADOWS(of, on) NEEDS_SET(of, on, "render.shadows!=off", "render.shadows=opaque")
#define NEEDS_PATHS(of, on) NEEDS(of, on, "render.integrator=path")

static const needs_row light_rows[] = {
    NEEDS_LIGHT(RENDER,
                "caustics photons samples depth beyond lighting shadows soft_shadows min_weight seed radiance spectrum "
                "polarisation lambda_nm wavelengths unit_m weights"),
    NEEDS_LIGHT(BACKGROUND, "kind color horizon image rain drops sun_elevation_deg sun_azimuth_deg sky_type ambient "
                            "absorb_per_m"),
    NEEDS_LIGHT(LIGHT, "*"),
    NEEDS_LIGHT(
        MATERIAL,
        "ambient diffuse specular shininess absorb_per_m absorb_spectrum absorb_data tint_distance extinction "
        "extraordinary_ior optic_axis film_ior coating_data sheet sheet_axis sheet_pass sheet_block retardance_deg "
        "birefringence roughness scatter_per_m scatter_data asymmetry"),
};

static const needs_row rows[] = {
    NEEDS_PATHS(RENDER, "paths error sampler filter light_sampling roulette energy_compensation"),
    FACT(RENDER, "samples", path_samples),
    NEEDS_SET(RENDER, "error", "render.paths>16",
              "render.paths=256"), /* the pilot renders 16: render/frame/renderer.h */
    FACT(RENDER, "light_sampling", nothing_lit),
    FACT(RENDER, "light_sampling", one_light),
    NEEDS_SET(RENDER, "roulette", "render.depth>3", "render.depth=8"), /* render/integrators/path.c */
    FACT(RENDER, "energy_compensation", no_roughness),
    FACT(RENDER, "seed", no_random_numbers),
    NEEDS(RENDER, "layer", "render.integrator=aov"),
    NEEDS_SET(RENDER, "lighting min_weight", "render.integrator!=path", "render.integrator=whitted"),
    FACT(RENDER, "lighting", no_highlights),
    FACT(RENDER, "depth beyond min_weight", no_tree),
    NEEDS_SET(RENDER, "min_weight", "render.depth>0", "render.depth=4"),
    NEEDS_SET(RENDER, "beyond", "render.depth!=unlimited", "render.depth=8"),
    FACT(RENDER, "beyond", nothing_beyond),
    ACTS_WHERE(RENDER, "transmission", some_face_materials),
    FACT(RENDER, "transmission weights", no_clear),
    FACT(RENDER, "transmission weights", same_when_drawn),
    NEEDS(RENDER, "weights", "render.transmission=refract"),
    NEEDS_RAYS(RENDER, "shadows caustics photons radiance"),
    FACT(RENDER, "shadows", nothing_lit),
    FACT(RENDER, "shadows", lit_by_hits),
    NEEDS(RENDER, "soft_shadows", "render.integrator=whitted|raycast"),
    NEEDS_SHADOWS(RENDER, "soft_shadows caustics photons"),
    FACT(RENDER, "soft_shadows", nothing_lit),
    FACT(RENDER, "soft_shadows", no_size),
    NEEDS(RENDER, "photons", "render.caustics=photons"),
    FACT(RENDER, "photons", no_photons),
    FACT(RENDER, "caustics", same_photons),
    NEEDS(RENDER, "radiance", "render.transmission=refract"),
    FACT(RENDER, "radiance", inert_radiance),
    FACT(RENDER, "polarisation", polarisation_unseen),
    NEEDS(RENDER, "wavelengths", "render.spectrum=spectral"),
    NEEDS(RENDER, "lambda_nm", "render.spectrum=rgb"),
    FACT(RENDER, "lambda_nm", no_clear),
    FACT(RENDER, "lambda_nm", no_dispersion),
    FACT(RENDER, "unit_m", no_absorption),
    NEEDS(RENDER, "texturing", "render.integrator=zbuffer"),
    FACT(RENDER, "texturing", untextured),

    NEEDS(CAMERA, "fov_deg", "camera.projection=perspective"),
    NEEDS(CAMERA, "view_height", "camera.projection=orthographic"),
    FACT(CAMERA, "aperture focus", lens_unsampled),
    NEEDS_SET(CAMERA, "focus", "camera.aperture>0", "camera.aperture=0.2"),
    FACT(CAMERA, "analyser analyser_angle_deg", unpolarised),
    NEEDS(CAMERA, "analyser_angle_deg", "camera.analyser=linear"),
    FACT(CAMERA, "analyser_angle_deg", inert_polarisation),

    FACT(BACKGROUND, "kind", flat_sky),
    NEEDS_SET(BACKGROUND, "color", "background.kind!=image", "background.kind=uniform"),
    NEEDS(BACKGROUND, "brightness", "background.kind=image"),
    NEEDS(BACKGROUND, "horizon", "background.kind=gradient|rain|cie"),
    NEEDS(BACKGROUND, "rain drops", "background.kind=rain"),
    NEEDS_SET(BACKGROUND, "drops", "background.rain>0", "background.rain=0.3"),
    NEEDS(BACKGROUND, "sky_type", "background.kind=cie"),
    NEEDS(BACKGROUND, "sun_elevation_deg sun_azimuth_deg", "background.kind=rain|cie"),
    FACT(BACKGROUND, "sun_elevation_deg sun_azimuth_deg", no_own_sun),
    NEEDS_SET(BACKGROUND, "sun_azimuth_deg", "background.sun_elevation_deg!=90|-90", "background.sun_elevation_deg=20"),
    NEEDS_SET(BACKGROUND, "ambient", "render.integrator!=path", "render.integrator=whitted"),
    FACT(BACKGROUND, "ambient", no_ambient),
    FACT(BACKGROUND, "ior medium", nothing_refracts),
    NEEDS(BACKGROUND, "ior medium", "render.transmission=refract"),
    FACT(BACKGROUND, "ior medium", not_bent_outside),
    NEEDS_RAYS(BACKGROUND, "absorb_per_m"),

    FACT(MESH, "*", unused_mesh),
    NEEDS(MESH, "handedness", "generate=file"),
    NEEDS(MESH, "count", "generate=sparse|dense|sphere"),
    NEEDS(MESH, "level", "generate=icosphere|slime"),
    NEEDS(MESH, "major minor", "generate=torus"),
    NEEDS(MESH, "around", "generate=torus|lathe|terrain"),
    NEEDS(MESH, "tube", "generate=torus|terrain"),
    NEEDS(MESH, "profile crease_deg", "generate=lathe"),
    NEEDS(MESH, "size", "generate=box|terrain"),
    NEEDS(MESH, "depth seed", "generate=terrain"),
    FACT(MESH, "*", at_rest),
    NEEDS(MESH, "ground_y restitution friction", "ground=on"),
    FACT(TEXTURE, "*", unused_texture),
    FACT(TEXTURE, "space", of_floats),
    FACT(DATA, "*", unused_data),
    FACT(DATA, "glass column scale relative_to", not_of_file),

    ACTS_WHERE(LIGHT, "position target kind", moves_sky),
    NEEDS(LIGHT, "color", "spectrum=color"),
    NEEDS(LIGHT, "temperature_k", "spectrum=black_body"),
    NEEDS(LIGHT, "line_nm", "spectrum=line"),
    NEEDS(LIGHT, "spectrum_data", "spectrum=data"),
    NEEDS_SET(LIGHT, "*", "intensity>0", "%.intensity=1"),
    FACT(LIGHT, "*", black_lamp),
    FACT(LIGHT, "polarised polarisation_deg", unpolarised),
    NEEDS_SET(LIGHT, "polarisation_deg", "polarised>0", "%.polarised=1"),
    FACT(LIGHT, "polarised polarisation_deg", depolarised),
    NEEDS_SET(LIGHT, "target", "kind!=point", "%.kind=cone"),
    NEEDS_SET(LIGHT, "reach", "kind!=sun", "%.kind=point"),
    NEEDS(LIGHT, "half_angle_deg", "kind=cone|soft_cone"),
    NEEDS(LIGHT, "radius", "kind=disc|point|cone|soft_cone"),
    NEEDS(LIGHT, "width height roll_deg", "kind=rectangle"),
    NEEDS(LIGHT, "angular_diameter_deg", "kind=sun"),
    FACT(LIGHT, "radius width height roll_deg angular_diameter_deg", size_unsampled),
    NEEDS_SET(LIGHT, "width roll_deg", "height>0", "%.height=1"),
    NEEDS_SET(LIGHT, "height roll_deg", "width>0", "%.width=1"),
    FACT(LIGHT, "*", lights_nothing),

    NEEDS_RAYS(BEAM, "*"),
    NEEDS_SHADOWS(BEAM, "*"),
    NEEDS(BEAM, "*", "render.caustics=photons"),
    NEEDS(BEAM, "*", "visible=on"),
    NEEDS_SET(BEAM, "*", "power>0", "%.power=1"),
    FACT(BEAM, "*", unseen_beam),
    NEEDS(BEAM, "angle_deg", "kind=pencil|fan"),
    NEEDS(BEAM, "width", "kind=bundle|sheet"),
    NEEDS(BEAM, "normal", "kind=fan|sheet"),
    NEEDS(BEAM, "target", "direction=0,0,0"),
    NEEDS(BEAM, "lambda_nm", "white=off"),
    FACT(BEAM, "profile", thin_beam),
    FACT(BEAM, "*", shows_no_light),

    FACT(MATERIAL, "color color_data", no_color_or_tint),
    FACT(MATERIAL, "color", by_data),
    FACT(MATERIAL, "emission ambient diffuse", is_black_surface),
    NEEDS_SET(MATERIAL, "ambient", "render.integrator!=path", "render.integrator=whitted"),
    NEEDS_SET(MATERIAL, "ambient", "background.ambient!=0,0,0", "background.ambient=1,1,1"),
    FACT(MATERIAL, "diffuse", unlit),
    NEEDS_SET(MATERIAL, "shininess", "specular>0", "%.specular=0.5"),
    FACT(MATERIAL, "specular shininess", no_highlight),
    FACT(MATERIAL, "reflectivity", no_reflectivity),
    FACT(MATERIAL, "coefficients", no_law),
    NEEDS(MATERIAL, "medium_data", "medium=data"),
    FACT(MATERIAL, "ior coefficients medium_data", no_index),
    FACT(MATERIAL, "medium", no_medium),
    NEEDS(MATERIAL, "extinction", "transparency=0"),
    NEEDS(MATERIAL, "extinction", "medium=ior"),
    FACT(MATERIAL, "extinction", nothing_reflected),
    FACT(MATERIAL,
         "extraordinary_ior optic_axis sheet sheet_axis sheet_pass sheet_block retardance_deg birefringence "
         "absorb_per_m absorb_spectrum absorb_data scatter_per_m scatter_data asymmetry tint_distance",
         opaque_rule),
    NEEDS_SET(MATERIAL, "film_ior", "film_thickness_nm>0", "%.film_thickness_nm=300"),
    FACT(MATERIAL, "coating_data", no_data_layer),
    FACT(MATERIAL,
         "extraordinary_ior optic_axis film_thickness_nm film_ior coating coating_data sheet sheet_axis sheet_pass "
         "sheet_block "
         "retardance_deg birefringence absorb_per_m absorb_spectrum absorb_data scatter_per_m scatter_data asymmetry "
         "tint_distance",
         mirror_rule),
    NEEDS(MATERIAL, "extraordinary_ior optic_axis", "render.integrator=whitted"),
    NEEDS(MATERIAL, "extraordinary_ior optic_axis", "render.lighting=whitted"),
    NEEDS(MATERIAL, "extraordinary_ior optic_axis", "render.transmission=refract"),
    NEEDS(MATERIAL, "extraordinary_ior optic_axis", "render.weights=fresnel"),
    NEEDS_SET(MATERIAL, "optic_axis", "extraordinary_ior>0", "%.extraordinary_ior=1.7"),
    FACT(MATERIAL, "film_thickness_nm film_ior coating coating_data roughness", constant_weights),
    FACT(MATERIAL, "film_thickness_nm film_ior coating coating_data", film_unseen),
    FACT(MATERIAL, "film_ior coating_data", nothing_reflected),
    NEEDS_RAYS(MATERIAL, "sheet sheet_axis sheet_pass sheet_block retardance_deg birefringence"),
    FACT(MATERIAL, "sheet sheet_axis sheet_pass sheet_block retardance_deg birefringence", sheet_unpassed),
    NEEDS(MATERIAL, "sheet_axis", "sheet=polariser|retarder"),
    NEEDS(MATERIAL, "sheet_pass sheet_block", "sheet=polariser|circular_left|circular_right"),
    NEEDS(MATERIAL, "retardance_deg birefringence", "sheet=retarder"),
    FACT(MATERIAL, "sheet_axis retardance_deg birefringence", unpolarised),
    FACT(MATERIAL, "sheet_axis", axis_unseen),
    NEEDS_PATHS(MATERIAL, "roughness scatter_per_m scatter_data asymmetry"),
    FACT(MATERIAL, "roughness", nothing_rough),
    FACT(MATERIAL, "absorb_per_m absorb_spectrum absorb_data scatter_per_m scatter_data asymmetry tint_distance",
         unpassed),
    NEEDS(MATERIAL, "absorb_per_m", "absorb_spectrum=[]"),
    FACT(MATERIAL, "absorb_per_m absorb_spectrum scatter_per_m", by_data),
    FACT(MATERIAL, "asymmetry", not_turbid),
    NEEDS_SET(MATERIAL, "tint_distance", "color!=1,1,1", "%.color=0.9,0.7,0.5"),
    FACT(MATERIAL, "texture texture_size", no_texture),
    FACT(MATERIAL, "alpha alpha_cutoff", no_alpha),
    NEEDS_SET(MATERIAL, "checker_color", "checker>0", "%.checker=0.2"),
    FACT(MATERIAL, "texture texture_size checker checker_color", no_color),
    FACT(MATERIAL, "checker", one_color),
    FACT(MATERIAL, "*", covered),
    FACT(MATERIAL, "*", no_interface),
    FACT(MATERIAL, "*", unseen),

    NEEDS(SOLID, "*", "visible=on"),
    FACT(SOLID, "priority", overlaps_unseen),
    FACT(SOLID, "rotation", looks_the_same),
    NEEDS_SET(SOLID, "spacing", "copies!=1,1,1", "%.copies=2,1,1"),
    FACT(SOLID, "shading", unshaded),
    FACT(SOLID, "mesh", one_mesh),
    FACT(SOLID, "points", no_point_files),
    NEEDS_SET(SOLID, "conic_1", "radius_1!=0", "%.radius_1=2"),
    NEEDS_SET(SOLID, "conic_2", "radius_2!=0", "%.radius_2=-2"),
    FACT(SOLID, "form_1 form_2", flat_side),
    NEEDS_SET(SOLID, "radius_1_x", "form_1!=round", "%.form_1=toric"),
    NEEDS_SET(SOLID, "radius_2_x", "form_2!=round", "%.form_2=toric"),
    NEEDS_SET(SOLID, "conic_1_x", "form_1=biconic", "%.form_1=biconic"),
    NEEDS_SET(SOLID, "conic_2_x", "form_2=biconic", "%.form_2=biconic"),
    NEEDS_SET(SOLID, "conic_1_x", "radius_1_x!=0", "%.radius_1_x=2"),
    NEEDS_SET(SOLID, "conic_2_x", "radius_2_x!=0", "%.radius_2_x=-2"),
    NEEDS_SET(SOLID, "contact_angle_deg contact_radius", "capillary_length>0", "%.capillary_length=0.1"),
    NEEDS_SET(SOLID, "capillary_length contact_radius", "contact_angle_deg!=90", "%.contact_angle_deg=20"),
};

/* Whether the list, whose words are separated by `between`, has the word. */
static bool has_word(const char *list, char between, const char *word, size_t length)
{
    for (const char *at = list; at; at = strchr(at, between)) {
        at += *at == between;
        if (strncmp(at, word, length) == 0 && (at[length] == between || at[length] == 0))
            return true;
    }
    return false;
}

/* --- a condition on another parameter --- */

typedef struct need {
    char path[NOTE_PLACE_MAX];
    const param *row;
    const void *field;
    const char *sign; /* the comparison and its values: "=point", "!=sun", ">0" */
} need;

static const void *values_of(const inert_case *c, param_group group)
{
    if (group == PARAM_MATERIAL)
        return c->m;
    return group == PARAM_SOLID ? c->owner : object_values(c->s, group, group == c->at.object_group ? c->at.index : 0);
}

static need need_of(const inert_case *c, const needs_row *r)
{
    char name[SCENE_NAME_MAX + 1];
    need n = {.sign = r->needs + strcspn(r->needs, "=!>")};
    const char *dot = memchr(r->needs, '.', (size_t)(n.sign - r->needs)), *field_name = dot ? dot + 1 : r->needs;
    param_group group = r->group;
    for (int g = PARAM_RENDER; dot && g <= PARAM_BACKGROUND; g++)
        if (strncmp(param_group_name((param_group)g), r->needs, (size_t)(dot - r->needs)) == 0)
            group = (param_group)g;
    snprintf(name, sizeof name, "%.*s", (int)(n.sign - field_name), field_name);
    snprintf(n.path, sizeof n.path, "%s.%s", dot ? param_group_name(group) : c->name, name);
    n.row = param_find(group, name);
    n.field = (const char *)values_of(c, group) + n.row->offset;
    return n;
}

static double number_of(const need *n)
{
    int64_t integer;
    double real;
    memcpy(&integer, n->field, sizeof integer);
    memcpy(&real, n->field, sizeof real);
    return n->row->type == PARAM_REAL ? real : (double)integer;
}

static bool is_met(const need *n, const char *value)
{
    if (*n->sign == '>')
        return number_of(n) > strtod(n->sign + 1, NULL);
    const bool differs = *n->sign == '!';
    return has_word(n->sign + 1 + differs, '|', value, strlen(value)) != differs;
}

static bool say_unmet(const inert_case *c, const needs_row *r, const need *n, const char *value)
{
    char remedy[NOTE_TEXT_MAX];
    const char *mark = r->remedy ? strchr(r->remedy, '%') : NULL;
    if (mark)
        snprintf(remedy, sizeof remedy, "set %s%s", c->name, mark + 1);
    else if (r->remedy)
        snprintf(remedy, sizeof remedy, "set %s", r->remedy);
    else
        snprintf(remedy, sizeof remedy, "set %s=%.*s", n->path, (int)strcspn(n->sign + 1, "|"), n->sign + 1);
    return inert_say(c, r->needs, remedy, "no effect with %s=%.60s", n->path, value);
}

/* Whether the condition on another parameter does not hold. */
static bool is_unmet(const inert_case *c, const needs_row *r)
{
    const need n = need_of(c, r);
    if (n.row == c->at.row)
        return false;
    char *value = param_value_text(n.row, -1, n.field);
    const bool unmet = value && !is_met(&n, value) && say_unmet(c, r, &n, value);
    free(value);
    return unmet;
}

/* --- the table --- */

static bool ask_rows(const inert_case *c, param_group group, const needs_row *first, size_t count)
{
    const char *name = c->at.row->name;
    for (const needs_row *r = first; r < first + count; r++) {
        if (r->group != group || !(r->names[0] == '*' || has_word(r->names, ' ', name, strlen(name))))
            continue;
        if (r->needs ? is_unmet(c, r) : r->fact(c))
            return !r->acts;
    }
    return false;
}

bool needs_ask(const inert_case *c, param_group group)
{
    return ask_rows(c, group, rows, sizeof rows / sizeof *rows);
}

bool needs_light(const inert_case *c)
{
    return ask_rows(c, c->at.row->group, light_rows, sizeof light_rows / sizeof *light_rows);
}

/* Writes the condition with " or " between the values, so that a narrow table can break the line; returns its
 * length. */
static int add_condition(char *text, size_t size, const char *condition)
{
    int used = 0;
    for (const char *at = condition; *at; at++)
        if ((size_t)used < size)
            used += *at == '|' ? snprintf(text + used, size - (size_t)used, " or ")
                               : snprintf(text + used, size - (size_t)used, "%c", *at);
    return used;
}

char *inert_needs_text(const param *row, char *text, size_t size)
{
    int used = 0;
    text[0] = 0;
    for (const needs_row *r = rows; r < rows + sizeof rows / sizeof *rows; r++) {
        if (!r->needs || r->group != row->group || !has_word(r->names, ' ', row->name, strlen(row->name)))
            continue;
        if (used && (size_t)used < size)
            used += snprintf(text + used, size - (size_t)used, ", ");
        if ((size_t)used < size)
            used += add_condition(text + used, size - (size_t)used, r->needs);
    }
    return text;
}

const needs_row *needs_rows(size_t *count)
{
    *count = sizeof rows / sizeof *rows;
    return rows;
}
