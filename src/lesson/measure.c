/* Measures the curve and the value of a lesson, and names the commands that print the same numbers. */
#include "base/number.h"
#include "base/text.h"
#include "job/job.h"
#include "lesson/lesson.h"
#include "measure/topology.h"
#include "render/inspect/beams.h"
#include "scene/assets/slime.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "softbody/trials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the metrics of lessons: those of `cuvette realism` and `cuvette motion`, and speedup (the time of a frame with
 * one thread, divided by the time with the scene's threads) --- */

typedef struct lesson_meter {
    const lesson *l;
    isa level;
    job *frames;         /* NULL before the first frame */
    double one_thread_s; /* time of a frame with one thread; 0 before it is measured */
} lesson_meter;

/* A metric in the lesson's unit; the tolerance of times is INFINITY. */
typedef struct lesson_value {
    double measured, theory, tolerance;
} lesson_value;

bool lesson_is_timed(const lesson *l)
{
    return l->metric && strcmp(l->metric, LESSON_SPEEDUP) == 0;
}

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

/* Measures a motion metric of the scene's first slime. */
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

/* The median time of FRAMES frames, after a frame that starts the threads. */
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

static status time_one_thread(lesson_meter *m, const scene *s, diagnostic *why)
{
    int workers;
    scene *copy = scene_clone(s);
    status code = copy ? scene_set(copy, "render.threads", "1", why) : out_of_memory(why);
    THEN(code, job_load(m->frames, copy, NULL, why));
    THEN(code, time_frame(m, copy, &m->one_thread_s, &workers, why));
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
    if (!(m->one_thread_s > 0.0))
        TRY(time_one_thread(m, s, why));
    if (scene_settings(s)->threads == 1) {
        *out = (lesson_value){1.0, 1.0, INFINITY};
        return STATUS_OK;
    }
    scene *copy = scene_clone(s);
    status code = copy ? job_load(m->frames, copy, NULL, why) : out_of_memory(why);
    THEN(code, time_frame(m, copy, &wall_s, &workers, why));
    scene_destroy(copy);
    *out = (lesson_value){m->one_thread_s / wall_s, fmin(workers, topology_pu_count(machine)), INFINITY};
    return code;
}

/* --- metrics of a beam, as NAME.image; their theory is a formula of the lesson ---
 *
 * NAME.image       distance from the beam's start to where the last parts of its two middle rays meet, or seem to;
 *                  image.x, .y, .z: that place
 * NAME.turn        angle between the first and the last direction of its first ray, degrees
 * NAME.incidence.K angle of incidence of the first ray at its K-th surface, degrees
 * NAME.share       fraction of the power of the first ray at the start of its last part
 * NAME.reflectance at the first surface */

typedef struct beam_reading {
    const scene *s;
    size_t name_length;
    const char *metric; /* with the name */
    vec3 start, origin[2], direction[2];
    int found; /* rays of these */
    double value;
} beam_reading;

static int strongest_child(const ray_tree *tree, int at)
{
    int best = RAY_NONE;
    for (int i = tree->node[at].first_child; i != RAY_NONE; i = tree->node[i].next)
        if (best == RAY_NONE || beam_fraction(&tree->node[i]) > beam_fraction(&tree->node[best]))
            best = i;
    return best;
}

/* Reads from the first ray; hits: 0, or the surface that is meant, from 1. */
static double read_first(const ray_tree *tree, const char *what, int surface)
{
    const ray_node *now = tree->node, *first = now;
    int at = 0, met = 0;
    for (int child; now->end == RAY_END_HIT; now = &tree->node[at = child]) {
        if (++met == surface && strncmp(what, "incidence", 9) == 0)
            return acos(fmin(now->hit.cos_i, 1.0)) * 180.0 / M_PI;
        if ((child = strongest_child(tree, at)) == RAY_NONE)
            break;
    }
    if (strcmp(what, "reflectance") == 0)
        return first->end == RAY_END_HIT ? first->hit.R : NAN;
    if (strcmp(what, "share") == 0)
        return beam_fraction(now) / beam_fraction(first);
    const vec3 across = vec3_cross(first->direction, now->direction);
    return strcmp(what, "turn") == 0
               ? atan2(vec3_length(across), vec3_dot(first->direction, now->direction)) * 180.0 / M_PI
               : NAN;
}

