/* Meshes and rays that are difficult for hierarchies, from fixed random streams. Ownership: the caller releases a
 * mesh. */
#pragma once

#include "base/lanes.h"
#include "geometry/hierarchy/hierarchy.h"
#include "geometry/mesh/mesh_generators.h"
#include "random_stream.h"

/* A mesh of these corners, three per triangle. */
static inline mesh *mesh_of_corners(const vec3 *corners, size_t triangles)
{
    mesh *m = NULL;
    if (mesh_create(3 * triangles, triangles, false, false, false, &m, NULL) != STATUS_OK)
        return NULL;
    for (size_t i = 0; i < 3 * triangles; i++) {
        m->vertices[i] = corners[i];
        m->triangles[i / 3].corner[i % 3] = (uint32_t)i;
    }
    if (mesh_finish(m, NULL) != STATUS_OK) {
        mesh_release(m);
        return NULL;
    }
    return m;
}

/* A difficult coordinate: on a coarse grid (so that corners, planes and edges coincide), in single precision, or
 * anywhere. */
static inline double random_coordinate(uint64_t *seed, int style, double reach)
{
    const double v = random_real(seed, -reach, reach);
    return style == 0 ? floor(4.0 * v / reach) * 0.25 * reach : style == 1 ? single_round(v) : v;
}

/* Triangles of all kinds: small and large, slivers, without area, duplicates, and in planes perpendicular to an
 * axis. */
static inline mesh *random_mesh(uint64_t *seed, int triangles)
{
    static const double reaches[] = {1.0, 1e-3, 1e3, 1e6};
    enum { TRIANGLES_MAX = 512 };
    vec3 corners[3 * TRIANGLES_MAX];
    const double reach = reaches[random_below(seed, 4)];
    const int style = random_below(seed, 3);
    for (int i = 0; i < triangles; i++) {
        vec3 *c = &corners[3 * i];
        const double size = random_below(seed, 4) == 0 ? reach : random_real(seed, 0.0, 0.2) * reach;
        vec3 middle = {random_coordinate(seed, style, reach), random_coordinate(seed, style, reach),
                       random_coordinate(seed, style, reach)};
        for (int j = 0; j < 3; j++) {
            const vec3 away = {random_coordinate(seed, style, size), random_coordinate(seed, style, size),
                               random_coordinate(seed, style, size)};
            c[j] = vec3_add(middle, away);
        }
        switch (random_below(seed, 10)) {
        case 0: c[2] = c[random_below(seed, 2)]; break;                              /* two corners at one position */
        case 1: c[2] = vec3_add(c[0], vec3_scale(vec3_sub(c[1], c[0]), 0.5)); break; /* nearly collinear */
        case 2: c[2] = vec3_add(c[1], vec3_scale(random_direction(seed), 1e-9 * reach)); break; /* a sliver */
        case 3: c[0].x = c[1].x = c[2].x = middle.x; break; /* perpendicular to the x axis */
        case 4: c[0].z = c[1].z = c[2].z = middle.z; break;
        case 5:
            if (i > 0)
                for (int j = 0; j < 3; j++)
                    c[j] = corners[3 * random_below(seed, i) + j]; /* corners of others; often a duplicate */
            break;
        case 6:
            if (i > 0)
                for (int j = 0, other = random_below(seed, i); j < 3; j++)
                    c[j] = corners[3 * other + j];
            break;
        default: break;
        }
    }
    return mesh_of_corners(corners, (size_t)triangles);
}

/* A point of triangle i: a corner, on an edge, inside, or near it. */
static inline vec3 random_target(const mesh *m, uint64_t *seed)
{
    const mesh_triangle *t = &m->triangles[random_bits(seed) % m->triangle_count];
    const vec3 a = m->vertices[t->corner[0]], ab = vec3_sub(m->vertices[t->corner[1]], a),
               ac = vec3_sub(m->vertices[t->corner[2]], a);
    const double u = random_real(seed, 0.0, 1.0), v = random_real(seed, 0.0, 1.0 - u);
    switch (random_below(seed, 4)) {
    case 0: return m->vertices[t->corner[random_below(seed, 3)]];
    case 1: return vec3_add(a, vec3_scale(ab, u));
    case 2: return vec3_add(a, vec3_add(vec3_scale(ab, 0.5), vec3_scale(ac, 0.5)));
    default: return vec3_add(a, vec3_add(vec3_scale(ab, u), vec3_scale(ac, v)));
    }
}

static inline mesh_ray random_ray(const mesh *m, uint64_t *seed)
{
    const double reach = 1e-300 + vec3_length(vec3_sub(m->bounds.high, m->bounds.low));
    mesh_ray r = {.t_max = (double)INFINITY, .skip = TRIANGLE_NONE, .facing = FACING_ANY};
    const vec3 target = random_target(m, seed);
    vec3 d = random_direction(seed);
    switch (random_below(seed, 6)) {
    case 0: d = vec3_make(random_below(seed, 2) ? 1.0 : -1.0, 0.0, 0.0); break;
    case 1: d = vec3_make(0.0, random_below(seed, 2) ? 1.0 : -1.0, random_below(seed, 2) ? 0.0 : -0.0); break;
    case 2: d = vec3_make(random_below(seed, 2) ? 1.0 : 1e-17, random_real(seed, -1.0, 1.0), 0.0); break;
    case 3: d = vec3_sub(random_target(m, seed), target); break; /* often within a triangle's plane */
    default: break;
    }
    if (!(vec3_dot(d, d) > 0.0))
        d = vec3_make(0.0, 0.0, -1.0);
    r.direction = random_below(seed, 3) ? d : vec3_scale(d, random_real(seed, 1e-6, 1e6));
    r.origin = random_below(seed, 4)
                   ? vec3_sub(target, vec3_scale(d, random_real(seed, 0.0, 2.0) * reach / vec3_length(d)))
                   : target;
    if (random_below(seed, 8) == 0)
        r.t_min = random_real(seed, 0.0, reach);
    if (random_below(seed, 8) == 0)
        r.t_max = random_real(seed, 0.0, 2.0 * reach);
    if (random_below(seed, 8) == 0)
        r.facing = 1 + random_below(seed, 2);
    if (random_below(seed, 8) == 0)
        r.skip = (uint32_t)(random_bits(seed) % m->triangle_count);
    return r;
}
