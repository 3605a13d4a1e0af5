/* A triangle mesh: indexed vertices with optional normals and texture coordinates, and a material slot a face.
 * Triangles are seen from both sides; a triangle's front is where its vertices run counterclockwise, so that its
 * geometric normal (b - a) x (c - a) points towards who looks at the front. A mesh whose every edge joins two
 * triangles, once in each direction, is closed: it bounds a volume, which lies behind the fronts.
 *
 * A mesh is not changed once it is made (but for mesh_move), and is shared: mesh_retain and mesh_release count its
 * owners (from any thread). Makers and readers fill one through mesh_create, and end with mesh_finish. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Numbers of triangles and of vertices fit into 32 bits, and their three corners times the memory of one into any
 * size_t. */
enum { MESH_TRIANGLES_MAX = 1 << 28, MESH_VERTICES_MAX = 1 << 29, MESH_SLOTS_MAX = 256 };
#define MESH_FAR 1e9 /* coordinates are finite and not larger than this */

typedef struct mesh_triangle {
    uint32_t corner[3];
} mesh_triangle;
typedef struct mesh_uv {
    double u, v;
} mesh_uv; /* u to the right, v upwards in the picture, whose lower left corner is 0, 0 */
typedef struct bounds3 {
    vec3 low, high;
} bounds3;

/* What mesh_finish found about a mesh that is not closed: an edge (by two vertices) that is not shared as it should be.
 */
typedef struct mesh_hole {
    uint32_t from, to;
    size_t triangle;
    int sharing;
} mesh_hole;

typedef struct mesh {
    size_t vertex_count, triangle_count;
    vec3 *vertices;
    mesh_triangle *triangles;
    vec3 *normals;                    /* by vertex, unit vectors; NULL if there are none */
    mesh_uv *uvs;                     /* by vertex; NULL if there are none */
    uint8_t *slots;                   /* material slot by triangle; NULL: all 0 */
    int slot_count;                   /* at least 1 */
    char *slot_names[MESH_SLOTS_MAX]; /* owned; NULL where a slot has no name */
    /* found by mesh_finish: */
    bounds3 bounds;           /* of the vertices that triangles use; low > high when there is no triangle */
    bool closed;              /* and every front looks outwards */
    bool single;              /* every coordinate is exactly a float */
    mesh_hole hole;           /* of a mesh that is not closed */
    struct mesh_share *share; /* number of owners, and what others have made for it (geometry/hierarchy.h) */
} mesh;

/* An unfinished mesh with room for so many; all zero; with_* say which optional arrays to have. STATUS_BAD_INPUT beyond
 * the limits, STATUS_FAILURE when memory is out. The caller is its one owner. */
status mesh_create(size_t vertex_count, size_t triangle_count, bool with_normals, bool with_uvs, bool with_slots,
                   mesh **out, diagnostic *why);

/* Checks that indices are in range and numbers finite and within MESH_FAR, normalises normals (a zero one becomes the
 * triangle's), finds bounds and whether the mesh is closed: vertices at equal positions are one here (-0 equals 0).
 * Triangles that run the wrong way round in an otherwise closed mesh are turned round, and so is a closed mesh that is
 * inside out (negative volume). A triangle with two equal corners joins nothing and is skipped in this. A connected
 * part of which three quarters agree keeps their direction, so that a hollow stays one; one more mixed comes to look
 * outwards. Normals that were given stay as they are. Of a surface with one side only the hole is an edge shared by 2.
 * STATUS_BAD_INPUT names the triangle or vertex. */
status mesh_finish(mesh *m, diagnostic *why);

void mesh_retain(const mesh *m);
void mesh_release(const mesh *m); /* NULL is allowed */
long mesh_owners(const mesh *m);  /* how many there are now */

/* Moves the vertices of a finished mesh, and gives it these normals where it has any (they are normalised as by
 * mesh_finish): of a body that moves, between frames, when no other thread looks at it. Vertices that lay at one place
 * must do so still, for whether it is closed is not found out again. Hierarchies that were kept with it do not fit any
 * more until hierarchy_follow (geometry/hierarchy.h). vertices and normals: one for each vertex; normals NULL leaves
 * them. STATUS_BAD_INPUT as mesh_finish, the mesh is then as it was. */
status mesh_move(mesh *m, const vec3 *vertices, const vec3 *normals, diagnostic *why);

/* Volume enclosed by a closed mesh (negative when inside out), and surface area. */
double mesh_volume(const mesh *m);
double mesh_area(const mesh *m);
