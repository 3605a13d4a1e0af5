#include "realism/view.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/view_settings.h"

#include <math.h>

view view_of(const scene *s)
{
    const struct camera *c = scene_camera(s);
    const double degree = M_PI / 180.0;
    view v = {.x = c->position.x,
              .y = c->position.y,
              .z = c->position.z,
              .yaw = c->yaw_deg * degree,
              .pitch = c->pitch_deg * degree,
              .roll = c->roll_deg * degree,
              .width = (double)scene_settings(s)->width,
              .height = (double)scene_settings(s)->height};
    if (c->aimed) {
        const double dx = c->target.x - v.x, dy = c->target.y - v.y, dz = c->target.z - v.z;
        v.yaw = atan2(dx, dz);
        v.pitch = atan2(dy, hypot(dx, dz));
    }
    v.focal_px = v.height / 2.0 / tan(c->fov_deg / 2.0 * degree);
    return v;
}

/* Camera coordinates (right, up, ahead); roll rotates right and up, pitch then up and ahead, yaw then right and ahead.
 * */
sight view_through(const view *v, double px, double py)
{
    const double across = (px - v->width / 2.0) / v->focal_px, upwards = (v->height / 2.0 - py) / v->focal_px;
    const double right = across * cos(v->roll) + upwards * sin(v->roll);
    const double up = upwards * cos(v->roll) - across * sin(v->roll);
    const double length = sqrt(right * right + up * up + 1.0);
    const double level = cos(v->pitch) - up * sin(v->pitch);
    sight s = {.x = (right * cos(v->yaw) + level * sin(v->yaw)) / length,
               .y = (sin(v->pitch) + up * cos(v->pitch)) / length,
               .z = (level * cos(v->yaw) - right * sin(v->yaw)) / length};
    return s;
}

bool view_place(const view *v, double x, double y, double z, double *px, double *py)
{
    const double dx = x - v->x, dy = y - v->y, dz = z - v->z;
    const double right = dx * cos(v->yaw) - dz * sin(v->yaw), level = dx * sin(v->yaw) + dz * cos(v->yaw);
    const double ahead = level * cos(v->pitch) + dy * sin(v->pitch), up = dy * cos(v->pitch) - level * sin(v->pitch);
    if (!(ahead > 0.0))
        return false;
    const double across = right * cos(v->roll) - up * sin(v->roll), upwards = right * sin(v->roll) + up * cos(v->roll);
    *px = v->width / 2.0 + v->focal_px * across / ahead;
    *py = v->height / 2.0 - v->focal_px * upwards / ahead;
    return true;
}
