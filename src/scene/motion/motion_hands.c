/* Picks, grabs and moves slimes with the pointer (motion_hands.h). */
#include "scene/motion/motion_hands.h"
#include "base/cancel.h"
#include "measure/clock.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>

static vec3 multiply(vec3 a, vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

static vec3 divide(vec3 a, vec3 b)
{
    return vec3_make(a.x / b.x, a.y / b.y, a.z / b.z);
}

/* Cuts the interval of a ray by a slab, which is widened by slightly more than the rounding error. */
static void cut(double low, double high, double o, double d, double *enter, double *leave)
{
    const double slack = 1e-9 * (fabs(low) + fabs(high) + fabs(o));
    const double a = (low - slack - o) / d, b = (high + slack - o) / d;
    if (d != 0.0) {
        *enter = fmax(*enter, fmin(a, b));
        *leave = fmin(*leave, fmax(a, b));
    } else if (o < low - slack || o > high + slack) {
        *leave = -INFINITY;
    }
}

/* Whether the ray hits the box. The test skips most copies, of which there may be millions. */
static bool hits_box(bounds3 box, vec3 o, vec3 d)
{
    double enter = 0.0, leave = INFINITY;
    cut(box.low.x, box.high.x, o.x, d.x, &enter, &leave);
    cut(box.low.y, box.high.y, o.y, d.y, &enter, &leave);
    cut(box.low.z, box.high.z, o.z, d.z, &enter, &leave);
    return enter <= leave;
}

/* A pick in the frame of one solid. */
typedef struct search {
    const softbody *body;
    bounds3 box;
    const solid_shape *shape;
    size_t solid;
    vec3 origin, direction;
} search;

/* Keeps the nearer of the best hit and the hit of one copy. */
static void pick_copy(const search *q, vec3 copy, motion_place *best)
{
    const solid_shape *shape = q->shape;
    const vec3 o = divide(vec3_sub(q->origin, copy), shape->scale), d = divide(q->direction, shape->scale);
    vec3 met;
    if (!hits_box(q->box, o, d) || !softbody_pick(q->body, o, d, &met))
        return;
    const vec3 at = vec3_add(copy, multiply(met, shape->scale));
    const double distance = vec3_length(vec3_sub(at, q->origin)); /* the direction is a unit vector */
    if (distance < best->distance) {
        *best =
            (motion_place){.where = vec3_add(shape->position, mat3_apply(rotation_from_deg(shape->rotation_deg), at)),
                           .on_mesh = met,
                           .distance = distance,
                           .solid = q->solid};
    }
}

static void pick_copies(const search *q, motion_place *best)
{
    const vec3 copies = q->shape->copies;
    for (double z = 0.0; z < copies.z; z++) {
        for (double y = 0.0; y < copies.y; y++)
            for (double x = 0.0; x < copies.x; x++)
                pick_copy(q, multiply(vec3_make(x, y, z), q->shape->spacing), best);
    }
}

static bool is_wanted(const solid *one, const char *mesh_name, int solid_or_any, size_t index)
{
    const bool shows = solid_shows_mesh(one, mesh_name);
    return solid_or_any == MOTION_ANY_SOLID ? shows && one->visible : solid_or_any == (int)index;
}

status scene_motion_pick(const scene_motion *m, size_t i, int solid_or_any, vec3 origin, vec3 direction,
                         motion_place *out, diagnostic *why)
{
    *out = (motion_place){.distance = INFINITY};
    const scene *s = m->s;
    const mesh_entry *entry = motion_entry(m, &m->slimes[i]);
    for (size_t k = 0; k < s->solid_count; k++) {
        const solid_shape *shape = &s->solids[k].shape;
        if (!is_wanted(&s->solids[k], entry->name, solid_or_any, k))
            continue;
        TRY(solid_shape_check(shape, why));
        const mat3 rotation = rotation_from_deg(shape->rotation_deg);
        const search q = {.body = m->slimes[i].x.body,
                          .box = entry->data->bounds,
                          .shape = shape,
                          .solid = k,
                          .origin = mat3_apply_transposed(rotation, vec3_sub(origin, shape->position)),
                          .direction = mat3_apply_transposed(rotation, direction)};
        pick_copies(&q, out);
    }
    return STATUS_OK;
}

status scene_motion_grab(scene_motion *m, size_t i, const motion_place *place, double reach, motion_hand *hands,
                         int *number, diagnostic *why)
{
    const solid_shape *shape = &m->s->solids[place->solid].shape;
    const double largest = fmax(fabs(shape->scale.x), fmax(fabs(shape->scale.y), fabs(shape->scale.z)));
    const int hand = softbody_grab(m->slimes[i].x.body, place->on_mesh, reach / largest);
    if (hand == HAND_NO_MEMORY)
        return out_of_memory(why);
    if (hand < 0)
        return diagnose(why, STATUS_BAD_INPUT, "release one of them first",
                        "all hands are in use, or they hold all masses");
    hands[hand] = (motion_hand){.holds = true,
                                .rotation = rotation_from_deg(shape->rotation_deg),
                                .scale = shape->scale,
                                .where = place->on_mesh};
    *number = hand;
    return STATUS_OK;
}

void scene_motion_release(scene_motion *m, size_t i, motion_hand *hands, int number)
{
    softbody_release(m->slimes[i].x.body, number);
    hands[number] = (motion_hand){.holds = false};
}

vec3 motion_hand_offset(const motion_hand *h, vec3 by)
{
    return divide(mat3_apply_transposed(h->rotation, by), h->scale);
}

static bool is_moving(const motion_hand *h)
{
    return h->holds && (h->from.x != h->to.x || h->from.y != h->to.y || h->from.z != h->to.z);
}

/* The displacement at a fraction of the move, by the same arithmetic as for scripts. */
static vec3 offset_at(const motion_hand *h, double fraction)
{
    return fraction >= 1.0 ? h->to : vec3_add(h->from, vec3_scale(vec3_sub(h->to, h->from), fraction));
}

/* Moves the targets of the hands to a fraction of their displacement. */
static void move_hands(softbody *body, const motion_hand *hands, double fraction)
{
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++)
        if (is_moving(&hands[i]))
            softbody_hold(body, i, vec3_add(hands[i].where, offset_at(&hands[i], fraction)));
}

