/* Camera moves, and their bounds, so that no gesture loses the scene: the camera stays above the grounds that it is
 * above, and its distance from the pivot stays within the scene's scale. A ground is a visible opaque plane that faces
 * up. Lengths in scene units. */
#include "base/elementary.h"
#include "geometry/shapes/shape.h"
#include "scene/model/camera.h"
#include "scene/model/edit/edit.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <math.h>
#include <string.h>

/* --- bounds --- */

static const double ground_up_y = 0.9;

/* Whether the solid is a ground; its normal. A camera can dive into a transparent plane, such as a sea. */
static bool is_ground(const solid *one, vec3 *up)
{
    if (!one->visible || !shape_of(&one->shape)->unbounded || one->surface.transparency > 0.0)
        return false;
    *up = mat3_apply(rotation_from_deg(one->shape.rotation_deg), vec3_make(0.0, 1.0, 0.0));
    return up->y >= ground_up_y;
}

/* How far `to` is below the height that a camera which comes from above the ground must keep; 0 or less: it is high
 * enough. */
static double height_lacking(const solid *one, vec3 up, vec3 from, vec3 to, double gap)
{
    const double before = vec3_dot(up, vec3_sub(from, one->shape.position)),
                 after = vec3_dot(up, vec3_sub(to, one->shape.position));
    return before > 0.0 ? fmin(before, gap) - after : 0.0;
}

/* Whether a camera that moves from one point to another stays above every ground below the first point. */
static bool is_clear(const scene *s, vec3 from, vec3 to, double gap)
{
    vec3 up;
    for (size_t i = 0; i < s->solid_count; i++)
        if (is_ground(&s->solids[i], &up) && height_lacking(&s->solids[i], up, from, to, gap) > 0.0)
            return false;
    return true;
}

/* Lifts `to` above each ground in turn. */
static vec3 lift_above_grounds(const scene *s, vec3 from, vec3 to, double gap)
{
    vec3 up;
    for (size_t i = 0; i < s->solid_count; i++)
        if (is_ground(&s->solids[i], &up))
            to = vec3_add(to, vec3_scale(up, fmax(0.0, height_lacking(&s->solids[i], up, from, to, gap))));
    return to;
}

/* The distance from a point to the farthest end of a solid. */
static double extent_about(const scene *s, vec3 point)
{
    double extent = 0.0, radius;
    vec3 centre;
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && placement_bounding_sphere(s, &s->solids[i], &centre, &radius))
            extent = fmax(extent, vec3_length(vec3_sub(centre, point)) + radius);
    return extent;
}

/* Limits a distance from the pivot to between a thousandth of the scene's extent about the pivot and twenty times it. A
 * camera that is already beyond a bound may stay there. */
static double distance_within(const scene *s, vec3 pivot, double now, double wanted)
{
    const double nearest = 1e-3, farthest = 20.0, extent = extent_about(s, pivot), scale = extent > 0.0 ? extent : now;
    return fmin(fmax(wanted, fmin(nearest * scale, now)), fmax(farthest * scale, now));
}

/* A ball around all visible bounded solids; false if there are none. */
static bool scene_ball(const scene *s, vec3 *centre, double *radius)
{
    vec3 low = vec3_make(INFINITY, INFINITY, INFINITY), high = vec3_scale(low, -1.0), at;
    double r;
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && placement_bounding_sphere(s, &s->solids[i], &at, &r)) {
            low = vec3_make(fmin(low.x, at.x - r), fmin(low.y, at.y - r), fmin(low.z, at.z - r));
            high = vec3_make(fmax(high.x, at.x + r), fmax(high.y, at.y + r), fmax(high.z, at.z + r));
        }
    *centre = vec3_scale(vec3_add(low, high), 0.5);
    *radius = low.x <= high.x ? extent_about(s, *centre) : 0.0;
    return *radius > 0.0;
}

/* --- moves --- */

static const double pitch_max_deg = 89.5;
/* The minimum distance from a ground, as a fraction of the distance from the pivot. */
static const double gap_fraction = 1e-3;

static vec3 direction_of(double yaw_deg, double pitch_deg)
{
    const double yaw = yaw_deg * M_PI / 180.0,
                 pitch = fmin(fmax(pitch_deg, -pitch_max_deg), pitch_max_deg) * M_PI / 180.0;
    return vec3_make(cos(pitch) * sin(yaw), sin(pitch), cos(pitch) * cos(yaw));
}

/* Rotates a direction by yaw and pitch. */
static vec3 rotate_direction(vec3 direction, const double by_deg[2])
{
    const double yaw_deg = atan2(direction.x, direction.z) * 180.0 / M_PI,
                 pitch_deg = asin(fmin(fmax(direction.y, -1.0), 1.0)) * 180.0 / M_PI;
    return direction_of(yaw_deg + by_deg[0], pitch_deg + by_deg[1]);
}

