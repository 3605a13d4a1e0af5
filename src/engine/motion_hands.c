/* The hands of cuvette.h, implemented with scene/motion/motion_hands.h. */
#include "engine/motion_private.h"

#include <math.h>

/* Finds the solid on which the ray hits the slime of that name; best->distance is infinite on a miss. */
static status pick(const cuvette_motion *m, const char *name, const cuvette_ray *ray, size_t *slime, motion_place *best,
                   diagnostic *why)
{
    int only;
    status code = motion_find(m, name, slime, &only, why);
    THEN(code, engine_check_ray(NULL, ray, 0, why));
    THEN(code, scene_motion_pick(m->bodies, *slime, only < 0 ? MOTION_ANY_SOLID : only, engine_vector(ray->origin),
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
    size_t slime;
    motion_place found;
    const status code = pick(motion, name, ray, &slime, &found, &inner);
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
    size_t slime;
    motion_place found;
    int number = CUVETTE_NO_HAND;
    status code = STATUS_OK;
    if (!(reach > 0.0 && isfinite(reach)))
        code = diagnose(&inner, STATUS_BAD_INPUT, "give a length above 0", "a hand's reach cannot be %g", reach);
    THEN(code, pick(motion, name, ray, &slime, &found, &inner));
    if (code == STATUS_OK && isfinite(found.distance))
        code = scene_motion_grab(motion->bodies, slime, &found, reach, &motion->hands[slime * SOFTBODY_HANDS_MAX],
                                 &number, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    report_point(&found, where);
    motion->of->grabbed |= number >= 0;
    *hand = number < 0 ? CUVETTE_NO_HAND : (int)slime * SOFTBODY_HANDS_MAX + number;
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
    const size_t slime = (size_t)hand / SOFTBODY_HANDS_MAX;
    scene_motion_release(motion->bodies, slime, &motion->hands[slime * SOFTBODY_HANDS_MAX], hand % SOFTBODY_HANDS_MAX);
    return CUVETTE_OK;
}