/* Reports progress about every 10 ms; *shown_s is the time of the last report. */
static void show(const load_watch *watch, double fraction, double *shown_s)
{
    const double show_s = 0.01, now_s = watch ? clock_wall_s() : 0.0;
    if (!watch || now_s - *shown_s < show_s)
        return;
    *shown_s = now_s;
    watch->progress(watch->context, fraction);
}

status scene_motion_step_held(scene_motion *m, size_t i, motion_hand *hands, double time_s, const load_watch *watch,
                              diagnostic *why)
{
    softbody *body = m->slimes[i].x.body;
    const mesh_entry *entry = motion_entry(m, &m->slimes[i]);
    const uint64_t begin = softbody_measure(body).steps, end = (uint64_t)floor(time_s / entry->slime.dt_s + 0.5);
    bool any = false;
    for (int k = 0; k < SOFTBODY_HANDS_MAX; k++)
        any |= is_moving(&hands[k]);
    diagnostic bad = {.line = 0};
    status code = STATUS_OK;
    double fraction = any ? 0.0 : 1.0, shown_s = clock_wall_s();
    for (uint64_t step = begin; any && step < end && code == STATUS_OK; step++) {
        fraction = (double)(step + 1 - begin) / (double)(end - begin);
        move_hands(body, hands, fraction);
        code = softbody_step(body, &bad);
        show(watch, fraction, &shown_s);
        if (code == STATUS_OK && step + 1 < end && cancel_asked())
            code = diagnose(&bad, STATUS_INTERRUPTED, "", "interrupted before %.6g s of simulated time", time_s);
    }
    for (int k = 0; k < SOFTBODY_HANDS_MAX && begin < end; k++)
        hands[k].from = offset_at(&hands[k], fraction);
    if (code == STATUS_OK)
        return code;
    diagnostic_locate(why, bad.file, bad.line, bad.column);
    return diagnose(why, code, bad.remedy, "%.80s: %s", entry->name, bad.what);
}
