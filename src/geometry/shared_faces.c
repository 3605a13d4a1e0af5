#include "geometry/shared_faces.h"

#include <math.h>

/* The plane n.x = at, n a unit vector. */
typedef struct flat {
    vec3 n;
    double at;
} flat;

enum { COMPARED_MAX = 1000000 };

static size_t flat_count(const solid_shape *s)
{
    switch (s->kind) {
    case SHAPE_PLANE: return 1;
    case SHAPE_CYLINDER: return 2;
    case SHAPE_CUP: return 3;
    case SHAPE_BOX: return 6;
    case SHAPE_MESH: return s->mesh->triangle_count;
    case SHAPE_SPHERE:
    case SHAPE_COUNT: break;
    }
    return 0;
}

static flat flat_through(const solid_shape *s, vec3 local_normal, vec3 local_point)
{
    const mat3 turn = rotation_from_deg(s->rotation_deg);
    const vec3 n = mat3_apply(turn, vec3_normalize(local_normal));
    return (flat){n, vec3_dot(n, vec3_add(s->position, mat3_apply(turn, local_point)))};
}

static flat flat_of_triangle(const solid_shape *s, size_t i)
{
    vec3 corner[3];
    for (int k = 0; k < 3; k++) {
        const vec3 v = s->mesh->vertices[s->mesh->triangles[i].corner[k]];
        corner[k] = vec3_make(v.x * s->scale.x, v.y * s->scale.y, v.z * s->scale.z);
    }
    return flat_through(s, vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0])), corner[0]);
}

static flat flat_at(const solid_shape *s, size_t i)
{
    const double up[3] = {0.0, s->height, s->floor};
    if (s->kind == SHAPE_MESH) {
        return flat_of_triangle(s, i);
    }
    if (s->kind != SHAPE_BOX) {
        const double y = s->kind == SHAPE_PLANE ? 0.0 : up[i];
        return flat_through(s, vec3_make(0, 1, 0), vec3_make(0, y, 0));
    }
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const vec3 n = vec3_make(i / 2 == 0 ? side : 0.0, i / 2 == 1 ? side : 0.0, i / 2 == 2 ? side : 0.0);
    return flat_through(s, n, vec3_make(0.5 * n.x * s->size.x, 0.5 * n.y * s->size.y, 0.5 * n.z * s->size.z));
}

/* Up to rounding; a sliver without a normal counts as well. */
static bool is_one_plane(flat a, flat b)
{
    const double same = vec3_dot(a.n, b.n), slack = 1e-9 * (1.0 + fabs(a.at));
    return !(fabs(same) < 1.0 - 1e-12) && !(fabs(a.at - (same < 0.0 ? -b.at : b.at)) > slack);
}

static bool is_curved(const solid_shape *s)
{
    return s->kind == SHAPE_CYLINDER || s->kind == SHAPE_CUP || s->kind == SHAPE_SPHERE;
}

static bool has_copies(const solid_shape *s)
{
    return s->kind == SHAPE_MESH && (s->copies.x > 1.0 || s->copies.y > 1.0 || s->copies.z > 1.0);
}

bool solid_shapes_may_share_faces(const solid_shape *a, const solid_shape *b)
{
    if ((is_curved(a) && is_curved(b)) || (a->kind == SHAPE_MESH && !a->mesh) || (b->kind == SHAPE_MESH && !b->mesh)) {
        return true;
    }
    const size_t of_a = flat_count(a), of_b = flat_count(b);
    if (has_copies(a) || has_copies(b) || (of_b > 0 && of_a > COMPARED_MAX / of_b)) {
        return true;
    }
    for (size_t i = 0; i < of_a; i++) {
        const flat one = flat_at(a, i);
        for (size_t k = 0; k < of_b; k++) {
            if (is_one_plane(one, flat_at(b, k))) {
                return true;
            }
        }
    }
    return false;
}
