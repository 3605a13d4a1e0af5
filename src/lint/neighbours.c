/* Notes pairs of solids that overlap with equal priority, or leave a narrow gap, found along a lattice of lines through
 * both. A finding is confirmed at nearby points before it becomes a note: touching is not overlapping, and the closest
 * point of two curved surfaces is not a gap. */
#include "base/array.h"
#include "base/cancel.h"
#include "geometry/primitives/primitive.h"
#include "geometry/regions/instance_set.h"
#include "geometry/scene_geometry.h"
#include "geometry/shapes/shape.h"
#include "lint/inert.h"
#include "scene/model/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- intersections of lines with solids --- */

/* A line, infinite in both directions; the direction is a unit vector. */
typedef struct line {
    vec3 origin, direction;
} line;

enum { SPANS_MAX = 32 };
/* The segments of a line inside a solid: sorted and disjoint. Ends may be infinite. */
typedef struct line_spans {
    int count;
    double in[SPANS_MAX], out[SPANS_MAX];
} line_spans;

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

static void add_crossing(void *context, const mesh_hit *hit)
{
    mesh_crossings *c = context;
    int i = c->count++;
    if (i >= 2 * SPANS_MAX) /* too many: the caller sees it by the count */
        return;
    for (; i > 0 && c->t[i - 1] > hit->t; i--) {
        c->t[i] = c->t[i - 1];
        c->facing[i] = c->facing[i - 1];
    }
    c->t[i] = hit->t;
    c->facing[i] = hit->facing;
}

/* Adds the segments inside one copy; false unless the line crosses front and back faces in turn. The line's origin must
 * be in front of the mesh. */
static bool through_copy(const instanced_mesh *p, uint32_t copy, const line *l, isa level, line_spans *out)
{
    static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);
    const vec3 o = mat3_apply_transposed(p->rotation, vec3_sub(l->origin, instance_set_origin(p, copy)));
    const vec3 d = mat3_apply_transposed(p->rotation, l->direction), s = p->scale;
    const mesh_ray ray = {.origin = vec3_make(o.x / s.x, o.y / s.y, o.z / s.z),
                          .direction = vec3_make(d.x / s.x, d.y / s.y, d.z / s.z),
                          .t_max = HUGE_VAL,
                          .skip = TRIANGLE_NONE,
                          .facing = FACING_ANY};
    mesh_crossings c = {.count = 0};
    kernels[level]->all(p->tree, &ray, add_crossing, &c);
    if (c.count > 2 * SPANS_MAX || c.count % 2 || out->count + c.count / 2 > SPANS_MAX)
        return false;
    for (int i = 0; i < c.count; i++)
        if (c.facing[i] != (i % 2 ? FACING_BACK : FACING_FRONT))
            return false;
    for (int i = 0; i < c.count; i += 2)
        add_span(out, c.t[i], c.t[i + 1]);
    return true;
}

/* Sorts the segments: copies do not overlap, but a line may meet them in any order. */
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

static bool through_mesh(const instanced_mesh *p, const line *l, isa level, line_spans *out)
{
    const uint64_t copies = (uint64_t)p->copies[0] * p->copies[1] * p->copies[2];
    bool known = p->closed && copies <= COPIES_FEW;
    for (uint32_t i = 0; known && i < copies; i++)
        known = through_copy(p, i, l, level, out);
    sort_spans(out);
    return known;
}

/* Intersects a line with a solid. False if undecidable: an open mesh, more than SPANS_MAX segments, or a line through
 * an edge of a mesh, which counts as no crossing or two. */
static bool line_through(const scene_geometry *a, const region *b, const line *l, isa level, line_spans *out)
{
    out->count = 0;
    const primitive *p = &a->primitives[b->outside];
    if (!p->rule)
        return through_mesh(&a->meshes->parts[a->meshes->by_primitive[b->outside]], l, level, out);
    interval outer[CHORDS_MAX], inner[CHORDS_MAX];
    inner[0] = (interval){HUGE_VAL, HUGE_VAL};
    const int count = primitive_chords(p, l->origin, l->direction, outer);
    if (b->hollow >= 0 && primitive_chords(&a->primitives[b->hollow], l->origin, l->direction, inner) == 0)
        inner[0] = (interval){HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < count; i++) {
        add_span(out, outer[i].in, fmin(outer[i].out, inner[0].in));
        add_span(out, fmax(outer[i].in, inner[0].out), outer[i].out);
    }
    return true;
}

/* --- pairs of solids --- */

