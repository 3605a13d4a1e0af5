/* Motions: advance the slimes of a scene in time, as long as the scene's slimes are those that the motion was created
 * for. */
#include "engine/motion_private.h"

#include "geometry/shapes/shape.h"
#include "measure/clock.h"
#include "scene/model/params.h"
#include "scene/assets/slime.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double time_max_s = 86400; /* the maximum of the parameter time_s, which an advance sets in the scene */

void cuvette_motion_destroy(cuvette_motion *motion)
{
    if (!motion)
        return;
    scene_motion_destroy(motion->bodies); /* does not access the scene, which may have been destroyed */
    engine_release_scene(motion->of);
    free(motion->hands);
    free(motion);
}

/* The caller holds the scene. */
static status begin(cuvette_motion *m, diagnostic *why)
{
    m->of->grabbed = false;
    m->of->slimes_changed++; /* invalidates the previous motion of these slimes */
    m->slimes_changed = m->of->slimes_changed;
    pthread_mutex_lock(&m->of->loading);
    status code = scene_check(m->of->model, why);
    THEN(code, scene_motion_create(m->of->model, &m->bodies, why));
    pthread_mutex_unlock(&m->of->loading);
    if (code != STATUS_OK)
        return code;
    m->hands = calloc(scene_motion_count(m->bodies) * SOFTBODY_HANDS_MAX, sizeof *m->hands);
    return m->hands ? STATUS_OK : out_of_memory(why);
}

cuvette_status cuvette_motion_create(cuvette_scene *s, cuvette_motion **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(s);
    ENGINE_TRY(engine_begin_advance(s, why));
    cuvette_motion *m = calloc(1, sizeof *m);
    status code = m ? STATUS_OK : out_of_memory(&inner);
    if (m) {
        m->of = s;
        atomic_fetch_add(&s->owners, 1);
        code = begin(m, &inner);
    }
    engine_end_advance(s);
    if (code != STATUS_OK) {
        cuvette_motion_destroy(m);
        return engine_report(code, &inner, why);
    }
    *out = m;
    return CUVETTE_OK;
}

static status check_alive(const cuvette_motion *m, diagnostic *why)
{
    static const char remedy[] = "destroy it and create another one";
    if (!m->of->model)
        return diagnose(why, STATUS_BAD_INPUT, remedy, "the motion's scene is destroyed");
    if (m->of->slimes_changed != m->slimes_changed)
        return diagnose(
            why, STATUS_BAD_INPUT, remedy,
            "the motion is out of date: a slime was changed, a mesh was removed, or another motion was created");
    if (m->failed)
        return diagnose(why, STATUS_BAD_INPUT, remedy, "the motion ended because an advance failed");
    return STATUS_OK;
}

cuvette_status motion_is_alive(const cuvette_motion *m, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    return atomic_load(&m->of->advancing) ? engine_is_advancing(why)
                                          : engine_report(check_alive(m, &inner), &inner, why);
}

/* Checks that need no simulation: the motion stays valid if they fail. */
static status check_time(const cuvette_motion *m, double time_s, diagnostic *why)
{
    if (!(time_s >= m->time_s && time_s <= time_max_s))
        return diagnose(why, STATUS_BAD_INPUT, "give a time from the current one to 86400 s, or create another motion",
                        "the motion cannot advance from %g s to %g s", m->time_s, time_s);
    status code = STATUS_OK;
    for (size_t i = 0; i < scene_motion_count(m->bodies) && code == STATUS_OK; i++) {
        mesh_entry then = m->of->model->meshes[scene_motion_mesh(m->bodies, i)];
        then.time_s = time_s;
        code = slime_check(&then, why);
    }
    return code;
}

/* The time of the body that is furthest. */
static double reached_s(const cuvette_motion *m)
{
    double most = m->time_s;
    for (size_t i = 0; i < scene_motion_count(m->bodies); i++)
        most = fmax(most, softbody_measure(scene_motion_body(m->bodies, i)).time_s);
    return most;
}

