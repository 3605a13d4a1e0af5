/* A triangle mesh: indexed vertices with optional normals, texture coordinates and colours, and one material slot per
 * face; without triangles, a cloud of points.
 * Triangles are visible from both sides. The geometric normal (b - a) x (c - a) of a triangle points towards a viewer
 * in front, who sees its corners run clockwise in the left-handed world. A mesh whose every edge joins two triangles,
 * once in each direction, is closed: it bounds a volume, which is behind the fronts. So is one whose closed parts touch
 * at edges and faces (mesh_finish).
 *
 * A finished mesh is immutable (except for mesh_move) and shared: mesh_retain and mesh_release count its owners, from
 * any thread. Generators and readers create a mesh with mesh_create, fill it, and end with mesh_finish. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The numbers of vertices, of triangles and of triangle corners (three per triangle) fit into 32 bits. */
enum { MESH_TRIANGLES_MAX = 1 << 28, MESH_VERTICES_MAX = 1 << 29, MESH_SLOTS_MAX = 256 };
#define MESH_FAR 1e9 /* the largest magnitude of a coordinate */

typedef struct mesh_triangle {
    uint32_t corner[3];
} mesh_triangle;
typedef struct mesh_uv {
    double u, v;
} mesh_uv; /* u to the right, v upwards in the texture image; 0, 0 is its lower left corner */
typedef struct bounds3 {
    vec3 low, high;
} bounds3;

/* The hierarchies that a mesh owns, one per kind (geometry/hierarchy/hierarchy.h). */
typedef struct hierarchy hierarchy;
typedef enum hierarchy_kind {
    HIERARCHY_NONE,
    HIERARCHY_SPHERE,
    HIERARCHY_OCTANT,
    HIERARCHY_BVH,
    HIERARCHY_KIND_COUNT
} hierarchy_kind;

/* Why mesh_finish found a mesh not closed. */
typedef enum mesh_fault {
    MESH_FLAT,       /* no triangle has three different corners */
    MESH_ODD,        /* an odd number of triangles share the edge; 1: it is open */
    MESH_ONE_SIDED,  /* the fronts of the 2 triangles that share the edge cannot agree */
    MESH_UNBALANCED, /* more than 2 share it, and not as many run along it in either direction */
    MESH_CANCELLED,  /* all triangles of the part of the mesh lie on others with the same corners and opposite fronts */
    MESH_FAULT_COUNT
} mesh_fault;

/* Where: the edge between two vertices of a triangle, which `sharing` triangles share. */
typedef struct mesh_hole {
    uint32_t from, to;
    size_t triangle;
    int sharing;
    mesh_fault fault;
} mesh_hole;

typedef struct mesh {
    size_t vertex_count, triangle_count;
    vec3 *vertices;
    mesh_triangle *triangles;
    vec3 *normals;                    /* by vertex, unit vectors; NULL if there are none */
    mesh_uv *uvs;                     /* by vertex; NULL if there are none */
    float (*colors)[3];               /* by vertex, linear RGB from 0 to 1; NULL if there are none */
    uint8_t *slots;                   /* material slot by triangle; NULL: all 0 */
    int slot_count;                   /* at least 1 */
    char *slot_names[MESH_SLOTS_MAX]; /* owned; NULL where a slot has no name */
    /* set by the creator if no two vertices have the same position (-0 equals 0): mesh_finish then need not search for
     * such vertices. mesh_finish resets it. */
    bool distinct;
    /* set by mesh_finish: */
    bounds3 bounds;             /* of the vertices that triangles use, or of all without triangles; low > high: none */
    bool closed;                /* closed, with every front facing outwards */
    bool single;                /* every coordinate is exactly a float */
    bool crowded;               /* closed, though more than two triangles share some edge */
    size_t shell_count;         /* mesh_shells of a closed mesh; 0 for one that is not closed */
    mesh_hole hole;             /* for a mesh that is not closed */
    struct mesh_shared *shared; /* number of owners, and the hierarchies and operands built for it */
    uint32_t *numbers;          /* of an operand (hierarchy_operands): the mesh's numbers of its triangles; else NULL */
} mesh;

/* Checks that a mesh of this size is allowed and, with the temporary arrays of mesh_finish, fits into memory
 * (base/budget.h), before its vertices are computed. STATUS_BAD_INPUT if not. */
status mesh_check_size(size_t vertex_count, size_t triangle_count, bool with_normals, bool with_uvs, bool with_slots,
                       diagnostic *why);

/* Creates an unfinished mesh, all zero; with_* select the optional arrays. STATUS_BAD_INPUT as mesh_check_size,
 * STATUS_FAILURE: out of memory. The caller is its only owner. */
status mesh_create(size_t vertex_count, size_t triangle_count, bool with_normals, bool with_uvs, bool with_slots,
                   mesh **out, diagnostic *why);

/* Gives an unfinished mesh the array of colours, all black. Errors as mesh_create. */
status mesh_add_colors(mesh *m, diagnostic *why);

