/* An independent check whether a note of the linter is true. It does not use the linter's lines, boxes and intervals:
 * containment in solids is by definition in quadruple precision (solid_reference.h), in meshes by the solid angle (van
 * Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983); along random lines, each segment between two crossings is
 * classified at its midpoint. Ownership: the scene is borrowed. */
#pragma once

#include "law_scene.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include "solid_reference.h"

enum { ORACLE_CROSSINGS_MAX = 512, ORACLE_LINES = 4000 };

typedef struct oracle {
    const scene *s;
    uint64_t seed;
} oracle;

static inline const mesh *oracle_mesh(const oracle *o, const solid *x)
{
    return x->shape.kind == SHAPE_MESH ? scene_find_mesh(o->s, x->mesh)->data : NULL;
}

static inline vec3 copy_offset(const solid_shape *s, int copy)
{
    const int nx = (int)s->copies.x, ny = (int)s->copies.y;
    return vec3_make(copy % nx * s->spacing.x, copy / nx % ny * s->spacing.y, copy / nx / ny * s->spacing.z);
}

static inline quad3 mesh_corner(const solid_shape *s, const mesh *m, size_t triangle, int k, int copy)
{
    const vec3 v = m->vertices[m->triangles[triangle].corner[k]];
    const quad3 scaled = quad3_make((quad)v.x * s->scale.x, (quad)v.y * s->scale.y, (quad)v.z * s->scale.z);
    return quad3_add(scaled, quad3_from(copy_offset(s, copy)));
}

static inline int copy_count(const solid_shape *s)
{
    return (int)(s->copies.x * s->copies.y * s->copies.z);
}

/* Solid angle of a triangle from the origin, in units of a full sphere. */
static inline double solid_angle(quad3 a, quad3 b, quad3 c)
{
    const quad la = quad3_length(a), lb = quad3_length(b), lc = quad3_length(c);
    const quad up = quad3_dot(a, quad3_cross(b, c));
    const quad down = la * lb * lc + quad3_dot(a, b) * lc + quad3_dot(a, c) * lb + quad3_dot(b, c) * la;
    return 2.0 * atan2((double)up, (double)down) / (4.0 * M_PI);
}

/* May the point be within the first copy? Not beyond all of its vertices along an axis. */
static inline bool mesh_comes_near(const solid_shape *s, const mesh *m, vec3 p)
{
    const double margin = 1e-9; /* rounding of doubles */
    vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < m->vertex_count; i++) {
        const vec3 v = m->vertices[i];
        low = vec3_make(fmin(low.x, v.x), fmin(low.y, v.y), fmin(low.z, v.z));
        high = vec3_make(fmax(high.x, v.x), fmax(high.y, v.y), fmax(high.z, v.z));
    }
    return p.x >= low.x * s->scale.x - margin && p.x <= high.x * s->scale.x + margin &&
           p.y >= low.y * s->scale.y - margin && p.y <= high.y * s->scale.y + margin &&
           p.z >= low.z * s->scale.z - margin && p.z <= high.z * s->scale.z + margin;
}

static inline bool mesh_holds(const oracle *o, const solid *x, quad3 point)
{
    const mesh *m = oracle_mesh(o, x);
    const quad3 p = quad3_turn(quad3_sub(point, quad3_from(x->shape.position)), x->shape.rotation_deg, 1);
    const vec3 near = vec3_make((double)p.x, (double)p.y, (double)p.z);
    for (int copy = 0; m->closed && copy < copy_count(&x->shape); copy++) {
        if (!mesh_comes_near(&x->shape, m, vec3_sub(near, copy_offset(&x->shape, copy))))
            continue;
        double turns = 0.0;
        for (size_t t = 0; t < m->triangle_count; t++)
            turns += solid_angle(quad3_sub(mesh_corner(&x->shape, m, t, 0, copy), p),
                                 quad3_sub(mesh_corner(&x->shape, m, t, 1, copy), p),
                                 quad3_sub(mesh_corner(&x->shape, m, t, 2, copy), p));
        if (turns > 0.5)
            return true;
    }
    return false;
}

