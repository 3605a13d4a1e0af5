/* Motions advance the slimes of a scene in time, until a change of the scene's slimes invalidates them, and move the
 * hands that hold slimes (scene/motion/motion_hands.h). */
#include "engine/engine_private.h"
#include "geometry/shapes/shape.h"
#include "measure/clock.h"
#include "scene/assets/slime.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "scene/motion/motion_hands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cuvette_motion {
    cuvette_scene *of;
    scene_motion *bodies;
    uint64_t slimes_changed; /* the scene's value when this motion was created */
    bool failed;             /* an advance failed: the state of the bodies is invalid */
    double time_s;
    motion_hand *hands; /* SOFTBODY_HANDS_MAX per slime */
};

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

/* The caller has begun an advance of the scene. */
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

/* CUVETTE_OK when the motion is valid and no advance is in progress. */
static cuvette_status motion_is_alive(const cuvette_motion *m, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    return atomic_load(&m->of->advancing) ? engine_is_advancing(why)
                                          : engine_report(check_alive(m, &inner), &inner, why);
}

/* Checks that need no simulation: the motion stays valid if they fail. */
static status check_time(const cuvette_motion *m, double time_s, diagnostic *why)
{
    if (!(time_s >= m->time_s && time_s <= time_max_s))
        return diagnose(why, STATUS_BAD_INPUT, "use a time from the current one to 86400 s, or create another motion",
                        "the motion cannot advance from %g s to %g s", m->time_s, time_s);
    status code = STATUS_OK;
    for (size_t i = 0; i < scene_motion_count(m->bodies) && code == STATUS_OK; i++) {
        mesh_entry then = m->of->model->meshes[scene_motion_mesh(m->bodies, i)];
        then.time_s = time_s;
        code = slime_check(&then, why);
    }
    return code;
}

/* The time that the furthest body has reached. */
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
                                              bool (*progress)(void *context, double fraction), void *context,
                                              cuvette_diagnostic *why)
{
    ENGINE_CALL(motion);
    host_progress report = {.callback = progress, .context = context, .host = &host, .next_s = clock_wall_s() + 0.01};
    ENGINE_TRY(engine_begin_advance(motion->of, why));
    status code = check_alive(motion, &inner);
    THEN(code, check_time(motion, time_s, &inner));
    engine_begin_progress(&report);
    THEN(code, advance(motion, time_s, &(load_watch){engine_report_if_due, &report}, &inner));
    engine_end_progress(&report);
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

/* Finds the slime of the mesh, or of the solid, with that name. *solid_or_none is set to the solid's index, or -1 for a
 * mesh. */
static status motion_find(const cuvette_motion *m, const char *name, size_t *index, int *solid_or_none, diagnostic *why)
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

/* --- hands --- */

/* Finds the solid on which the ray hits the slime of that name; best->distance is infinite on a miss. */
static status pick(const cuvette_motion *m, const char *name, const cuvette_ray *ray, size_t *body, motion_place *best,
                   diagnostic *why)
{
    int only;
    status code = motion_find(m, name, body, &only, why);
    THEN(code, engine_check_ray(NULL, ray, 0, why));
    THEN(code, scene_motion_pick(m->bodies, *body, only < 0 ? MOTION_ANY_SOLID : only, engine_vector(ray->origin),
                                 engine_unit(ray->direction), best, why));
    if (code == STATUS_OK && ray->reach > 0.0 && best->distance > ray->reach)
        best->distance = INFINITY;
    return code;
}

static void report_point(const motion_place *found, double *where)
{
    if (where && isfinite(found->distance))
        where[0] = found->where.x, where[1] = found->where.y, where[2] = found->where.z;
}

cuvette_status cuvette_motion_pick(const cuvette_motion *motion, const char *name, const cuvette_ray *ray,
                                   double *where, double *distance, cuvette_diagnostic *why)
{
    ENGINE_CALL(motion, name, ray, distance);
    ENGINE_TRY(motion_is_alive(motion, why));
    size_t body;
    motion_place found;
    const status code = pick(motion, name, ray, &body, &found, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    report_point(&found, where);
    *distance = found.distance;
    return CUVETTE_OK;
}

cuvette_status cuvette_motion_grab(cuvette_motion *motion, const char *name, const cuvette_ray *ray, double reach,
                                   int *hand, double *where, cuvette_diagnostic *why)
{
    ENGINE_CALL(motion, name, ray, hand);
    ENGINE_TRY(motion_is_alive(motion, why));
    size_t body;
    motion_place found;
    int number = CUVETTE_NO_HAND;
    status code = STATUS_OK;
    if (!(reach > 0.0 && isfinite(reach)))
        code = diagnose(&inner, STATUS_BAD_INPUT, "use a length above 0", "a hand's reach cannot be %g", reach);
    THEN(code, pick(motion, name, ray, &body, &found, &inner));
    if (code == STATUS_OK && isfinite(found.distance))
        code = scene_motion_grab(motion->bodies, body, &found, reach, &motion->hands[body * SOFTBODY_HANDS_MAX],
                                 &number, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    report_point(&found, where);
    motion->of->grabbed |= number >= 0;
    *hand = number < 0 ? CUVETTE_NO_HAND : (int)body * SOFTBODY_HANDS_MAX + number;
    return CUVETTE_OK;
}

/* The hand of that number, which must hold something. */
static cuvette_status find_hand(cuvette_motion *m, int number, motion_hand **out, cuvette_diagnostic *why)
{
    ENGINE_TRY(motion_is_alive(m, why));
    diagnostic inner = {.line = 0};
    const bool is_one = number >= 0 && (size_t)number < scene_motion_count(m->bodies) * SOFTBODY_HANDS_MAX;
    const bool holds = is_one && m->hands[number].holds;
    if (holds)
        *out = &m->hands[number];
    else
        diagnose(&inner, STATUS_BAD_INPUT, "pass a hand number returned by cuvette_motion_grab",
                 "hand %d holds nothing", number);
    return engine_report(holds ? STATUS_OK : STATUS_BAD_INPUT, &inner, why);
}

cuvette_status cuvette_motion_move(cuvette_motion *motion, int hand, const double *by, cuvette_diagnostic *why)
{
    ENGINE_CALL(motion, by);
    motion_hand *h = NULL;
    ENGINE_TRY(find_hand(motion, hand, &h, why));
    if (!engine_is_finite(by))
        return engine_report(
            diagnose(&inner, STATUS_BAD_INPUT, "use three finite numbers", "the hand's displacement is not finite"),
            &inner, why);
    h->to = motion_hand_offset(h, engine_vector(by));
    return CUVETTE_OK;
}

cuvette_status cuvette_motion_release(cuvette_motion *motion, int hand, cuvette_diagnostic *why)
{
    ENGINE_CALL(motion);
    motion_hand *h = NULL;
    ENGINE_TRY(find_hand(motion, hand, &h, why));
    const size_t body = (size_t)hand / SOFTBODY_HANDS_MAX;
    scene_motion_release(motion->bodies, body, &motion->hands[body * SOFTBODY_HANDS_MAX], hand % SOFTBODY_HANDS_MAX);
    return CUVETTE_OK;
}
