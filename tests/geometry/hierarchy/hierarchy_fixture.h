/* Meshes and hierarchies for tests of the builders. A fixture owns both; fixture_free frees it. */
#pragma once

#include "geometry/hierarchy/layout.h"

#include <stdlib.h>
#include <string.h>

typedef struct fixture {
    mesh m;
    hierarchy h;
} fixture;

/* A mesh of that many triangles with separate corners, triangle i with vertices 3 i to 3 i + 2, all zero at first. */
static inline fixture fixture_make(size_t triangles, bool single)
{
    fixture f;
    memset(&f, 0, sizeof f);
    f.m.triangle_count = triangles;
    f.m.vertex_count = 3 * triangles;
    f.m.vertices = calloc(3 * triangles + 1, sizeof *f.m.vertices);
    f.m.triangles = calloc(triangles + 1, sizeof *f.m.triangles);
    f.m.slot_count = 1;
    f.m.single = single;
    assert_non_null(f.m.vertices);
    assert_non_null(f.m.triangles);
    for (size_t i = 0; i < triangles; i++)
        for (size_t k = 0; k < 3; k++)
            f.m.triangles[i].corner[k] = (uint32_t)(3 * i + k);
    return f;
}

static inline void fixture_set(fixture *f, size_t triangle, vec3 a, vec3 b, vec3 c)
{
    f->m.vertices[3 * triangle] = a;
    f->m.vertices[3 * triangle + 1] = b;
    f->m.vertices[3 * triangle + 2] = c;
}

static inline void fixture_build(fixture *f, int threads)
{
    diagnostic why;
    memset(&f->h, 0, sizeof f->h);
    f->h.of = &f->m;
    f->h.kind = HIERARCHY_BVH;
    assert_int_equal(hierarchy_build_bvh(&f->h, threads, &why), STATUS_OK);
}

static inline void fixture_free_hierarchy(fixture *f)
{
    free(f->h.nodes);
    free(f->h.blocks);
    memset(&f->h, 0, sizeof f->h);
}

static inline void fixture_free(fixture *f)
{
    fixture_free_hierarchy(f);
    free(f->m.vertices);
    free(f->m.triangles);
}