static status read_ray(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    (void)p, (void)why;
    beam_reading *b = context;
    const char *name = b->s->beams[ray->beam].name, *what = b->metric + b->name_length + 1;
    const int middle = (ray->rays - 1) / 2;
    if (strlen(name) != b->name_length || strncmp(name, b->metric, b->name_length) != 0 || ray->field)
        return STATUS_OK;
    if (ray->number == 0) {
        b->start = tree->node[0].origin;
        b->value = read_first(tree, what, strncmp(what, "incidence.", 10) == 0 ? atoi(what + 10) : 0);
    }
    if (b->found < 2 && (ray->number == middle || ray->number == middle + 1)) {
        int last = 0;
        for (int child; (child = strongest_child(tree, last)) != RAY_NONE;)
            last = child;
        b->origin[b->found] = tree->node[last].origin;
        b->direction[b->found++] = tree->node[last].direction;
    }
    return STATUS_OK;
}

/* The point of the first line that is nearest to the second one. */
static vec3 meeting_point(const beam_reading *b)
{
    const vec3 normal = vec3_cross(b->direction[0], b->direction[1]), apart = vec3_sub(b->origin[1], b->origin[0]);
    const double t = vec3_dot(vec3_cross(apart, b->direction[1]), normal) / vec3_dot(normal, normal);
    return vec3_add(b->origin[0], vec3_scale(b->direction[0], t));
}

static status read_beam(const lesson *l, const scene *s, isa level, lesson_value *out, diagnostic *why)
{
    beam_reading b = {.s = s, .name_length = strcspn(l->metric, "."), .metric = l->metric, .value = NAN};
    const char *what = l->metric[b.name_length] ? l->metric + b.name_length + 1 : "";
    if (!what[0])
        return diagnose(why, STATUS_BAD_INPUT, "write NAME.image, .turn, .incidence.1, .share or .reflectance",
                        "'%.64s' is not a metric of a beam", l->metric);
    scene *loaded = scene_clone(s);
    status code = loaded ? scene_load(loaded, why) : out_of_memory(why);
    if (code == STATUS_OK)
        b.s = loaded, code = beams_each_ray(loaded, level, 0, read_ray, &b, why);
    const bool meets = strncmp(what, "image", 5) == 0 && b.found == 2;
    if (code == STATUS_OK && meets) {
        const vec3 at = meeting_point(&b);
        b.value = what[5] != '.'   ? vec3_length(vec3_sub(at, b.start))
                  : what[6] == 'x' ? at.x
                  : what[6] == 'y' ? at.y
                                   : at.z;
    }
    scene_destroy(loaded);
    THEN(code, lesson_formula(l, s, NAN, l->theory, &out->theory, why));
    out->measured = b.value;
    out->tolerance = l->tolerance;
    if (code == STATUS_OK && isnan(b.value) && !b.found)
        return diagnose(why, STATUS_BAD_INPUT, "name a visible beam of the lesson", "there is no beam for '%.64s'",
                        l->metric);
    return code;
}

static status lesson_metric(lesson_meter *m, const scene *s, lesson_value *out, diagnostic *why)
{
    if (lesson_is_timed(m->l))
        return read_speedup(m, s, out, why);
    if (m->l->theory)
        return read_beam(m->l, s, m->level, out, why);
    return softbody_has_trial(m->l->metric) ? read_motion(m->l, s, m->level, out, why)
                                            : read_realism(m->l, s, m->level, out, why);
}

static void lesson_meter_release(lesson_meter *m)
{
    job_destroy(m->frames);
    m->frames = NULL;
}

/* --- curves --- */

enum { STEPS = 25 }; /* points of a curve over a control with a range */

/* Reads the value from the curve's point nearest to x = `at`. */
static void read_point(const lesson *l, lesson_result *out)
{
    double nearest = INFINITY;
    out->tolerance = l->tolerance;
    for (int i = 0; i < out->points.count; i++) {
        const realism_point *p = &out->points.at[i];
        if (fabs(p->x - l->at) >= nearest)
            continue;
        nearest = fabs(p->x - l->at);
        out->measured = p->measured;
        out->theory = p->theory;
    }
}

/* The i-th value of the control on the x axis; false after the last. */
static bool value_at(const lesson_control *c, int i, char text[NUMBER_TEXT_MAX], double *x)
{
    if (i >= (c->choice_count ? c->choice_count : STEPS))
        return false;
    *x = c->from + (c->to - c->from) * i / (STEPS - 1);
    if (c->choice_count)
        number_parse_real(c->choices[i], x);
    number_format(*x, text);
    return true;
}

static status sweep_control(lesson_meter *m, const scene *s, realism_points *out, diagnostic *why)
{
    const lesson_control *c = &m->l->control[m->l->over];
    char text[NUMBER_TEXT_MAX];
    double x;
    scene *copy = scene_clone(s);
    status code = copy ? STATUS_OK : out_of_memory(why);
    out->count = 0;
    for (int i = 0; code == STATUS_OK && value_at(c, i, text, &x); i++) {
        lesson_value v = {NAN, NAN, NAN};
        code = scene_set(copy, c->parameter, text, why);
        if (c->with)
            THEN(code, scene_set(copy, c->with, text, why));
        THEN(code, lesson_metric(m, copy, &v, why));
        out->at[out->count++] = (realism_point){x, v.measured, v.theory};
    }
    scene_destroy(copy);
    return code;
}

