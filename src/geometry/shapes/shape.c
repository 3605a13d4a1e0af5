/* The table of shapes, and queries that every shape answers. */
#include "geometry/shapes/shape.h"
#include "geometry/scene_geometry.h"
#include <math.h>
#include <string.h>

#define SHAPE_RULE(KIND, file) [SHAPE_##KIND] = &shape_##file,
static const shape_rule *const rules[SHAPE_COUNT] = {SHAPES(SHAPE_RULE)};

const shape_rule *shape_of_kind(shape_kind kind)
{
    return (size_t)kind < SHAPE_COUNT ? rules[kind] : NULL;
}

bool shape_named(const char *word, shape_kind *out)
{
    for (int k = 0; k < SHAPE_COUNT; k++) {
        if (strcmp(rules[k]->word, word) == 0) {
            *out = (shape_kind)k;
            return true;
        }
    }
    return false;
}

bool shape_has(const shape_rule *rule, const char *parameter)
{
    for (const char *const *name = rule->parameters; name && *name; name++)
        if (strcmp(*name, parameter) == 0)
            return true;
    return false;
}

const char *shape_face_name(const shape_rule *rule, int64_t face)
{
    const char *const *names = rule->triangles ? NULL : rule->faces[face >= HOLLOW_FACES && rule->primitive_count > 1];
    for (int64_t i = rule->primitive_count > 1 ? face % HOLLOW_FACES : face; names && i > 0 && names[1]; i--)
        names++;
    return names ? *names : "surface";
}

const shape_rule *shape_of(const solid_shape *shape)
{
    return rules[shape->kind];
}

status solid_shape_check(const solid_shape *shape, diagnostic *why)
{
    if (!vec3_is_finite(shape->position) || !vec3_is_finite(shape->rotation_deg))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers", "position or rotation is not finite");
    const shape_rule *rule = shape_of_kind(shape->kind);
    if (!rule)
        return diagnose(why, STATUS_BAD_INPUT, "", "unknown shape");
    return rule->check ? rule->check(shape, why) : STATUS_OK;
}

size_t solid_shape_count(const solid_shape *shape)
{
    return shape->points ? shape->points->vertex_count : 1;
}

solid_shape solid_shape_copy(const solid_shape *shape, size_t i)
{
    solid_shape copy = *shape;
    copy.points = NULL;
    if (!shape->points)
        return copy;
    const vec3 p = shape->points->vertices[i], turned = shape->rotation_deg,
               scaled = vec3_make(shape->scale.x * p.x, shape->scale.y * p.y, shape->scale.z * p.z);
    const bool upright = turned.x == 0.0 && turned.y == 0.0 && turned.z == 0.0;
    copy.position = vec3_add(shape->position, upright ? scaled : mat3_apply(rotation_from_deg(turned), scaled));
    return copy;
}

bool solid_shape_contains(const solid_shape *shape, vec3 point)
{
    const shape_rule *rule = shape_of(shape);
    const vec3 from_center = vec3_sub(point, shape->position), turned = shape->rotation_deg;
    if (!rule->contains || shape->points)
        return false;
    if (turned.x == 0.0 && turned.y == 0.0 && turned.z == 0.0) /* the common case; drawings call this often */
        return rule->contains(shape, from_center);
    return rule->contains(shape, mat3_apply_transposed(rotation_from_deg(turned), from_center));
}

placed_shape shape_placed(const solid_shape *shape)
{
    return (placed_shape){*shape, rotation_from_deg(shape->rotation_deg), shape_of(shape)};
}

double shape_reach(const solid_shape *shape, vec3 d)
{
    const shape_rule *rule = shape_of(shape);
    return points_reach(shape, d) +
           (rule->triangles ? box_reach(rule->extent(shape).box, d) : rule->farthest(shape, d));
}

bounds3 shape_world_box(const solid_shape *shape)
{
    const vec3 infinite = vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL), at = shape->position;
    if (shape_of(shape)->unbounded)
        return (bounds3){vec3_scale(infinite, -1.0), infinite};
    const mat3 turn = rotation_from_deg(shape->rotation_deg);
    double low[3], high[3];
    for (int k = 0; k < 3; k++) { /* the world's axes in the solid's frame */
        high[k] = shape_reach(shape, turn.row[k]);
        low[k] = -shape_reach(shape, vec3_scale(turn.row[k], -1.0));
    }
    return (bounds3){vec3_add(at, vec3_make(low[0], low[1], low[2])),
                     vec3_add(at, vec3_make(high[0], high[1], high[2]))};
}

/* --- coincident faces --- */

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
 * from the origin within a fraction of 1e-9. A sliver without a normal (NaN) counts as equal. */
static bool is_same_plane(flat a, flat b)
{
    const double same = vec3_dot(a.n, b.n), slack = 1e-9 * (1.0 + fabs(a.at));
    return !(fabs(same) < 1.0 - 1e-12) && !(fabs(a.at - (same < 0.0 ? -b.at : b.at)) > slack);
}

/* A solid at several points, a mesh with several copies, or one that is not loaded. */
static bool is_unknown(const solid_shape *s)
{
    return s->points ||
           (shape_of(s)->triangles && (!s->mesh || s->copies.x > 1.0 || s->copies.y > 1.0 || s->copies.z > 1.0));
}

bool solid_shapes_may_coincide(const solid_shape *a, const solid_shape *b)
{
    if ((shape_of(a)->curved && shape_of(b)->curved) || is_unknown(a) || is_unknown(b))
        return true;
    const size_t count_a = flat_count(a), count_b = flat_count(b);
    if (count_b > 0 && count_a > COMPARED_MAX / count_b)
        return true;
    flat one, other;
    for (size_t i = 0; flat_at(a, i, &one); i++) {
        for (size_t k = 0; flat_at(b, k, &other); k++)
            if (is_same_plane(one, other))
                return true;
    }
    return false;
}
