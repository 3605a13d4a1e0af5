/* Random rooms of a few overlapping solids, and the solids at each point by definition, in quadruple precision.
 * Ownership: room_fill and room_build create m->solids; free it with scene_geometry_destroy. */
#pragma once

#include "random_stream.h"
#include "ray_fixture.h"
#include "solid_reference.h"

enum { SOLIDS_MAX = 9, WALK_MAX = 64 };

typedef struct room {
    int count;
    solid_shape shape[SOLIDS_MAX];
    int64_t priority[SOLIDS_MAX], medium[SOLIDS_MAX];
    int opaque[SOLIDS_MAX];
    double shadow_transmittance[SOLIDS_MAX];
    scene_geometry *solids;
} room;

typedef struct change {
    quad t;
    int before, after;
} change; /* solids' indices; -1 for none */

static inline void room_build(room *m)
{
    region_source sources[SOLIDS_MAX];
    for (int i = 0; i < m->count; i++)
        sources[i] = (region_source){.shape = &m->shape[i],
                                     .priority = m->priority[i],
                                     .medium = m->medium[i],
                                     .opaque = m->opaque[i],
                                     .shadow_transmittance = m->opaque[i] ? 0.0 : m->shadow_transmittance[i],
                                     .solid = i};
    assert_int_equal(scene_geometry_build(sources, m->count, 0, TREE_IF_MANY, &m->solids, NULL), STATUS_OK);
}

/* The definition: the highest priority wins; of equal ones the first. */
static inline int winner(const room *m, vec3 at)
{
    int best = -1;
    for (int i = 0; i < m->count; i++)
        if (solid_shape_contains(&m->shape[i], at) && (best < 0 || m->priority[i] > m->priority[best]))
            best = i;
    return best;
}

/* Which of two solids, either of which may be none, has the higher priority index. */
static inline int higher_of(const room *m, int a, int b)
{
    if (a < 0 || b < 0)
        return a < 0 ? b : a;
    return m->priority[a] != m->priority[b] ? (m->priority[a] > m->priority[b] ? a : b) : a < b ? a : b;
}

static inline int is_opaque(const room *m, int i)
{
    return i >= 0 && m->opaque[i];
}

/* An opaque solid owns its surface; between two opaque solids the one after the crossing is visible. */
static inline int owner_of_surface(const room *m, int before, int after)
{
    return is_opaque(m, after) ? after : is_opaque(m, before) ? before : higher_of(m, before, after);
}

static inline int64_t medium_of(const room *m, int i)
{
    return i < 0 ? 0 : m->medium[i];
}

static inline int solid_of(const room *m, int priority_index)
{
    return m->solids->regions[priority_index].solid;
}

static inline vec3 point_at(const reference_line *line, quad t)
{
    quad3 p = reference_at(line, t);
    return vec3_make((double)p.x, (double)p.y, (double)p.z);
}

/* All t > 0 where the line crosses any shape's surface, in order. */
static inline int crossings_of(const room *m, const reference_line *line, quad *t)
{
    int n = 0;
    for (int i = 0; i < m->count; i++) {
        quad own[REFERENCE_CROSSINGS_MAX];
        const int found = reference_events(&m->shape[i], line, 0, own);
        for (int k = 0; k < found; k++)
            t[n++] = own[k];
    }
    reference_sort(t, n);
    return n;
}

/* Changes of the winning solid along the line, without those between equal media. Crossings at the same distance are
 * one. Returns -1 if distinct crossings are so close that double precision may order them differently. */
static inline int changes_of(const room *m, const reference_line *line, change *out)
{
    const quad same = (quad)1e-13, apart = (quad)1e-6;
    quad t[SOLIDS_MAX * REFERENCE_CROSSINGS_MAX], last = 0;
    const int n = crossings_of(m, line, t);
    int count = 0;
    for (int i = 0; i < n;) {
        int next = i + 1;
        while (next < n && t[next] - t[i] < same)
            next++;
        const quad behind = next < n ? t[next] : t[i] + 1;
        if (t[i] - last < apart || behind - t[i] < apart)
            return -1;
        const int before = winner(m, point_at(line, (last + t[i]) / 2)),
                  after = winner(m, point_at(line, (t[i] + behind) / 2));
        if (medium_of(m, before) != medium_of(m, after))
            out[count++] = (change){t[i], before, after};
        last = t[i];
        i = next;
    }
    return count;
}

