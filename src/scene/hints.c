#include "scene/hints.h"
#include "scene/looks.h"
#include "scene/medium.h"

#include <math.h>
#include <stdio.h>

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

/* What a clear solid seems to lack. */
static void hint_at_clear(const scene *s, const solid *owner, const note_taker *taker)
{
    const material *m = &owner->surface;
    if (s->render.integrator == INTEGRATOR_ZBUFFER) {
        if (m->ambient == 0.0 && m->diffuse == 0.0) {
            note_give(taker, owner->name, "diffuse", "set its diffuse",
                      "%s is transparent, and the depth buffer draws its surface: black but for highlights", owner->name);
        }
    } else if (!scene_has_constant_shares(&s->render) && is_like_surroundings(s, m) && !material_tints(m) && m->reflectivity == 0.0 &&
               !is_inside_medium(s, owner)) {
        const bool seen = m->transparency < 1.0 || m->ambient > 0.0 || is_lit(m);
        note_give(taker, owner->name, "ior", "set its ior", "%s is transparent with the index of what is around it: it %s", owner->name,
                  seen ? "bends no light" : "is invisible");
    }
}

/* What the solid seems to lack. */
static void hint_at_solid(const scene *s, const solid *owner, const note_taker *taker)
{
    const material *m = &owner->surface;
    if (m->transparency > 0.0) {
        hint_at_clear(s, owner, taker);
    } else if (m->medium != MEDIUM_IOR || m->ior != 1.0) {
        note_give(taker, owner->name, m->medium == MEDIUM_IOR ? "ior" : "medium", "set its transparency",
                  "%s has a refractive index but is opaque", owner->name);
    } else if (m->ambient == 0.0 && m->reflectivity == 0.0 && !is_lit(m) && !looks_by_face(s, owner)) {
        note_give(taker, owner->name, "diffuse", "set its diffuse", "%s is neither transparent, nor diffuse, nor lit: it is black",
                  owner->name);
    }
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

static void hint_at_cover(const scene *s, const solid *hidden, const note_taker *taker)
{
    const solid *cover = find_cover(s, hidden);
    char remedy[NOTE_TEXT_MAX];
    if (cover) {
        snprintf(remedy, sizeof remedy, "give %s the higher priority", hidden->name);
        note_give(taker, hidden->name, "priority", remedy, "%s lies wholly inside %s, which wins there and hides it", hidden->name,
                  cover->name);
    }
}

/* A law that is used outside the wavelengths where its medium was measured. */
static void hint_at_range(const scene *s, const char *where, const char *name, const index_law *law, const note_taker *taker)
{
    static const char remedy[] = "keep to these wavelengths, or give coefficients that reach further";
    const bool spectral = s->render.spectrum == SPECTRUM_SPECTRAL;
    const double low_nm = spectral ? VISIBLE_LOW_NM : s->render.lambda_nm, high_nm = spectral ? VISIBLE_HIGH_NM : s->render.lambda_nm;
    if (dispersion_covers(&law->law, low_nm, high_nm)) {
        return;
    }
    if (law->law.kind == DISPERSION_TABLE) {
        note_give(taker, where, "coefficients", remedy, "its table of indices reaches from %g to %g nm only, and keeps its ends' indices beyond",
                  law->law.coefficient[0], law->law.coefficient[law->law.count - 2]);
    } else {
        note_give(taker, where, "medium", remedy, "%s was measured from %g to %g nm only, and is extrapolated beyond", name, law->law.low_nm,
                  law->law.high_nm);
    }
}

/* What is set and does nothing. */
static void hint_at_idle(const solid *owner, const note_taker *taker)
{
    const material *m = &owner->surface;
    if (m->transparency == 0.0 && material_absorbs(m)) {
        note_give(taker, owner->name, m->absorb_spectrum.count > 0 ? "absorb_spectrum" : "absorb_per_m", "set its transparency",
                  "%s absorbs but is opaque", owner->name);
    }
    if (m->coefficients.count > 0 && (m->medium == MEDIUM_IOR || m->medium >= MEDIUM_CATALOGUE)) {
        note_give(taker, owner->name, "coefficients", "set its medium to cauchy, sellmeier or table",
                  "%s has coefficients but no law for them", owner->name);
    }
}

static void hint_at_lights(const scene *s, const note_taker *taker)
{
    const bool path = s->render.integrator == INTEGRATOR_PATH;
    bool clear = false;
    for (size_t i = 0; i < s->solid_count; i++) {
        clear |= s->solids[i].visible && s->solids[i].surface.transparency > 0.0;
    }
    for (size_t i = 0; i < s->light_count; i++) {
        const light *lamp = &s->lights[i];
        if (lamp->radius > 0.0 && !path) {
            note_give(taker, lamp->name, "radius", "set render.integrator=path, where its radius shows", "%s is lit as a point", lamp->name);
        } else if (lamp->radius == 0.0 && path && clear && lamp->intensity > 0.0) {
            note_give(taker, lamp->name, "radius", "give it a radius and a reach",
                      "%s is a point, which random paths cannot find through clear solids: no caustics", lamp->name);
        }
    }
}

void scene_range_hints(const scene *s, const note_taker *taker)
{
    index_law law = surrounding_index_law(&s->background);
    hint_at_range(s, "background", surrounding_words[s->background.medium], &law, taker);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        if (one->visible && one->surface.transparency > 0.0 && material_index_law(&one->surface, "", &law, NULL) == STATUS_OK) {
            hint_at_range(s, one->name, medium_words[one->surface.medium], &law, taker);
        }
    }
}

void scene_hints(const scene *s, const note_taker *taker)
{
    size_t visible = 0, lit = 0;
    for (size_t i = 0; i < s->solid_count; i++) {
        visible += s->solids[i].visible != 0;
        lit += s->solids[i].visible && is_lit(&s->solids[i].surface);
    }
    if (visible == 0) {
        note_give(taker, "solids", NULL, "add solids:", "no visible solids: the picture shows the background alone");
    }
    if (lit > 0 && s->light_count == 0) {
        note_give(taker, "lights", NULL, "add lights:", "no lights: opaque surfaces are dark but for their ambient light");
    }
    hint_at_lights(s, taker);
    for (size_t i = 0; i < s->solid_count; i++) {
        if (s->solids[i].visible) {
            hint_at_solid(s, &s->solids[i], taker);
            hint_at_idle(&s->solids[i], taker);
            hint_at_cover(s, &s->solids[i], taker);
        }
    }
    scene_range_hints(s, taker);
}