vec3 camera_pivot_of(const scene *s, camera_pivot known)
{
    if (s->camera.aimed)
        return s->camera.target;
    const vec3 offset = vec3_sub(known.at, s->camera.position), forward = camera_frame_of(s).forward;
    const double distance = vec3_length(offset), off_axis = 1e-9;
    const bool is_ahead = distance > 0.0 && vec3_dot(offset, forward) >= distance * (1.0 - off_axis);
    return known.known && is_ahead ? known.at : placement_of(s).looked_at;
}

/* Aims the camera without moving it: sets its target or, if it has none, its angles. */
static void aim(scene *s, vec3 direction, vec3 target)
{
    s->camera.target = s->camera.aimed ? target : s->camera.target;
    if (!s->camera.aimed) {
        s->camera.yaw_deg = atan2(direction.x, direction.z) * 180.0 / M_PI;
        s->camera.pitch_deg = asin(fmin(fmax(direction.y, -1.0), 1.0)) * 180.0 / M_PI;
    }
}

/* Converts a turn to the image's right and up into yaw and pitch, which differ if the camera is rolled. */
static void image_turn_to_angles(double roll_deg, double right_deg, double up_deg, double out[2])
{
    double sine, cosine;
    elementary_sincos_deg(roll_deg, &sine, &cosine);
    out[0] = cosine * right_deg + sine * up_deg;
    out[1] = cosine * up_deg - sine * right_deg;
}

static vec3 eye_at_distance(vec3 pivot, vec3 direction, double distance)
{
    return vec3_sub(pivot, vec3_scale(direction, distance));
}

/* The viewing direction after all of the yaw and the largest fraction of the pitch that stays above the ground. */
static vec3 clear_direction(const scene *s, vec3 forward, vec3 pivot, double distance, const double by_deg[2])
{
    enum { HALVINGS = 50 };
    double clear = 0.0, fraction = 1.0, step = 1.0;
    for (int i = 0; i < HALVINGS; i++) {
        const vec3 direction = rotate_direction(forward, (double[2]){by_deg[0], fraction * by_deg[1]});
        const bool good =
            is_clear(s, s->camera.position, eye_at_distance(pivot, direction, distance), gap_fraction * distance);
        if (good && fraction == 1.0)
            return direction;
        clear = good ? fraction : clear;
        step *= 0.5;
        fraction = good ? fraction + step : fraction - step;
    }
    return rotate_direction(forward, (double[2]){by_deg[0], clear * by_deg[1]});
}

static void orbit(const camera_move *m, scene *s)
{
    double by[2];
    const vec3 pivot = m->pivot.at, forward = camera_frame_of(s).forward;
    const double distance = vec3_length(vec3_sub(pivot, s->camera.position));
    image_turn_to_angles(s->camera.roll_deg, m->orbit_deg[0], -m->orbit_deg[1], by);
    const vec3 direction = clear_direction(s, forward, pivot, distance, by),
               to = eye_at_distance(pivot, direction, distance);
    if (!is_clear(s, s->camera.position, to, gap_fraction * distance))
        return; /* on a slope even the yaw may lead below the ground */
    s->camera.position = to;
    aim(s, direction, pivot);
}

static void turn(camera_move *m, scene *s)
{
    double by[2];
    const vec3 forward = camera_frame_of(s).forward;
    const double distance = vec3_length(vec3_sub(m->pivot.at, s->camera.position));
    image_turn_to_angles(s->camera.roll_deg, m->turn_deg[0], m->turn_deg[1], by);
    const vec3 direction = rotate_direction(forward, by);
    m->pivot.at = vec3_add(s->camera.position, vec3_scale(direction, distance));
    aim(s, direction, m->pivot.at);
}

/* What an orthographic camera shows does not depend on its distance: a zoom changes its view_height instead. */
static void zoom_parallel(const camera_move *m, scene *s)
{
    const double height = s->camera.view_height;
    s->camera.view_height = distance_within(s, m->pivot.at, height, m->zoom * height);
}

/* Moves along the line to the pivot: bisection finds the last point above the ground. */
static void zoom(const camera_move *m, scene *s)
{
    const vec3 from = s->camera.position, offset = vec3_sub(from, m->pivot.at);
    const double distance = vec3_length(offset);
    double fraction = distance_within(s, m->pivot.at, distance, m->zoom * distance) / distance, bad = fraction,
           clear = 1.0;
    for (int i = 0; i < 50; i++) {
        const vec3 to = vec3_add(m->pivot.at, vec3_scale(offset, fraction));
        if (is_clear(s, from, to, gap_fraction * distance))
            clear = fraction;
        else
            bad = fraction;
        if (clear == bad)
            break;
        fraction = 0.5 * (clear + bad);
    }
    s->camera.position = vec3_add(m->pivot.at, vec3_scale(offset, clear));
}