enum { LATTICE_LEAST = 8, LATTICE_MOST = 32, LINES_MAX = 200000 };
/* Fractions of the thinner solid's thickness: */
#define GAP_FRACTION 1e-3     /* a smaller gap is narrow */
#define PATCH_FRACTION 0.25   /* a narrow gap must extend over this */
#define OVERLAP_FRACTION 1e-6 /* a smaller overlap counts as touching */
/* Fraction of the coordinates: closer surfaces are in contact. */
#define CONTACT_FRACTION 1e-12

typedef struct neighbour {
    const region *of;
    const solid *owner;
    bounds3 box;
    double thickness;
    int priority_index;
} neighbour;

typedef struct pair {
    const lint_input *input;
    const neighbour *a, *b;
    vec3 low, high; /* the bounds common to both solids, enlarged by gaps */
    double thinner, extent;
    int lattice;         /* lines per edge of the lattice */
    bool overlaps, gaps; /* what to look for */
    float *gap;          /* width of the narrow gap on each line of one axis, 0 for none; lattice * lattice */
    double *middle;      /* distance of the gap's middle along the line */
} pair;

static double *component(vec3 *v, int axis)
{
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

static bool is_in(const scene_geometry *a, const region *b, uint64_t inside)
{
    return scene_geometry_set_has(a, inside, b->outside) && !scene_geometry_set_has(a, inside, b->hollow);
}

/* The minimum depth of an overlap. */
static double deep_enough(const pair *p)
{
    return fmax(OVERLAP_FRACTION * p->thinner, CONTACT_FRACTION * p->extent);
}

/* Whether both solids contain the point and a neighbourhood around it. */
static bool overlap_at(const pair *p, vec3 point)
{
    const scene_geometry *a = p->input->probe->geometry;
    const double far = deep_enough(p);
    for (int i = 0; i < 6; i++) {
        vec3 at = point;
        *component(&at, i / 2) += i % 2 ? far : -far;
        const uint64_t inside = scene_geometry_inside(a, at);
        if (!is_in(a, p->a->of, inside) || !is_in(a, p->b->of, inside))
            return false;
    }
    return true;
}

static inline line lattice_line(const pair *p, int axis, int i, int j)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    vec3 low = p->low, high = p->high;
    line l = {low, {0.0, 0.0, 0.0}};
    /* irregular fractions, to avoid edges */
    *component(&l.origin, u) += (*component(&high, u) - *component(&low, u)) * (i + 0.4871) / p->lattice;
    *component(&l.origin, v) += (*component(&high, v) - *component(&low, v)) * (j + 0.5237) / p->lattice;
    vec3 first = p->a->box.low, second = p->b->box.low;
    const double before =
        fmin(isfinite(*component(&first, axis)) ? *component(&first, axis) : *component(&low, axis),
             isfinite(*component(&second, axis)) ? *component(&second, axis) : *component(&low, axis));
    *component(&l.origin, axis) = before - 0.01 * (*component(&high, axis) - before) - p->thinner * GAP_FRACTION;
    *component(&l.direction, axis) = 1.0;
    return l;
}

static vec3 line_at(const line *l, double t)
{
    return vec3_add(l->origin, vec3_scale(l->direction, t));
}

static bool spans_overlap(const pair *p, const line *l, const line_spans *a, const line_spans *b)
{
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < b->count; k++) {
            const double in = fmax(a->in[i], b->in[k]), out = fmin(a->out[i], b->out[k]);
            if (out - in > 2.0 * deep_enough(p) && isfinite(in) && isfinite(out) &&
                overlap_at(p, line_at(l, 0.5 * (in + out))))
                return true;
        }
    return false;
}

/* The width of the narrowest gap between the segments of two solids that are not in contact; 0 for none. */
static double spans_gap(const pair *p, const line_spans *a, const line_spans *b, double *middle)
{
    double best = GAP_FRACTION * p->thinner;
    bool found = false;
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < b->count; k++) {
            const bool first = a->out[i] <= b->in[k];
            const double from = first ? a->out[i] : b->out[k], to = first ? b->in[k] : a->in[i];
            if (to - from < best && to - from > CONTACT_FRACTION * p->extent) {
                best = to - from;
                *middle = 0.5 * (from + to);
                found = true;
            }
        }
    return found ? best : 0.0;
}

/* The segments inside both solids; false if a solid has none, or they are undecidable. A mesh comes last, because it
 * takes longest. */
