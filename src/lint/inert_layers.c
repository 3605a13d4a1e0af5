/* Parameters without effect for an integrator with named layers, which traces no light; and layers for other
 * integrators. */
#include "lint/inert_private.h"

#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

/* By group: parameters that concern only light. */
static bool is_of_light(const inert_case *c)
{
    static const char *const of_render[] = {"caustics",    "photons",  "samples",      "depth",
                                            "beyond",      "lighting", "shadows",      "soft_shadows",
                                            "min_weight",  "paths",    "roulette",     "seed",
                                            "radiance",    "spectrum", "polarisation", "lambda_nm",
                                            "wavelengths", "unit_m",   "weights",      "energy_compensation",
                                            NULL};
    static const char *const of_sky[] = {"kind",     "color",   "horizon",           "picture",
                                         "rain",     "drops",   "sun_elevation_deg", "sun_azimuth_deg",
                                         "sky_type", "ambient", "absorb_per_m",      NULL};
    static const char *const of_surface[] = {"ambient",        "diffuse",       "specular",
                                             "shininess",      "absorb_per_m",  "absorb_spectrum",
                                             "tint_distance",  "extinction",    "extraordinary_ior",
                                             "optic_axis",     "film_ior",      "sheet",
                                             "sheet_axis",     "sheet_pass",    "sheet_block",
                                             "retardance_deg", "birefringence", "roughness",
                                             "scatter_per_m",  "asymmetry",     NULL};
    switch (c->at.object_group) {
    case PARAM_LIGHT: return true;
    case PARAM_RENDER: return is_among(c, of_render);
    case PARAM_BACKGROUND: return is_among(c, of_sky);
    case PARAM_MATERIAL: return is_among(c, of_surface);
    case PARAM_SOLID: return c->at.row->group == PARAM_MATERIAL && is_among(c, of_surface);
    case PARAM_CAMERA:
    case PARAM_BEAM:
    case PARAM_MESH:
    case PARAM_TEXTURE:
    case PARAM_GROUP_COUNT: break;
    }
    return false;
}

bool inert_layers(const inert_case *c)
{
    const char *word = integrator_with_layers();
    const bool given = integrator_traits_of(scene_settings(c->s))->layers;
    if (!given)
        return c->at.object_group == PARAM_RENDER && strcmp(c->at.row->name, "layer") == 0 && word &&
               inert_say(c, "layers-only", inert_set("render.integrator=%s", word).text,
                         "this render.integrator writes no layers");
    return is_of_light(c) && inert_say(c, "no-light", "set render.integrator=whitted",
                                       "the image shows a layer of the first hits: light is not traced");
}

/* Whether the film is unchanged with the parameter scaled by that factor. */
static bool same_times(const inert_case *c, const char *path, double factor)
{
    char *now = NULL;
    if (scene_get(c->s, path, &now, NULL) != STATUS_OK)
        return false;
    double value = strtod(now, NULL);
    free(now);
    if (value == 0.0 && c->at.row->group == PARAM_SOLID) /* of contact_radius: the solid's radius */
        value = c->s->solids[c->at.index].shape.radius;
    return inert_same(c, "%s=%.6g", path, value * factor);
}

/* The background, and surface properties that only decide whether there is a surface, may matter for this image: the
 * witness decides. */
bool inert_unmet(const inert_case *c, const char *path)
{
    static const struct {
        const char *name, *values[3];
    } rows[] = {
        {"emission", {"0", "1", NULL}},
        {"transparency", {"0", "0.5", "1"}},
        {"ior", {"1.1", "1.9", NULL}},
        {"film_thickness_nm", {"0", "300", NULL}},
        {"medium", {"water", "diamond", "bk7"}},
        {"priority", {"-1000", "0", "1000"}},
        {"visible", {"on", "off", NULL}},
        {"color", {"0,0,0", "1,1,1", NULL}},
        {"capillary_length", {"0", "0.05", "0.2"}},
        {"contact_angle_deg", {"20", "90", "150"}},
        {"contact_radius", {"0", NULL}}, /* 0: the largest */
        {"inner_radius", {NULL}},
        {"floor", {NULL}},
    };
    if (!integrator_traits_of(scene_settings(c->s))->layers || !c->witness->same)
        return false;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (strcmp(rows[i].name, c->at.row->name) != 0)
            continue;
        const bool part = strcmp(rows[i].name, "contact_radius") == 0;
        bool same =
            (rows[i].values[0] && !part) || (same_times(c, path, 0.5) && same_times(c, path, part ? 0.9 : 1.05));
        for (size_t k = 0; k < 3 && rows[i].values[k] && same; k++)
            same = inert_same(c, "%s=%s", path, rows[i].values[k]);
        return same &&
               inert_say(c, "met-first", "set render.integrator=whitted", "the first hits of this image do not change");
    }
    return false;
}
