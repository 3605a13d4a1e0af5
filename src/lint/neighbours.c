/* Pairs of solids, examined along a lattice of lines through the region of both. A finding is confirmed at nearby
 * points before it becomes a note: touching is not overlapping, and the closest point of two curved surfaces is not a
 * gap. */
#include "base/cancel.h"
#include "geometry/shapes/shape.h"
#include "lint/lines.h"
#include "lint/parts.h"
#include "scene/model/cover.h"

#include <math.h>
#include <stdlib.h>

enum { LATTICE_LEAST = 8, LATTICE_MOST = 32, LINES_MAX = 200000 };
#define GAP_SHARE 1e-3      /* fraction of the thinner solid's thickness: a smaller gap is narrow */
#define PATCH_SHARE 0.25    /* fraction of the thinner solid's thickness: the minimum extent of a narrow gap */
#define OVERLAP_SHARE 1e-6  /* fraction of the thinner solid's thickness: a smaller overlap counts as touching */
#define CONTACT_SHARE 1e-12 /* fraction of the coordinates: closer surfaces are in contact */

typedef struct neighbour {
    const region *of;
    const solid *said;
    bounds3 box;
    double thickness;
    int priority_index;
} neighbour;

typedef struct pair {
    const lint_room *room;
    const neighbour *a, *b;
    vec3 low, high; /* the bounds common to both solids, enlarged by gaps */
    double thinner, extent;
    int lattice;         /* lines per edge of the lattice */
    bool overlaps, gaps; /* thresholds */
    float *gap;          /* width of the narrow gap on each line of one axis, 0 for none; lattice * lattice */
    double *middle;      /* its position on the line */
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
    return fmax(OVERLAP_SHARE * p->thinner, CONTACT_SHARE * p->extent);
}

/* Whether both contain the point and a neighbourhood around it. */
static bool overlap_at(const pair *p, vec3 point)
{
    const scene_geometry *a = p->room->made->geometry;
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

static line lattice_line(const pair *p, int axis, int i, int j)
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
    *component(&l.origin, axis) = before - 0.01 * (*component(&high, axis) - before) - p->thinner * GAP_SHARE;
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

/* The narrowest gap between a span of one and a span of the other above the minimum; 0 for none. */
static double spans_gap(const pair *p, const line_spans *a, const line_spans *b, double *middle)
{
    double best = GAP_SHARE * p->thinner;
    bool found = false;
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < b->count; k++) {
            const bool first = a->out[i] <= b->in[k];
            const double from = first ? a->out[i] : b->out[k], to = first ? b->in[k] : a->in[i];
            if (to - from < best && to - from > CONTACT_SHARE * p->extent) {
                best = to - from;
                *middle = 0.5 * (from + to);
                found = true;
            }
        }
    return found ? best : 0.0;
}

/* Examines all lines of an axis; true if the solids overlap. */
static bool look_along(const pair *p, int axis)
{
    const scene_geometry *a = p->room->made->geometry;
    for (int i = 0; i < p->lattice && !cancel_asked(); i++)
        for (int j = 0; j < p->lattice; j++) {
            const line l = lattice_line(p, axis, i, j);
            line_spans one, two;
            float *gap = &p->gap[i * p->lattice + j];
            *gap = 0.0F;
            if (!line_through(a, p->a->of, &l, &one) || one.count == 0 || !line_through(a, p->b->of, &l, &two) ||
                two.count == 0)
                continue;
            if (p->overlaps && spans_overlap(p, &l, &one, &two))
                return true;
            if (p->gaps)
                *gap = (float)spans_gap(p, &one, &two, &p->middle[i * p->lattice + j]);
        }
    return false;
}

/* Whether the gap is narrow and empty on the line and on eight lines around it, over the minimum extent. */
static bool is_patch(const pair *p, int axis, int i, int j, int step_u, int step_v)
{
    const scene_geometry *a = p->room->made->geometry;
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
    const double apart = *component(&size, axis) / p->lattice;
    return (int)fmin(p->lattice, fmax(1.0, ceil(0.5 * PATCH_SHARE * p->thinner / apart)));
}

/* The narrowest gap of an axis. */
static double narrowest(const pair *p)
{
    double least = HUGE_VAL;
    for (int i = 0; i < p->lattice * p->lattice; i++)
        least = p->gap[i] > 0.0F ? fmin(least, p->gap[i]) : least;
    return least;
}

/* The width of the gap along an axis; 0 for none. */
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
    const solid *first = p->a->said < p->b->said ? p->a->said : p->b->said,
                *second = first == p->a->said ? p->b->said : p->a->said;
    note_give(p->room->taker, second->name, "priority", "give a higher priority to the solid that displaces the other",
              "%s and %s overlap with equal priority and different media: the medium there is that of %s "
              "only because it is listed first",
              first->name, second->name, first->name);
}

static void note_gap(const pair *p, double gap)
{
    const neighbour *thin = p->a->thickness <= p->b->thickness ? p->a : p->b;
    const solid *first = p->a->said < p->b->said ? p->a->said : p->b->said,
                *second = first == p->a->said ? p->b->said : p->a->said;
    note_give(p->room->taker, second->name, NULL,
              "make them touch exactly or overlap (the higher priority then decides), or move them apart",
              "the gap between %s and %s is about %.2g, less than a thousandth of the thickness of %s "
              "(%.3g): it acts as a thin film",
              first->name, second->name, gap, thin->said->name, thin->thickness);
}