static bool meet_both(const pair *p, const line *l, line_spans *one, line_spans *two)
{
    const scene_geometry *g = p->input->probe->geometry;
    const isa level = p->input->level;
    const bool mesh_first = !g->primitives[p->a->of->outside].rule;
    const region *early = mesh_first ? p->b->of : p->a->of, *late = mesh_first ? p->a->of : p->b->of;
    line_spans *early_spans = mesh_first ? two : one, *late_spans = mesh_first ? one : two;
    return line_through(g, early, l, level, early_spans) && early_spans->count > 0 &&
           line_through(g, late, l, level, late_spans) && late_spans->count > 0;
}

/* Examines all lines of an axis; true if the solids overlap. */
static bool examine_along(const pair *p, int axis)
{
    for (int i = 0; i < p->lattice && !cancel_asked(); i++)
        for (int j = 0; j < p->lattice; j++) {
            const line l = lattice_line(p, axis, i, j);
            line_spans one, two;
            float *gap = &p->gap[i * p->lattice + j];
            *gap = 0.0F;
            if (!meet_both(p, &l, &one, &two))
                continue;
            if (p->overlaps && spans_overlap(p, &l, &one, &two))
                return true;
            if (p->gaps)
                *gap = (float)spans_gap(p, &one, &two, &p->middle[i * p->lattice + j]);
        }
    return false;
}

/* Whether there is a narrow gap, which no solid fills, both on line i, j and on the eight lines that are step_u and
 * step_v away from it. */
static bool is_patch(const pair *p, int axis, int i, int j, int step_u, int step_v)
{
    const scene_geometry *a = p->input->probe->geometry;
    for (int di = -1; di <= 1; di++)
        for (int dj = -1; dj <= 1; dj++) {
            const int at_i = i + di * step_u, at_j = j + dj * step_v;
            if (at_i < 0 || at_j < 0 || at_i >= p->lattice || at_j >= p->lattice ||
                p->gap[at_i * p->lattice + at_j] == 0.0F)
                return false;
        }
    for (int di = -1; di <= 1; di++)
        for (int dj = -1; dj <= 1; dj++) {
            const int at_i = i + di * step_u, at_j = j + dj * step_v;
            const line l = lattice_line(p, axis, at_i, at_j);
            if (scene_geometry_priority_index(
                    a, scene_geometry_inside(a, line_at(&l, p->middle[at_i * p->lattice + at_j]))) != 0)
                return false;
        }
    return true;
}

/* Number of lines from the centre of a patch to its edge. */
static int patch_step(const pair *p, int axis)
{
    vec3 size = vec3_sub(p->high, p->low);
    const double spacing = *component(&size, axis) / p->lattice;
    return (int)fmin(p->lattice, fmax(1.0, ceil(0.5 * PATCH_FRACTION * p->thinner / spacing)));
}

/* The narrowest gap of an axis. */
static double narrowest(const pair *p)
{
    double least = HUGE_VAL;
    for (int i = 0; i < p->lattice * p->lattice; i++)
        least = p->gap[i] > 0.0F ? fmin(least, p->gap[i]) : least;
    return least;
}

/* The width of the narrowest gap along an axis, if a patch of its lines has narrow gaps; 0 for none. */
static double find_patch(const pair *p, int axis)
{
    const int step_u = patch_step(p, (axis + 1) % 3), step_v = patch_step(p, (axis + 2) % 3);
    for (int i = step_u; i < p->lattice - step_u; i++)
        for (int j = step_v; j < p->lattice - step_v; j++)
            if (p->gap[i * p->lattice + j] > 0.0F && is_patch(p, axis, i, j, step_u, step_v))
                return narrowest(p);
    return 0.0;
}

static void note_overlap(const pair *p)
{
    const solid *first = p->a->owner < p->b->owner ? p->a->owner : p->b->owner,
                *second = first == p->a->owner ? p->b->owner : p->a->owner;
    note_report(p->input->taker, second->name, "priority",
                "give a higher priority to the solid that displaces the other",
                "%s and %s overlap with equal priority and different media: %s fills the overlap only because it is "
                "listed first",
                first->name, second->name, first->name);
}

static void note_gap(const pair *p, double gap)
{
    const neighbour *thin = p->a->thickness <= p->b->thickness ? p->a : p->b;
    const solid *first = p->a->owner < p->b->owner ? p->a->owner : p->b->owner,
                *second = first == p->a->owner ? p->b->owner : p->a->owner;
    note_report(p->input->taker, second->name, NULL,
                "make them touch exactly or overlap (the higher priority then decides), or move them apart",
                "the gap between %s and %s is about %.2g, less than a thousandth of the thickness of %s "
                "(%.3g): it acts as a thin film",
                first->name, first == second ? "another copy of it" : second->name, gap, thin->owner->name,
                thin->thickness);
}

