/* Functions that the files geometry/mesh*.c share. */
#pragma once

#include "geometry/mesh.h"

/* Checks that indices and slots are in range and coordinates finite and within MESH_FAR. The message of
 * STATUS_BAD_INPUT names the triangle or vertex. */
status mesh_check(const mesh *m, diagnostic *why);

/* same[v] is the lowest vertex at v's position, where -0 equals 0. The caller frees it. STATUS_FAILURE: out of
 * memory. */
status mesh_weld(const mesh *m, uint32_t **same, diagnostic *why);

/* Sets m->closed or m->hole, and flips triangles with the wrong winding. m has passed mesh_check. */
status mesh_close(mesh *m, diagnostic *why);

/* Triangles of a mesh without a hole. Half-edge 3 t + k runs from corner k of triangle t to the next corner; mates[] is
 * the half-edge on its other side, UINT32_MAX in a triangle with two equal corners, which has no neighbours. queue and
 * turned have room for each triangle. */
typedef struct mesh_neighbours {
    const uint32_t *same, *mates;
    uint32_t *queue;
    uint8_t *turned;
} mesh_neighbours;

/* Flips triangles so that neighbours agree. False for a one-sided surface: *at is then a half-edge where two neighbours
 * cannot agree, and nothing is flipped. A connected part of which three quarters agree keeps their direction; any other
 * part is made to face outwards. */
bool mesh_orient(mesh *m, mesh_neighbours *n, size_t *at);

/* Flips a triangle: swaps its second and third corner. */
void mesh_turn(mesh *m, size_t triangle);

/* Six times the volume between a triangle and a point. */
double mesh_triangle_volume6(const mesh *m, size_t triangle, vec3 origin);

/* Sets m->bounds and m->single from the vertices that triangles use. */
void mesh_find_bounds(mesh *m);

/* Makes every normal a unit vector; a zero normal becomes that of the first adjacent triangle that has one. */
void mesh_normalize(mesh *m);
