/* What the files of geometry/mesh*.c share, and no other needs. */
#pragma once

#include "geometry/mesh.h"

/* Are indices and slots in range, numbers finite and within MESH_FAR? STATUS_BAD_INPUT names the triangle or vertex. */
status mesh_check(const mesh *m, diagnostic *why);

/* same[v] is the lowest vertex at v's position, -0 being 0. The caller frees it; STATUS_FAILURE when memory is out. */
status mesh_weld(const mesh *m, uint32_t **same, diagnostic *why);

/* Sets m->closed or m->hole, and turns triangles that run the wrong way round. m has passed mesh_check. */
status mesh_close(mesh *m, diagnostic *why);

/* Triangles of a mesh without a hole. A half-edge 3 t + k runs from corner k of triangle t to the next one; mates[] is
 * the one on its other side, UINT32_MAX in triangles that join nothing. queue and turned have room for each triangle.
 */
typedef struct mesh_neighbours {
    const uint32_t *same, *mates;
    uint32_t *queue;
    uint8_t *turned;
} mesh_neighbours;

/* Turns triangles round so that neighbours agree. False if the surface has one side only: *at is then a half-edge where
 * it shows, and nothing is turned. Where three quarters of a connected part agree, they are right; otherwise its fronts
 * come to look outwards. */
bool mesh_orient(mesh *m, mesh_neighbours *n, size_t *at);

/* Exchanges the second and the third corner. */
void mesh_turn(mesh *m, size_t triangle);

/* Six times the volume between a triangle and a point. */
double mesh_triangle_volume6(const mesh *m, size_t triangle, vec3 origin);

/* Sets m->bounds and m->single from the vertices that triangles use. */
void mesh_find_bounds(mesh *m);

/* Makes every normal a unit vector; a zero one becomes that of the first triangle there that has one. */
void mesh_normalize(mesh *m);
