/* Why a parameter does nothing under an integrator that gives named layers of what camera rays meet first: it follows
 * no light. And why no other integrator shows a layer. */
#include "scene/model/inert/inert_private.h"

#include <string.h>

/* By group: what is about light alone. */
static bool is_of_light(const inert_case *c)
{
    static const char *const of_render[] = {"samples",    "depth",        "beyond",    "lighting",    "shadows",
                                            "min_weight", "paths",        "roulette",  "seed",        "radiance",
                                            "spectrum",   "polarisation", "lambda_nm", "wavelengths", "unit_m",
                                            "texturing",  "weights",      NULL};
    static const char *const of_sky[] = {"kind", "color", "horizon", "picture", "ambient", "absorb_per_m", NULL};
    static const char *const of_surface[] = {"ambient",      "diffuse",         "specular",      "shininess",
                                             "absorb_per_m", "absorb_spectrum", "tint_distance", NULL};
    switch (c->at.group) {
    case PARAM_LIGHT: return true;
    case PARAM_RENDER: return is_among(c, of_render);
    case PARAM_BACKGROUND: return is_among(c, of_sky);
    case PARAM_MATERIAL: return is_among(c, of_surface);
    case PARAM_SOLID: return c->at.row->group == PARAM_MATERIAL && is_among(c, of_surface);
    case PARAM_CAMERA:
    case PARAM_MESH:
    case PARAM_TEXTURE:
    case PARAM_GROUP_COUNT: break;
    }
    return false;
}

bool inert_layers(const inert_case *c)
{
    const char *word = integrator_with_layers();
    const bool given = integrator_of(&c->s->render)->layers;
    if (!given)
        return c->at.group == PARAM_RENDER && strcmp(c->at.row->name, "layer") == 0 && word &&
               inert_say(c, "layers-only", inert_set("render.integrator=%s", word).text,
                         "this render.integrator gives no layers");
    return is_of_light(c) && inert_say(c, "no-light", "set render.integrator=whitted",
                                       "the image shows a layer of what camera rays meet: no light is followed");
}
