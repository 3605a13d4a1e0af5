/* Prescriptions from files and scenes, and the solids that stand for them. */
#include "lens/lens.h"

#include "scene/lens/lens_prescription.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

/* The lens of a placement: light along the +y of its frame, fields of +y towards its -z, as files are placed. */
static void place_of(const scene *s, const lens_prescription *p, const lens_placement *at, lens_place *out)
{
    const mat3 turn = rotation_from_deg(at->rotation_deg);
    *out = (lens_place){.s = s,
                        .origin = at->position,
                        .across = mat3_apply(turn, vec3_make(1.0, 0.0, 0.0)),
                        .up = mat3_apply(turn, vec3_make(0.0, 0.0, -1.0)),
                        .along = mat3_apply(turn, vec3_make(0.0, 1.0, 0.0)),
                        .scale = at->scale / p->unit_mm};
}

/* Whether an index of the prescription is that of a catalogue, and so relative to air. */
static bool needs_air(const lens_prescription *p)
{
    bool needs = p->object_medium.kind == LENS_CATALOGUE || p->object_medium.kind == LENS_DATA;
    for (size_t i = 0; i < p->count; i++)
        needs |= p->surface[i].medium.kind == LENS_CATALOGUE || p->surface[i].medium.kind == LENS_DATA;
    return needs;
}

/* Rays are aimed at the stop's edge: it has no solid, and where it is the rim of an element, that is larger. */
static void without_stop(lens_prescription *p)
{
    if (p->stop >= 0 && (size_t)p->stop < p->count)
        p->surface[p->stop].diameter *= 1.02;
    p->stop = -1;
}

status lens_place_alone(const lens_prescription *p, const lens_glasses *glasses, scene **out, lens_place *place,
                        diagnostic *why)
{
    const lens_placement at = {.name = "lens", .scale = p->unit_mm, .glasses = glasses};
    lens_prescription bare = *p;
    *out = NULL;
    scene *s = scene_create();
    bare.surface = malloc(p->count * sizeof *bare.surface);
    if (!s || !bare.surface) {
        free(bare.surface);
        scene_destroy(s);
        return out_of_memory(why);
    }
    memcpy(bare.surface, p->surface, p->count * sizeof *bare.surface);
    without_stop(&bare);
    s->render.unit_m = 0.001;
    /* Otherwise surroundings of index 1 stand for air, and constant indices are used as they are. */
    status code = needs_air(p) ? scene_set(s, "background.medium", "air", why) : STATUS_OK;
    THEN(code, lens_add_to_scene(s, &bare, &at, why));
    THEN(code, scene_load(s, why));
    free(bare.surface);
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    place_of(s, p, &at, place);
    *out = s;
    return STATUS_OK;
}

status lens_place_in_scene(scene *s, const char *system, lens_prescription *p, lens_place *place, diagnostic *why)
{
    lens_placement at;
    TRY(lens_of_scene(s, system, p, &at, why));
    const int stop = at.name ? scene_find_solid(s, at.name) : -1;
    if (stop >= 0)
        s->solids[stop].visible = 0;
    place_of(s, p, &at, place);
    return STATUS_OK;
}

static status open_scene(const char *path, const char *system, lens_prescription *p, scene **out, lens_place *place,
                         diagnostic *why)
{
    scene *s = NULL;
    TRY(scene_read(path, &s, why));
    status code = scene_load(s, why);
    if (code == STATUS_OK)
        code = locate_failure(why, path, lens_place_in_scene(s, system, p, place, why));
    if (code == STATUS_OK)
        *out = s;
    else
        scene_destroy(s);
    return code;
}

status lens_open(const char *path, const char *system, const lens_glasses *glasses, lens_prescription *p, scene **s,
                 lens_place *place, diagnostic *why)
{
    *s = NULL;
    if (!lens_file_named(path))
        return open_scene(path, system, p, s, place, why);
    TRY(lens_file_read(path, glasses, p, why));
    return locate_failure(why, path, lens_place_alone(p, glasses, s, place, why));
}