/* Mirrors an unfinished mesh between right-handed and left-handed axes: z changes its sign, and the last two corners of
 * each triangle change places, so that fronts stay fronts. Twice is the identity, except that -0 becomes 0. When
 * cancelled it ends early, and mesh_finish fails. */
void mesh_mirror(mesh *m);

/* Finishes a mesh. Checks that indices are in range, coordinates finite and within MESH_FAR, and colours within 0 to 1,
 * normalises normals (a zero normal becomes the triangle's), computes the bounds, and finds whether the mesh is closed;
 * for this, vertices at equal positions are one vertex (-0 equals 0) and a triangle with two equal corners is skipped.
 *
 * Triangles with the wrong winding in an otherwise closed mesh are flipped, and so is a closed mesh that is inside out
 * (negative volume). A connected part of which three quarters of the triangles agree keeps their direction, so that a
 * hollow stays a hollow; a more mixed part is made to face outwards. Given normals are not changed.
 *
 * Shells of a closed mesh may touch: where more than two triangles share an edge, as many must run along it in either
 * direction. Two triangles there with the same corners and opposite fronts cancel, as where two boxes are glued; they
 * stay in the mesh, but in no shell (mesh_shells). A part whose triangles all cancel is refused: m is not closed.
 *
 * The message of STATUS_BAD_INPUT names the triangle or vertex. STATUS_FAILURE: out of memory. STATUS_INTERRUPTED:
 * cancelled. */
status mesh_finish(mesh *m, diagnostic *why);

void mesh_retain(const mesh *m);
void mesh_release(const mesh *m);         /* NULL is allowed */
long mesh_reference_count(const mesh *m); /* the current number of owners */

/* Moves the vertices of a finished mesh, and replaces its normals if it has any (normalised as by mesh_finish): for an
 * animated solid between frames, while no other thread uses the mesh. Vertices with equal positions must stay together,
 * since `closed` is not computed again. The mesh's hierarchies are invalid until hierarchy_update
 * (geometry/hierarchy/hierarchy.h). vertices and normals: one per vertex; normals NULL keeps them. STATUS_BAD_INPUT as
 * mesh_finish, with the mesh unchanged. */
status mesh_move(mesh *m, const vec3 *vertices, const vec3 *normals, diagnostic *why);

/* same[v] is the lowest vertex at v's position, where -0 equals 0. The caller frees *same, which is NULL after a
 * failure. STATUS_FAILURE: out of memory. STATUS_INTERRUPTED: cancelled. */
status mesh_weld(const mesh *m, uint32_t **same, diagnostic *why);

/* first[t] is the lowest triangle of t's shell. The shells of a closed mesh are closed meshes: triangles with a common
 * edge are in one, but where more than two share the edge, only those that bound a wedge of solid there, one of which
 * opens it and one of which closes it around the edge. UINT32_MAX: t is in no shell, since it has two equal corners, or
 * cancels with another (mesh_finish), or its shell consists of triangles that all coincide with those of another shell
 * and face the same way, which counts once. Ownership and errors as mesh_weld. */
status mesh_shells(const mesh *m, uint32_t **first, diagnostic *why);

/* --- closing an open mesh (repair.c) --- */

/* What mesh_repair changed. */
typedef struct mesh_repairs {
    size_t welded; /* vertices that were moved to another one */
    size_t degenerate,
        duplicate;           /* triangles dropped: with two equal corners, and with the corners of an earlier one */
    size_t swapped;          /* pairs of triangles divided by the other diagonal */
    size_t turned;           /* triangles turned over */
    size_t holes, triangles; /* holes filled, and with how many triangles */
    struct mesh_fill {
        size_t edges;
        double span; /* the largest distance of two of its corners along an axis */
    } * fills;       /* one for each hole, in the order of their first triangles */
} mesh_repairs;

/* A closed copy of a finished mesh: moves each vertex to the first one within the distance `weld` (0: at the same
 * place), drops what repairs->degenerate and ->duplicate count, divides quadrilaterals by their other diagonal where
 * more than two triangles meet in one, turns triangles so that neighbours agree, and fills holes: with the
 * triangulation of least area of its corners (Barequet and Sharir, "Filling gaps in the boundary of a polyhedron", CAGD
 * 12(2), 1995), or, if that would use an edge of the mesh or has more than 400 corners, around a new vertex at their
 * mean. New triangles have the slot of a neighbour, and vertices of their own if the mesh has normals. The caller frees
 * repairs->fills, also after a failure, and releases the mesh. STATUS_BAD_INPUT, with the place, if the result is not
 * closed: more than two triangles share an edge, the surface has one side, or it is flat. Otherwise as mesh_finish. */
status mesh_repair(const mesh *m, double weld, mesh_repairs *repairs, mesh **out, diagnostic *why);

/* The volume enclosed by a closed mesh (negative when inside out), and the surface area. */
double mesh_volume(const mesh *m);
double mesh_area(const mesh *m);