/* Two half-spaces intersect unless their planes are parallel, and each is outside the other. */
static bool planes_overlap(const pair *p)
{
    const primitive *a = &p->input->probe->geometry->primitives[p->a->of->outside],
                    *b = &p->input->probe->geometry->primitives[p->b->of->outside];
    const vec3 up_a = vec3_make(a->rotation.row[0].y, a->rotation.row[1].y, a->rotation.row[2].y);
    const vec3 up_b = vec3_make(b->rotation.row[0].y, b->rotation.row[1].y, b->rotation.row[2].y);
    const double distance = vec3_dot(vec3_sub(b->origin, a->origin), up_a);
    return vec3_dot(up_a, up_b) > -1.0 + 1e-9 || distance < -OVERLAP_FRACTION * fmax(1.0, fmax(a->extent, b->extent));
}

/* True if there is a note. */
static bool examine_pair(pair *p)
{
    bool overlap = false;
    double gap = 0.0;
    if (isfinite(p->high.x - p->low.x)) {
        for (int axis = 0; axis < 3 && !overlap; axis++) {
            overlap = examine_along(p, axis);
            if (!overlap && p->gaps && gap == 0.0)
                gap = find_patch(p, axis);
        }
    } else {
        overlap = p->overlaps && planes_overlap(p);
    }
    if (cancel_asked())
        return false; /* some lines were not examined */
    if (overlap)
        note_overlap(p);
    else if (gap > 0.0)
        note_gap(p, gap);
    return overlap || gap > 0.0;
}

/* Whether medium or absorption differ. */
static bool media_differ(const plan *made, const neighbour *a, const neighbour *b)
{
    const vec3 off = vec3_sub(made->absorption[a->priority_index], made->absorption[b->priority_index]);
    return a->of->medium != b->of->medium || off.x != 0.0 || off.y != 0.0 || off.z != 0.0;
}

/* Whether the region's interface with the surroundings is visible: the solid is opaque, or its medium differs. */
static bool shows(const region *b)
{
    return b->opaque || b->medium != 0;
}

static bool is_covered(const lint_input *input, const neighbour *a, const neighbour *b)
{
    return scene_cover(input->original, a->owner) == b->owner || scene_cover(input->original, b->owner) == a->owner;
}

/* False: the pair needs no examination. */
static bool prepare_pair(const lint_input *input, const neighbour *a, const neighbour *b, pair *p)
{
    if (a->of->opaque && b->of->opaque)
        return false; /* their interior is invisible */
    if (a->owner == b->owner && !scene_points_of(input->original, a->owner))
        return false; /* layers of one mesh are one solid */
    *p = (pair){.input = input, .a = a, .b = b, .thinner = fmin(a->thickness, b->thickness)};
    if (!isfinite(p->thinner))
        p->thinner = 1.0;
    const double pad = GAP_FRACTION * p->thinner;
    p->low = vec3_make(fmax(a->box.low.x, b->box.low.x) - pad, fmax(a->box.low.y, b->box.low.y) - pad,
                       fmax(a->box.low.z, b->box.low.z) - pad);
    p->high = vec3_make(fmin(a->box.high.x, b->box.high.x) + pad, fmin(a->box.high.y, b->box.high.y) + pad,
                        fmin(a->box.high.z, b->box.high.z) + pad);
    p->extent = fmax(fmax(fmax(fabs(p->low.x), fabs(p->low.y)), fmax(fabs(p->low.z), fabs(p->high.x))),
                     fmax(fabs(p->high.y), fabs(p->high.z)));
    p->overlaps = a->owner != b->owner && a->owner->priority == b->owner->priority && media_differ(input->probe, a, b);
    p->gaps = shows(a->of) && shows(b->of);
    return (p->overlaps || p->gaps) && p->low.x < p->high.x && p->low.y < p->high.y && p->low.z < p->high.z;
}

/* Pairs that need examination, in the order of the solids. */
typedef struct candidate {
    int a, b; /* indices of neighbours, a < b */
} candidate;

typedef struct candidates {
    candidate *list;
    size_t count, room;
} candidates;

/* A neighbour's range in x, enlarged by the largest gap that a pair with it may have. */
typedef struct reach {
    double low, high;
    int of;
} reach;

static int by_low(const void *a, const void *b)
{
    const reach *one = a, *two = b;
    return (one->low > two->low) - (one->low < two->low);
}

static int by_solids(const void *a, const void *b)
{
    const candidate *one = a, *two = b;
    return one->a != two->a ? one->a - two->a : one->b - two->b;
}