static inline bool oracle_holds(const oracle *o, const solid *x, quad3 point)
{
    return x->shape.kind == SHAPE_MESH ? mesh_holds(o, x, point) : reference_contains(&x->shape, point);
}

/* The solid of highest priority at a point; NULL for none. */
static inline const solid *oracle_winner(const oracle *o, quad3 point)
{
    const solid *best = NULL;
    for (size_t i = 0; i < o->s->solid_count; i++) {
        const solid *x = &o->s->solids[i];
        if (x->visible && (!best || x->priority > best->priority) && oracle_holds(o, x, point))
            best = x;
    }
    return best;
}

/* --- along lines --- */

typedef struct crossing_list {
    int count;
    quad t[ORACLE_CROSSINGS_MAX];
} crossing_list;

static inline void add_mesh_crossings(const oracle *o, const solid *x, const reference_line *world, crossing_list *out)
{
    const mesh *m = oracle_mesh(o, x);
    const reference_line l = reference_local(&x->shape, world);
    for (int copy = 0; copy < copy_count(&x->shape); copy++)
        for (size_t i = 0; i < m->triangle_count; i++) {
            const quad3 a = mesh_corner(&x->shape, m, i, 0, copy);
            const quad3 u = quad3_sub(mesh_corner(&x->shape, m, i, 1, copy), a),
                        v = quad3_sub(mesh_corner(&x->shape, m, i, 2, copy), a);
            const quad3 n = quad3_cross(u, v);
            const quad down = quad3_dot(n, l.d);
            if (down == 0 || out->count == ORACLE_CROSSINGS_MAX)
                continue;
            const quad t = quad3_dot(n, quad3_sub(a, l.o)) / down;
            const quad3 at = quad3_sub(reference_at(&l, t), a);
            const quad n2 = quad3_dot(n, n), alpha = quad3_dot(quad3_cross(at, v), n) / n2,
                       beta = quad3_dot(quad3_cross(u, at), n) / n2;
            if (alpha >= 0 && beta >= 0 && alpha + beta <= 1)
                out->t[out->count++] = t;
        }
}

static inline void add_crossings(const oracle *o, const solid *x, const reference_line *l, crossing_list *out)
{
    if (x->shape.kind == SHAPE_MESH)
        add_mesh_crossings(o, x, l, out);
    else if (out->count + REFERENCE_CROSSINGS_MAX <= ORACLE_CROSSINGS_MAX)
        out->count += reference_crossings(&x->shape, l, out->t + out->count);
}

static inline ball ball_of(const solid *x)
{
    law_solid s = {.shape = x->shape, .mesh = x->shape.kind == SHAPE_MESH ? x->mesh : NULL};
    return ball_around(&s);
}

/* A corner, or a point of an edge or a rim, slightly inside: few lines through the whole solid pass through a part that
 * is only there. */
