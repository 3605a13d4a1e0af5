#include "scene/hints.h"
#include "scene/looks.h"
#include "scene/medium.h"

#include <math.h>
#include <stdio.h>

enum { HINT_MAX = 256 };

static bool is_lit(const material *m)
{
    return m->diffuse > 0.0 || m->specular > 0.0;
}

static bool is_like_surroundings(const scene *s, const material *m)
{
    index_law own, around = surrounding_index_law(&s->background);
    return material_index_law(m, "", &own, NULL) == STATUS_OK &&
           index_law_at(&own, s->render.lambda_nm) == index_law_at(&around, s->render.lambda_nm);
}

/* Does another medium hold the solid, so that one of the air's index is a bubble? Its position says so: the centre, or
 * that of the base. */
static bool is_inside_medium(const scene *s, const solid *bubble)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *other = &s->solids[i];
        if (other != bubble && other->visible && other->surface.transparency > 0.0 && !is_like_surroundings(s, &other->surface) &&
            solid_shape_contains(&other->shape, bubble->shape.position)) {
            return true;
        }
    }
    return false;
}

/* What the solid seems to lack, or NULL; text is room for it. */
static const char *solid_hint(const scene *s, const solid *owner, char text[HINT_MAX])
{
    const material *m = &owner->surface;
    const char *problem = NULL;
    if (m->transparency > 0.0 && s->render.integrator == INTEGRATOR_ZBUFFER) {
        if (m->ambient == 0.0 && m->diffuse == 0.0) {
            problem = "is transparent, and the depth buffer draws its surface: black but for highlights; set its diffuse";
        }
    } else if (m->transparency > 0.0) {
        if (!scene_has_constant_shares(&s->render) && is_like_surroundings(s, m) && !material_tints(m) && m->reflectivity == 0.0 &&
            !is_inside_medium(s, owner)) {
            problem = m->transparency < 1.0 || m->ambient > 0.0 || is_lit(m)
                          ? "is transparent with the index of what is around it: it bends no light; set its ior"
                          : "is transparent with the index of what is around it: it is invisible; set its ior";
        }
    } else if (m->medium != MEDIUM_IOR || m->ior != 1.0) {
        problem = "has a refractive index but is opaque; set its transparency";
    } else if (m->ambient == 0.0 && m->reflectivity == 0.0 && !is_lit(m) && !looks_by_face(s, owner)) {
        problem = "is neither transparent, nor diffuse, nor lit: it is black; set its diffuse";
    }
    if (problem) {
        snprintf(text, HINT_MAX, "%s %s", owner->name, problem);
    }
    return problem ? text : NULL;
}

/* A radius about the position that the solid does not reach beyond. */
static double reach(const solid_shape *shape)
{
    switch (shape->kind) {
    case SHAPE_CYLINDER: return hypot(shape->radius * fmax(1.0, 1.0 / shape->m), shape->height);
    case SHAPE_CUP: return hypot(shape->radius, shape->height);
    case SHAPE_BOX: return 0.5 * vec3_length(shape->size);
    case SHAPE_SPHERE: return shape->radius;
    case SHAPE_MESH:
    case SHAPE_PLANE:
    case SHAPE_COUNT: break;
    }
    return INFINITY;
}

/* Both of one scene. */
static bool wins(const solid *winner, const solid *loser)
{
    return winner != loser && winner->visible &&
           (winner->priority > loser->priority || (winner->priority == loser->priority && winner < loser));
}

/* The solid that holds all of another and wins there, so that nothing of the other is met; NULL if there is none. Looks at
 * points of a grid, turned so that no face of a box lies along it, and says nothing when too few of them are inside. */
static const solid *find_cover(const scene *s, const solid *hidden)
{
    enum { STEPS = 24, ENOUGH = 20 };
    const double radius = reach(&hidden->shape);
    const mat3 turn = rotation_from_deg(vec3_make(11.0, 23.0, 37.0));
    const solid *cover = NULL;
    size_t inside = 0;
    for (int i = 0; i < STEPS * STEPS * STEPS && isfinite(radius); i++) {
        const double u = (i % STEPS + 0.5) / STEPS, v = (i / STEPS % STEPS + 0.5) / STEPS,
                     w = (i / STEPS / STEPS + 0.5) / STEPS;
        const vec3 offset = mat3_apply(turn, vec3_make(2 * u - 1, 2 * v - 1, 2 * w - 1));
        const vec3 point = vec3_add(hidden->shape.position, vec3_scale(offset, radius));
        if (!solid_shape_contains(&hidden->shape, point)) {
            continue;
        }
        inside++;
        for (size_t k = 0; !cover && k < s->solid_count; k++) {
            if (wins(&s->solids[k], hidden) && solid_shape_contains(&s->solids[k].shape, point)) {
                cover = &s->solids[k];
            }
        }
        if (!cover || !solid_shape_contains(&cover->shape, point)) {
            return NULL;
        }
    }
    return inside >= ENOUGH ? cover : NULL;
}