/* The curve's point at the control's present value. A time is read from it: a second measurement would differ. */
static const realism_point *point_of_now(const lesson *l, const scene *s, const realism_points *points)
{
    char *text = NULL;
    double now = NAN;
    if (l->over >= 0 && scene_get(s, l->control[l->over].parameter, &text, NULL) == STATUS_OK)
        number_parse_real(text, &now);
    free(text);
    for (int i = 0; i < points->count; i++)
        if (points->at[i].x == now)
            return &points->at[i];
    return NULL;
}

static status read_value(lesson_meter *m, const scene *s, lesson_result *out, diagnostic *why)
{
    const realism_point *known = lesson_is_timed(m->l) ? point_of_now(m->l, s, &out->points) : NULL;
    lesson_value v = {NAN, NAN, NAN};
    if (known)
        v = (lesson_value){known->measured, known->theory, INFINITY};
    else
        TRY(lesson_metric(m, s, &v, why));
    out->measured = v.measured;
    out->theory = v.theory;
    out->tolerance = v.tolerance;
    return STATUS_OK;
}

/* The lesson's values, what the pupil should have measured by hand, and the right choice, in this scene. */
static status follow_formulas(const lesson *l, const scene *s, lesson_result *out, diagnostic *why)
{
    double which = l->right + 1.0;
    out->truth = NAN;
    TRY(lesson_values(l, s, out->theory, out->values, why));
    if (l->hand.tool != LESSON_NO_TOOL)
        TRY(lesson_formula(l, s, out->theory, l->hand.truth, &out->truth, why));
    if (l->which)
        TRY(lesson_formula(l, s, out->theory, l->which, &which, why));
    out->right = which >= 1.0 && which <= l->choice_count ? (int)which - 1 : l->right;
    return STATUS_OK;
}

status lesson_measure(const lesson *l, const scene *s, isa level, lesson_result *out, diagnostic *why)
{
    lesson_meter m = {.l = l, .level = level};
    *out = (lesson_result){.measured = NAN, .theory = NAN};
    status code = l->over < 0 ? realism_measure_curve(s, level, l->curve, &out->points, why)
                              : sweep_control(&m, s, &out->points, why);
    for (int i = 0; i < out->points.count; i++) {
        const double error = fabs(out->points.at[i].measured - out->points.at[i].theory);
        out->error = error <= out->error ? out->error : error; /* a NaN stays */
    }
    if (l->metric)
        THEN(code, read_value(&m, s, out, why));
    else
        read_point(l, out);
    lesson_meter_release(&m);
    THEN(code, follow_formulas(l, s, out, why));
    out->passes =
        out->error <= l->tolerance && (isnan(out->theory) || fabs(out->measured - out->theory) <= out->tolerance);
    return code;
}

status lesson_check(const lesson *l, isa level, lesson_result *out, diagnostic *why)
{
    status code = lesson_measure(l, l->start, level, out, why);
    if (code == STATUS_OK && !out->passes)
        code = diagnose(why, STATUS_BAD_INPUT, "correct the scene, or raise the tolerance",
                        "the largest error of the curve is %.2g, and %.10g was read instead of %.10g", out->error,
                        out->measured, out->theory);
    if (code != STATUS_OK)
        diagnostic_locate(why, l->path, l->line, l->column);
    return code;
}

/* The command without --set: for the curve, or for the metric. */
static char *command_of(const lesson *l, bool curve)
{
    if (curve)
        return text_format("cuvette realism %s --curve %s", l->scene_path, realism_curve_name(l->curve));
    if (lesson_is_timed(l))
        return text_format("cuvette render %s --json -o frame.png", l->scene_path);
    return text_format("cuvette %s %s", softbody_has_trial(l->metric) ? "motion" : "realism", l->scene_path);
}

char *lesson_command(const lesson *l, bool curve)
{
    char *text = command_of(l, curve);
    for (size_t i = 0; text && i < l->setting_count; i++) {
        char *longer = text_format("%s --set %s", text, l->setting[i]);
        free(text);
        text = longer;
    }
    return text;
}

char *lesson_x_label(const lesson *l)
{
    return strdup(l->over < 0 ? realism_curve_x(l->curve) : l->control[l->over].label);
}

char *lesson_y_label(const lesson *l)
{
    if (l->over < 0)
        return strdup(realism_curve_y(l->curve));
    return text_format(l->unit[0] ? "%s, %s" : "%s", l->reading, l->unit);
}