static inline vec3 oracle_corner(oracle *o, const solid *x)
{
    const solid_shape *s = &x->shape;
    const mesh *m = oracle_mesh(o, x);
    const double depth = random_real(&o->seed, 0.0, 1.0),
                 in = 1.0 - 0.02 * (random_below(&o->seed, 2) ? depth : depth * depth * depth);
    const double turn = random_real(&o->seed, 0.0, 360.0) * M_PI / 180.0;
    const vec3 half = vec3_scale(s->size, 0.5 * in);
    vec3 p = {0.0, 0.0, 0.0};
    if (m) {
        const vec3 v = m->vertices[random_below(&o->seed, (int)m->vertex_count)];
        p = vec3_add(vec3_make(in * v.x * s->scale.x, in * v.y * s->scale.y, in * v.z * s->scale.z),
                     copy_offset(s, random_below(&o->seed, copy_count(s))));
    } else if (s->kind == SHAPE_BOX)
        p = vec3_make(random_below(&o->seed, 2) ? half.x : -half.x, random_below(&o->seed, 2) ? half.y : -half.y,
                      random_below(&o->seed, 2) ? half.z : -half.z);
    else if (s->kind == SHAPE_CYLINDER || s->kind == SHAPE_CUP)
        p = vec3_make(in * s->radius * cos(turn), random_below(&o->seed, 2) ? in * s->height : (1.0 - in) * s->height,
                      in * s->radius * sin(turn) / s->m);
    else if (s->kind == SHAPE_SPHERE)
        p = vec3_scale(random_direction(&o->seed), in * s->radius);
    else if (s->kind == SHAPE_PRISM) { /* an edge along the axis, or a corner */
        const double corner = 2.0 * M_PI * random_below(&o->seed, (int)s->sides) / (double)s->sides;
        const double share =
            random_below(&o->seed, 2) ? random_real(&o->seed, 0.0, 1.0) : (random_below(&o->seed, 2) ? in : 1.0 - in);
        p = vec3_make(in * s->radius * sin(corner), share * s->height, -in * s->radius * cos(corner));
    } else if (s->kind == SHAPE_CONE) {
        const bool top = random_below(&o->seed, 2);
        const double radius = in * (top ? s->top_radius : s->radius);
        p = vec3_make(radius * cos(turn), (top ? in : 1.0 - in) * s->height, radius * sin(turn));
    } else if (s->kind == SHAPE_TORUS) {
        const double around = random_real(&o->seed, 0.0, 2.0 * M_PI);
        const double away = s->radius + in * s->tube_radius * cos(around);
        p = vec3_make(away * cos(turn), in * s->tube_radius * sin(around), away * sin(turn));
    }
    return vec3_add(s->position, mat3_apply(rotation_from_deg(s->rotation_deg), p));
}

/* A line through a random point of the smaller solid's bounding ball or near a corner of either solid, along an axis of
 * the world or of either solid. */
static inline reference_line oracle_line(oracle *o, const solid *a, const solid *b)
{
    const ball p = ball_of(a), q = ball_of(b), small = p.radius < q.radius ? p : q;
    const double radius = isfinite(small.radius) ? small.radius : 10.0;
    vec3 through, d = {0.0, 0.0, 0.0};
    do
        through = random_point(&o->seed, 1.0);
    while (vec3_dot(through, through) > 1.0);
    through = vec3_add(small.middle, vec3_scale(through, radius));
    if (random_below(&o->seed, 2))
        through = oracle_corner(o, random_below(&o->seed, 2) ? a : b);
    const int axis = random_below(&o->seed, 3), frame = random_below(&o->seed, 3);
    d = vec3_make(axis == 0, axis == 1, axis == 2);
    if (frame)
        d = mat3_apply(rotation_from_deg(frame == 1 ? a->shape.rotation_deg : b->shape.rotation_deg), d);
    return (reference_line){quad3_from(through), quad3_from(d)};
}

/* Does the line have a segment longer than `longer` inside both solids? */
static inline bool line_overlap(const oracle *o, const solid *a, const solid *b, const reference_line *l, double longer)
{
    crossing_list c = {.count = 2, .t = {-1e4, 1e4}}; /* half-spaces have a single crossing */
    add_crossings(o, a, l, &c);
    add_crossings(o, b, l, &c);
    reference_sort(c.t, c.count);
    for (int i = 0; i + 1 < c.count; i++) {
        const quad3 middle = reference_at(l, (c.t[i] + c.t[i + 1]) / 2);
        if (c.t[i + 1] - c.t[i] > longer && oracle_holds(o, a, middle) && oracle_holds(o, b, middle))
            return true;
    }
    return false;
}

static inline bool oracle_overlap(oracle *o, const solid *a, const solid *b, int lines, double longer)
{
    for (int i = 0; i < lines; i++) {
        const reference_line l = oracle_line(o, a, b);
        if (line_overlap(o, a, b, &l, longer))
            return true;
    }
    return false;
}