/* Two half-spaces intersect unless they face away from each other. */
static bool planes_overlap(const pair *p)
{
    const primitive *a = &p->room->made->geometry->primitives[p->a->of->outside],
                    *b = &p->room->made->geometry->primitives[p->b->of->outside];
    const vec3 up_a = vec3_make(a->rotation.row[0].y, a->rotation.row[1].y, a->rotation.row[2].y);
    const vec3 up_b = vec3_make(b->rotation.row[0].y, b->rotation.row[1].y, b->rotation.row[2].y);
    const double apart = vec3_dot(vec3_sub(b->origin, a->origin), up_a);
    return vec3_dot(up_a, up_b) > -1.0 + 1e-9 || apart < -OVERLAP_SHARE * fmax(1.0, fmax(a->extent, b->extent));
}

static void look_at_pair(pair *p)
{
    bool overlap = false;
    double gap = 0.0;
    if (isfinite(p->high.x - p->low.x)) {
        for (int axis = 0; axis < 3 && !overlap; axis++) {
            overlap = look_along(p, axis);
            if (!overlap && p->gaps && gap == 0.0)
                gap = find_patch(p, axis);
        }
    } else {
        overlap = p->overlaps && planes_overlap(p);
    }
    if (cancel_asked())
        return; /* some lines were not examined */
    if (overlap)
        note_overlap(p);
    else if (gap > 0.0)
        note_gap(p, gap);
}

/* Whether medium or absorption differ. */
static bool media_differ(const plan *made, const neighbour *a, const neighbour *b)
{
    const vec3 off = vec3_sub(made->absorption[a->priority_index], made->absorption[b->priority_index]);
    return a->of->medium != b->of->medium || off.x != 0.0 || off.y != 0.0 || off.z != 0.0;
}

/* Whether an interface with the surroundings is visible, on a transparent or an opaque solid. */
static bool shows(const region *b)
{
    return b->opaque || b->medium != 0;
}

static bool is_covered(const lint_room *room, const neighbour *a, const neighbour *b)
{
    return scene_cover(room->of, a->said) == b->said || scene_cover(room->of, b->said) == a->said;
}

/* False: the pair needs no examination. */
static bool prepare_pair(const lint_room *room, const neighbour *a, const neighbour *b, pair *p)
{
    if (a->of->opaque && b->of->opaque)
        return false; /* their interior is invisible */
    *p = (pair){.room = room, .a = a, .b = b, .thinner = fmin(a->thickness, b->thickness)};
    if (!isfinite(p->thinner))
        p->thinner = 1.0;
    const double pad = GAP_SHARE * p->thinner;
    p->low = vec3_make(fmax(a->box.low.x, b->box.low.x) - pad, fmax(a->box.low.y, b->box.low.y) - pad,
                       fmax(a->box.low.z, b->box.low.z) - pad);
    p->high = vec3_make(fmin(a->box.high.x, b->box.high.x) + pad, fmin(a->box.high.y, b->box.high.y) + pad,
                        fmin(a->box.high.z, b->box.high.z) + pad);
    p->extent = fmax(fmax(fmax(fabs(p->low.x), fabs(p->low.y)), fmax(fabs(p->low.z), fabs(p->high.x))),
                     fmax(fabs(p->high.y), fabs(p->high.z)));
    p->overlaps = a->said->priority == b->said->priority && media_differ(room->made, a, b);
    p->gaps = shows(a->of) && shows(b->of);
    return (p->overlaps || p->gaps) && p->low.x < p->high.x && p->low.y < p->high.y && p->low.z < p->high.z;
}

static size_t count_pairs(const lint_room *room, const neighbour *all, int count)
{
    size_t pairs = 0;
    pair p;
    for (int i = 0; i < count && !cancel_asked(); i++)
        for (int k = i + 1; k < count; k++)
            pairs += prepare_pair(room, &all[i], &all[k], &p);
    return pairs;
}

static void look_at_all(const lint_room *room, const neighbour *all, int count, float *gap, double *middle)
{
    const size_t pairs = count_pairs(room, all, count);
    for (int i = 0; i < count && !cancel_asked(); i++)
        for (int k = i + 1; k < count; k++) {
            pair p;
            if (!prepare_pair(room, &all[i], &all[k], &p) || (p.overlaps && is_covered(room, &all[i], &all[k])))
                continue;
            p.lattice = (int)fmax(LATTICE_LEAST, fmin(LATTICE_MOST, sqrt(LINES_MAX / (3.0 * (double)pairs))));
            p.gap = gap;
            p.middle = middle;
            look_at_pair(&p);
        }
}

status lint_neighbours(const lint_room *room, diagnostic *why)
{
    const scene_geometry *a = room->made->geometry;
    if (a->region_count > COVER_SOLIDS_MAX)
        return STATUS_OK;
    neighbour *all = calloc((size_t)a->region_count + 1, sizeof *all);
    float *gap = calloc(LATTICE_MOST * LATTICE_MOST, sizeof *gap);
    double *middle = calloc(LATTICE_MOST * LATTICE_MOST, sizeof *middle);
    const bool there = all && gap && middle;
    int count = 0;
    for (int priority_index = 1; there && priority_index <= a->region_count; priority_index++) {
        const region *b = &a->regions[priority_index];
        const solid *said = lint_solid(room, priority_index);
        const solid_shape shape = scene_loaded_shape(room->of, said);
        if (shape.mesh && !shape.mesh->closed)
            continue; /* it contains nothing */
        all[count++] =
            (neighbour){b, said, shape_world_box(&shape), shape_of(&shape)->thickness(&shape), priority_index};
    }
    if (there)
        look_at_all(room, all, count, gap, middle);
    free(all);
    free(gap);
    free(middle);
    return there ? cancel_check(why) : out_of_memory(why);
}
