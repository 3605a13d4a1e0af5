#include "scene/model/camera_moves.h"
#include "scene/model/camera.h"
#include "scene/model/edit/edit.h"

#include "base/elementary.h"
#include "scene/model/scene.h"
#include <math.h>

static const double pitch_max_deg = 89.5;

static vec3 direction_of(double yaw_deg, double pitch_deg)
{
    const double yaw = yaw_deg * M_PI / 180.0,
                 pitch = fmin(fmax(pitch_deg, -pitch_max_deg), pitch_max_deg) * M_PI / 180.0;
    return vec3_make(cos(pitch) * sin(yaw), sin(pitch), cos(pitch) * cos(yaw));
}

/* The direction rotated by yaw and pitch. */
static vec3 turned(vec3 direction, const double by_deg[2])
{
    const double yaw_deg = atan2(direction.x, direction.z) * 180.0 / M_PI,
                 pitch_deg = asin(fmin(fmax(direction.y, -1.0), 1.0)) * 180.0 / M_PI;
    return direction_of(yaw_deg + by_deg[0], pitch_deg + by_deg[1]);
}

/* The target, or a point as far away as the centre of the scene's frame. */
static vec3 focus_of(const scene *s, vec3 forward)
{
    if (s->camera.aimed)
        return s->camera.target;
    return vec3_add(s->camera.position, vec3_scale(forward, fmax(1.0, vec3_length(s->camera.position))));
}

static void look_along(scene *s, vec3 direction, double distance)
{
    if (s->camera.aimed) {
        s->camera.target = vec3_add(s->camera.position, vec3_scale(direction, distance));
        return;
    }
    s->camera.yaw_deg = atan2(direction.x, direction.z) * 180.0 / M_PI;
    s->camera.pitch_deg = asin(fmin(fmax(direction.y, -1.0), 1.0)) * 180.0 / M_PI;
}

/* Converts a turn to the image's right and up into yaw and pitch: a rolled camera's image has its own right. */
static void unrolled(double roll_deg, double right_deg, double up_deg, double out[2])
{
    double sine, cosine;
    elementary_sincos_deg(roll_deg, &sine, &cosine);
    out[0] = cosine * right_deg + sine * up_deg;
    out[1] = cosine * up_deg - sine * right_deg;
}

status camera_move_apply(void *of, scene *s, diagnostic *why)
{
    const camera_move *m = of;
    camera_frame f = camera_frame_of(s);
    const vec3 focus = focus_of(s, f.forward);
    const double distance = vec3_length(vec3_sub(focus, f.eye));
    if (m->orbit_deg[0] != 0.0 || m->orbit_deg[1] != 0.0) {
        double by[2];
        unrolled(s->camera.roll_deg, m->orbit_deg[0], -m->orbit_deg[1], by);
        const vec3 direction = turned(f.forward, by);
        s->camera.position = vec3_sub(focus, vec3_scale(direction, distance));
        look_along(s, direction, distance);
    }
    if (m->turn_deg[0] != 0.0 || m->turn_deg[1] != 0.0) {
        double by[2];
        unrolled(s->camera.roll_deg, m->turn_deg[0], m->turn_deg[1], by);
        look_along(s, turned(camera_frame_of(s).forward, by), distance);
    }
    f = camera_frame_of(s);
    const vec3 step = vec3_add(vec3_scale(f.right, m->step[0]),
                               vec3_add(vec3_scale(f.up, m->step[1]), vec3_scale(f.forward, m->step[2])));
    return scene_move(s, "camera", step, why);
}