static void hint_at_cover(const scene *s, const solid *hidden, void (*note)(void *context, const char *text), void *context)
{
    const solid *cover = find_cover(s, hidden);
    if (cover) {
        char text[HINT_MAX];
        snprintf(text, HINT_MAX, "%s lies wholly inside %s, which wins there and hides it; give %s the higher priority",
                 hidden->name, cover->name, hidden->name);
        note(context, text);
    }
}

/* A law that is used outside the wavelengths where its medium was measured. */
static void hint_at_range(const scene *s, const char *where, const char *name, const index_law *law,
                          void (*note)(void *context, const char *text), void *context)
{
    const bool spectral = s->render.spectrum == SPECTRUM_SPECTRAL;
    const double low_nm = spectral ? VISIBLE_LOW_NM : s->render.lambda_nm, high_nm = spectral ? VISIBLE_HIGH_NM : s->render.lambda_nm;
    if (dispersion_covers(&law->law, low_nm, high_nm)) {
        return;
    }
    char text[HINT_MAX];
    if (law->law.kind == DISPERSION_TABLE) {
        snprintf(text, HINT_MAX, "%s: its table of indices reaches from %g to %g nm only, and keeps its ends' indices beyond", where,
                 law->law.coefficient[0], law->law.coefficient[law->law.count - 2]);
    } else {
        snprintf(text, HINT_MAX, "%s: %s was measured from %g to %g nm only, and is extrapolated beyond", where, name, law->law.low_nm,
                 law->law.high_nm);
    }
    note(context, text);
}

/* What is set and does nothing. */
static void hint_at_idle(const solid *owner, void (*note)(void *context, const char *text), void *context)
{
    const material *m = &owner->surface;
    char text[HINT_MAX];
    if (m->transparency == 0.0 && material_absorbs(m)) {
        snprintf(text, HINT_MAX, "%s absorbs but is opaque; set its transparency", owner->name);
        note(context, text);
    }
    if (m->coefficients.count > 0 && (m->medium == MEDIUM_IOR || m->medium >= MEDIUM_CATALOGUE)) {
        snprintf(text, HINT_MAX, "%s has coefficients but no law for them; set its medium to cauchy, sellmeier or table", owner->name);
        note(context, text);
    }
}

static void hint_at_lights(const scene *s, void (*note)(void *context, const char *text), void *context)
{
    const bool path = s->render.integrator == INTEGRATOR_PATH;
    bool clear = false;
    char text[HINT_MAX];
    for (size_t i = 0; i < s->solid_count; i++) {
        clear |= s->solids[i].visible && s->solids[i].surface.transparency > 0.0;
    }
    for (size_t i = 0; i < s->light_count; i++) {
        const light *lamp = &s->lights[i];
        if (lamp->radius > 0.0 && !path) {
            snprintf(text, HINT_MAX, "%s is lit as a point: its radius shows with render.integrator=path", lamp->name);
            note(context, text);
        } else if (lamp->radius == 0.0 && path && clear && lamp->intensity > 0.0) {
            snprintf(text, HINT_MAX, "%s is a point, which random paths cannot find through clear solids: no caustics; give it a radius "
                                     "and a reach", lamp->name);
            note(context, text);
        }
    }
}

void scene_range_hints(const scene *s, void (*note)(void *context, const char *text), void *context)
{
    index_law law = surrounding_index_law(&s->background);
    hint_at_range(s, "background", surrounding_words[s->background.medium], &law, note, context);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one->visible && one->surface.transparency > 0.0 && material_index_law(&one->surface, "", &law, NULL) == STATUS_OK) {
            hint_at_range(s, one->name, medium_words[one->surface.medium], &law, note, context);
        }
    }
}

void scene_hints(const scene *s, void (*note)(void *context, const char *text), void *context)
{
    size_t visible = 0, lit = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        visible += s->solids[i].visible != 0;
        lit += s->solids[i].visible && is_lit(&s->solids[i].surface);
    }
    if (visible == 0) {
        note(context, "no visible solids: the picture shows the background alone; add solids:");
    }
    if (lit > 0 && s->light_count == 0) {
        note(context, "no lights: opaque surfaces are dark but for their ambient light; add lights:");
    }
    hint_at_lights(s, note, context);
    for (size_t i = 0; i < s->solid_count; i++) {
        char text[HINT_MAX];
        const char *hint = s->solids[i].visible ? solid_hint(s, &s->solids[i], text) : NULL;
        if (hint) {
            note(context, hint);
        }
        if (s->solids[i].visible) {
            hint_at_idle(&s->solids[i], note, context);
            hint_at_cover(s, &s->solids[i], note, context);
        }
    }
    scene_range_hints(s, note, context);
}
