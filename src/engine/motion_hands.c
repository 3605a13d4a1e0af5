/* Hands of the caller's. A ray of the world is taken into a slime's frame: x of the mesh stands at p + R (s x + c), with the solid's position p,
 * rotation R and scale s, and c where a copy begins; distances along the ray, as multiples of its direction, are the same in both. */
#include "engine/motion_private.h"

#include <math.h>
#include <string.h>

typedef struct grasp {
    vec3 where;       /* of the world */
    vec3 on_mesh;     /* the same place in the mesh's frame */
    double distance;  /* infinite: missed */
    const solid_shape *shape; /* whose */
} grasp;

static vec3 times(vec3 a, vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

static vec3 over(vec3 a, vec3 b)
{
    return vec3_make(a.x / b.x, a.y / b.y, a.z / b.z);
}

static vec3 vector_of(const double *v)
{
    return vec3_make(v[0], v[1], v[2]);
}

static bool is_finite(const double *v)
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static status check_ray(const cuvette_ray *ray, diagnostic *why)
{
    const double *o = ray->origin, *d = ray->direction, far_origin = 1e6;
    if (!(fabs(o[0]) <= far_origin && fabs(o[1]) <= far_origin && fabs(o[2]) <= far_origin))
        return diagnose(why, STATUS_BAD_INPUT, "start within 1e6 scene units of the middle", "the ray starts too far away");
    if (!is_finite(d) || (d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "give a finite direction that is not 0,0,0", "the ray has no direction");
    if (!(ray->reach >= 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "give a distance, or 0 for any", "the ray has a negative reach");
    return STATUS_OK;
}

/* What a pair of planes leaves of a ray, a little more than rounding needs. */
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

/* Does the ray pass the box? There may be millions of copies that it has nothing to do with. */
static bool passes(bounds3 box, vec3 o, vec3 d)
{
    double enter = 0.0, leave = INFINITY;
    cut(box.low.x, box.high.x, o.x, d.x, &enter, &leave);
    cut(box.low.y, box.high.y, o.y, d.y, &enter, &leave);
    cut(box.low.z, box.high.z, o.z, d.z, &enter, &leave);
    return enter <= leave;
}

/* The nearest of what is met so far and one copy; origin and direction in the solid's frame. */
static void pick_copy(const softbody *body, bounds3 box, const solid_shape *shape, vec3 copy, vec3 origin, vec3 direction, grasp *best)
{
    const vec3 o = over(vec3_sub(origin, copy), shape->scale), d = over(direction, shape->scale);
    vec3 met;
    if (!passes(box, o, d) || !softbody_pick(body, o, d, &met))
        return;
    const vec3 at = vec3_add(copy, times(met, shape->scale));
    const double distance = vec3_length(vec3_sub(at, origin)); /* the direction is a unit vector */
    if (distance < best->distance)
        *best = (grasp){.where = vec3_add(shape->position, mat3_apply(rotation_from_deg(shape->rotation_deg), at)), .on_mesh = met,
                        .distance = distance, .shape = shape};
}

static void pick_solid(const softbody *body, bounds3 box, const solid_shape *shape, const cuvette_ray *ray, grasp *best)
{
    const mat3 rotation = rotation_from_deg(shape->rotation_deg);
    const vec3 origin = mat3_apply_transposed(rotation, vec3_sub(vector_of(ray->origin), shape->position));
    const vec3 direction = mat3_apply_transposed(rotation, engine_unit(ray->direction));
    for (double z = 0.0; z < shape->copies.z; z++)
        for (double y = 0.0; y < shape->copies.y; y++)
            for (double x = 0.0; x < shape->copies.x; x++)
                pick_copy(body, box, shape, times(vec3_make(x, y, z), shape->spacing), origin, direction, best);
}

/* Under which solid the ray meets the slime of that name; best->distance is infinite where it misses. */
static status pick(const cuvette_motion *m, const char *name, const cuvette_ray *ray, size_t *slime, grasp *best, diagnostic *why)
{
    int only;
    *best = (grasp){.distance = INFINITY};
    status code = motion_find(m, name, slime, &only, why);
    if (code == STATUS_OK)
        code = check_ray(ray, why);
    if (code != STATUS_OK)
        return code;
    const scene *s = m->of->model;
    const mesh_entry *entry = &s->meshes[scene_motion_mesh(m->bodies, *slime)];
    const softbody *body = scene_motion_body(m->bodies, *slime);
    for (size_t i = 0; i < s->solid_count; i++) {
        const solid *one = &s->solids[i];
        const bool shows = one->shape.kind == SHAPE_MESH && strcmp(one->mesh, entry->name) == 0;
        if (only < 0 ? shows && one->visible : only == (int)i) {
            code = solid_shape_check(&one->shape, why);
            if (code != STATUS_OK)
                return code;
            pick_solid(body, entry->data->bounds, &one->shape, ray, best);
        }
    }
    if (ray->reach > 0.0 && best->distance > ray->reach)
        best->distance = INFINITY;
    return STATUS_OK;
}

static void tell(const grasp *found, double *where)
{
    if (where && isfinite(found->distance))
        where[0] = found->where.x, where[1] = found->where.y, where[2] = found->where.z;
}

cuvette_status cuvette_motion_pick(const cuvette_motion *motion, const char *name, const cuvette_ray *ray, double *where, double *distance,
                                   cuvette_diagnostic *why)
{
    ENGINE_NEED(motion, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(ray, why);
    ENGINE_NEED(distance, why);
    const cuvette_status alive = motion_is_alive(motion, why);
    if (alive != CUVETTE_OK)
        return alive;
    diagnostic inner = {.line = 0};
    size_t slime;
    grasp found;
    const status code = pick(motion, name, ray, &slime, &found, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    tell(&found, where);
    *distance = found.distance;
    return CUVETTE_OK;
}

static status grab(cuvette_motion *m, size_t index, const grasp *found, double reach, int *hand, diagnostic *why)
{
    const vec3 scale = found->shape->scale;
    const int number = softbody_grab(scene_motion_body(m->bodies, index), found->on_mesh, reach / fmax(scale.x, fmax(scale.y, scale.z)));
    if (number == HAND_NO_MEMORY)
        return diagnose(why, STATUS_FAILURE, "", "memory is out");
    if (number < 0)
        return diagnose(why, STATUS_BAD_INPUT, "let one release what it holds", "no hand is free, or others hold all of it");
    *hand = (int)index * SOFTBODY_HANDS_MAX + number;
    const mat3 rotation = rotation_from_deg(found->shape->rotation_deg);
    m->hands[*hand] = (caller_hand){.holds = true, .rotation = rotation, .scale = scale, .where = found->on_mesh};
    return STATUS_OK;
}

cuvette_status cuvette_motion_grab(cuvette_motion *motion, const char *name, const cuvette_ray *ray, double reach, int *hand, double *where,
                                   cuvette_diagnostic *why)
{
    ENGINE_NEED(motion, why);
    ENGINE_NEED(name, why);
    ENGINE_NEED(ray, why);
    ENGINE_NEED(hand, why);
    const cuvette_status alive = motion_is_alive(motion, why);
    if (alive != CUVETTE_OK)
        return alive;
    diagnostic inner = {.line = 0};
    size_t slime;
    grasp found;
    int number = CUVETTE_NO_HAND;
    status code = STATUS_OK;
    if (!(reach > 0.0 && isfinite(reach)))
        code = diagnose(&inner, STATUS_BAD_INPUT, "give a length above 0", "a hand cannot reach %g", reach);
    if (code == STATUS_OK)
        code = pick(motion, name, ray, &slime, &found, &inner);
    if (code == STATUS_OK && isfinite(found.distance))
        code = grab(motion, slime, &found, reach, &number, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    tell(&found, where);
    *hand = number;
    return CUVETTE_OK;
}

/* The hand of that number, which holds something. */
static cuvette_status find_hand(cuvette_motion *m, int number, caller_hand **out, cuvette_diagnostic *why)
{
    const cuvette_status alive = motion_is_alive(m, why);
    if (alive != CUVETTE_OK)
        return alive;
    diagnostic inner = {.line = 0};
    const bool is_one = number >= 0 && (size_t)number < scene_motion_count(m->bodies) * SOFTBODY_HANDS_MAX;
    const bool holds = is_one && m->hands[number].holds;
    if (holds)
        *out = &m->hands[number];
    else
        diagnose(&inner, STATUS_BAD_INPUT, "give the number that cuvette_motion_grab told", "hand %d holds nothing", number);
    return engine_report(holds ? STATUS_OK : STATUS_BAD_INPUT, &inner, why);
}

cuvette_status cuvette_motion_move(cuvette_motion *motion, int hand, const double *by, cuvette_diagnostic *why)
{
    ENGINE_NEED(motion, why);
    ENGINE_NEED(by, why);
    caller_hand *h = NULL;
    const cuvette_status code = find_hand(motion, hand, &h, why);
    if (code != CUVETTE_OK)
        return code;
    diagnostic inner = {.line = 0};
    if (!is_finite(by))
        return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "give three finite numbers", "the hand moves to nowhere"), &inner, why);
    h->to = over(mat3_apply_transposed(h->rotation, vector_of(by)), h->scale);
    return CUVETTE_OK;
}

cuvette_status cuvette_motion_release(cuvette_motion *motion, int hand, cuvette_diagnostic *why)
{
    ENGINE_NEED(motion, why);
    caller_hand *h = NULL;
    const cuvette_status code = find_hand(motion, hand, &h, why);
    if (code != CUVETTE_OK)
        return code;
    softbody_release(scene_motion_body(motion->bodies, (size_t)hand / SOFTBODY_HANDS_MAX), hand % SOFTBODY_HANDS_MAX);
    *h = (caller_hand){.holds = false};
    return CUVETTE_OK;
}

static bool is_moving(const caller_hand *h)
{
    return h->holds && (h->from.x != h->to.x || h->from.y != h->to.y || h->from.z != h->to.z);
}

/* Where the hands are to be at the end of a step, a share of the way that they have; in a script's own arithmetic. */
static void put_hands(softbody *body, const caller_hand *hands, double share)
{
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++) {
        const caller_hand *h = &hands[i];
        const vec3 offset = share >= 1.0 ? h->to : vec3_add(h->from, vec3_scale(vec3_sub(h->to, h->from), share));
        if (is_moving(h))
            softbody_hold(body, i, vec3_add(h->where, offset));
    }
}

status motion_step_held(cuvette_motion *m, size_t slime, double time_s, diagnostic *why)
{
    softbody *body = scene_motion_body(m->bodies, slime);
    caller_hand *hands = &m->hands[slime * SOFTBODY_HANDS_MAX];
    const mesh_entry *entry = &m->of->model->meshes[scene_motion_mesh(m->bodies, slime)];
    const uint64_t begin = softbody_measure(body).steps, end = (uint64_t)floor(time_s / entry->slime.dt_s + 0.5);
    bool any = false;
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++)
        any |= is_moving(&hands[i]);
    diagnostic bad = {.line = 0};
    status code = STATUS_OK;
    for (uint64_t k = begin; any && k < end && code == STATUS_OK; k++) {
        put_hands(body, hands, (double)(k + 1 - begin) / (double)(end - begin));
        code = softbody_step(body, &bad);
    }
    for (int i = 0; i < SOFTBODY_HANDS_MAX && begin < end; i++)
        hands[i].from = hands[i].to;
    if (code == STATUS_OK)
        return code;
    diagnostic_locate(why, bad.file, bad.line, bad.column);
    return diagnose(why, code, bad.remedy, "%.80s: %s", entry->name, bad.what);
}