static status advance(cuvette_motion *m, double time_s, const load_watch *watch, diagnostic *why)
{
    status code = STATUS_OK;
    pthread_mutex_lock(&m->of->loading);
    for (size_t i = 0; i < scene_motion_count(m->bodies) && code == STATUS_OK; i++)
        code = scene_motion_step_held(m->bodies, i, &m->hands[i * SOFTBODY_HANDS_MAX], time_s, watch, why);
    THEN(code, scene_motion_advance_until(m->bodies, time_s, true, watch, why));
    pthread_mutex_unlock(&m->of->loading);
    m->failed = code != STATUS_OK && code != STATUS_INTERRUPTED;
    m->time_s = code == STATUS_INTERRUPTED ? reached_s(m) : time_s;
    return code;
}

cuvette_status cuvette_motion_advance_watched(cuvette_motion *motion, double time_s,
                                              bool (*progress)(void *context, double share), void *context,
                                              cuvette_diagnostic *why)
{
    ENGINE_CALL(motion);
    host_progress asked = {.tell = progress, .context = context, .host = &host, .next_s = clock_wall_s() + 0.01};
    ENGINE_TRY(engine_begin_advance(motion->of, why));
    status code = check_alive(motion, &inner);
    THEN(code, check_time(motion, time_s, &inner));
    engine_begin_progress(&asked);
    THEN(code, advance(motion, time_s, &(load_watch){engine_show, &asked}, &inner));
    engine_end_progress(&asked);
    engine_end_advance(motion->of);
    return engine_report(code, &inner, why);
}

cuvette_status cuvette_motion_advance(cuvette_motion *motion, double time_s, cuvette_diagnostic *why)
{
    return cuvette_motion_advance_watched(motion, time_s, NULL, NULL, why);
}

size_t cuvette_motion_count(const cuvette_motion *motion)
{
    return motion && motion_is_alive(motion, NULL) == CUVETTE_OK ? scene_motion_count(motion->bodies) : 0;
}

const char *cuvette_motion_name(const cuvette_motion *motion, size_t index)
{
    return index < cuvette_motion_count(motion)
               ? motion->of->model->meshes[scene_motion_mesh(motion->bodies, index)].name
               : NULL;
}

status motion_find(const cuvette_motion *m, const char *name, size_t *index, int *solid_or_none, diagnostic *why)
{
    const scene *s = m->of->model;
    param_place at;
    TRY(param_place_find_object(s, name, &at, why));
    const bool is_solid = at.object_group == PARAM_SOLID && shape_of(&s->solids[at.index].shape)->triangles;
    const char *mesh_name = is_solid ? s->solids[at.index].mesh : name;
    *solid_or_none = is_solid ? (int)at.index : -1;
    for (size_t i = 0; (is_solid || at.object_group == PARAM_MESH) && i < scene_motion_count(m->bodies); i++)
        if (strcmp(s->meshes[scene_motion_mesh(m->bodies, i)].name, mesh_name) == 0) {
            *index = i;
            return STATUS_OK;
        }
    return diagnose(why, STATUS_BAD_INPUT, "name a slime's mesh, or a solid that uses one", "%.80s is not a slime",
                    name);
}

cuvette_status cuvette_motion_state(const cuvette_motion *motion, const char *name, cuvette_slime *out,
                                    cuvette_diagnostic *why)
{
    ENGINE_CALL(motion, name, out);
    ENGINE_TRY(motion_is_alive(motion, why));
    size_t i;
    int unused;
    const status code = motion_find(motion, name, &i, &unused, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    const softbody *body = scene_motion_body(motion->bodies, i);
    const softbody_quantities a = softbody_measure(body);
    cuvette_slime result = {.time_s = a.time_s,
                            .steps = a.steps,
                            .substeps = a.substeps,
                            .masses = softbody_mass_count(body),
                            .held = a.held,
                            .kinetic = a.kinetic,
                            .elastic = a.elastic,
                            .compression = a.compression,
                            .gravity = a.gravity,
                            .volume = a.volume,
                            .volume_at_rest = a.volume_at_rest,
                            .low = a.low,
                            .high = a.high,
                            .speed_max = a.speed_max};
    engine_put_vector(result.center, a.center);
    engine_put_vector(result.momentum, a.momentum);
    return engine_copy_struct(&result, sizeof result, out, why);
}