static status add_candidate(const lint_input *input, const neighbour *all, int i, int k, candidates *to,
                            diagnostic *why)
{
    const candidate c = {i < k ? i : k, i < k ? k : i};
    pair p;
    if (!prepare_pair(input, &all[c.a], &all[c.b], &p))
        return STATUS_OK;
    if (!GROW(to->list, to->room, to->count + 1))
        return out_of_memory(why);
    to->list[to->count++] = c;
    return STATUS_OK;
}

/* By a sweep along x: solids far from each other are no pairs to look at. */
static status find_candidates(const lint_input *input, const neighbour *all, int count, candidates *to, diagnostic *why)
{
    reach *sweep = calloc((size_t)count + 1, sizeof *sweep);
    status code = sweep ? STATUS_OK : out_of_memory(why);
    for (int i = 0; sweep && i < count; i++) {
        const double pad = GAP_FRACTION * (isfinite(all[i].thickness) ? all[i].thickness : 1.0);
        sweep[i] = (reach){all[i].box.low.x - pad, all[i].box.high.x + pad, i};
    }
    if (sweep)
        qsort(sweep, (size_t)count, sizeof *sweep, by_low);
    for (int i = 0; code == STATUS_OK && i < count && !cancel_asked(); i++)
        for (int k = i + 1; code == STATUS_OK && k < count && sweep[k].low <= sweep[i].high; k++)
            code = add_candidate(input, all, sweep[i].of, sweep[k].of, to, why);
    free(sweep);
    if (to->count > 1)
        qsort(to->list, to->count, sizeof *to->list, by_solids);
    return code;
}

/* Solids with a note: of many copies of a solid, the first pair has it. */
typedef struct noted_pair {
    const solid *a, *b;
} noted_pair;

typedef struct noted_pairs {
    noted_pair *list;
    size_t count, room;
} noted_pairs;

static bool is_noted(const noted_pairs *n, const solid *a, const solid *b)
{
    for (size_t i = 0; i < n->count; i++)
        if ((n->list[i].a == a && n->list[i].b == b) || (n->list[i].a == b && n->list[i].b == a))
            return true;
    return false;
}

static status examine_all(const lint_input *input, const neighbour *all, int count, float *gap, double *middle,
                          noted_pairs *noted, diagnostic *why)
{
    candidates pairs = {.list = NULL};
    status code = find_candidates(input, all, count, &pairs, why);
    for (size_t i = 0; code == STATUS_OK && i < pairs.count && !cancel_asked(); i++) {
        const neighbour *a = &all[pairs.list[i].a], *b = &all[pairs.list[i].b];
        pair p;
        if (!prepare_pair(input, a, b, &p) || (p.overlaps && is_covered(input, a, b)) ||
            is_noted(noted, a->owner, b->owner))
            continue;
        p.lattice = (int)fmax(LATTICE_LEAST, fmin(LATTICE_MOST, sqrt(LINES_MAX / (3.0 * (double)pairs.count))));
        p.gap = gap;
        p.middle = middle;
        if (!examine_pair(&p))
            continue;
        if (!GROW(noted->list, noted->room, noted->count + 1))
            code = out_of_memory(why);
        else
            noted->list[noted->count++] = (noted_pair){a->owner, b->owner};
    }
    free(pairs.list);
    THEN(code, cancel_check(why));
    return code;
}

status lint_neighbours(const lint_input *input, diagnostic *why)
{
    const scene_geometry *a = input->probe->geometry;
    if (a->region_count > COVER_SOLIDS_MAX)
        return STATUS_OK;
    neighbour *all = calloc((size_t)a->region_count + 1, sizeof *all);
    float *gap = calloc(LATTICE_MOST * LATTICE_MOST, sizeof *gap);
    double *middle = calloc(LATTICE_MOST * LATTICE_MOST, sizeof *middle);
    const bool allocated = all && gap && middle;
    noted_pairs noted = {0};
    int count = 0;
    for (int r = 1; allocated && r <= a->region_count; r++) {
        const solid_shape shape = scene_geometry_shape(a, r);
        if (!shape.mesh || shape.mesh->closed) /* an open mesh contains nothing */
            all[count++] =
                (neighbour){&a->regions[r], lint_solid(input, r), shape_world_box(&shape), shape_thickness(&shape), r};
    }
    const status code = allocated ? examine_all(input, all, count, gap, middle, &noted, why) : out_of_memory(why);
    free(all);
    free(gap);
    free(middle);
    free(noted.list);
    return code;
}
