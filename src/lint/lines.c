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
    if (i >= 2 * SPANS_MAX) /* too many: the count shows it */
        return;
    for (; i > 0 && c->t[i - 1] > hit->t; i--) {
        c->t[i] = c->t[i - 1];
        c->facing[i] = c->facing[i - 1];
    }
    c->t[i] = hit->t;
    c->facing[i] = hit->facing;
}

/* One copy: alternating front and back faces. The line is traced from its origin, in front of the mesh. */
static bool through_copy(const instanced_mesh *p, uint32_t copy, const line *l, line_spans *out)
{
    const vec3 o = mat3_apply_transposed(p->rotation, vec3_sub(l->origin, instance_set_origin(p, copy)));
    const vec3 d = mat3_apply_transposed(p->rotation, l->direction), s = p->scale;
    const mesh_ray ray = {.origin = vec3_make(o.x / s.x, o.y / s.y, o.z / s.z),
                          .direction = vec3_make(d.x / s.x, d.y / s.y, d.z / s.z),
                          .t_max = HUGE_VAL,
                          .skip = TRIANGLE_NONE,
                          .facing = FACING_ANY};
    mesh_crossings c = {.count = 0};
    ISA_BASE_OF(hierarchy_kernels).all(p->tree, &ray, take_crossing, &c);
    if (c.count > 2 * SPANS_MAX || c.count % 2 || out->count + c.count / 2 > SPANS_MAX)
        return false;
    for (int i = 0; i < c.count; i++)
        if (c.facing[i] != (i % 2 ? FACING_BACK : FACING_FRONT))
            return false;
    for (int i = 0; i < c.count; i += 2)
        add_span(out, c.t[i], c.t[i + 1]);
    return true;
}

/* Copies do not overlap, but those on one line are not in the order of distance for every direction. */
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

static bool through_mesh(const instanced_mesh *p, const line *l, line_spans *out)
{
    const uint64_t copies = (uint64_t)p->copies[0] * p->copies[1] * p->copies[2];
    bool known = p->closed && copies <= COPIES_FEW;
    for (uint32_t i = 0; known && i < copies; i++)
        known = through_copy(p, i, l, out);
    sort_spans(out);
    return known;
}

bool line_through(const scene_geometry *a, const region *b, const line *l, line_spans *out)
{
    out->count = 0;
    const primitive *p = &a->primitives[b->outside];
    if (!p->rule)
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
