/* Clips lines to a frame. Each edge of a frame is a plane through the eye, or parallel to the view, so that a line is
 * in the frame where several linear functions of s are not negative (Liang and Barsky, "A new concept and method for
 * line clipping", ACM Transactions on Graphics 3(1), 1984). The planes are those of the frustum in the scene, so that
 * lines may be infinite, and points behind the eye are clipped before projection. */
#include "render/inspect/ray_line.h"

#include <math.h>

/* Distance of the near plane, relative to the distance of the line's start from the eye, and to the eye's coordinates,
 * whose rounding would otherwise decide where a camera ray begins. */
#define NEAR 1e-6
#define NEAR_OF_EYE 1e-9
/* Tangent of the angle to the view below which the image of a direction in a parallel view is rounding noise. */
#define ALONG_THE_VIEW 1e-12

ray_line ray_line_between(vec3 from, vec3 to)
{
    return (ray_line){from, vec3_sub(to, from), 1.0};
}

ray_line ray_line_of(const ray_node *node)
{
    switch (node->end) {
    case RAY_END_HIT: return ray_line_between(node->origin, node->hit.point);
    case RAY_END_SKY: return (ray_line){node->origin, node->direction, HUGE_VAL};
    case RAY_END_LIT:
    case RAY_END_BLOCKED: return (ray_line){node->origin, node->direction, node->light_distance};
    case RAY_END_CUT_DEPTH:
    case RAY_END_CUT_WEIGHT: break;
    }
    return (ray_line){node->origin, node->direction, 0.0};
}

static vec3 at(const ray_line *line, double s)
{
    return vec3_add(line->from, vec3_scale(line->along, s));
}

void ray_line_far_end(const ray_line *line, double xyzw[4])
{
    const bool leaves = isinf(line->end);
    const vec3 end = leaves ? line->along : at(line, line->end);
    xyzw[0] = end.x, xyzw[1] = end.y, xyzw[2] = end.z, xyzw[3] = leaves ? 0.0 : 1.0;
}

image_frame image_frame_of(int width, int height, double margin_px)
{
    return (image_frame){width, height, -margin_px, -margin_px, width + margin_px, height + margin_px};
}

typedef struct part {
    double first, last; /* range of s; empty if first > last */
} part;

/* Clips to start + s slope >= 0. */
static void clip(part *p, double start, double slope)
{
    if (slope == 0.0 && start < 0.0)
        *p = (part){1.0, 0.0};
    if (slope > 0.0)
        p->first = fmax(p->first, -start / slope);
    if (slope < 0.0)
        p->last = fmin(p->last, -start / slope);
}

static vec3 in_axes(vec3 v, vec3 x, vec3 y, vec3 z)
{
    return vec3_make(vec3_dot(v, x), vec3_dot(v, y), vec3_dot(v, z));
}

/* A direction in the axes of a parallel view; a line along the view becomes a point. */
static vec3 flattened(vec3 along)
{
    const bool is_point = hypot(along.x, along.y) <= ALONG_THE_VIEW * fabs(along.z);
    return is_point ? vec3_make(0.0, 0.0, along.z) : along;
}

/* Scales a vector in the camera's axes, x and y in half widths and half heights of the image. */
static vec3 in_image(const camera_frame *view, vec3 v)
{
    return vec3_make(v.x / view->half_width, v.y / view->half_height, v.z);
}

/* The image of a point of the line. In perspective it is the direction's image if the point is infinitely far away (its
 * vanishing point), or is the eye. */
static vec3 project(const ray_line *line, bool parallel, const image_frame *frame, double s)
{
    const bool far = isinf(s);
    vec3 p = far ? line->from : at(line, s);
    if (!parallel && (far || p.z <= 0.0))
        p = line->along;
    const double spread = parallel ? 1.0 : p.z;
    const double depth = line->from.z + s * line->along.z;
    return vec3_make(0.5 * (1.0 + p.x / spread) * frame->width, 0.5 * (1.0 - p.y / spread) * frame->height,
                     far ? HUGE_VAL : fmax(parallel ? depth : 0.0, depth));
}

bool ray_line_seen(const ray_line *line, const camera_frame *view, const image_frame *frame, vec3 ends[2])
{
    const vec3 offset = vec3_sub(line->from, view->eye);
    const vec3 from = in_axes(offset, view->right, view->up, view->forward);
    const vec3 along = in_axes(line->along, view->right, view->up, view->forward);
    const ray_line l = {in_image(view, from), in_image(view, view->parallel ? flattened(along) : along), line->end};
    const double near = view->parallel ? 0.0 : NEAR * vec3_length(offset) + NEAR_OF_EYE * vec3_length(view->eye);
    const double spread = view->parallel ? 1.0 : l.from.z, widening = view->parallel ? 0.0 : l.along.z;
    const double left = 2.0 * frame->left / frame->width - 1.0, right = 2.0 * frame->right / frame->width - 1.0;
    const double top = 1.0 - 2.0 * frame->top / frame->height, bottom = 1.0 - 2.0 * frame->bottom / frame->height;
    const bool leaves_past_plane = view->parallel && isinf(l.end) && l.from.z >= 0.0;
    part p = {0.0, l.end};
    if (!leaves_past_plane)
        clip(&p, l.from.z - near, l.along.z);
    clip(&p, l.from.x - left * spread, l.along.x - left * widening);
    clip(&p, right * spread - l.from.x, right * widening - l.along.x);
    clip(&p, l.from.y - bottom * spread, l.along.y - bottom * widening);
    clip(&p, top * spread - l.from.y, top * widening - l.along.y);
    if (!(p.first < p.last))
        return false;
    ends[0] = project(&l, view->parallel, frame, p.first);
    ends[1] = project(&l, view->parallel, frame, p.last);
    return true;
}

bool ray_line_projected(const ray_line *line, const section_plane *window, section_point ends[2])
{
    const section_point from = section_project(window, line->from);
    const vec3 normal = vec3_cross(window->e_u, window->e_v);
    const vec3 along = flattened(in_axes(line->along, window->e_u, window->e_v, normal));
    part p = {0.0, line->end};
    clip(&p, from.u - window->u0, along.x);
    clip(&p, window->u1 - from.u, -along.x);
    clip(&p, from.v - window->v0, along.y);
    clip(&p, window->v1 - from.v, -along.y);
    if (!(p.first < p.last))
        return false;
    const double last = isinf(p.last) ? 0.0 : p.last; /* perpendicular to the plane: a point */
    ends[0] = (section_point){from.u + p.first * along.x, from.v + p.first * along.y};
    ends[1] = (section_point){from.u + last * along.x, from.v + last * along.y};
    return true;
}
