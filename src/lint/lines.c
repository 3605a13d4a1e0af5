#include "lint/lines.h"

#include "geometry/primitives/primitive.h"
#include <math.h>
#include <string.h>

static void add_span(line_spans *s, double in, double out)
{
    if (in < out && s->count < SPANS_MAX) {
        s->in[s->count] = in;
        s->out[s->count++] = out;
    }
}

typedef struct mesh_crossings {
    int count;
    double t[2 * SPANS_MAX];
    int facing[2 * SPANS_MAX];
} mesh_crossings;

static void take_crossing(void *context, const mesh_hit *hit)
{
    mesh_crossings *c = context;
    int i = c->count++;
    if (i >= 2 * SPANS_MAX) /* too many: the count says so */
        return;
    for (; i > 0 && c->t[i - 1] > hit->t; i--) {
        c->t[i] = c->t[i - 1];
        c->facing[i] = c->facing[i - 1];
    }
    c->t[i] = hit->t;
    c->facing[i] = hit->facing;
}

/* Of one copy: in at a front, out at a back, and so on. From here the line is followed from its origin, which lies
 * before the mesh. */
static bool through_copy(const forest_part *p, uint32_t copy, const line *l, line_spans *out)
{
    const vec3 o = mat3_apply_transposed(p->rotation, vec3_sub(l->origin, forest_origin(p, copy)));
    const vec3 d = mat3_apply_transposed(p->rotation, l->direction), s = p->scale;
    const mesh_ray ray = {.origin = vec3_make(o.x / s.x, o.y / s.y, o.z / s.z),
                          .direction = vec3_make(d.x / s.x, d.y / s.y, d.z / s.z),
                          .t_max = HUGE_VAL,
                          .skip = TRIANGLE_NONE,
                          .facing = FACING_ANY};
    mesh_crossings c = {.count = 0};
    hierarchy_kernels_sse2.all(p->tree, &ray, take_crossing, &c);
    if (c.count > 2 * SPANS_MAX || c.count % 2 || out->count + c.count / 2 > SPANS_MAX)
        return false;
    for (int i = 0; i < c.count; i++)
        if (c.facing[i] != (i % 2 ? FACING_BACK : FACING_FRONT))
            return false;
    for (int i = 0; i < c.count; i += 2)
        add_span(out, c.t[i], c.t[i + 1]);
    return true;
}

/* Copies do not overlap, and those of one line of them stand in the order of their distance only if they are looked
 * at so. */
static void sort_spans(line_spans *s)
{
    for (int i = 1; i < s->count; i++)
        for (int k = i; k > 0 && s->in[k - 1] > s->in[k]; k--) {
            const interval swap = {s->in[k], s->out[k]};
            s->in[k] = s->in[k - 1], s->out[k] = s->out[k - 1];
            s->in[k - 1] = swap.in, s->out[k - 1] = swap.out;
        }
}

enum { COPIES_FEW = 64 };

static bool through_mesh(const forest_part *p, const line *l, line_spans *out)
{
    const uint64_t copies = (uint64_t)p->copies[0] * p->copies[1] * p->copies[2];
    bool known = p->closed && copies <= COPIES_FEW;
    for (uint32_t i = 0; known && i < copies; i++)
        known = through_copy(p, i, l, out);
    sort_spans(out);
    return known;
}

bool line_through(const arrangement *a, const body *b, const line *l, line_spans *out)
{
    out->count = 0;
    const primitive *p = &a->primitives[b->outside];
    if (p->kind == PRIMITIVE_MESH)
        return through_mesh(&a->meshes->parts[a->meshes->by_primitive[b->outside]], l, out);
    interval whole[CHORDS_MAX], hollow[CHORDS_MAX] = {{HUGE_VAL, HUGE_VAL}};
    const int count = primitive_chords(p, l->origin, l->direction, whole);
    if (b->hollow >= 0 && primitive_chords(&a->primitives[b->hollow], l->origin, l->direction, hollow) == 0)
        hollow[0] = (interval){HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < count; i++) {
        add_span(out, whole[i].in, fmin(whole[i].out, hollow[0].in));
        add_span(out, fmax(whole[i].in, hollow[0].out), whole[i].out);
    }
    return true;
}

