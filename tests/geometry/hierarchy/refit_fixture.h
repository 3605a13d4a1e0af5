/* Deformed meshes, and the comparisons of hierarchies over them. Ownership: the caller owns meshes and hierarchies.
 * Include after cmocka.h. */
#pragma once

#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/hierarchy/layout.h"
#include "hierarchy_scenes.h"

#include <stdlib.h>
#include <string.h>

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { BATCH = 128, SHOWN_MAX = 4096 };

static const hierarchy_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(hierarchy_kernels);

static inline int effort(int full)
{
#ifdef __OPTIMIZE__
    return full;
#else
    return full / 20 + 1;
#endif
}

static inline hierarchy *built(const mesh *m, hierarchy_kind kind)
{
    hierarchy *h = NULL;
    assert_int_equal(hierarchy_build(m, kind, 1, &h, NULL), STATUS_OK);
    return h;
}

static inline mesh *icosphere(int level)
{
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(level, &m, NULL), STATUS_OK);
    return m;
}

static inline vec3 *copy_of_vertices(const mesh *m)
{
    vec3 *copy = malloc(m->vertex_count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, m->vertices, m->vertex_count * sizeof *copy);
    return copy;
}

static inline void move(mesh *m, const vec3 *to)
{
    assert_int_equal(mesh_move(m, to, NULL, NULL), STATUS_OK);
}

/* Deformations of a mesh; each is a function of the position alone, or of the vertex number if the position is not
 * enough. */
typedef vec3 deformation(vec3 p, size_t vertex, uint64_t *seed);

static inline vec3 squash(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_make(1.3 * p.x, 0.05 * p.y, 1.3 * p.z);
}

static inline vec3 twist(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    const double angle = 4.0 * p.y;
    return vec3_make(cos(angle) * p.x - sin(angle) * p.z, p.y, sin(angle) * p.x + cos(angle) * p.z);
}

static inline vec3 scatter(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex;
    return vec3_add(p, random_point(seed, 5.0));
}

/* Most triangles lose their area: whole parts collapse into a point, others onto a line or into a plane. */
static inline vec3 collapse(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return p.x > 0.3    ? vec3_make(0.3, 0.1, -0.2)
           : p.x > -0.2 ? vec3_make(p.x, 0.0, 0.0)
           : p.y > 0.0  ? vec3_make(p.x, 0.0, p.z)
                        : p;
}

static inline vec3 far_away(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_make(1e6 + 1e3 * p.x, 1e6 * p.y, -1e6 + p.z);
}

static inline vec3 tiny(vec3 p, size_t vertex, uint64_t *seed)
{
    (void)vertex, (void)seed;
    return vec3_scale(p, 1e-39); /* a float cannot hold all of its bits */
}

static inline vec3 on_floats(vec3 p, size_t vertex, uint64_t *seed)
{
    const vec3 q = twist(p, vertex, seed);
    return vec3_make(single_round(q.x), single_round(q.y), single_round(q.z));
}

static inline void deform(mesh *m, const vec3 *rest, deformation *displace, uint64_t *seed)
{
    vec3 *to = malloc(m->vertex_count * sizeof *to);
    assert_non_null(to);
    for (size_t i = 0; i < m->vertex_count; i++)
        to[i] = displace(rest[i], i, seed);
    move(m, to);
    free(to);
}

static inline void same_hit(const mesh_hit *a, const mesh_hit *b)
{
    assert_int_equal(a->triangle, b->triangle);
    assert_memory_equal(&a->t, &b->t, sizeof a->t);
    assert_memory_equal(&a->u, &b->u, sizeof a->u);
    assert_memory_equal(&a->v, &b->v, sizeof a->v);
    assert_int_equal(a->facing, b->facing);
}

/* All hits of a ray, or all triangles reported to it, in an order-independent form. */
typedef struct collected {
    uint64_t sum;
    long count;
    uint32_t triangle[SHOWN_MAX];
} collected;

static inline void collect(void *context, const mesh_hit *hit)
{
    collected *g = context;
    uint64_t bits;
    memcpy(&bits, &hit->t, sizeof bits);
    g->sum += (bits ^ (uint64_t)hit->triangle << 32) * 0x9e3779b97f4a7c15u;
    assert_true(g->count < SHOWN_MAX);
    g->triangle[g->count++] = hit->triangle;
}

static inline double collect_box(void *context, uint32_t triangle, double t_max)
{
    collected *g = context;
    assert_true(g->count < SHOWN_MAX);
    g->triangle[g->count++] = triangle;
    return t_max;
}

/* Asserts that every triangle that is hit is also reported, and none twice. */
static inline void reports_every_hit_once(const hierarchy_kernels *kernel, const hierarchy *h, const mesh_ray *r,
                                          const collected *hits)
{
    static collected shown;
    uint8_t *times = calloc(h->of->triangle_count, 1);
    assert_non_null(times);
    shown.count = 0;
    kernel->boxes(h, r, collect_box, &shown);
    for (long i = 0; i < shown.count; i++)
        assert_int_equal(times[shown.triangle[i]]++, 0);
    for (long i = 0; i < hits->count; i++)
        assert_int_equal(times[hits->triangle[i]], 1);
    free(times);
}

/* Sends random rays through all three hierarchies; returns the number of hits. */
static inline long compare(const mesh *m, const hierarchy *refitted, int batches, uint64_t *seed)
{
    static collected all[2];
    hierarchy *const none = built(m, HIERARCHY_NONE), *const fresh = built(m, HIERARCHY_BVH);
    long hit_count = 0;
    for (int batch = 0; batch < batches; batch++) {
        const hierarchy_kernels *kernel = kernels[(unsigned)batch % (unsigned)(isa_best() + 1)];
        mesh_ray r[BATCH];
        mesh_hit expected[BATCH], hits[BATCH], one;
        bool shadowed[BATCH];
        for (int i = 0; i < BATCH; i++)
            r[i] = random_ray(m, seed);
        kernels[ISA_BASE]->nearest_batch(none, r, BATCH, expected);
        kernel->nearest_batch(refitted, r, BATCH, hits);
        kernel->any_batch(refitted, r, BATCH, shadowed);
        for (int i = 0; i < BATCH; i++) {
            const bool hit = expected[i].triangle != TRIANGLE_NONE;
            same_hit(&hits[i], &expected[i]);
            assert_int_equal(shadowed[i], hit);
            kernel->nearest(refitted, &r[i], &one);
            same_hit(&one, &expected[i]);
            kernel->nearest(fresh, &r[i], &one);
            same_hit(&one, &expected[i]);
            assert_int_equal(kernel->any(refitted, &r[i]), hit);
            hit_count += hit;
        }
        for (int i = 0; i < 8; i++) {
            memset(all, 0, sizeof all);
            kernel->all(none, &r[i], collect, &all[0]);
            kernel->all(refitted, &r[i], collect, &all[1]);
            assert_int_equal(all[1].count, all[0].count);
            assert_true(all[1].sum == all[0].sum);
            reports_every_hit_once(kernel, refitted, &r[i], &all[0]);
        }
    }
    hierarchy_destroy(fresh);
    hierarchy_destroy(none);
    return hit_count;
}