/* An upper bound of the thickness of the solid at its thinnest part. */
static inline double oracle_thickness(const solid *x)
{
    const solid_shape *s = &x->shape;
    switch (s->kind) {
    case SHAPE_CYLINDER: return fmin(s->height, 2.0 * fmin(s->radius, s->radius / s->m));
    case SHAPE_CUP: return fmin((s->radius - s->inner_radius) * fmin(1.0, 1.0 / s->m), s->floor);
    case SHAPE_BOX: return smallest(s->size);
    case SHAPE_SPHERE: return 2.0 * s->radius;
    case SHAPE_CONE: return fmin(s->height, s->radius + s->top_radius);
    case SHAPE_PRISM: return fmin(s->height, 2.0 * s->radius);
    case SHAPE_TORUS: return 2.0 * s->tube_radius;
    case SHAPE_LENS: return s->thickness;
    case SHAPE_MESH: return 2.0 * ball_of(x).radius;
    case SHAPE_PLANE:
    case SHAPE_COUNT: break;
    }
    return HUGE_VAL;
}

static inline bool line_gap(const oracle *o, const solid *a, const solid *b, const reference_line *l, double narrower)
{
    crossing_list c = {.count = 2, .t = {-1e4, 1e4}}; /* half-spaces have a single crossing */
    add_crossings(o, a, l, &c);
    add_crossings(o, b, l, &c);
    reference_sort(c.t, c.count);
    for (int i = 1; i + 2 < c.count; i++) {
        const quad wide = c.t[i + 1] - c.t[i];
        if (!(wide > 1e-15) || !(wide < narrower))
            continue;
        const quad3 middle = reference_at(l, (c.t[i] + c.t[i + 1]) / 2), before = reference_at(l, c.t[i] - wide / 2),
                    behind = reference_at(l, c.t[i + 1] + wide / 2);
        const bool a_first = oracle_holds(o, a, before) && oracle_holds(o, b, behind);
        if (!oracle_winner(o, middle) && (a_first || (oracle_holds(o, b, before) && oracle_holds(o, a, behind))))
            return true;
    }
    return false;
}

static inline bool oracle_gap(oracle *o, const solid *a, const solid *b)
{
    const double narrower = 1e-3 * fmin(oracle_thickness(a), oracle_thickness(b)) * (1.0 + 1e-9);
    for (int i = 0; i < ORACLE_LINES; i++) {
        const reference_line l = oracle_line(o, a, b);
        if (line_gap(o, a, b, &l, narrower))
            return true;
    }
    return false;
}

/* --- at points --- */

/* Does `cover` contain `hidden`, and win everywhere in it? */
static inline bool oracle_covers(oracle *o, const solid *cover, const solid *hidden)
{
    const ball around = ball_of(hidden);
    bool covers = cover->priority > hidden->priority || (cover->priority == hidden->priority && cover < hidden);
    for (int i = 0; i < (hidden->shape.kind == SHAPE_MESH ? 300 : 2000) && covers; i++) {
        const quad3 p = quad3_from(vec3_add(around.middle, random_point(&o->seed, around.radius)));
        if (oracle_holds(o, hidden, p) && !oracle_holds(o, cover, p))
            covers = cover->shape.kind != SHAPE_MESH && reference_distance(&cover->shape, p) < 1e-9;
    }
    return covers;
}

static inline bool has_surrounding_index(const oracle *o, const solid *x)
{
    return x->surface.ior == o->s->background.ior;
}

/* Has the solid the surroundings' index, and does it nowhere replace another visible solid? */
static inline bool oracle_bends_nothing(oracle *o, const solid *x)
{
    const ball around = ball_of(x);
    bool nothing = has_surrounding_index(o, x);
    for (int i = 0; i < (x->shape.kind == SHAPE_MESH ? 300 : 1000) && nothing; i++) {
        const double radius = isfinite(around.radius) ? around.radius : 10.0;
        const quad3 p = quad3_from(vec3_add(around.middle, random_point(&o->seed, radius)));
        if (oracle_winner(o, p) != x)
            continue;
        for (size_t k = 0; k < o->s->solid_count; k++) {
            const solid *other = &o->s->solids[k];
            const bool seen = other->surface.transparency == 0.0 || !has_surrounding_index(o, other);
            nothing &= !(other != x && seen && oracle_holds(o, other, p));
        }
    }
    return nothing;
}