static bounds3 box_about(vec3 middle, vec3 half)
{
    return (bounds3){vec3_sub(middle, half), vec3_add(middle, half)};
}

/* How far the mesh or box of these half lengths in a turned frame reaches along the world's axes. */
static vec3 turned_half(const mat3 *turn, vec3 half)
{
    double h[3];
    for (int k = 0; k < 3; k++)
        h[k] = fabs(turn->row[k].x) * half.x + fabs(turn->row[k].y) * half.y + fabs(turn->row[k].z) * half.z;
    return vec3_make(h[0], h[1], h[2]);
}

static bounds3 mesh_box(const forest_part *p)
{
    const bounds3 b = p->triangles->bounds;
    const vec3 s = p->scale, n = vec3_make(p->copies[0] - 1.0, p->copies[1] - 1.0, p->copies[2] - 1.0),
               step = p->spacing;
    const vec3 low = vec3_make(b.low.x * s.x + fmin(0.0, n.x * step.x), b.low.y * s.y + fmin(0.0, n.y * step.y),
                               b.low.z * s.z + fmin(0.0, n.z * step.z));
    const vec3 high = vec3_make(b.high.x * s.x + fmax(0.0, n.x * step.x), b.high.y * s.y + fmax(0.0, n.y * step.y),
                                b.high.z * s.z + fmax(0.0, n.z * step.z));
    const vec3 middle = vec3_scale(vec3_add(low, high), 0.5);
    return box_about(vec3_add(p->origin, mat3_apply(p->rotation, middle)),
                     turned_half(&p->rotation, vec3_scale(vec3_sub(high, low), 0.5)));
}

static bounds3 cylinder_box(const primitive *p)
{
    const double deep = p->radius / sqrt(p->m2), half = 0.5 * (p->top - p->bottom);
    const vec3 middle = vec3_add(p->origin, mat3_apply(p->rotation, vec3_make(0.0, p->bottom + half, 0.0)));
    double h[3];
    for (int k = 0; k < 3; k++)
        h[k] = fabs(p->rotation.row[k].y) * half + hypot(p->rotation.row[k].x * p->radius, p->rotation.row[k].z * deep);
    return box_about(middle, vec3_make(h[0], h[1], h[2]));
}

bounds3 bounds_of_body(const arrangement *a, const body *b)
{
    const primitive *p = &a->primitives[b->outside];
    switch (p->kind) {
    case PRIMITIVE_CYLINDER: return cylinder_box(p);
    case PRIMITIVE_BOX: return box_about(p->origin, turned_half(&p->rotation, p->half));
    case PRIMITIVE_SPHERE: return box_about(p->origin, vec3_make(p->radius, p->radius, p->radius));
    case PRIMITIVE_MESH: return mesh_box(&a->meshes->parts[a->meshes->by_primitive[b->outside]]);
    case PRIMITIVE_HALFSPACE: break;
    }
    const vec3 ever = vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL);
    return (bounds3){vec3_scale(ever, -1.0), ever};
}

static double least_of_three(vec3 v)
{
    return fmin(v.x, fmin(v.y, v.z));
}

double shape_thickness(const solid_shape *shape)
{
    switch (shape->kind) {
    case SHAPE_PLANE: return HUGE_VAL;
    case SHAPE_CYLINDER: return fmin(shape->height, 2.0 * fmin(shape->radius, shape->radius / shape->m));
    case SHAPE_CUP: return fmin((shape->radius - shape->inner_radius) * fmin(1.0, 1.0 / shape->m), shape->floor);
    case SHAPE_BOX: return least_of_three(shape->size);
    case SHAPE_SPHERE: return 2.0 * shape->radius;
    case SHAPE_MESH: {
        const double area = mesh_area(shape->mesh);
        return area > 0.0 ? 2.0 * fabs(mesh_volume(shape->mesh)) / area * least_of_three(shape->scale) : 0.0;
    }
    case SHAPE_COUNT: break;
    }
    return 0.0;
}
