/* The shape mesh: a triangle mesh, scaled along each axis and copied on a grid with the given spacing. A closed mesh is
 * a solid; an open mesh is an open surface that contains no points. Neither copies nor the parts of one mesh may
 * overlap; copies may touch. */
#include "geometry/shapes/parts.h"

static bool is_copy_count(double value)
{
    return value >= 1.0 && value <= COPIES_MAX && value == floor(value);
}

static status check(const solid_shape *shape, diagnostic *why)
{
    const vec3 n = shape->copies, s = shape->scale, step = shape->spacing;
    if (!is_copy_count(n.x) || !is_copy_count(n.y) || !is_copy_count(n.z) || n.x * n.y * n.z > COPIES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use three whole numbers from 1, at most 4194304 copies in all",
                        "copies is %g, %g, %g", n.x, n.y, n.z);
    if (s.x == 0.0 || s.y == 0.0 || s.z == 0.0 || !vec3_is_finite(s) || !vec3_is_finite(step))
        return diagnose(why, STATUS_BAD_INPUT, "use scales other than 0, and finite numbers",
                        "scale is %g, %g, %g, spacing %g, %g, %g", s.x, s.y, s.z, step.x, step.y, step.z);
    return STATUS_OK;
}

/* An upper bound of the distance of the copies from the solid's position. */
static double reach(const solid_shape *shape)
{
    const bounds3 b = shape->mesh->bounds;
    const vec3 low = b.low, high = b.high, scale = shape->scale, n = shape->copies, step = shape->spacing;
    const double x = largest_of(fabs(low.x), fabs(high.x), 0.0) * fabs(scale.x) + (n.x - 1.0) * fabs(step.x);
    const double y = largest_of(fabs(low.y), fabs(high.y), 0.0) * fabs(scale.y) + (n.y - 1.0) * fabs(step.y);
    const double z = largest_of(fabs(low.z), fabs(high.z), 0.0) * fabs(scale.z) + (n.z - 1.0) * fabs(step.z);
    return shape->mesh->triangle_count > 0 ? x + y + z : 0.0;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, NULL, reach(shape));
}

static vec3 times(vec3 a, vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

/* The offset from the first copy to the last one. */
static vec3 copies_reach(const solid_shape *shape)
{
    return times(vec3_sub(shape->copies, vec3_make(1.0, 1.0, 1.0)), shape->spacing);
}

/* One flat face per triangle, of the first copy. */
static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    if (i >= shape->mesh->triangle_count)
        return false;
    vec3 corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] = times(shape->mesh->vertices[shape->mesh->triangles[i].corner[k]], shape->scale);
    *normal = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    *point = corner[0];
    return true;
}

static shape_extent extent(const solid_shape *shape)
{
    const vec3 more = copies_reach(shape);
    const vec3 low = shape->mesh->bounds.low, high = shape->mesh->bounds.high, s = shape->scale;
    bounds3 b = {vec3_make((s.x < 0.0 ? high : low).x, (s.y < 0.0 ? high : low).y, (s.z < 0.0 ? high : low).z),
                 vec3_make((s.x < 0.0 ? low : high).x, (s.y < 0.0 ? low : high).y, (s.z < 0.0 ? low : high).z)};
    b.low = vec3_add(times(b.low, s), vec3_make(fmin(more.x, 0.0), fmin(more.y, 0.0), fmin(more.z, 0.0)));
    b.high = vec3_add(times(b.high, s), vec3_make(fmax(more.x, 0.0), fmax(more.y, 0.0), fmax(more.z, 0.0)));
    return (shape_extent){b, 0.5 * vec3_length(vec3_sub(b.high, b.low))};
}

/* A measure of a point. most_of_vertices returns its maximum over the vertices of the copies at the grid's corners,
 * which have the same convex hull as all copies. */
typedef double point_measure(const void *context, vec3 local);

static double most_of_vertices(const solid_shape *s, point_measure *measure, const void *context)
{
    if (!s->mesh)
        return INFINITY;
    const vec3 more = copies_reach(s);
    double most = -INFINITY;
    for (int i = 0; i < 8; i++) {
        const vec3 offset = vec3_make(i & 1 ? more.x : 0.0, i & 2 ? more.y : 0.0, i & 4 ? more.z : 0.0);
        if ((i & 1 && s->copies.x == 1.0) || (i & 2 && s->copies.y == 1.0) || (i & 4 && s->copies.z == 1.0))
            continue;
        for (size_t k = 0; k < s->mesh->vertex_count; k++)
            most = fmax(most, measure(context, vec3_add(times(s->mesh->vertices[k], s->scale), offset)));
    }
    return most;
}

static double along(const void *direction, vec3 local)
{
    return vec3_dot(*(const vec3 *)direction, local);
}

static double farthest(const solid_shape *shape, vec3 direction)
{
    return most_of_vertices(shape, along, &direction);
}

typedef struct around {
    const placed_shape *placed;
    const round_frame *frame;
} around;

static double distance(const void *context, vec3 local)
{
    const around *a = context;
    return round_distance(a->frame, vec3_add(a->placed->shape.position, mat3_apply(a->placed->turn, local)));
}

static double farthest_from(const placed_shape *placed, const round_frame *frame)
{
    return most_of_vertices(&placed->shape, distance, &(around){placed, frame});
}

/* Twice the volume over the area: for a plate its thickness, for a convex solid at most its width. */
static double thickness(const solid_shape *shape)
{
    const double area = mesh_area(shape->mesh);
    const vec3 s = shape->scale, size = vec3_make(fabs(s.x), fabs(s.y), fabs(s.z));
    return area > 0.0 ? 2.0 * fabs(mesh_volume(shape->mesh)) / area * least_of_three(size) : 0.0;
}

const shape_rule shape_mesh = {
    .word = "mesh",
    .meaning =
        "a triangle mesh, scaled along each axis and copied on a grid with the given spacing; its position is the "
        "origin of the mesh",
    .parameters = WORDS("mesh", "scale", "copies", "spacing", "shading"),
    .triangles = true,
    .check = check,
    .primitive_count = 1,
    .primitives = primitives,
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .farthest_from = farthest_from,
    .thickness = thickness,
};