static status step(camera_move *m, scene *s, diagnostic *why)
{
    const camera_frame f = camera_frame_of(s);
    const vec3 by = vec3_add(vec3_scale(f.right, m->step[0]),
                             vec3_add(vec3_scale(f.up, m->step[1]), vec3_scale(f.forward, m->step[2])));
    const double gap = gap_fraction * vec3_length(vec3_sub(m->pivot.at, f.eye));
    const vec3 slide = vec3_sub(lift_above_grounds(s, f.eye, vec3_add(f.eye, by), gap), f.eye);
    const bool blocked = !is_clear(s, f.eye, vec3_add(f.eye, by), gap);
    m->pivot.at = vec3_add(m->pivot.at, blocked ? slide : by);
    return scene_move(s, "camera", blocked ? slide : by, why);
}

/* --- from a side, and framed --- */

/* Moves the camera so that it looks at the pivot along a direction, and lifts it above the grounds. */
static void look_at_pivot(const camera_move *m, scene *s, vec3 direction, double distance)
{
    const vec3 pivot = m->pivot.at, to = eye_at_distance(pivot, direction, distance);
    s->camera.position = lift_above_grounds(s, s->camera.position, to, gap_fraction * distance);
    aim(s, vec3_normalize(vec3_sub(pivot, s->camera.position)), pivot);
}

static status look(const camera_move *m, scene *s, diagnostic *why)
{
    static const struct {
        const char *word;
        vec3 direction;
    } sides[] = {
        {"front", {0, 0, 1}}, {"back", {0, 0, -1}}, {"left", {1, 0, 0}}, {"right", {-1, 0, 0}}, {"top", {0, -1, 0}}};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
        if (strcmp(sides[i].word, m->look) == 0) {
            look_at_pivot(m, s, sides[i].direction, vec3_length(vec3_sub(m->pivot.at, s->camera.position)));
            return STATUS_OK;
        }
    return diagnose(why, STATUS_BAD_INPUT, "use front, back, left, right or top", "unknown side '%.60s'", m->look);
}

/* The ball that an image of the object must show. A light without a size is shown with its surroundings. */
static status ball_of(const scene *s, const char *name, double distance, vec3 *centre, double *radius, diagnostic *why)
{
    const int index = scene_find_solid(s, name);
    if (index >= 0 && placement_bounding_sphere(s, &s->solids[index], centre, radius))
        return STATUS_OK;
    if (index >= 0)
        return diagnose(why, STATUS_BAD_INPUT, "frame another solid, or all", "%.80s is unbounded and cannot be framed",
                        name);
    for (size_t i = 0; i < s->light_count; i++)
        if (strcmp(s->lights[i].name, name) == 0) {
            *centre = s->lights[i].position;
            *radius = fmax(light_extent(&s->lights[i]), 0.1 * distance);
            return STATUS_OK;
        }
    if (strcmp(name, "all") != 0)
        return diagnose(why, STATUS_BAD_INPUT, "give a solid, a light or all", "no solid or light '%.80s'", name);
    return scene_ball(s, centre, radius)
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "add a bounded solid", "the scene has no bounded solid to frame");
}

/* Frames an object. In perspective a ball fits into the narrower half angle a at the distance radius / sin a, where tan
 * a is half the image's shorter edge. An orthographic image's shorter edge becomes the ball's diameter. */
static status frame(camera_move *m, scene *s, diagnostic *why)
{
    const camera_frame f = camera_frame_of(s);
    const double margin = 1.1, tangent = fmin(f.half_width, f.half_height);
    vec3 centre;
    double radius;
    TRY(ball_of(s, m->frame, vec3_length(vec3_sub(m->pivot.at, f.eye)), &centre, &radius, why));
    m->pivot.at = centre;
    if (f.parallel) { /* the distance stays, unless it is too small */
        s->camera.view_height = 2.0 * margin * radius * f.half_height / tangent;
        look_at_pivot(m, s, f.forward, fmax(vec3_length(vec3_sub(centre, f.eye)), 2.0 * margin * radius));
    } else {
        look_at_pivot(m, s, f.forward, margin * radius * sqrt(1.0 + tangent * tangent) / tangent);
    }
    return STATUS_OK;
}

static bool any_nonzero(const double *values, int count)
{
    bool any = false;
    for (int i = 0; i < count; i++)
        any |= values[i] != 0.0;
    return any;
}

status camera_move_apply(camera_move *m, scene *s, diagnostic *why)
{
    m->pivot = (camera_pivot){camera_pivot_of(s, m->pivot), true};
    if (m->frame)
        TRY(frame(m, s, why));
    if (m->look)
        TRY(look(m, s, why));
    if (any_nonzero(m->orbit_deg, 2))
        orbit(m, s);
    if (any_nonzero(m->turn_deg, 2))
        turn(m, s);
    if (m->zoom > 0.0)
        (s->camera.projection == PROJECTION_ORTHOGRAPHIC ? zoom_parallel : zoom)(m, s);
    return any_nonzero(m->step, 3) ? step(m, s, why) : STATUS_OK;
}
