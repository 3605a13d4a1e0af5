#include "geometry/apart.h"

#include <math.h>

/* How far the shape reaches along a direction in its own frame: its support function. HUGE_VAL where that is not known. */
static double reach_of_mesh(const solid_shape *s, vec3 d)
{
    double far = -HUGE_VAL;
    for (size_t i = 0; s->mesh && i < s->mesh->vertex_count; i++) {
        const vec3 v = s->mesh->vertices[i];
        far = fmax(far, d.x * s->scale.x * v.x + d.y * s->scale.y * v.y + d.z * s->scale.z * v.z);
    }
    const double last = (s->copies.x - 1.0) * fmax(0.0, d.x * s->spacing.x) + (s->copies.y - 1.0) * fmax(0.0, d.y * s->spacing.y) +
                        (s->copies.z - 1.0) * fmax(0.0, d.z * s->spacing.z);
    return s->mesh ? far + last : HUGE_VAL;
}

static double reach_in_own_frame(const solid_shape *s, vec3 d)
{
    /* The ellipse x^2 + m^2 z^2 = radius^2 reaches to radius sqrt(x^2 + (z / m)^2) along (x, z). */
    const double m = s->kind == SHAPE_CYLINDER ? s->m : 1.0;
    switch (s->kind) {
    case SHAPE_BOX: return 0.5 * (fabs(d.x) * s->size.x + fabs(d.y) * s->size.y + fabs(d.z) * s->size.z);
    case SHAPE_SPHERE: return s->radius * vec3_length(d);
    case SHAPE_CYLINDER:
    case SHAPE_CUP: return s->radius * hypot(d.x, d.z / m) + fmax(0.0, s->height * d.y);
    case SHAPE_MESH: return reach_of_mesh(s, d);
    case SHAPE_PLANE: return d.y > 0.0 && hypot(d.x, d.z) < 1e-12 * d.y ? 0.0 : HUGE_VAL;
    case SHAPE_COUNT: break;
    }
    return HUGE_VAL;
}

static double reach_along(const solid_shape *s, vec3 d)
{
    const mat3 turn = rotation_from_deg(s->rotation_deg);
    return vec3_dot(s->position, d) + reach_in_own_frame(s, mat3_apply_transposed(turn, d));
}

/* Does a plane across d lie between them, a behind it? */
static bool parted_along(const solid_shape *a, const solid_shape *b, vec3 d)
{
    const double below = reach_along(a, d), above = -reach_along(b, vec3_scale(d, -1.0));
    return below <= above && below < HUGE_VAL && above > -HUGE_VAL;
}

static bool parted_by_axes_of(const solid_shape *frame, const solid_shape *a, const solid_shape *b)
{
    const mat3 turn = rotation_from_deg(frame->rotation_deg);
    const vec3 axes[3] = {vec3_make(1, 0, 0), vec3_make(0, 1, 0), vec3_make(0, 0, 1)};
    for (int i = 0; i < 3; i++) {
        const vec3 d = mat3_apply(turn, axes[i]);
        if (parted_along(a, b, d) || parted_along(b, a, d)) {
            return true;
        }
    }
    return false;
}

bool solid_shapes_apart(const solid_shape *a, const solid_shape *b)
{
    const solid_shape upright = {.rotation_deg = {0, 0, 0}};
    const vec3 between = vec3_sub(b->position, a->position), level = vec3_make(between.x, 0.0, between.z);
    const double length = vec3_length(between), width = vec3_length(level);
    return parted_by_axes_of(a, a, b) || parted_by_axes_of(b, a, b) || parted_by_axes_of(&upright, a, b) ||
           (length > 0.0 && parted_along(a, b, vec3_scale(between, 1.0 / length))) ||
           (width > 0.0 && parted_along(a, b, vec3_scale(level, 1.0 / width)));
}
