/* Random rooms of overlapping solids, some of them meshes, and the solids that contain a point by definition: for a
 * mesh by the winding number of its triangles around the point, for others by their shapes. Ownership: mesh_room_fill
 * creates, mesh_room_empty frees. */
#pragma once

#include "geometry/mesh/mesh_generators.h"
#include "geometry/regions/instance_set.h"
#include "room_fixture.h"
#include <stdlib.h>

typedef struct mesh_room {
    room r;
    mesh *mesh_solid[SOLIDS_MAX]; /* NULL: the solid is not a mesh */
    hierarchy *tree[SOLIDS_MAX];
    vec3 (*triangle[SOLIDS_MAX])[3]; /* in the world, of all copies */
    size_t count[SOLIDS_MAX];
} mesh_room;

/* The winding number around a point: the sum of the triangles' solid angles over 4 pi (Van Oosterom and Strackee, "The
 * solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30(2), 1983, eq. 8). */
static inline double winding(const vec3 (*triangle)[3], size_t count, vec3 at)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const vec3 a = vec3_sub(triangle[i][0], at), b = vec3_sub(triangle[i][1], at), c = vec3_sub(triangle[i][2], at);
        const double la = vec3_length(a), lb = vec3_length(b), lc = vec3_length(c);
        sum += 2.0 * atan2(vec3_dot(a, vec3_cross(b, c)),
                           la * lb * lc + vec3_dot(a, b) * lc + vec3_dot(b, c) * la + vec3_dot(c, a) * lb);
    }
    return sum / (4.0 * 3.141592653589793);
}

static inline bool solid_contains(const mesh_room *m, int i, vec3 at)
{
    return m->mesh_solid[i] ? winding((const vec3(*)[3])m->triangle[i], m->count[i], at) > 0.5
                            : solid_shape_contains(&m->r.shape[i], at);
}

static inline int winner_in_room(const mesh_room *m, vec3 at)
{
    int best = -1;
    for (int i = 0; i < m->r.count; i++)
        if (solid_contains(m, i, at) && (best < 0 || m->r.priority[i] > m->r.priority[best]))
            best = i;
    return best;
}

enum { ROOM_CROSSINGS_MAX = 512 };

/* Moller and Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 2(1), 1997, in quadruple precision;
 * slightly wider than the triangle, so that none is missed. */
static inline int triangle_event(const vec3 v[3], const reference_line *line, quad *t)
{
    const quad3 a = quad3_from(v[0]), e1 = quad3_sub(quad3_from(v[1]), a), e2 = quad3_sub(quad3_from(v[2]), a),
                s = quad3_sub(line->o, a);
    const quad3 p = {line->d.y * e2.z - line->d.z * e2.y, line->d.z * e2.x - line->d.x * e2.z,
                     line->d.x * e2.y - line->d.y * e2.x};
    const quad3 q = {s.y * e1.z - s.z * e1.y, s.z * e1.x - s.x * e1.z, s.x * e1.y - s.y * e1.x};
    const quad det = e1.x * p.x + e1.y * p.y + e1.z * p.z, hair = (quad)1e-12;
    if (det == 0)
        return 0;
    const quad u = (s.x * p.x + s.y * p.y + s.z * p.z) / det,
               w = (line->d.x * q.x + line->d.y * q.y + line->d.z * q.z) / det;
    *t = (e2.x * q.x + e2.y * q.y + e2.z * q.z) / det;
    return u >= -hair && w >= -hair && u + w <= 1 + hair && *t > 0;
}

static inline int crossings_in_room(const mesh_room *m, const reference_line *line, quad *t)
{
    int n = 0;
    for (int i = 0; i < m->r.count; i++) {
        if (!m->mesh_solid[i])
            n += reference_events(&m->r.shape[i], line, 0, t + n);
        for (size_t k = 0; m->mesh_solid[i] && k < m->count[i]; k++)
            n += triangle_event((const vec3 *)m->triangle[i][k], line, &t[n]);
        assert_true(n < ROOM_CROSSINGS_MAX - REFERENCE_CROSSINGS_MAX);
    }
    reference_sort(t, n);
    return n;
}

/* As changes_of in room_fixture.h. */
static inline int changes_in_room(const mesh_room *m, const reference_line *line, change *out)
{
    const quad same = (quad)1e-13, clear = (quad)1e-6;
    quad t[ROOM_CROSSINGS_MAX], last = 0;
    const int n = crossings_in_room(m, line, t);
    int count = 0;
    for (int i = 0; i < n;) {
        int next = i + 1;
        while (next < n && t[next] - t[i] < same)
            next++;
        const quad behind = next < n ? t[next] : t[i] + 1;
        if (t[i] - last < clear || behind - t[i] < clear)
            return -1;
        const int before = winner_in_room(m, point_at(line, (last + t[i]) / 2)),
                  after = winner_in_room(m, point_at(line, (t[i] + behind) / 2));
        if (medium_of(&m->r, before) != medium_of(&m->r, after))
            out[count++] = (change){t[i], before, after};
        last = t[i];
        i = next;
    }
    return count;
}

