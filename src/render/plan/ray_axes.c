/* The axes of a fan or beam, and its rays: in a plane, or along Vogel's spiral over a disc or cone. */
#include "render/plan/ray_axes.h"

#include "base/elementary.h"

status ray_axes_set(ray_axes *a, vec3 from, vec3 axis, const vec3 *normal, diagnostic *why)
{
    if (!(vec3_length(axis) > 0.0 && isfinite(vec3_length(axis))))
        return diagnose(why, STATUS_BAD_INPUT, "give two points", "from and to are the same point");
    a->from = from;
    a->axis = vec3_normalize(axis);
    vec3 n = normal ? *normal : vec3_make(0, 1, 0);
    if (!normal && axis.y != 0.0) {
        const vec3 level = vec3_cross(a->axis, vec3_make(0, 1, 0));
        n = vec3_length(level) > 1e-9 ? level : vec3_make(0, 0, 1);
    }
    const double length = vec3_length(n);
    vec3 across_axis = vec3_sub(n, vec3_scale(a->axis, vec3_dot(n, a->axis)));
    if (!(length > 0.0 && isfinite(length)) || vec3_length(across_axis) < 1e-9 * length)
        return diagnose(why, STATUS_BAD_INPUT, "give a normal that is not along the axis",
                        "the normal is zero or parallel to the axis");
    a->normal = vec3_normalize(across_axis);
    /* Choose the sign: upwards, or for a horizontal plane, to the left of the axis seen from above. */
    a->across = vec3_cross(a->axis, a->normal);
    if (fabs(a->across.y) > 1e-9 ? a->across.y < 0.0 : a->axis.x * a->across.z - a->axis.z * a->across.x < 0.0)
        a->across = vec3_scale(a->across, -1.0);
    return STATUS_OK;
}

double ray_axes_in_plane(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction)
{
    const double fraction = n > 1 ? (double)i / (n - 1) - 0.5 : 0.0, offset = size * fraction;
    *origin = a->from, *direction = a->axis;
    if (!spreads) {
        *origin = vec3_add(a->from, vec3_scale(a->across, offset));
        return offset;
    }
    double sine, cosine;
    elementary_sincos_deg(offset, &sine, &cosine);
    *direction = vec3_add(vec3_scale(a->axis, cosine), vec3_scale(a->across, sine));
    return offset;
}

void ray_axes_round(const ray_axes *a, bool spreads, double size, int i, int n, vec3 *origin, vec3 *direction)
{
    const double golden_deg = 137.50776405003785; /* 180 (3 - sqrt 5) */
    const double fraction = n > 1 ? (i + 0.5) / n : 0.0;
    double sine, cosine;
    elementary_sincos_deg(fmod(golden_deg * i, 360.0), &sine, &cosine);
    const vec3 radial = vec3_add(vec3_scale(a->across, cosine), vec3_scale(a->normal, sine));
    *origin = a->from, *direction = a->axis;
    if (!spreads) {
        *origin = vec3_add(a->from, vec3_scale(radial, 0.5 * size * sqrt(fraction)));
        return;
    }
    double half_sine, half_cosine;
    elementary_sincos_deg(0.25 * size, &half_sine, &half_cosine);
    /* 1 - cos t is uniform in solid angle; the half angle avoids cancellation in a narrow cone */
    const double versine = 2.0 * half_sine * half_sine * fraction;
    *direction = vec3_add(vec3_scale(a->axis, 1.0 - versine), vec3_scale(radial, sqrt(versine * (2.0 - versine))));
}
