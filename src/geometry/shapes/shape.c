/* The table of shapes, and queries that every shape answers. */
#include "geometry/primitives/primitive.h"
#include "geometry/scene_geometry.h"
#include "geometry/shapes/parts.h"
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

/* --- scale --- */

bool shape_is_scaled(const solid_shape *s)
{
    return rule_scales(shape_of(s), s);
}

shape_extent shape_extent_of(const solid_shape *s)
{
    return rule_extent(shape_of(s), s);
}

double shape_farthest(const solid_shape *s, vec3 d)
{
    return rule_farthest(shape_of(s), s, d);
}

PRIMITIVE_RULE(scaled_1);
PRIMITIVE_RULE(scaled_2);
PRIMITIVE_RULE(scaled_3);
PRIMITIVE_RULE(scaled_5);
PRIMITIVE_RULE(scaled_7);
PRIMITIVE_RULE(scaled_9);

status solid_shape_check(const solid_shape *shape, diagnostic *why)
{
    if (!vec3_is_finite(shape->position) || !vec3_is_finite(shape->rotation_deg))
        return diagnose(why, STATUS_BAD_INPUT, "use finite numbers", "position or rotation is not finite");
    const shape_rule *rule = shape_of_kind(shape->kind);
    if (!rule)
        return diagnose(why, STATUS_BAD_INPUT, "", "unknown shape");
    const vec3 k = shape->scale;
    if (!rule->triangles && !(k.x == 0.0 && k.y == 0.0 && k.z == 0.0) &&
        !(vec3_is_finite(k) && k.x != 0.0 && k.y != 0.0 && k.z != 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "use scales other than 0, and finite numbers", "scale is %g, %g, %g",
                        k.x, k.y, k.z);
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
    if (!shape_of(shape)->triangles)
        copy.scale = vec3_make(1.0, 1.0, 1.0);
    const vec3 p = shape->points->vertices[i], turned = shape->rotation_deg,
               scaled = vec3_make(shape->scale.x * p.x, shape->scale.y * p.y, shape->scale.z * p.z);
    const bool upright = turned.x == 0.0 && turned.y == 0.0 && turned.z == 0.0;
    copy.position = vec3_add(shape->position, upright ? scaled : mat3_apply(rotation_from_deg(turned), scaled));
    return copy;
}

bool shape_is_isotropic(const solid_shape *s)
{
    const vec3 k = sizes(s->scale);
    return shape_of(s)->isotropic && (!shape_is_scaled(s) || (k.x == k.y && k.y == k.z));
}

double shape_thickness(const solid_shape *s)
{
    const vec3 k = sizes(s->scale);
    return shape_of(s)->thickness(s) * (shape_is_scaled(s) ? fmin(k.x, fmin(k.y, k.z)) : 1.0);
}

int shape_rings(const solid_shape *s, shape_ring out[RINGS_MAX])
{
    const int count = shape_of(s)->rings(s, out);
    for (int i = 0; i < count && shape_is_scaled(s); i++)
        out[i].x *= s->scale.x, out[i].y *= s->scale.y, out[i].z *= s->scale.z;
    return count;
}

vec3 shape_tessellation_scale(const solid_shape *s)
{
    const shape_rule *rule = shape_of(s);
    const vec3 own = rule->tessellation_scale ? rule->tessellation_scale(s) : vec3_make(1.0, 1.0, 1.0);
    return shape_is_scaled(s) ? multiplied(own, s->scale) : own;
}

/* The shape without place and scale. */
static solid_shape unscaled(const solid_shape *s)
{
    solid_shape inner = *s;
    inner.position = inner.rotation_deg = vec3_make(0.0, 0.0, 0.0);
    inner.scale = vec3_make(1.0, 1.0, 1.0);
    return inner;
}

void shape_primitives(const solid_shape *s, primitive *parts)
{
    const shape_rule *rule = shape_of(s);
    if (!shape_is_scaled(s)) {
        rule->primitives(s, parts);
        return;
    }
    const solid_shape own = unscaled(s);
    primitive inner[SHAPE_PRIMITIVES];
    rule->primitives(&own, inner);
    const vec3 k = sizes(s->scale);
    for (int i = 0; i < rule->primitive_count; i++) {
        const primitive_rule *const by_intervals[CHORDS_MAX] = {&scaled_1_rule, &scaled_2_rule, &scaled_3_rule,
                                                                &scaled_5_rule, &scaled_5_rule, &scaled_7_rule,
                                                                &scaled_7_rule, &scaled_9_rule, &scaled_9_rule};
        parts[i] = primitive_placed(s, by_intervals[inner[i].rule->ISA_BASELINE->intervals - 1],
                                    inner[i].extent * fmax(k.x, fmax(k.y, k.z)));
        parts[i].sides = inner[i].sides;
    }
}

size_t shape_details(const solid_shape *s, int k, void *out)
{
    const shape_rule *rule = shape_of(s);
    if (!shape_is_scaled(s))
        return rule->details && k == 0 ? rule->details(s, out) : 0;
    const solid_shape own = unscaled(s);
    const size_t more = rule->details && k == 0 ? rule->details(&own, NULL) : 0;
    scaled_primitive *const d = out;
    if (d) {
        primitive inner[SHAPE_PRIMITIVES];
        rule->primitives(&own, inner);
        *d = (scaled_primitive){s->scale, divided(vec3_make(1.0, 1.0, 1.0), s->scale), inner[k]};
        d->inner.turned = true;
        if (more > 0)
            rule->details(&own, d + 1), d->inner.details = d + 1;
    }
    return sizeof(scaled_primitive) + more;
}

bool solid_shape_contains(const solid_shape *shape, vec3 point)
{
    const shape_rule *rule = shape_of(shape);
    const vec3 from_center = vec3_sub(point, shape->position), turned = shape->rotation_deg;
    if (!rule->contains || shape->points)
        return false;
    const bool upright = turned.x == 0.0 && turned.y == 0.0 && turned.z == 0.0; /* often so, for drawings */
    const vec3 local = upright ? from_center : mat3_apply_transposed(rotation_from_deg(turned), from_center);
    return rule->contains(shape, shape_is_scaled(shape) ? divided(local, shape->scale) : local);
}

placed_shape shape_placed(const solid_shape *shape)
{
    return (placed_shape){*shape, rotation_from_deg(shape->rotation_deg), shape_of(shape)};
}

double shape_reach(const solid_shape *shape, vec3 d)
{
    const shape_rule *rule = shape_of(shape);
    return points_reach(shape, d) +
           (rule->triangles ? box_reach(rule->extent(shape).box, d) : shape_farthest(shape, d));
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
    if (shape_is_scaled(s))
        normal = divided(normal, s->scale), point = multiplied(point, s->scale);
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