/* The triangles of all copies, placed as defined in solid.h. */
static inline void place_triangles(mesh_room *m, int i)
{
    const solid_shape *s = &m->r.shape[i];
    const mesh *b = m->mesh_solid[i];
    const mat3 turn = rotation_from_deg(s->rotation_deg);
    const size_t nx = (size_t)s->copies.x, ny = (size_t)s->copies.y, nz = (size_t)s->copies.z;
    m->count[i] = 0;
    m->triangle[i] = calloc(nx * ny * nz * b->triangle_count, sizeof *m->triangle[i]);
    assert_non_null(m->triangle[i]);
    for (size_t copy = 0; copy < nx * ny * nz; copy++) {
        const vec3 at = vec3_make((double)(copy % nx) * s->spacing.x, (double)(copy / nx % ny) * s->spacing.y,
                                  (double)(copy / nx / ny) * s->spacing.z);
        for (size_t k = 0; k < b->triangle_count; k++, m->count[i]++)
            for (int c = 0; c < 3; c++) {
                const vec3 v = b->vertices[b->triangles[k].corner[c]],
                           local = vec3_make(v.x * s->scale.x + at.x, v.y * s->scale.y + at.y, v.z * s->scale.z + at.z);
                m->triangle[i][m->count[i]][c] = vec3_add(s->position, mat3_apply(turn, local));
            }
    }
}

static inline mesh *random_body(uint64_t *seed, bool box, vec3 size)
{
    static const profile_point cup[] = {{0.0, -0.6}, {0.7, -0.6}, {0.7, 0.6}, {0.5, 0.6}, {0.5, -0.3}, {0.0, -0.3}};
    mesh *b = NULL;
    status code;
    switch (box ? 0 : random_below(seed, 4)) {
    case 0: code = generate_box(size, &b, NULL); break;
    case 1: code = generate_icosphere(random_below(seed, 2), &b, NULL); break;
    case 2: code = generate_torus(0.7, 0.3, 7, 5, &b, NULL); break;
    default: code = generate_lathe(cup, sizeof cup / sizeof cup[0], 6, 30.0, &b, NULL); break;
    }
    assert_int_equal(code, STATUS_OK);
    assert_true(b->closed);
    return b;
}

static inline void mesh_room_arrange(mesh_room *m)
{
    region_source sources[SOLIDS_MAX];
    for (int i = 0; i < m->r.count; i++)
        sources[i] = (region_source){.shape = &m->r.shape[i],
                                     .tree = m->tree[i],
                                     .priority = m->r.priority[i],
                                     .medium = m->r.medium[i],
                                     .opaque = m->r.opaque[i],
                                     .shadow_transmittance = m->r.opaque[i] ? 0.0 : m->r.shadow_transmittance[i],
                                     .solid = i};
    assert_int_equal(scene_geometry_build(sources, m->r.count, 0, TREE_IF_TOO_MANY, &m->r.solids, NULL), STATUS_OK);
}

/* About two thirds of the solids are meshes; on the grid they are boxes whose faces and copies often coincide. */
static inline void mesh_room_fill(mesh_room *m, uint64_t *seed, bool on_a_grid)
{
    memset(m, 0, sizeof *m);
    (on_a_grid ? room_fill_on_a_grid : room_fill)(&m->r, seed);
    scene_geometry_destroy(m->r.solids);
    for (int i = 0; i < m->r.count; i++) {
        solid_shape *s = &m->r.shape[i];
        if (random_below(seed, 3) == 0)
            continue;
        m->mesh_solid[i] = random_body(seed, on_a_grid, s->size);
        s->kind = SHAPE_MESH;
        s->mesh = m->mesh_solid[i];
        s->scale =
            on_a_grid || random_below(seed, 2)
                ? vec3_make(1.0, 1.0, 1.0)
                : vec3_make(random_real(seed, 0.4, 1.6), random_real(seed, 0.4, 1.6), random_real(seed, 0.4, 1.6));
        s->copies = vec3_make(1.0 + random_below(seed, 3) % 2, 1.0, 1.0 + random_below(seed, 4) % 3 % 2);
        s->spacing = on_a_grid ? s->size : vec3_make(2.1 * s->scale.x, 1.0, 2.1 * s->scale.z);
        if (!on_a_grid)
            s->spacing = vec3_add(s->spacing, vec3_scale(s->size, 1.0));
        assert_int_equal(hierarchy_build(m->mesh_solid[i], (hierarchy_kind)random_below(seed, HIERARCHY_KIND_COUNT), 1,
                                         &m->tree[i], NULL),
                         STATUS_OK);
        place_triangles(m, i);
    }
    mesh_room_arrange(m);
}

static inline void mesh_room_empty(mesh_room *m)
{
    scene_geometry_destroy(m->r.solids);
    for (int i = 0; i < m->r.count; i++) {
        hierarchy_destroy(m->tree[i]);
        mesh_release(m->mesh_solid[i]);
        free(m->triangle[i]);
    }
}
