#include "scene/model/camera_limits.h"
#include "geometry/shapes/shape.h"
#include "scene/model/place/placement.h"
#include "scene/model/scene.h"

#include <math.h>

static const double ground_up_y = 0.9;

/* The ground's normal; false for another solid. One can dive into a transparent plane, such as a sea. */
static bool is_ground(const solid *one, vec3 *up)
{
    if (!one->visible || !shape_of(&one->shape)->unbounded || one->surface.transparency > 0.0)
        return false;
    *up = mat3_apply(rotation_from_deg(one->shape.rotation_deg), vec3_make(0.0, 1.0, 0.0));
    return up->y >= ground_up_y;
}

/* How much a point is too low for a camera that comes from above; 0 or less: it is not. */
static double missing(const solid *one, vec3 up, vec3 from, vec3 to, double gap)
{
    const double before = vec3_dot(up, vec3_sub(from, one->shape.position)),
                 after = vec3_dot(up, vec3_sub(to, one->shape.position));
    return before > 0.0 ? fmin(before, gap) - after : 0.0;
}

bool camera_is_clear(const scene *s, vec3 from, vec3 to, double gap)
{
    vec3 up;
    for (size_t i = 0; i < s->solid_count; i++)
        if (is_ground(&s->solids[i], &up) && missing(&s->solids[i], up, from, to, gap) > 0.0)
            return false;
    return true;
}

vec3 camera_lifted(const scene *s, vec3 from, vec3 to, double gap)
{
    vec3 up;
    for (size_t i = 0; i < s->solid_count; i++)
        if (is_ground(&s->solids[i], &up))
            to = vec3_add(to, vec3_scale(up, fmax(0.0, missing(&s->solids[i], up, from, to, gap))));
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

double camera_distance_within(const scene *s, vec3 pivot, double now, double wanted)
{
    const double nearest = 1e-3, farthest = 20.0, extent = extent_about(s, pivot), scale = extent > 0.0 ? extent : now;
    return fmin(fmax(wanted, fmin(nearest * scale, now)), fmax(farthest * scale, now));
}

bool camera_scene_ball(const scene *s, vec3 *centre, double *radius)
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
