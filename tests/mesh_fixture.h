/* Small meshes for tests, made from lists, and a cube that tests modify. */
#pragma once

#include "geometry/mesh/mesh.h"
#include <string.h>

/* An unfinished mesh of these vertices and triangles. */
static inline mesh *mesh_of(const vec3 *vertices, size_t vertex_count, const mesh_triangle *triangles,
                            size_t triangle_count)
{
    mesh *m = NULL;
    if (mesh_create(vertex_count, triangle_count, false, false, false, &m, NULL) != STATUS_OK)
        return NULL;
    memcpy(m->vertices, vertices, vertex_count * sizeof *vertices);
    if (triangle_count)
        memcpy(m->triangles, triangles, triangle_count * sizeof *triangles);
    return m;
}

/* Cube number c = 0, 1 ... with edges of 2 half about center, fronts facing outwards: vertices 8 c + (x > 0) + 2 (y >
 * 0) + 4 (z > 0), triangles from 12 c on. */
static inline void put_cube(mesh *m, size_t c, vec3 center, double half)
{
    static const uint32_t corners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (size_t v = 0; v < 8; v++)
        m->vertices[8 * c + v] =
            vec3_add(center, vec3_make(v & 1 ? half : -half, v & 2 ? half : -half, v & 4 ? half : -half));
    for (size_t t = 0; t < 12; t++)
        for (size_t k = 0; k < 3; k++)
            m->triangles[12 * c + t].corner[k] = (uint32_t)(8 * c) + corners[t][k];
}

static inline mesh *cubes(size_t count)
{
    mesh *m = NULL;
    if (mesh_create(8 * count, 12 * count, false, false, false, &m, NULL) != STATUS_OK)
        return NULL;
    for (size_t c = 0; c < count; c++)
        put_cube(m, c, vec3_make(10.0 * (double)c, 0.0, 0.0), 1.0);
    return m;
}

static inline void turn_triangle(mesh *m, size_t t)
{
    const mesh_triangle old = m->triangles[t];
    m->triangles[t] = (mesh_triangle){{old.corner[0], old.corner[2], old.corner[1]}};
}
