/* A test whether two solids may have coincident faces. */
#include "geometry/shared_faces.h"

#include "geometry/shapes/shape.h"
#include <math.h>

/* The plane n.x = at; n is a unit vector. */
typedef struct flat {
    vec3 n;
    double at;
} flat;

enum { COMPARED_MAX = 1000000 }; /* pairs of faces; for more, the answer is "perhaps" */

static bool flat_at(const solid_shape *s, size_t i, flat *out)
{
    vec3 normal, point;
    const shape_rule *rule = shape_of(s);
    if (!rule->flat || !rule->flat(s, i, &normal, &point))
        return false;
    const mat3 turn = rotation_from_deg(s->rotation_deg);
    out->n = mat3_apply(turn, vec3_normalize(normal));
    out->at = vec3_dot(out->n, vec3_add(s->position, mat3_apply(turn, point)));
    return true;
}

static size_t flat_count(const solid_shape *s)
{
    size_t count = 0;
    for (flat unused; count <= COMPARED_MAX && flat_at(s, count, &unused);)
        count++;
    return count;
}

/* True if the planes are equal up to rounding: the normals within 1.4e-6 rad (a cosine of 1 - 1e-12), the distances
 * from the origin within a share of 1e-9. A sliver without a normal (NaN) counts as equal. */
static bool is_same_plane(flat a, flat b)
{
    const double same = vec3_dot(a.n, b.n), slack = 1e-9 * (1.0 + fabs(a.at));
    return !(fabs(same) < 1.0 - 1e-12) && !(fabs(a.at - (same < 0.0 ? -b.at : b.at)) > slack);
}

/* A mesh with several copies, or one that is not loaded. */
static bool is_unknown(const solid_shape *s)
{
    return shape_of(s)->triangles && (!s->mesh || s->copies.x > 1.0 || s->copies.y > 1.0 || s->copies.z > 1.0);
}

bool solid_shapes_may_share_faces(const solid_shape *a, const solid_shape *b)
{
    if ((shape_of(a)->curved && shape_of(b)->curved) || is_unknown(a) || is_unknown(b))
        return true;
    const size_t of_a = flat_count(a), of_b = flat_count(b);
    if (of_b > 0 && of_a > COMPARED_MAX / of_b)
        return true;
    flat one, other;
    for (size_t i = 0; flat_at(a, i, &one); i++) {
        for (size_t k = 0; flat_at(b, k, &other); k++)
            if (is_same_plane(one, other))
                return true;
    }
    return false;
}