/* Any pair of sides within their conics' widths, and a thickness with which they do not cross within the rim. */
static inline void random_lens(solid_shape *s, uint64_t *seed)
{
    double *const radius[2] = {&s->radius_1, &s->radius_2}, *const conic[2] = {&s->conic_1, &s->conic_2};
    double sag[2];
    s->diameter = random_real(seed, 0.4, 2.0);
    for (int k = 0; k < 2; k++) {
        const double r = s->diameter * random_real(seed, 0.53, 2.0);
        *radius[k] = random_below(seed, 5) ? (random_below(seed, 2) ? r : -r) : 0.0;
        *conic[k] = random_below(seed, 3) ? 0.0 : random_real(seed, -3.0, 0.0);
        const double c = *radius[k] == 0.0 ? 0.0 : 1.0 / *radius[k], rho2 = s->diameter * s->diameter / 4.0;
        sag[k] = c * rho2 / (1.0 + sqrt(1.0 - (1.0 + *conic[k]) * c * c * rho2));
    }
    const double least = fmax(0.0, sag[0]) + fmax(0.0, -sag[1]);
    s->thickness = least + s->diameter * random_real(seed, 0.02, 0.6);
}

/* For the analytic solids. */
static inline shape_kind random_kind(uint64_t *seed)
{
    const int kind = random_below(seed, SHAPE_COUNT - 1);
    return (shape_kind)(kind < SHAPE_MESH ? kind : kind + 1);
}

static inline solid_shape random_shape(uint64_t *seed)
{
    solid_shape s = {.kind = random_kind(seed), .position = random_point(seed, 0.8)};
    if (random_below(seed, 3))
        s.rotation_deg = random_point(seed, 180.0);
    s.radius = random_real(seed, 0.3, 1.2);
    s.height = random_real(seed, 0.4, 2.0);
    s.m = random_below(seed, 2) ? 1.0 : random_real(seed, 0.5, 2.0);
    s.inner_radius = s.radius * random_real(seed, 0.4, 0.95);
    s.floor = s.height * random_real(seed, 0.05, 0.6);
    s.sides = 3 + random_below(seed, 6);
    s.top_radius = random_below(seed, 3) ? s.radius * random_real(seed, 0.1, 1.5) : 0.0;
    s.tube_radius = s.radius * random_real(seed, 0.1, 0.9);
    s.size = vec3_make(random_real(seed, 0.2, 2.0), random_real(seed, 0.2, 2.0), random_real(seed, 0.2, 2.0));
    random_lens(&s, seed);
    return s;
}

/* Shuffled priorities with ties, a few transparent media shared, some of them the surrounding one. */
static inline void room_fill(room *m, uint64_t *seed)
{
    m->count = 1 + random_below(seed, SOLIDS_MAX);
    for (int i = 0; i < m->count; i++) {
        m->shape[i] = random_shape(seed);
        m->priority[i] = random_below(seed, 6) - 2;
        m->opaque[i] = random_below(seed, 4) == 0;
        m->medium[i] = m->opaque[i] || random_below(seed, 3) ? i + 1 : -random_below(seed, 3);
        m->shadow_transmittance[i] = random_below(seed, 3) ? random_real(seed, 0.1, 1.0) : 1.0;
    }
    room_build(m);
}

/* Positions, sizes and quarter turns on a grid: faces, caps and walls often coincide. */
static inline void room_fill_on_a_grid(room *m, uint64_t *seed)
{
    room_fill(m, seed);
    scene_geometry_destroy(m->solids);
    for (int i = 0; i < m->count; i++) {
        solid_shape *s = &m->shape[i];
        s->position = vec3_make(0.25 * (random_below(seed, 5) - 2), 0.25 * (random_below(seed, 5) - 2),
                                0.25 * (random_below(seed, 5) - 2));
        s->rotation_deg =
            vec3_make(90.0 * random_below(seed, 4), 0.0, random_below(seed, 2) ? 0.0 : 90.0 * random_below(seed, 4));
        s->radius = 0.25 * (2 + random_below(seed, 4));
        s->inner_radius = s->radius - 0.25;
        s->height = 0.25 * (2 + random_below(seed, 5));
        s->floor = 0.25;
        s->m = 1.0;
        s->tube_radius = 0.25;
        s->sides = 4;
        s->top_radius = 0.25 * random_below(seed, 4);
        s->diameter = 0.5 * (1 + random_below(seed, 3));
        s->radius_1 = s->diameter * (random_below(seed, 3) - 1);
        s->radius_2 = s->diameter * (random_below(seed, 3) - 1);
        s->thickness = 0.25 * (1 + random_below(seed, 4)) + 0.25 * s->diameter;
        s->conic_1 = s->conic_2 = 0.0;
        s->size = vec3_make(0.5 * (1 + random_below(seed, 3)), 0.5 * (1 + random_below(seed, 3)),
                            0.5 * (1 + random_below(seed, 3)));
    }
    room_build(m);
}

static inline int has_plane(const room *m)
{
    for (int i = 0; i < m->count; i++)
        if (m->shape[i].kind == SHAPE_PLANE)
            return 1;
    return 0;
}
