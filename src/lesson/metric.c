/* A metric of a lesson at one state of its scene: of optics, of the motion of a slime, or the speed-up by threads. */
#include "lesson/metric.h"

#include "measure/topology.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "scene/model/slime.h"
#include "softbody/trials.h"
#include <math.h>
#include <string.h>

enum { FRAMES = 3 };
#define FRAME_LIMIT_S 5.0

static status read_realism(const lesson *l, const scene *s, isa level, lesson_value *out, diagnostic *why)
{
    realism_value v;
    TRY(realism_measure_one(s, level, l->metric, &v, why));
    const double factor = strcmp(v.unit, "rad") == 0 && strcmp(l->unit, "deg") == 0 ? 180.0 / M_PI : 1.0;
    *out = (lesson_value){v.measured * factor, v.theory * factor, v.tolerance * factor};
    return STATUS_OK;
}

/* Of the scene's first slime. */
static status read_motion(const lesson *l, const scene *s, isa level, lesson_value *out, diagnostic *why)
{
    for (size_t i = 0; i < s->mesh_count; i++) {
        if (s->meshes[i].source != MESH_SLIME)
            continue;
        const softbody_settings settings = slime_settings(&s->meshes[i]);
        softbody_trial t;
        TRY(softbody_trial_one(&settings, level, l->metric, &t, why));
        *out = (lesson_value){t.measured, t.theory, l->tolerance};
        return STATUS_OK;
    }
    return diagnose(why, STATUS_BAD_INPUT, "add a mesh with 'generate: slime'", "nothing moves in this scene");
}

/* Median of FRAMES frames, after one that starts the threads. */
static status time_frame(lesson_meter *m, const scene *s, double *wall_s, int *workers, diagnostic *why)
{
    job_account first, timed = {.result = NULL};
    status code = job_render(m->frames, s, NULL, &first, why);
    job_account_release(&first);
    THEN(code, job_repeat(m->frames, s, FRAMES, NULL, &timed, why));
    if (code == STATUS_OK) {
        *wall_s = job_account_wall_s(&timed);
        *workers = timed.result->worker_count;
    }
    job_account_release(&timed);
    return code;
}

static status time_alone(lesson_meter *m, const scene *s, diagnostic *why)
{
    int one;
    scene *copy = scene_clone(s);
    status code = copy ? scene_set(copy, "render.threads", "1", why) : out_of_memory(why);
    THEN(code, job_load(m->frames, copy, NULL, why));
    THEN(code, time_frame(m, copy, &m->alone_s, &one, why));
    scene_destroy(copy);
    return code;
}

static status read_speedup(lesson_meter *m, const scene *s, lesson_value *out, diagnostic *why)
{
    const topology *machine = NULL;
    const job_settings settings = {.level = &m->level, .time_s = FRAME_LIMIT_S};
    double wall_s = NAN;
    int workers = 1;
    if (!m->frames)
        TRY(job_create(&settings, &m->frames, why));
    TRY(job_machine(m->frames, &machine, why));
    if (!(m->alone_s > 0.0))
        TRY(time_alone(m, s, why));
    if (scene_settings(s)->threads == 1) {
        *out = (lesson_value){1.0, 1.0, INFINITY};
        return STATUS_OK;
    }
    scene *copy = scene_clone(s);
    status code = copy ? job_load(m->frames, copy, NULL, why) : out_of_memory(why);
    THEN(code, time_frame(m, copy, &wall_s, &workers, why));
    scene_destroy(copy);
    *out = (lesson_value){m->alone_s / wall_s, fmin(workers, topology_pu_count(machine)), INFINITY};
    return code;
}

status lesson_metric(lesson_meter *m, const scene *s, lesson_value *out, diagnostic *why)
{
    if (lesson_is_timed(m->l))
        return read_speedup(m, s, out, why);
    return softbody_has_trial(m->l->metric) ? read_motion(m->l, s, m->level, out, why)
                                            : read_realism(m->l, s, m->level, out, why);
}

void lesson_meter_release(lesson_meter *m)
{
    job_destroy(m->frames);
    m->frames = NULL;
}
