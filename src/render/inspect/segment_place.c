/* Projection of segments into the image. */
#include "render/inspect/segment_place.h"

#include <math.h>

static vec3 seen(const camera_frame *view, int width, int height, vec3 at)
{
    const vec3 d = vec3_sub(at, view->eye);
    const double depth = vec3_dot(d, view->forward), spread = camera_spread(view, depth);
    return vec3_make((vec3_dot(d, view->right) / (spread * view->half_width) + 1.0) * 0.5 * width,
                     (1.0 - vec3_dot(d, view->up) / (spread * view->half_height)) * 0.5 * height,
                     view->parallel ? depth : vec3_length(d));
}

bool segment_place(const camera_frame *view, int width, int height, vec3 from, vec3 to, vec3 ends[2])
{
    const double depth_from = vec3_dot(vec3_sub(from, view->eye), view->forward);
    const double depth_to = vec3_dot(vec3_sub(to, view->eye), view->forward);
    const double farther = fmax(depth_from, depth_to), near = view->parallel ? 0.0 : 1e-4 * farther;
    if (!(farther > 0.0))
        return false;
    const vec3 cut = vec3_add(from, vec3_scale(vec3_sub(to, from), (near - depth_from) / (depth_to - depth_from)));
    ends[0] = seen(view, width, height, depth_from < near ? cut : from);
    ends[1] = seen(view, width, height, depth_to < near ? cut : to);
    const double far = 1e7; /* px */
    return fabs(ends[0].x) < far && fabs(ends[0].y) < far && fabs(ends[1].x) < far && fabs(ends[1].y) < far;
}
